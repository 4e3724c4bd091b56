"""Periodic orbits against closed forms."""

from __future__ import annotations

import pickle
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import balls_at, series_of_any_length
from singimpact.branches import SEARCH, Closing, ClosingBoxes, closed_boxes, conditions, resting, solutions
from singimpact.branches.periodic import _doubts_in_window, _doubts_of_two, _lacking, periodic
from singimpact.flights.family import family
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.inputs import InputError


@pytest.mark.parametrize("n", [1, 2, 3])
def test_one_impact_in_n_periods(n: int) -> None:
    omega, r, c = 2 * n, 0.5, 0.02
    (found,) = periodic(linear(omega, c, r), 1, n)
    G = 1 / (1 - omega**2)
    v = 2 * r * omega * np.sqrt(G * G - c * c) / (1 - r)
    assert found.v[0] == pytest.approx(v, rel=1e-12)
    assert G * np.cos(omega * found.tau[0]) == pytest.approx(c, rel=1e-9)
    assert G * omega * np.sin(omega * found.tau[0]) == pytest.approx(v * (1 / r - 1) / 2, rel=1e-12)
    assert np.prod(found.multipliers) == pytest.approx(r**2, rel=1e-9)


def test_digits() -> None:
    (found,) = periodic(linear(4, 0, "0.5"), 1, 2, digits=30)
    with mpmath.workdps(40):
        assert abs(found.v[0] - mpmath.mpf(8) / 15) < mpmath.mpf(10) ** -29
        assert abs(found.tau[0] - 3 * mpmath.pi / 8) < mpmath.mpf(10) ** -29
        assert abs(found.multipliers[0] * found.multipliers[1] - mpmath.mpf(1) / 4) < mpmath.mpf(10) ** -29


@pytest.mark.parametrize(("n", "k"), [(-1, 1), (1, 0), (1.5, 1), (True, 1)])
def test_bad_counts(n: object, k: object) -> None:
    with pytest.raises(InputError):
        periodic(linear(4, 0, "0.5"), n, k)


def test_no_period() -> None:
    with pytest.raises(InputError, match="period"):
        periodic(ImpactOscillator("0", "-1", 0, "0.5"), 1, 1)


def closed_form(omega: float, r: float, c: float, k: int) -> list[tuple[float, float]]:
    """Budd and Dux 1994: the (1, k) orbits of x'' + x = cos(omega t), from c + v r'... solved for the velocity."""
    T = 2 * np.pi * k / omega
    G, C, S = 1 / (1 - omega**2), np.cos(T), np.sin(T)
    # x - G cos(omega t) is a free motion that starts at c - G cos, v + G omega sin: it must come back to c with -v/r
    found = np.array([_gap(tau, omega, r, c, G, C, S)[0] for tau in np.linspace(0, 2 * np.pi / omega, 4001)[:-1]])
    orbits = []
    grid = np.linspace(0, 2 * np.pi / omega, 4001)
    for i in np.flatnonzero(found * np.roll(found, -1) < 0):
        low, high = grid[i], grid[i + 1]
        for _ in range(80):
            middle = (low + high) / 2
            same = _gap(middle, omega, r, c, G, C, S)[0] * _gap(low, omega, r, c, G, C, S)[0] > 0
            low, high = (middle, high) if same else (low, middle)
        orbits.append((low, _gap(low, omega, r, c, G, C, S)[1]))
    return orbits


def _gap(tau, omega, r, c, G, C, S):
    a, b = c - G * np.cos(omega * tau), G * omega * np.sin(omega * tau)
    # a C + (v + b) S = a;  -a S + (v + b) C - b = -v/r
    v = a * (1 - C) / S - b
    return -a * S + (v + b) * C - b + v / r, v


