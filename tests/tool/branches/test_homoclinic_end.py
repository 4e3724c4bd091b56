"""Ends of homoclinic orbits: two on one side of a tangency and none beyond; an impact that is lost at a graze."""

import json
from dataclasses import replace

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError


def orbits_at(r, omega="2.8"):
    (saddle,) = si.linear(omega, 0, r).periodic(1, 1)
    return si.homoclinic_points(saddle, resolution="1e-4")


@pytest.fixture(scope="module")
def tangency():
    return si.homoclinic_end(orbits_at("0.5722")[0], "restitution")


def test_the_angle_of_orbits_falls_like_a_square_root_and_none_is_left_beyond(tangency):
    ((r,),) = tangency.parameters.tolist()
    assert r == pytest.approx(0.5719922606, abs=1e-9)
    near, far = (orbits_at(str(r + beside)) for beside in (2e-6, 8e-6))
    assert len(near) == len(far) == 2
    # states of the two orbits come together like the root of the distance, on both sides of those of the tangency
    apart = [abs(one.states[one.index] - other.states[other.index]).max() for one, other in (near, far)]
    assert apart[1] / apart[0] == pytest.approx(2, rel=0.02)
    assert len(orbits_at(str(r - 2e-6))) == 0


def test_no_impact_grazes_and_each_is_the_image_of_the_one_before(tangency):
    (states,), ((r,),) = tangency.states, tangency.parameters.tolist()
    assert tangency.weakest[0] == pytest.approx(0.1734, abs=1e-4)
    osc = si.linear("2.8", 0, r)
    after = osc.impact_map(*states[:-1].T)
    period = 2 * np.pi / 2.8
    turns = (after.tau - states[1:, 0]) / period
    assert np.abs(turns - np.rint(turns)).max() < 1e-11
    assert after.v == pytest.approx(states[1:, 1], abs=1e-11)


@pytest.mark.slow
def test_it_is_a_curve_in_two_numbers():
    curve = si.homoclinic_end(orbits_at("0.5722")[0], ("restitution", "omega"), ["2.8", "2.8005"])
    assert curve.over == ("restitution", "omega")
    r = curve.parameters[:, 0]
    assert curve.parameters[:, 1].tolist() == [2.8, 2.8005]
    assert len(orbits_at(str(r[1] + 8e-6), "2.8005")) == 2
    assert len(orbits_at(str(r[1] - 8e-6), "2.8005")) == 0
    assert curve.table()["weakest"].tolist() == curve.weakest.tolist()


@pytest.mark.slow
def test_over_a_frequency_it_is_the_same_curve():
    """The period moves with the number: the same tangency is found over omega, and over r at that omega."""
    orbit = orbits_at("0.5722")[0]
    ((omega,),) = si.homoclinic_end(orbit, "omega").parameters.tolist()
    curve = si.homoclinic_end(orbit, ("restitution", "omega"), ["2.8", repr(omega)])
    assert curve.parameters[-1, 0] == pytest.approx(0.5722, abs=1e-10)
    (*_, states) = curve.states
    after = si.linear(omega, 0, curve.parameters[-1, 0]).impact_map(*states[:-1].T)
    turns = (after.tau - states[1:, 0]) / (2 * np.pi / omega)
    assert np.abs(turns - np.rint(turns)).max() < 1e-11


def clearances(c):
    (saddle,) = si.linear("2.8", c, "0.75").periodic(1, 1)
    return si.homoclinic_points(saddle)


@pytest.fixture(scope="module")
def graze():
    return si.homoclinic_end(min(clearances(0), key=lambda orbit: orbit.weakest), "clearance", kind="graze")


def test_a_file_of_ends_has_their_model(graze, tmp_path):
    graze.to_csv(tmp_path / "ends.csv")
    heading, names, row = (tmp_path / "ends.csv").read_text().splitlines()
    assert si.ImpactOscillator(**json.loads(heading[2:])) == si.linear("2.8", 0, "0.75")
    assert names == "clearance,weakest,visible"
    assert float(row.split(",")[0]) == graze.parameters[0, 0]


