"""Two events of one kind within a step of a branch, against closed forms."""

from __future__ import annotations

import numpy as np
import paired_events
import pytest

import singimpact as si


def check(pair: paired_events.Pair) -> None:
    lacking, branch = paired_events.missed(pair)
    assert not lacking, (pair, branch)
    assert paired_events.between(pair, branch).size, (pair, branch)


@pytest.mark.parametrize("kind", paired_events.KINDS)
def test_no_pair_is_missed(kind: str) -> None:
    seed = [11, paired_events.KINDS.index(kind)]
    check(paired_events.drawn(kind, np.random.default_rng(seed), (1e-4, 3e-3)))


@pytest.mark.slow
def test_no_pair_of_many_is_missed() -> None:
    for pair in paired_events.pairs(20, 12, (1e-4, 1e-1)):
        check(pair)


def test_a_closed_form_that_is_wrong_is_seen() -> None:
    pair = paired_events.drawn("period-doubling", np.random.default_rng([11, 0]), (1e-4, 3e-3))
    moved = (pair.events[0] + pair.distance / 100, pair.events[1])
    wrong = paired_events.Pair(pair.kind, pair.orbit, pair.between, moved, pair.distance)
    assert paired_events.missed(wrong)[0] == [moved[0]]


def doubling_test(omega: float, c: float, r: float, branch: int) -> float:
    """1 + trace + determinant of the return map of a (1, 1) orbit of x'' + x = cos(omega t), in closed form."""
    T, P = 2 * np.pi / omega, 1 / (1 - omega**2)
    across, along = (1 - r) / (2 * r * P * omega), (1 + r) / (2 * r * np.tan(T / 2))
    # (across v)^2 + ((c - along v)/P)^2 = 1
    roots = np.roots([across**2 + (along / P) ** 2, -2 * c * along / P**2, (c / P) ** 2 - 1])
    v = float(np.sort(roots.real)[branch])
    a = (c - along * v) / P - c
    return 1 + r * r - 2 * r * np.cos(T) - r * (1 + r) * a * np.sin(T) / v


def test_an_orbit_between_two_doublings_is_unstable() -> None:
    # two doublings 0.6 % of the interval apart, less than a step
    (orbit,) = si.linear("1.243", "-0.44", "0.692").periodic(1, 1)
    branch = si.branch(orbit, "omega", (0.825, 2.475))
    first, second = sorted((event for event in branch.events if 1.05 < event.parameter < 1.07),
                           key=lambda event: event.parameter)  # fmt: skip
    assert [first.kind, second.kind] == ["period-doubling"] * 2
    for event in (first, second):
        assert doubling_test(event.parameter, -0.44, 0.692, 1) == pytest.approx(0, abs=1e-9)
        assert branch.parameter[event.index + 1] == event.parameter
    near = branch.visible & (branch.parameter > 1.04) & (branch.parameter < 1.09)
    number, stable = branch.parameter[near], branch.stable[near]
    inside = (number > first.parameter) & (number < second.parameter)
    assert inside.any()
    assert not stable[inside].any()
    assert stable[(number < first.parameter) | (number > second.parameter)].all()


@pytest.mark.parametrize("share", [-1e-13, 0, 1e-13])
def test_two_events_that_meet_are_listed_or_noted(share: float) -> None:
    # v = 0 where the wall is as far as the amplitude of the forced motion: at q = 0, where the branch only touches it
    touching = abs(1 / (1 - 2.8**2)) * (1 + share)
    osc = si.ImpactOscillator("x - h + q**2/2", "cos(2.8*t)", 0, "0.8", {"h": repr(touching), "q": "0.3"})
    branch = si.branch(osc.periodic(1, 1)[0], "q", (-0.4, 0.4))
    grazes = [event.parameter for event in branch.events if event.kind == "graze" and abs(event.parameter) < 1e-6]
    noted = [note for note in branch.notes if "the test of a graze comes so near to 0" in note]
    assert (len(grazes), len(noted)) in ((2, 0), (0, 1))


@pytest.mark.slow
@pytest.mark.parametrize("kind", paired_events.KINDS)
def test_a_branch_from_the_orbit_of_an_event_has_that_event(kind):
    """A test function is 0 at the start there, up to rounding; of both sides one has the event."""
    for turn in range(4):
        pair = paired_events.drawn(kind, np.random.default_rng([41, turn]), (1e-2, 1e-1))
        for event in si.branch(pair.orbit, "q", pair.between).events:
            if event.kind in (kind, "period-doubling") and min(abs(event.parameter - at) for at in pair.events) < 1e-6:
                again = si.branch(event.orbit, "q", pair.between).events
                same = [
                    each for each in again if each.kind == event.kind and abs(each.parameter - event.parameter) < 1e-8
                ]
                assert same, (pair, event)


@pytest.mark.parametrize("turn", [879, 1184])
def test_a_branch_begins_where_rounding_of_the_number_is_larger_than_that_of_the_orbit(turn):
    check(paired_events.drawn("fold", np.random.default_rng([1, turn]), (1e-4, 1e-1)))
