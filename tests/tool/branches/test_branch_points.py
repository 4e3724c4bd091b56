"""Pitchforks and transcritical points of branches, against closed forms and against scipy."""

from __future__ import annotations

import numpy as np
import paired_events
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import singimpact as si
from singimpact.inputs import InputError


def doubling(rng: np.random.Generator) -> tuple[float, float, float, float] | None:
    """omega, c, r, v at a period doubling of a visible (1, 1) orbit, in closed form."""
    omega, r = float(rng.uniform(2.2, 6)), float(rng.uniform(0.3, 0.9))
    family = paired_events.Family(omega, 0.0, r, 1, int(rng.choice([-1, 1])))
    v = paired_events.event_velocity("period-doubling", family, rng)
    orbit = None if v is None else family.orbit(v)
    return None if v is None or orbit is None or family.lowest(v) <= 0.01 else (omega, float(orbit[1]), r, v)


def doubled_branch(rng: np.random.Generator) -> tuple[float, float, si.Branch, si.Branch]:
    """omega and c at a doubling of a drawn model, the branch of (1, 1) orbits over c, and that of its (2, 2) orbits."""
    while True:
        drawn = doubling(rng)
        if drawn is None:
            continue
        omega, c, r, v = drawn
        near = [orbit for orbit in si.linear(omega, c + 1e-3, r).periodic(1, 1) if abs(orbit.v[0] - v) < 0.05]
        if len(near) != 1:
            continue
        once = si.branch(near[0], "clearance", (c - 0.05, c + 0.05))
        events = [event for event in once.events if event.kind == "period-doubling" and abs(event.parameter - c) < 1e-9]
        if len(events) == 1:
            return omega, c, once, si.branch(events[0].others()[0], "clearance", (c - 0.05, c + 0.05))


def pitchforks_are_doublings(seed: int) -> None:
    omega, c, once, twice = doubled_branch(np.random.default_rng([21, seed]))
    events = [event for event in twice.events if event.kind == "pitchfork"]
    (event,) = [event for event in events if abs(event.parameter - c) < 1e-3]
    assert event.parameter == pytest.approx(c, abs=1e-10)
    assert twice.parameter[event.index + 1] == event.parameter
    assert (event.orbit.n, event.orbit.k) == (2, 2)
    assert np.diff(event.orbit.tau) == pytest.approx([2 * np.pi / omega], abs=1e-9)
    assert np.diff(event.orbit.v) == pytest.approx([0], abs=1e-9)
    assert np.abs(event.orbit.multipliers - 1).min() < 1e-7
    (half,) = event.others()
    assert (half.n, half.k) == (1, 1)
    assert np.abs(half.multipliers + 1).min() < 1e-8
    assert not any(event.kind == "fold" and abs(event.parameter - c) < 1e-6 for event in twice.events)
    assert "pitchfork" not in [event.kind for event in once.events]


def test_a_doubled_branch_has_a_pitchfork_where_it_began() -> None:
    pitchforks_are_doublings(0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 7))
def test_doubled_branches_have_pitchforks_where_they_began(seed: int) -> None:
    pitchforks_are_doublings(seed)


@pytest.fixture(scope="module")
def pitchfork():
    (orbit,) = si.linear("4.83", "0.36", "0.34").periodic(2, 2)
    (event,) = [event for event in si.branch(orbit, over="clearance", between=(0.35, 0.4)).events
                if event.kind == "pitchfork"]  # fmt: skip
    return event


def test_a_pitchfork_has_no_certificate(pitchfork) -> None:
    with pytest.raises(
        InputError, match=r"no proof covers an event of this kind.* the period doubling of the .1, 1. orbits"
    ):
        pitchfork.certified()
    # the doubling that it names is certified, and lies there
    (half,) = pitchfork.others()
    (event,) = [event for event in si.branch(half, "clearance", (0.35, 0.4)).events if event.kind == "period-doubling"]
    assert float(event.certified(12).parameter.value) == pytest.approx(pitchfork.parameter, abs=1e-11)


def test_the_curve_of_a_pitchfork_is_that_of_the_doublings_of_half_its_orbits(pitchfork) -> None:
    (half,) = pitchfork.others()
    (event,) = [event for event in si.branch(half, "clearance", (0.35, 0.4)).events if event.kind == "period-doubling"]
    both = [si.event_curve(each, ("clearance", "omega"), ((0.3, 0.45), (4.7, 4.9))) for each in (pitchfork, event)]
    whole, once = both
    assert (whole.kind, whole.n, once.kind, once.n) == ("pitchfork", 2, "period-doubling", 1)
    assert len(whole) > 10
    here = np.interp(whole.parameters[:, 1], once.parameters[:, 1], once.parameters[:, 0])
    assert np.abs(here - whole.parameters[:, 0]).max() < 1e-3
    assert np.abs(whole.v[:, 0] - whole.v[:, 1]).max() == 0


def test_a_pitchfork_is_drawn() -> None:
    (orbit,) = si.linear("4.83", "0.36", "0.34").periodic(2, 2)
    picture = si.plot(si.branch(orbit, over="clearance", between=(0.35, 0.4)))
    texts = [*picture.axes.texts, *picture.axes.get_legend().get_texts()]
    assert any("pitchfork" in text.get_text() for text in texts)


def return_map(q: float, b: float, K: float) -> np.ndarray:
    """The derivative of the map over a period at x = cos t, which solves the equation for every q."""

    def field(t: float, y: np.ndarray) -> list[float]:
        x, u, matrix = y[0], y[1], y[2:].reshape(2, 2)
        by_x, by_u = 1 + 3 * K * x * x + q * (1 - 3 * x * x - u * u), b - 2 * q * x * u
        force = x + b * u + K * x**3 + q * x * (1 - x * x - u * u)
        return [u, -b * np.sin(t) + K * np.cos(t) ** 3 - force,
                *(np.array([[0, 1], [-by_x, -by_u]]) @ matrix).ravel()]  # fmt: skip

    flown = solve_ivp(field, (0, 2 * np.pi), [1, 0, 1, 0, 0, 1], method="DOP853", rtol=1e-11, atol=1e-12)
    return np.asarray(flown.y[2:, -1].reshape(2, 2))


@pytest.mark.slow
def test_a_branch_that_another_one_crosses() -> None:
    rng = np.random.default_rng(8)
    b, K = (round(float(number), 3) for number in rng.uniform([0.2, 0.1], [0.3, 0.4]))

    def test(q: float) -> float:
        matrix = return_map(q, b, K)
        return float(1 - np.trace(matrix) + np.linalg.det(matrix))

    truth = float(brentq(test, 0.2, 1.4, xtol=1e-11))
    force = f"x + {b}*xdot + {K}*x**3 + q*x*(1 - x**2 - xdot**2)"
    osc = si.ImpactOscillator(force, f"-{b}*sin(t) + {K}*cos(t)**3", -3, "0.5", {"q": round(truth - 0.05, 3)})
    (orbit,) = [orbit for orbit in osc.periodic(0, 1) if abs(orbit.x[0] + 1) < 1e-6]
    branch = si.branch(orbit, "q", (truth - 0.1, truth + 0.1))
    (event,) = branch.events
    assert event.kind == "transcritical"
    assert event.parameter == pytest.approx(truth, abs=1e-9)
    (other,) = event.others()
    assert abs(other.x[0] + 1) > 1e-5
    again = si.branch(other, "q", (truth - 0.02, truth + 0.02))
    (event,) = again.events
    assert (event.kind, event.parameter) == ("transcritical", pytest.approx(truth, abs=1e-8))
