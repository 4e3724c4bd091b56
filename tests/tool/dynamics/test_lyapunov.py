"""Lyapunov exponents against multipliers, the mean shrinking of areas, and the growth of small distances."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Status

LINEAR = si.linear("2.8", 0, "0.8")


def shrinking(found, r, damping=0.0):
    """2 ln r n/T - damping + ln(v_0/v_n)/T: the sum of the exponents for constant restitution and damping."""
    return (2 * np.log(r) * found.impacts + np.log(found.start[1] / found.last[1])) / found.time - damping


@pytest.mark.parametrize(
    ("osc", "r", "damping", "impacts"),
    [
        (LINEAR, 0.8, 0.0, 100_000),
        (si.linear("2.8", "-0.1", "0.9", damping="0.1"), 0.9, 0.1, 30_000),
        (si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6"), 0.6, 0.1, 200),
    ],
)
def test_the_sum_is_the_mean_shrinking_of_areas(osc, r, damping, impacts):
    found = si.lyapunov(osc, 0.1, 0.5, impacts)
    assert (found.impacts, found.status) == (impacts, Status.hit)
    assert found.exponents.sum() == pytest.approx(shrinking(found, r, damping), abs=1e-12)
    assert found.per_impact == pytest.approx(found.exponents * found.time / impacts, rel=1e-15)


@pytest.mark.slow
def test_the_sum_with_a_law_of_restitution_and_a_damping_that_varies():
    osc = si.ImpactOscillator("x + xdot**3/5", "cos(2*t)", 0, "-0.8*v + 0.1*v**2")
    found = si.lyapunov(osc, 0.1, 0.5, 40, transient=0)
    tau, v = 0.1, 0.5
    total = 0.0
    for _ in range(40):
        hit = osc.first_hit(tau, v)
        u = float(hit.velocity)
        total += np.log(0.8 - 0.2 * u) + np.log(v / -u)
        total -= quad(lambda t: 0.6 * osc.flight(tau, v, t).xdot ** 2, 0, float(hit.flight_time), epsabs=1e-13)[0]  # noqa: B023
        tau, v = tau + float(hit.flight_time), -0.8 * u + 0.1 * u * u
    assert (tau, v) == pytest.approx(found.last, rel=1e-9)
    assert found.exponents.sum() == pytest.approx(total / found.time, abs=1e-10)


@pytest.mark.parametrize(("osc", "n", "k"), [(si.linear(4, 0, "0.5"), 1, 2), (si.linear(2, "0.3", "0.5"), 1, 1)])
def test_exponents_of_a_periodic_orbit_are_those_of_its_multipliers(osc, n, k):
    orbit = osc.periodic(n, k)[0]
    assert orbit.stable
    found = si.lyapunov(osc, orbit.tau[0], orbit.v[0], 4000)
    truth = np.sort(np.log(np.abs(orbit.multipliers)))[::-1] / (k * float(2 * np.pi / {1: 2, 2: 4}[k]))
    # the vector turns into place: a part of order 1/n
    assert found.exponents == pytest.approx(truth, abs=2e-3)
    assert found.exponents.sum() == pytest.approx(truth.sum(), rel=1e-11)


def test_small_distances_grow_at_the_larger_exponent():
    found = si.lyapunov(LINEAR, 0.1, 0.5, 40_000, transient=100)
    assert found.exponents[0] > 20 * found.error[0] > 0
    # two orbits, their distance set back at every impact
    (tau, v), period = (0.1, 0.5), 2 * np.pi / 2.8
    apart, growth, time = np.array([1e-7, 0.0]), [], []
    for _ in range(4000):
        ends = LINEAR.iterate([tau, tau + apart[0]], [v, v + apart[1]], 1)
        step = np.array([np.diff(ends.tau)[0], np.diff(ends.v)[0]])
        growth.append(np.log(np.hypot(*step) / 1e-7))
        time.append(ends.tau[0] - tau)
        tau, v = float(ends.tau[0]) % period, float(ends.v[0])
        apart = step * 1e-7 / np.hypot(*step)
    blocks = np.reshape(growth, (40, 100)).sum(axis=1) / np.mean(time) / 100
    spread = np.hypot(blocks.std() / np.sqrt(40), found.error[0])
    assert abs(blocks.mean() - found.exponents[0]) < 4 * spread


def test_the_standard_error_covers_what_longer_orbits_give():
    long = si.lyapunov(LINEAR, 0.1, 0.5, 1_000_000)
    short = [si.lyapunov(LINEAR, 0.1 * k, 0.5, 5000, transient=50) for k in range(1, 9)]
    off = [(each.exponents[0] - long.exponents[0]) / each.error[0] for each in short]
    assert 0.2 < np.sqrt(np.mean(np.square(off))) < 3


def test_blocks_of_any_length_give_one_result(monkeypatch):
    import singimpact.dynamics.lyapunov as module

    stable = si.linear(4, 0, "0.5")
    usual = [si.lyapunov(osc, 0.1, 0.5, 3000).exponents for osc in (LINEAR, stable)]
    monkeypatch.setattr(module, "SETTINGS", module.LyapunovSettings(stretches=3))
    assert si.lyapunov(LINEAR, 0.1, 0.5, 3000).exponents == pytest.approx(usual[0], abs=1e-12)
    # other blocks round the phase elsewhere: a chaotic orbit becomes another one
    monkeypatch.setattr(module, "SETTINGS", module.LyapunovSettings(block=700, stretches=3))
    assert si.lyapunov(stable, 0.1, 0.5, 3000).exponents == pytest.approx(usual[1], abs=1e-12)


def test_an_orbit_that_rests_again_and_again_is_superstable():
    found = si.lyapunov(si.linear("0.9", "0.2", "0.4"), "0.3", "0.4")
    assert found.superstable
    assert found.status == Status.sticks
    assert found.exponents.tolist() == [-np.inf, -np.inf]
    assert "superstable" in repr(found)
    resting = si.lyapunov(si.ImpactOscillator("0", "-2", 0, "1/2"), 0, 1)
    assert resting.superstable


def test_what_follows_one_rest_is_measured():
    # from rest at 0.3 the mass lifts off later; the orbit then settles without rests
    osc = si.linear(2, "0.3", "0.5")
    found = si.lyapunov(osc, "1.2", "0.01", 2000)
    assert not found.superstable
    assert found.exponents.sum() == pytest.approx(shrinking(found, 0.5), abs=1e-12)
    assert found.exponents == pytest.approx(np.full(2, np.log(0.5) / np.pi), abs=2e-3)


def test_a_graze_and_no_return_are_said():
    found = si.lyapunov(si.ImpactOscillator("0", "6*t - 4", 0, "1/2"), 0, 1)  # x = t (t - 1)^2
    assert found.status == Status.graze
    away = si.lyapunov(si.ImpactOscillator("0", "1", 0, "1/2"), 0, 1)
    assert away.status in (Status.no_return, Status.escaped)
    assert np.isnan(away.exponents).all()
    assert "ended by" in repr(away)


def test_bad_input_is_refused_in_a_sentence():
    with pytest.raises(InputError, match="do not broadcast"):
        si.lyapunov(LINEAR, [0, 1], [1, 2, 3])
    with pytest.raises(InputError, match="impacts = 0 is not accepted"):
        si.lyapunov(LINEAR, 0, 1, 0)
    with pytest.raises(InputError, match="osc = 'x' is not accepted: give an ImpactOscillator"):
        si.lyapunov("x", 0, 1)