@pytest.mark.parametrize("seed", range(6))
def test_one_impact_orbits_are_all_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    omega, r, c = rng.uniform(1.3, 6.5), rng.uniform(0.3, 0.95), rng.uniform(-0.02, 0.02)
    for k in (1, 2, 3):
        osc = linear(float(omega), float(c), float(r))
        orbits = osc.periodic(1, k)
        assert orbits.complete
        expected = []
        for tau, v in closed_form(omega, r, c, k):
            step = osc.impact_map(tau, v) if v > 0 else None
            if step is not None and abs(float(step.flight_time) - 2 * np.pi * k / omega) < 1e-6:
                expected.append((tau, v))
        assert [float(orbit.v[0]) for orbit in orbits] == pytest.approx([v for _, v in sorted(expected)], rel=1e-9)


@pytest.mark.parametrize("weak", [1e-4, 1e-6, 1e-9])
def test_orbits_that_nearly_graze(weak: float) -> None:
    w = 0.8
    A = np.hypot(1 - w * w, 0.1 * w) * (1 + 1.05 * weak)
    (orbit,) = linear(w, -1, "0.8", damping="0.1", amplitude=-float(A)).periodic(1, 1)
    assert 0.1 * weak < orbit.v[0] < 10 * weak


def test_orbits_of_other_kinds() -> None:
    chatter = linear(2, "0.7", "0.5").periodic(np.inf, 1)
    assert chatter.complete
    assert [orbit.kind for orbit in chatter] == ["chatter"]
    (free,) = linear("0.8", -3, "0.8", damping="0.1").periodic(0, 1)
    assert free.visible
    assert free.stable
    assert linear("0.8", "-2.71", "0.8", damping="0.1").periodic(0, 1) == []
    with pytest.raises(InputError, match=r"or math\.inf"):
        linear(4, 0, "0.5").periodic(-1, 1)


@pytest.mark.parametrize(("second", "both"), [("0.05", True), ("0.2", False)])
def test_an_orbit_of_chatter_through_one_or_two_lift_offs(second: str, both: bool) -> None:
    osc = si.ImpactOscillator("x", f"cos(2*t) + {second}*cos(t + 1)", "0.6", "1/2")
    found = osc.periodic(np.inf, 1)
    (orbit,) = found
    assert found.complete
    assert osc.periodic(np.inf, 2) == []
    flown = osc.orbit(orbit.tau[0], 0, impacts=2000)
    phases = np.mod(flown.tau[flown.kind == "release"], 2 * np.pi)
    assert (np.ptp(phases) > 1) == both
    assert np.abs(phases - orbit.tau[0]).min() < 1e-12


def test_lift_offs_without_rest_within_the_periods_are_decided() -> None:
    osc = linear("2.8", "0.6", "0.5")
    assert (osc.periodic(np.inf, 2), osc.periodic(np.inf, 2).complete) == ([], True)


def test_a_lift_off_that_is_not_decided_leaves_chatter_open(monkeypatch) -> None:
    monkeypatch.setattr(resting, "FLOWN", 3)
    flown = resting.orbit
    monkeypatch.setattr(resting, "orbit", lambda osc, tau, v, impacts: flown(osc, tau, v, min(impacts, 3)))
    found = linear(2, "0.7", "0.5").periodic(np.inf, 1)
    assert (found, found.complete) == ([], False)
    assert "no rest within 3 impacts" in found.notes[0]


def test_a_first_hit_that_doubles_leave_open_does_not_hide_an_orbit(monkeypatch) -> None:
    osc = linear(4, 0, "0.5")
    closing = Closing(family(osc), 1, 2)
    point = np.array([3 * np.pi / 8, 8 / 15])
    assert solutions.visible(closing, point, osc)
    open_ = replace(osc.impact_map(0.1, 0.5), status=np.int8(si.Status.unresolved), flight_time=np.float64(np.nan))
    monkeypatch.setattr(solutions, "impact_map", lambda *_, **__: open_)
    assert solutions.visible(closing, point, osc)
    monkeypatch.setattr(Closing, "heights", lambda *_: [(0.3, -0.1)])
    assert not solutions.visible(closing, point, osc)


