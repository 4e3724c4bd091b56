"""Periodic orbits that are proved to exist: they contain what Newton's method gives, and nothing false passes."""

import mpmath
import numpy as np
import paired_events
import pytest

import singimpact as si
from singimpact.branches import BallClosing, EnclosedOrbit
from singimpact.branches.krawczyk import enclosed_orbit
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.inputs import InputError

DUFFING = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


@pytest.mark.parametrize(("n", "k", "stable"), [(2, 1, False), pytest.param(3, 2, True, marks=pytest.mark.slow)])
def test_orbits_of_duffing(n, k, stable):
    (orbit,) = DUFFING.periodic(n, k)
    found = orbit.certified(25)
    assert found.stable is stable
    assert found.unique_within >= 1e-5
    digits = DUFFING.periodic(n, k, start=orbit, digits=30)[0]
    for name in ("tau", "v"):
        for ball, value in zip(getattr(found, name), getattr(digits, name), strict=True):
            assert ball.radius < mpmath.mpf(10) ** -25
            assert abs(ball.value - value) < mpmath.mpf(10) ** -24
    sizes = sorted(abs(complex(part)) for part in orbit.multipliers)
    balls = sorted(abs(complex(float(a.value), float(b.value))) for a, b in found.multipliers)
    assert np.allclose(sizes, balls, rtol=1e-8)


def test_one_impact_of_a_linear_model_is_that_of_the_closed_form():
    """x'' + x = cos 4 t, r = 1/2: v = 2 r omega |G|/(1 - r), G = 1/(1 - omega^2)."""
    (orbit,) = linear(4, 0, "0.5").periodic(1, 2)
    with mpmath.workdps(40):
        assert orbit.certified(30).v[0].contains(mpmath.mpf(8) / 15) or abs(
            orbit.certified(30).v[0].value - mpmath.mpf(8) / 15) < mpmath.mpf(10) ** -38  # fmt: skip


def test_states_that_are_no_orbit_are_refused():
    assert isinstance(enclosed_orbit(DUFFING, [1.9], [0.3], 1, 20), str)
    rest = linear(2, "0.99", "0.5").periodic(float("inf"), 1)
    for orbit in rest:
        with pytest.raises(InputError, match="impacts"):
            orbit.certified()


def test_a_box_without_the_orbit_is_not_accepted(monkeypatch):
    """Krawczyk's condition is what decides: where the last step of Newton's method is forged, the box is refused."""
    (orbit,) = DUFFING.periodic(2, 1)
    honest = BallClosing.miss
    calls = []

    def forged(self, states):
        calls.append(1)
        found = honest(self, states)
        return found * 0 if len(calls) == 1 else found

    monkeypatch.setattr(BallClosing, "miss", forged)
    found = enclosed_orbit(DUFFING, orbit.tau + 1e-2, orbit.v, 1, 20)
    assert isinstance(found, str) or not isinstance(found, EnclosedOrbit)


def states_beside(distance):
    """States that close through the wall, of the model beside an interior graze, where the orbit is virtual."""
    pair = paired_events.drawn("hidden impact", np.random.default_rng(5), (1e-2, 1e-1))
    branch = si.branch(pair.orbit, "q", pair.between)
    event = next(event for event in branch.events if event.kind == "hidden impact")
    for side in (1, -1):
        ends = sorted((event.parameter, event.parameter + side * distance))
        beside = si.branch(event.orbit, "q", (ends[0] - 1e-12, ends[1] + 1e-12))
        at = int(np.argmin(beside.parameter) if side < 0 else np.argmax(beside.parameter))
        if not beside.visible[at]:
            return beside.oscillator.replace(q=beside.parameter[at]), beside.tau[at], beside.v[at], pair.orbit.k
    raise AssertionError(f"no virtual orbit beside {event!r}")


@pytest.mark.parametrize("distance", [1e-3, 1e-5, 1e-6])
def test_an_orbit_that_dips_below_the_wall_is_refused(distance, monkeypatch):
    """The closing conditions hold through the wall: that flights are first hits is shown apart, and decides here."""
    osc, tau, v, k = states_beside(distance)
    assert isinstance(enclosed_orbit(osc, tau, v, k, 15), str)
    monkeypatch.setattr(BallClosing, "first_hits", lambda *_: None)
    assert isinstance(enclosed_orbit(osc, tau, v, k, 15), EnclosedOrbit)
