"""Proved chaos: the sets cross one another in flights of doubles too, and nothing false passes."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import flint
import numpy as np
import pytest

import singimpact as si
from singimpact.branches import CrossedSet, Horseshoe, horseshoe as room
from singimpact.branches.horseshoe import horseshoe
from singimpact.inputs import InputError

OSC = si.linear("2.8", 0, "0.8")
PERIOD = 2 * np.pi / 2.8


@pytest.fixture(scope="module")
def crossing():
    return si.homoclinic_points(OSC.periodic(1, 1)[0])[0]


@pytest.fixture(scope="module")
def found(crossing) -> Horseshoe:
    return crossing.horseshoe()


def coordinates(states: np.ndarray, of: CrossedSet) -> np.ndarray:
    """x_u/a and x_s/b of states."""
    away = states - [float(part) for part in of.centre]
    away[:, 0] -= PERIOD * np.rint(away[:, 0] / PERIOD)
    frame, radii = (np.array([[float(x) for x in row] for row in rows]) for rows in (of.frame, [of.radii]))
    return np.linalg.solve(frame, away.T).T / radii[0]


def sampled(one: CrossedSet, u: np.ndarray, s: np.ndarray) -> np.ndarray:
    centre = np.array([float(part) for part in one.centre])
    frame, radii = (np.array([[float(x) for x in row] for row in rows]) for rows in (one.frame, [one.radii]))
    return centre + (np.stack([u, s], axis=1) * radii[0]) @ frame.T


def flown(states: np.ndarray) -> np.ndarray:
    step = OSC.impact_map(*states.T)
    return np.stack([step.tau, step.v], axis=1)


@pytest.mark.slow
def test_loops_and_entropy(found):
    assert found.loops == (1, 17)
    assert len(found.sets) == 17
    x = max(root.real for root in np.roots([1, -1, *[0] * 15, -1]) if abs(root.imag) < 1e-12)
    assert float(found.entropy.value) == pytest.approx(np.log(x), abs=1e-12)
    assert found.entropy.radius < 1e-12


def test_flights_of_doubles_cross_the_same_sets(found):
    """Sides of each set land beyond opposite sides of the next one, all of it within the next one's height."""
    home, *way = found.sets
    along = np.linspace(-1, 1, 41)
    for one, other in [(home, home), (home, way[0]), *pairwise(way), (way[-1], home)]:
        ends = [coordinates(flown(sampled(one, np.full(41, side), along)), other) for side in (-1.0, 1.0)]
        signs = [np.unique(np.sign(each[:, 0])) for each in ends]
        assert all(len(each) == 1 for each in signs)
        assert signs[0] == -signs[1]
        assert min(np.abs(each[:, 0]).min() for each in ends) > 1
        for height in (-1.0, 0.0, 1.0):
            assert np.abs(coordinates(flown(sampled(one, along, np.full(41, height))), other)[:, 1]).max() < 1


def test_the_first_set_of_the_long_loop_lies_beside_that_round_the_saddle(found):
    home, first = found.sets[:2]
    u, s = (part.ravel() for part in np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)))
    assert np.abs(coordinates(sampled(first, u, s), home)[:, 0]).min() > 1
    assert first.corners.shape == (4, 2)


@pytest.mark.slow
def test_a_state_that_follows_a_sequence_of_loops(found):
    """Long, short, short, long, by bisection: as many impacts as doubles tell states of N apart."""
    home, *way = found.sets
    route = [*way, home, home, home, *way, home]

    def at(u: float, count: int) -> float:
        state = sampled(home, np.array([u]), np.zeros(1))
        for _ in range(count):
            state = flown(state)
        return float(coordinates(state, route[count - 1])[0, 0])

    def place(ends: tuple[float, float], target: float, count: int) -> float:
        left, right = ends
        sign = np.sign(at(right, count))
        assert at(left, count) * sign < -1
        for _ in range(60):
            middle = (left + right) / 2
            left, right = (middle, right) if at(middle, count) * sign < target else (left, middle)
        return (left + right) / 2

    ends, count = (-1.0, 1.0), 0
    while ends[1] - ends[0] > 1e-9:
        count += 1
        ends = place(ends, -1.0, count), place(ends, 1.0, count)
    assert count > 17
    assert abs(at(sum(ends) / 2, count)) < 1


def test_drawn(found):
    """The outlines that are drawn: the image of N reaches 2.96 half widths of it, on both sides."""
    axes = si.plot(found)
    lines = {line.get_label(): line.get_xydata() for line in axes.lines}
    assert list(lines) == ["image of $N$", "image of $B_{16}$", "$B_1$, the first set of the long loop",
                           "$N$, round the saddle", "saddle"]  # fmt: skip
    image = lines["image of $N$"]
    assert np.abs(image).max(axis=0) == pytest.approx([2.958, 0.2164], abs=2e-3)
    assert np.abs(lines["image of $B_{16}$"][:, 0]).max() > 1
    assert np.abs(lines["$B_1$, the first set of the long loop"][:, 0]).min() > 1