@pytest.mark.parametrize("law", ["0.6", "-0.8*v + 0.1*v**2"])
@pytest.mark.parametrize("force", ["x + 0.2*xdot", "x + 0.1*xdot + 0.3*x**3"])
def test_conditions_of_many_points_are_those_of_each(force: str, law: str) -> None:
    osc = si.ImpactOscillator(force, "cos(1.7*t)", "0.3", law)
    closing = Closing(family(osc), 2, 2)
    points = np.array([[0.4, 3.0, 0.7, 0.5], [2.0, 6.5, 0.3, 1.1], [5.0, 7.0, 0.2, 0.0]])
    miss, slope = conditions(closing, points)
    for i, point in enumerate(points):
        loop = closing.at(point)
        assert miss[i] == pytest.approx(loop.miss, abs=1e-11)
        assert slope[i] == pytest.approx(loop.slope, abs=1e-9)


def test_a_start() -> None:
    osc = linear(omega="2.8", clearance="0.1", restitution="0.8", amplitude=-1)
    every = osc.periodic(3, 3)
    assert not every.complete
    assert every.notes
    (one,) = osc.periodic(3, 3, start=(0.6, 0.48))
    assert one.v == pytest.approx(every[0].v, rel=1e-10)
    (same,) = osc.periodic(3, 3, start=every[1])
    assert same.v == pytest.approx(every[1].v, rel=1e-12)
    with pytest.raises(InputError, match="start"):
        osc.periodic(3, 3, start="here")


def test_orbits_that_close_sooner_are_left_out() -> None:
    osc = linear(omega="2.8", clearance="0.1", restitution="0.8", amplitude=-1)
    assert len(osc.periodic(1, 1)) == 1
    assert osc.periodic(2, 2) == []


@pytest.mark.parametrize(("damping", "k", "orbits"), [pytest.param("0", 2, 0, marks=pytest.mark.slow), ("0.1", 2, 1)])
def test_two_impacts_of_a_linear_model_are_complete(damping: str, k: int, orbits: int) -> None:
    osc = linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45") if damping != "0" else linear("2.8", "0.1", "0.8")
    found = osc.periodic(2, k)
    assert len(found) == orbits
    assert found.complete
    assert found.notes == ()
    assert pickle.loads(pickle.dumps(osc.periodic(2, k))).complete


def test_a_list_that_lacks_an_orbit_is_not_complete() -> None:
    osc = linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
    assert "the list lacks <(2, 2) orbit, stable" in _doubts_of_two(osc, 2, [])[0]


@pytest.mark.slow
def test_what_is_not_decided_of_two_impacts_is_said() -> None:
    # r = 1, omega = 2: every phase closes after two impacts
    found = linear(2, 0, 1).periodic(2, 2)
    assert not found.complete
    assert "not decided" in found.notes[0]
    assert "resonance" in linear(1, "0.1", "0.8").periodic(2, 2).notes[-1]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_two_impact_orbits_are_all_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    numbers = [repr(float(x)) for x in (rng.uniform(1.2, 6), rng.uniform(-0.3, 0.3), rng.uniform(0.3, 0.95))]
    for k in (1, 2, 3):
        found = linear(*numbers, damping=rng.choice(["0", "0.05", "0.3"])).periodic(2, k)
        assert found.complete, (numbers, k, found.notes)


DUFFING = ImpactOscillator("x + x**3/10", "cos(4*t)", 0, "0.5")


@pytest.mark.slow
def test_a_window_of_velocities_of_a_nonlinear_model() -> None:
    """The one orbit of the window is found by balls alone; a list without it is not complete, one with it is."""
    found = DUFFING.periodic(1, 2, v=("0.49", "0.5"))
    assert (len(found), found.complete) == (1, True)
    (doubt,) = _doubts_in_window(DUFFING, (1, 2), (Fraction(49, 100), Fraction(1, 2)), [])
    assert "the list lacks <(1, 2) orbit, stable: (tau, v) = (1.08739, 0.496883)>" in doubt


def test_ends_of_a_window_may_be_irrational() -> None:
    assert DUFFING.periodic(1, 2, v=("pi/6.3", "sqrt(2)")).complete
    assert len(DUFFING.periodic(1, 2, v=("0.49", "pi/6"))) == 1


