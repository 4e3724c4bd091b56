"""Tangencies of W^u and W^s: two orbits on one side, none on the other, and an angle like a square root between."""

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError


def orbits_at(r, omega="2.8"):
    (saddle,) = si.linear(omega, 0, r).periodic(1, 1)
    return si.homoclinic_points(saddle, resolution="1e-4")


@pytest.fixture(scope="module")
def tangency():
    return si.homoclinic_tangency(orbits_at("0.5722")[0], "restitution")


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
    curve = si.homoclinic_tangency(orbits_at("0.5722")[0], ("restitution", "omega"), ["2.8", "2.8005"])
    assert curve.over == ("restitution", "omega")
    r = curve.parameters[:, 0]
    assert curve.parameters[:, 1].tolist() == [2.8, 2.8005]
    assert len(orbits_at(str(r[1] + 8e-6), "2.8005")) == 2
    assert len(orbits_at(str(r[1] - 8e-6), "2.8005")) == 0
    assert curve.table()["weakest"].tolist() == curve.weakest.tolist()


def test_what_is_no_orbit_is_refused():
    with pytest.raises(InputError, match=r"crossing = 3 is not accepted: give an orbit of si\.homoclinic_points"):
        si.homoclinic_tangency(3, "restitution")


def test_numbers_that_do_not_fit_are_refused():
    orbit = orbits_at("0.5722")[0]
    with pytest.raises(InputError, match="one number of the model, or two and the values of the second"):
        si.homoclinic_tangency(orbit, ("restitution", "omega"))
    with pytest.raises(InputError, match="unknown number of the model 'mass'"):
        si.homoclinic_tangency(orbit, "mass")
