"""Periodic orbits of every model of a family, beside those of each model alone and the flights of scipy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", 0, "0.8", {"omega": "1.7"})


def drawn(model, members):
    rng = np.random.default_rng(members)
    numbers = {"omega": (1.5, 5), "clearance": (-0.5, 0.7), "restitution": (0.3, 0.9)}
    return model.over(**{name: rng.uniform(*ends, members) for name, ends in numbers.items()})


@pytest.mark.parametrize(("n", "k"), [(1, 1), (1, 2), (1, 3), (2, 2)])
def test_each_model_has_the_orbits_that_it_has_alone(n, k):
    many = drawn(si.linear(4, 0, "0.5"), 30)
    found = many.periodic(n, k)
    assert found.complete.all() == (n == 1)
    for index, model in enumerate(many):
        at, alone = np.flatnonzero(found.member == index), model.periodic(n, k)
        assert len(alone) == at.size == found.count[index]
        assert all(is_one(found, row, orbit) for row, orbit in zip(at.tolist(), alone, strict=True))


def is_one(found, row, orbit):
    """Whether a row is an orbit of `osc.periodic`."""
    return (
        np.abs(found.tau[row] - orbit.tau).max() < 1e-7
        and np.abs(found.v[row] - orbit.v).max() < 1e-7
        and np.allclose(found.multipliers[row], orbit.multipliers, 1e-6, 1e-6)
    )


def flown(omega, c, tau, v):
    """Time and velocity of the next hit of a Duffing model, by scipy."""

    def field(t, y):
        return [y[1], np.cos(omega * t) - 0.1 * y[1] - y[0] - 0.3 * y[0] ** 3]

    def height(_, y):
        return y[0] - c

    height.terminal, height.direction = True, -1
    end = solve_ivp(field, (tau, tau + 50), [c, v], "DOP853", events=height, rtol=1e-11, atol=1e-12)
    return end.t[-1] - tau, end.y[1, -1]


def test_orbits_without_a_closed_form_close_in_flights_of_scipy():
    many = drawn(DUFFING, 8)
    found = many.periodic(1, 1)
    assert len(found) >= 2
    assert not found.complete.any()
    for row, member in enumerate(found.member.tolist()):
        omega, c, r = (many.flat[name][member] for name in ("omega", "clearance", "restitution"))
        for late in (0.0, 1e-3):  # another phase is no orbit
            tau, v = found.tau[row, 0] + late, found.v[row, 0]
            time, velocity = flown(omega, c, tau, v)
            miss = max(abs(time - 2 * np.pi / omega), abs(-r * velocity - v))
            assert (miss < 1e-7) == (not late)


def test_orbits_of_several_impacts_begin_at_their_least_phase():
    found = si.linear("2.8", "0.1", "0.8").over(clearance=[[0.1, 0.11]]).periodic(3, 3)
    assert found.count.shape == (1, 2)
    assert len(found)
    period = 2 * np.pi / 2.8
    assert (found.tau[:, 0] >= 0).all()
    assert (found.tau[:, :1] % period <= found.tau % period + 1e-9).all()
    assert (np.diff(found.tau, axis=1) > 0).all()
    assert np.ptp(found.tau, axis=1).max() < 3 * period


def test_a_family_without_members_has_no_orbits():
    found = si.linear(2, 0, "1/2").over(omega=[]).periodic(1, 1)
    assert len(found) == 0
    assert found.tau.shape == (0, 1)


def test_tables_have_a_row_an_orbit(tmp_path):
    found = si.linear(4, 0, "0.5").over(restitution=[0.4, 0.5]).periodic(1, 2)
    found.to_csv(tmp_path / "orbits.csv")
    heading, names, *rows = (tmp_path / "orbits.csv").read_text().splitlines()
    assert heading.startswith('# {"f"')
    assert names.startswith("member,restitution,stable,tau_1,v_1,multiplier_re_1")
    assert len(rows) == 2
    assert "2 (1, 2) orbits of 2 models, 2 stable; shown to be all for 2 models" in repr(found)


@pytest.mark.parametrize(
    ("arguments", "named", "told"),
    [((1,), {}, "k = None"), ((-1, 1), {}, "n = -1"), ((1, 1), {"digits": 30}, "digits = 30")],
)
def test_what_is_refused_is_named(arguments, named, told):
    with pytest.raises(si.InputError, match=told):
        si.linear(2, 0, "1/2").over(omega=[2, 3]).periodic(*arguments, **named)


def test_other_orbits_are_found_model_by_model():
    rests = si.linear(2, "0.7", "1/2").over(restitution=[0.4, 0.5])
    assert rests.periodic(math.inf, 1).count.tolist() == [1, 1]
    pair = si.linear("2.8", "-0.5", "0.8").replace(upper="0.5").over(restitution=[0.8, 0.7])
    assert pair.periodic("lu", 1).tau.shape == (4, 2)