@pytest.mark.parametrize("v", [(1, 0), 3, (0, "a"), (-1, 2), (0, 1, 2)])
def test_windows_that_are_none(v) -> None:
    with pytest.raises(InputError, match=r"v = .* is not accepted: give two numbers \(low, high\)"):
        DUFFING.periodic(1, 2, v=v)


@pytest.mark.slow
def test_where_f_is_not_analytic_boxes_are_left() -> None:
    kink = ImpactOscillator("sqrt(x**2)", "cos(4*t)", "-0.05", "0.5")
    found = _doubts_in_window(kink, (1, 2), (Fraction(49, 100), Fraction(1, 2)), [])
    assert "are not decided" in found[0]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("osc", "n", "k", "v"),
    [
        (ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "-0.3", "0.6"), 1, 1, ("1.1", "1.3")),
        (DUFFING, 2, 2, ("0.55", "0.6")),
    ],
)
def test_orbits_of_nonlinear_models_are_all_found(osc, n: int, k: int, v) -> None:
    found = osc.periodic(n, k, v=v)
    assert len(found) == (n == 1)
    assert found.complete


@pytest.mark.slow
def test_an_orbit_of_two_impacts_is_isolated_in_its_window() -> None:
    """The window holds one orbit, a saddle: the boxes find it, and say so where a list lacks it."""
    osc = ImpactOscillator("x + x**3/10", "cos(2.8*t)", 0, "0.8")
    points, boxes = closed_boxes(osc, 2, 2, (Fraction(32, 100), Fraction(38, 100)))
    assert (boxes.complete, len(points)) == (True, 1)
    (orbit,) = osc.periodic(2, 2)
    proved = (points, boxes)
    assert _lacking(osc, (2, 2), proved, "velocities", [orbit]) == ()
    (doubt,) = _lacking(osc, (2, 2), proved, "velocities", [])
    assert "the list lacks <(2, 2) orbit, unstable: (tau, v) = (0.198629, 0.344181), (1.95592, 0.354193)>" in doubt


@pytest.mark.slow
@pytest.mark.parametrize("n", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_derivatives_of_the_closing_conditions_over_a_box_contain_differences(n: int) -> None:
    """Next to an orbit: the miss at the middles of small boxes, against the derivatives over a large one."""
    osc, k = (DUFFING, 2) if n == 1 else (ImpactOscillator("x + x**3/10", "cos(2.8*t)", 0, "0.8"), 2)
    (orbit,) = osc.periodic(n, k)
    first = int(np.argmax(orbit.v))
    centre, width = (float(orbit.tau[first]), float(orbit.v[first])), (2e-3, 5e-4)
    with balls_at(SEARCH.bits):
        system = ClosingBoxes(osc, n, k, (Fraction(1, 10), Fraction(1)))

        def place(state, spread):
            return tuple(system.balls.interval(Fraction(x - r), Fraction(x + r))
                         for x, r in zip(state, spread, strict=True))  # fmt: skip

        def missed(state):
            tau, v = place(state, (1e-9, 1e-9))
            with series_of_any_length():
                (end,) = [end for met, end in system._ends(tau, v, visible=False)
                          if met is None or met.time.overlaps(system.balls.interval(*hit))]  # fmt: skip
            return [float(end.height.mid()), float((system._after(end.speed)[0] - v).mid())]

        hit = [Fraction(float(orbit.tau[1 - first]) + (0 if first == 0 else 2 * np.pi / 2.8 * k) + s / 20)
               for s in (-1, 1)] if n == 2 else []  # fmt: skip
        _, over = system.linearised(box := place(centre, width), tuple(part.mid() for part in box))
        for j in (0, 1):
            ends = [missed([x + s * w * (i == j) for i, (x, w) in enumerate(zip(centre, width, strict=True))])
                    for s in (-1, 1)]  # fmt: skip
            for row in (0, 1):
                quotient = (ends[1][row] - ends[0][row]) / (2 * width[j])
                assert abs(float(over[row][j].mid()) - quotient) <= float(over[row][j].rad()) + 1e-5
        assert max(float(part.rad()) for row in over for part in row) < 0.5