def test_a_flight_touches_the_wall_where_an_impact_grazes(graze):
    """By the closed form of x'' + x = cos 2.8t between impacts."""
    (states,), ((c,),) = graze.states, graze.parameters.tolist()
    assert graze.visible.tolist() == [True]
    at = int(states[:, 1].argmin())
    assert abs(states[at, 1]) < 1e-12
    (tau, v), period = states[at - 1], 2 * np.pi / 2.8
    k = 1 / (1 - 2.8**2)
    P, Q = c - k * np.cos(2.8 * tau), v + 2.8 * k * np.sin(2.8 * tau)
    ends = states[at, 0] + period * np.arange(1, 5)
    touches = k * np.cos(2.8 * ends) + P * np.cos(ends - tau) + Q * np.sin(ends - tau) - c
    later = ends[np.abs(touches).argmin()]
    s = np.linspace(tau, later, 2001)[1:]
    x = k * np.cos(2.8 * s) + P * np.cos(s - tau) + Q * np.sin(s - tau)
    xdot = -2.8 * k * np.sin(2.8 * s) - P * np.sin(s - tau) + Q * np.cos(s - tau)
    assert x[-1] == pytest.approx(c, abs=1e-11)
    assert xdot[-1] == pytest.approx(0, abs=1e-11)
    assert (x[:-1] > c).all()
    # and the other impacts are images of one another
    after = si.linear("2.8", c, "0.75").impact_map(*np.delete(states[:-1], at - 1, axis=0).T)
    assert after.v == pytest.approx(np.delete(states[1:], at - 1, axis=0)[:, 1], abs=1e-9)


def test_the_weakest_velocity_falls_to_0_and_the_orbit_goes_on_without_the_impact(graze):
    ((c,),) = graze.parameters.tolist()
    far, near, beyond = (clearances(repr(c + beside)) for beside in (4e-4, 1e-4, -1e-4))
    weakest = [min(orbits, key=lambda orbit: orbit.weakest) for orbits in (far, near)]
    assert weakest[0].weakest / weakest[1].weakest == pytest.approx(4, rel=0.02)
    assert len(near) == len(beyond)
    (states,) = graze.states
    strong, period = np.delete(states, states[:, 1].argmin(), axis=0), 2 * np.pi / 2.8

    def beside(orbits):
        """Those that pass the strong impacts of the graze, and whether they have its weak one."""
        apart = [np.abs((strong[:, None] - orbit.states + period / 2) % period - period / 2) for orbit in orbits]
        gaps = [gap.max(axis=2).min(axis=1).max() for gap in apart]
        return [orbit.weakest < 1e-3 for orbit, gap in zip(orbits, gaps, strict=True) if gap < 0.01]

    assert beside(near) == [True]
    assert beside(beyond) == [False]


def test_an_orbit_below_the_wall_says_so(graze):
    assert "below the wall" not in repr(graze)
    assert "a flight is below the wall" in repr(replace(graze, visible=np.array([False])))


@pytest.mark.slow
def test_grazes_are_a_curve_in_two_numbers(graze):
    orbit = min(clearances(0), key=lambda orbit: orbit.weakest)
    curve = si.homoclinic_end(orbit, ("clearance", "restitution"), ["0.75", "0.751", "0.752"], "graze")
    assert curve.parameters[0, 0] == pytest.approx(graze.parameters[0, 0], abs=1e-11)
    assert np.abs(curve.weakest).max() < 1e-12
    assert curve.visible.all()
    bent = np.diff(curve.parameters[:, 0], 2)
    assert abs(bent[0]) < 0.05 * np.abs(np.diff(curve.parameters[:, 0])).min()


def test_what_is_no_orbit_is_refused():
    with pytest.raises(InputError, match=r"crossing = 3 is not accepted: give an orbit of si\.homoclinic_points"):
        si.homoclinic_end(3, "restitution")


def test_numbers_that_do_not_fit_are_refused():
    orbit = orbits_at("0.5722")[0]
    with pytest.raises(InputError, match="kind = 'cusp' is not accepted: give 'tangency' or 'graze'"):
        si.homoclinic_end(orbit, "restitution", kind="cusp")
    with pytest.raises(InputError, match="one number of the model, or two and values="):
        si.homoclinic_end(orbit, ("restitution", "omega"))
    with pytest.raises(InputError, match="unknown number of the model 'mass'"):
        si.homoclinic_end(orbit, "mass")