@pytest.mark.slow
def test_a_map_that_stretches_less_is_refused(monkeypatch, crossing):
    honest = room.derivative_over
    monkeypatch.setattr(room, "derivative_over", lambda *given: honest(*given) * (flint.arb(1) / 3))
    assert isinstance(horseshoe(crossing.unstable, crossing.states), str)


@pytest.mark.slow
def test_refusals(crossing):
    moved = crossing.states.copy()
    moved[crossing.index] += 0.05
    with pytest.raises(InputError, match="no horseshoe is proved next to"):
        replace(crossing, states=moved).horseshoe()
    saddle = crossing.unstable
    staying = np.repeat([[float(saddle.tau[0]), float(saddle.v[0])]], 30, axis=0)
    staying[0] += 1e-6
    assert isinstance(horseshoe(saddle, staying), str)
    other = next(orbit for orbit in OSC.periodic(2, 2) if not orbit.stable)
    with pytest.raises(InputError, match="comes back to its saddle"):
        si.homoclinic_points(saddle, other, length=3)[0].horseshoe()


@pytest.mark.slow
def test_beside_a_saddle_of_three_impacts():
    three = next(orbit for orbit in OSC.periodic(3, 3) if not orbit.stable)
    found = si.homoclinic_points(three, length=5)[0].horseshoe()
    assert found.loops[0] == 3
    assert found.loops[1] > 3


@pytest.fixture(scope="module")
def family(crossing):
    return crossing.horseshoes("restitution", ("0.799", "0.801"))


@pytest.mark.slow
def test_chaos_for_all_restitutions_of_an_interval(family):
    assert repr(family) == (
        "<certified horseshoes for all restitution in [0.799, 0.801], pieces: 4, entropy >= 0.137023>"
    )
    low = Fraction("0.799")
    for piece in family.pieces:  # they follow one another
        assert piece.oscillator.restitution == si.linear("2.8", 0, low + piece.reach).restitution
        low += 2 * piece.reach
        x = max(root.real for root in np.roots([1, -1, *[0] * (piece.loops[1] - 2), -1]) if abs(root.imag) < 1e-12)
        assert float(family.entropy.value) <= np.log(x) + 1e-12
    assert low == Fraction("0.801")


@pytest.mark.slow
@pytest.mark.parametrize("share", [-1, -0.4, 0.7, 1])
def test_flights_of_doubles_cross_the_sets_that_follow_the_number(family, share):
    """At values of r that no set was made for: the sides land beyond opposite sides, within the next one's height."""
    piece = family.pieces[-1]
    shift = share * float(piece.reach)
    osc = si.linear("2.8", 0, float(Fraction("0.801") - piece.reach) + shift)
    centres = [
        [float(x) + shift * float(rate) for x, rate in zip(one.centre, one.drift, strict=True)] for one in piece.sets
    ]
    moved = [replace(one, centre=tuple(map(Fraction, at))) for one, at in zip(piece.sets, centres, strict=True)]
    home, *way = moved
    along = np.linspace(-1, 1, 41)

    def landed(states):
        step = osc.impact_map(*states.T)
        return np.stack([step.tau, step.v], axis=1)

    for one, other in [(home, home), (home, way[0]), *pairwise(way), (way[-1], home)]:
        ends = [coordinates(landed(sampled(one, np.full(41, side), along)), other)[:, 0] for side in (-1.0, 1.0)]
        assert min(np.abs(each).min() for each in ends) > 1
        assert np.unique(np.sign(ends[0])) == -np.unique(np.sign(ends[1]))
        for height in (-1.0, 0.0, 1.0):
            assert np.abs(coordinates(landed(sampled(one, along, np.full(41, height))), other)[:, 1]).max() < 1


@pytest.mark.parametrize(
    ("over", "between", "why"),
    [
        ("w", (1, 2), "unknown number of the model 'w'"),
        ("omega", ("2.79", "2.81"), "a number that the period does not depend on"),
        ("restitution", ("0.9", "0.8"), "two rational numbers low < high in"),
        ("restitution", ("0.9", "1.2"), "two rational numbers low < high in"),
        ("clearance", ("a", 1), "two rational numbers low < high"),
        ("clearance", None, "two rational numbers low < high"),
    ],
)
def test_numbers_and_intervals_that_are_refused(crossing, over, between, why):
    with pytest.raises(InputError, match=why):
        crossing.horseshoes(over, between)


@pytest.mark.slow
def test_an_interval_in_which_the_saddle_turns_stable_is_refused(crossing):
    with pytest.raises(InputError, match="no horseshoes are proved next to"):
        crossing.horseshoes("restitution", ("0.01", "0.02"))
