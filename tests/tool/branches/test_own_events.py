"""Events that a user defines, against orbits that scipy alone closes, and what functions may not do."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

import singimpact as si
from singimpact.branches import Curve
from singimpact.inputs import InputError

SPEED = 0.5


def half_speed(orbit):
    return orbit.v[0] - SPEED


class Slowest:
    """An event with a name of its own."""

    name = "slowest impact at 0.3"

    def test(self, orbit):
        return min(orbit.v) - 0.3


def drawn(seed: int):
    """A Duffing oscillator, its numbers, and its orbits of one impact in one or two periods."""
    rng = np.random.default_rng([33, seed])
    b, w, r = (round(float(number), 3) for number in rng.uniform([0.05, 1.5, 0.4], [0.5, 3.0, 0.8]))
    osc = si.ImpactOscillator(f"x + 0.1*xdot + {b}*x**3", f"A*cos({w}*t)", "-0.2", str(r), {"A": "1"})
    return (b, w, r), osc, [orbit for k in (1, 2) for orbit in osc.periodic(1, k)]


def closed_by_scipy(numbers, k: int, near: tuple[float, float]) -> float:
    """The amplitude of an orbit of one impact in k periods that starts with the velocity, flown by scipy."""
    b, w, r = numbers

    def miss(unknowns):
        tau, A = unknowns

        def field(t, y):
            return [y[1], A * np.cos(w * t) - y[0] - 0.1 * y[1] - b * y[0] ** 3]

        span = (tau, tau + 2 * np.pi * k / w)
        x, velocity = solve_ivp(field, span, [-0.2, SPEED], method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        return [x + 0.2, -r * velocity - SPEED]

    solution = root(miss, near, tol=1e-13)
    assert solution.success
    return float(solution.x[1])


@pytest.mark.parametrize("seed", range(4))
def test_a_velocity_is_reached_where_scipy_closes_the_orbit(seed: int) -> None:
    numbers, _, orbits = drawn(seed)
    assert orbits
    count = 0
    for orbit in orbits:
        branch = si.branch(orbit, "A", (0.3, 2.5), events=[half_speed])
        events = [event for event in branch.events if event.kind == "half_speed"]
        passed = np.flatnonzero(np.diff(np.sign(branch.v[~branch.at_event, 0] - SPEED)))
        assert len(events) >= len(passed)
        for event in events:
            (tau,), (v,) = event.orbit.tau, event.orbit.v
            assert v == pytest.approx(SPEED, abs=1e-12)
            # a start that is not the answer itself
            truth = closed_by_scipy(numbers, orbit.k, (float(tau) + 1e-3, event.parameter * 1.001))
            assert event.parameter == pytest.approx(truth, rel=1e-9)
            count += 1
    assert count


def duffing():
    osc = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(1.7*t)", "-0.3", "0.6", {"A": "0.75"})
    return osc.periodic(1, 1)[0]


def without(branch, *names: str):
    """Kinds and parameters, up to the rounding in which interpreted and compiled flights differ."""
    return [
        (event.kind, pytest.approx(event.parameter, rel=1e-14)) for event in branch.events if event.kind not in names
    ]


def bare(branch):
    return [(event.kind, event.parameter) for event in branch.events]


def test_other_events_are_as_without_it() -> None:
    plain, own = (si.branch(duffing(), "A", (0.25, 0.8), events=events) for events in ([], [half_speed, Slowest()]))
    assert without(own, "half_speed", Slowest.name) == bare(plain)
    assert {"half_speed", Slowest.name} <= {event.kind for event in own.events}
    assert own.parameter[own.at_event].size == plain.parameter[plain.at_event].size + len(own.events) - len(
        plain.events
    )


def test_an_own_event_is_drawn_and_refused_as_a_curve_and_a_certificate() -> None:
    branch = si.branch(duffing(), "A", (0.25, 0.8), events=[Slowest()])
    event = next(event for event in branch.events if event.kind == Slowest.name)
    axes = si.plot(branch)
    assert Slowest.name in [text.get_text() for text in axes.texts]
    assert event.others() == []
    with pytest.raises(InputError, match=r"slowest impact at 0\.3.* no proof covers an event of this kind"):
        event.certified()
    with pytest.raises(InputError, match="graze, hidden impact, onset of rest or pitchfork"):
        si.event_curve(event, ("A", "clearance"))


def test_impacts_are_in_the_order_of_the_branch() -> None:
    """The second impact of an orbit is the second column, also where the phase of the first passes a period."""
    (orbit, *_) = si.linear("2.8", "0.1", "0.8", amplitude=-1, phase=2).periodic(3, 3)
    seen = []

    def second(orbit):
        seen.append(orbit.v[1])
        return orbit.v[1] - 0.5

    branch = si.branch(orbit, "clearance", (-0.2, 0.3), events=[second])
    assert not [note for note in branch.notes if "jumps" in note]
    crossed = [branch.v[event.index + 1, 1] for event in branch.events if event.kind == "second"]
    assert crossed
    assert crossed == pytest.approx([0.5] * len(crossed), abs=1e-12)
    first = np.argmin(np.mod(branch.tau, 2 * np.pi / 2.8), axis=1)
    assert len(set(first.tolist())) > 1, "no impact passes a period: the order was not tried"
    # an event of another kind, and a point between two events, are no points at which tests are computed
    assert len(set(branch.v[:, 1]) - set(seen)) <= 2 * len(branch.events)


def jumping(orbit):
    return 1.0 if orbit.v[0] > SPEED else -1.0


def offset(orbit):
    return orbit.v[0] - SPEED + np.copysign(1e-4, orbit.v[0] - SPEED)


def steep(orbit):
    return np.tanh(1e4 * (orbit.v[0] - SPEED))


def rooted(orbit):
    return np.copysign(abs(orbit.v[0] - SPEED) ** 0.5, orbit.v[0] - SPEED)


@pytest.mark.parametrize("function", [jumping, offset])
def test_a_jump_is_a_note_and_no_event(function) -> None:
    branch = si.branch(duffing(), "A", (0.25, 0.8), events=[function, half_speed])
    (event,) = [event for event in branch.events if event.kind in (function.__name__, "half_speed")]
    assert event.kind == "half_speed"
    (note,) = [note for note in branch.notes if "jumps" in note]
    assert note.startswith(f"{function.__name__} jumps from ")
    assert f"near A = {event.parameter:.9g}: this change of sign is not a zero" in note


@pytest.mark.parametrize("function", [steep, rooted])
def test_a_steep_zero_is_an_event(function) -> None:
    branch = si.branch(duffing(), "A", (0.25, 0.8), events=[function, half_speed])
    one, other = (event.parameter for event in branch.events if event.kind in (function.__name__, "half_speed"))
    assert one == pytest.approx(other, abs=1e-11)


def test_two_zeros_within_a_step() -> None:
    def twice(orbit):
        return (orbit.v[0] - SPEED) * (orbit.v[0] - SPEED - 1e-4)

    branch = si.branch(duffing(), "A", (0.25, 0.8), events=[twice])
    speeds = [float(event.orbit.v[0]) for event in branch.events if event.kind == "twice"]
    assert sorted(speeds) == pytest.approx([SPEED, SPEED + 1e-4], abs=1e-11)


def test_a_function_without_a_value_is_one_sentence() -> None:
    def lost(orbit):
        return np.nan if orbit.v[0] > SPEED else 1.0

    def broken(orbit):
        return orbit.speed

    with pytest.raises(InputError, match=r"^events: lost at A = \S+ is nan; give a function that has a finite value"):
        si.branch(duffing(), "A", (0.25, 0.8), events=[lost])
    with pytest.raises(InputError, match=r"^events: broken at A = \S+ raises AttributeError: .*; give a function"):
        si.branch(duffing(), "A", (0.25, 0.8), events=[broken])


@pytest.mark.parametrize(
    ("events", "words"),
    [
        (half_speed, "a list of functions"),
        ("half_speed", "a list of functions"),
        ([lambda orbit: orbit.v[0]], "a list of functions of an orbit that have a name"),
        ([3], "a list of functions"),
        ([half_speed, half_speed], "a name that no other event has"),
    ],
)
def test_bad_events_are_refused(events, words: str) -> None:
    with pytest.raises(InputError, match=words):
        si.branch(duffing(), "A", (0.25, 0.8), events=events)


def test_names_of_kinds_are_taken() -> None:
    def graze(orbit):
        return orbit.v[0]

    with pytest.raises(InputError, match="'graze' is not accepted: give a name that no other event has"):
        si.branch(duffing(), "A", (0.25, 0.8), events=[graze])


def test_values_of_own_functions_are_not_taken_from_the_cache(tmp_path, monkeypatch) -> None:
    """A branch goes on from its stored points, and another function of the same name is called at each of them."""
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))

    def speed(orbit):
        return orbit.v[0] - 0.5

    first = si.branch(duffing(), "A", (0.25, 0.8), events=[speed])

    def speed(orbit):
        return orbit.v[0] - 0.6

    steps = []
    beyond = Curve.beyond
    monkeypatch.setattr(Curve, "beyond", lambda self, start, length: steps.append(1) or beyond(self, start, length))
    second = si.branch(duffing(), "A", (0.25, 0.8), events=[speed])
    plain = si.branch(duffing(), "A", (0.25, 0.8))
    assert len(steps) < len(first) + len(second)
    for branch, value in ((first, 0.5), (second, 0.6)):
        (event,) = [event for event in branch.events if event.kind == "speed"]
        assert float(event.orbit.v[0]) == pytest.approx(value, abs=1e-11)
    assert without(second, "speed") == bare(plain) == without(first, "speed")
