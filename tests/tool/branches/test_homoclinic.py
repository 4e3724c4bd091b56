"""Homoclinic and heteroclinic orbits against flights in many digits, multipliers and slopes of the drawn curves."""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.branches import Crossing, Crossings, PeriodicOrbit, crossings
from singimpact.inputs import InputError

CHAOTIC = si.linear("2.8", 0, "0.8")
TWO_BASINS = si.linear("2.8", "0.1", "0.8", amplitude=-1)
PERIOD = 2 * np.pi / 2.8


@cache
def saddle_of(osc: si.ImpactOscillator, n: int) -> PeriodicOrbit:
    return next(orbit for orbit in osc.periodic(n, n) if not orbit.stable)


@pytest.fixture(scope="module")
def found() -> Crossings:
    return si.homoclinic_points(saddle_of(CHAOTIC, 1), v=1)


def nearest(orbit: Crossing, tau: float, v: float) -> float:
    return float(np.abs(orbit.states - [tau, v]).max(axis=1).min())


def test_the_homoclinic_orbit_of_the_excursion_of_three_impacts(found: Crossings) -> None:
    """Known from a bisection in doubles: (0.134, 0.196), (1.773, 0.428), (0.245, 0.447) and back to the saddle."""
    first = found[0]
    assert first.kind == "homoclinic"
    (again,) = CHAOTIC.periodic(1, 1)  # another object, the same orbit
    assert {each.kind for each in si.homoclinic_points(saddle_of(CHAOTIC, 1), again, length=3)} == {"homoclinic"}
    for tau, v in ((0.134, 0.196), (1.773, 0.428), (0.245, 0.447)):
        assert nearest(first, tau, v) < 5e-4
    assert (first.tau, first.v) == (pytest.approx(1.7728, abs=1e-4), pytest.approx(0.4282, abs=1e-4))
    assert first.weakest == pytest.approx(0.196, abs=1e-3)
    assert first.residual < 1e-14
    assert first.error < 1e-12
    assert (first.states[:, 0] >= 0).all()
    assert (first.states[:, 0] < PERIOD).all()


def coordinates(saddle: PeriodicOrbit, states: np.ndarray) -> np.ndarray:
    """Unstable and stable coordinates of states next to a (1, 1) saddle, shape (m, 2)."""
    values, vectors = np.linalg.eig(CHAOTIC.derivative(saddle.tau[0], saddle.v[0]).matrix)
    order = np.argsort(-np.abs(values))
    away = states - [saddle.tau[0], saddle.v[0]]
    away[:, 0] -= PERIOD * np.rint(away[:, 0] / PERIOD)
    return np.linalg.solve(vectors[:, order], away.T).T


def test_it_leaves_and_comes_back_with_the_factors_of_the_multipliers(found: Crossings) -> None:
    saddle = saddle_of(CHAOTIC, 1)
    for orbit in found[:4]:
        unstable, stable = coordinates(saddle, orbit.states.copy()).T
        assert stable[-6:] / stable[-7:-1] == pytest.approx(saddle.multipliers[1], rel=1e-2)
        assert unstable[1:7] / unstable[:6] == pytest.approx(saddle.multipliers[0], rel=1e-2)
        assert stable[-4:] / stable[-5:-1] == pytest.approx(saddle.multipliers[1], rel=5e-4)
        assert np.abs(unstable[-3:]).max() < 1e-2 * np.abs(stable[-3:]).max()


@pytest.mark.parametrize("index", [0, 1, 2])
def test_located_to_1e_10_by_flights_in_50_digits(found: Crossings, index: int) -> None:
    """From the point ten impacts forwards and back: what has grown is divided by how much it grows.

    With a state moved by 1e-9 the same quotient shows 1e-9.
    """
    orbit, saddle = found[index], saddle_of(CHAOTIC, 1)
    far, near = (abs(float(each)) for each in saddle.multipliers)

    def off(tau: float, v: float) -> tuple[float, float]:
        ahead, back = (mpmath.mpf(tau), mpmath.mpf(v)), (mpmath.mpf(tau), mpmath.mpf(v))
        after, before = len(orbit.states) - 1 - orbit.index, orbit.index
        for _ in range(after):
            step = CHAOTIC.impact_map(*ahead, digits=50)
            ahead = step.tau, step.v
        for _ in range(before):
            step = CHAOTIC.inverse_map(*back, digits=50)
            back = step.tau, step.v
        ends = [np.array([float(tau - PERIOD * mpmath.nint(tau / PERIOD)), float(v)]) for tau, v in (ahead, back)]
        u = coordinates(saddle, np.array([ends[0] - orbit.states[-1] + [saddle.tau[0], saddle.v[0]]]))[0, 0]
        s = coordinates(saddle, np.array([ends[1] - orbit.states[0] + [saddle.tau[0], saddle.v[0]]]))[0, 1]
        return abs(u) / far ** (after - 3), abs(s) * near ** (before - 3)

    assert max(off(orbit.tau, orbit.v)) < 1e-11
    assert min(off(orbit.tau + 1e-9, orbit.v)) > 5e-11


def test_the_angle_is_that_of_the_curves(found: Crossings) -> None:
    """Slopes of the drawn polylines next to the point, which know nothing of D G."""
    for orbit in found[:3]:
        slopes = []
        for grown in found.manifolds:
            chords = [(piece.points[i], piece.points[i + 1]) for piece in grown.pieces for i in range(len(piece) - 1)]
            chord = min(chords, key=lambda pair: abs(pair[0] + pair[1] - 2 * np.array([orbit.tau, orbit.v])).max())
            step = chord[1] - chord[0]
            slopes.append(np.arctan2(step[1], step[0]))
        between = abs(slopes[0] - slopes[1]) % np.pi
        assert min(between, np.pi - between) == pytest.approx(orbit.angle, abs=0.1)
        assert orbit.angles[orbit.index] == orbit.angle
        assert (orbit.angles > 1e-3).all()


@pytest.mark.slow
def test_each_orbit_once_and_more_with_the_length(found: Crossings) -> None:
    assert len(found) == 23
    starts = [each.s[0] for each in found]
    assert min(abs(a / b - 1) for i, a in enumerate(starts) for b in starts[:i]) > 1e-7
    middle = [nearest(one, other.tau, other.v) for i, one in enumerate(found) for other in found[:i]]
    assert min(middle) > 1e-9
    longer = si.homoclinic_points(saddle_of(CHAOTIC, 1), v=1, length=10)
    assert len(longer) == 118
    assert [each.s for each in longer[:3]] == [pytest.approx(each.s, rel=1e-6) for each in found[:3]]
    for each in found:
        assert min(nearest(other, each.tau, each.v) for other in longer) < 1e-11
    assert any(note.startswith("W^u ends after") for note in found.notes)


@pytest.mark.slow
def test_heteroclinic_orbits_join_two_saddles() -> None:
    one, other = saddle_of(CHAOTIC, 1), saddle_of(CHAOTIC, 2)
    there = si.homoclinic_points(one, other, length=5)
    assert {each.kind for each in there} == {"heteroclinic"}
    orbit = there[0]
    assert orbit.residual < 1e-14
    assert np.abs(orbit.states[0] - [one.tau[0], one.v[0]]).max() < 1e-3
    assert np.abs(orbit.states[-1] - [other.tau[0], other.v[0]]).max() < 1e-3
    assert repr(orbit).startswith("<heteroclinic point (")


@pytest.mark.slow
def test_of_a_saddle_of_three_impacts() -> None:
    saddle = saddle_of(CHAOTIC, 3)
    there = si.homoclinic_points(saddle, length=5)
    assert len(there) > 3
    for orbit in there[:3]:
        for end in (0, -1):
            assert np.abs(orbit.states[end] - [saddle.tau[0], saddle.v[0]]).max() < 1e-3
        image = CHAOTIC.impact_map(*orbit.states[:-1].T)
        gap = np.stack([np.asarray(image.tau), np.asarray(image.v)], axis=1) - orbit.states[1:]
        gap[:, 0] -= PERIOD * np.rint(gap[:, 0] / PERIOD)
        assert np.abs(gap).max() < 1e-13


@pytest.mark.slow
def test_a_saddle_whose_unstable_sides_end_in_attractors_has_none() -> None:
    none = si.homoclinic_points(saddle_of(TWO_BASINS, 3), v=1, length=20)
    assert list(none) == []
    assert len(none.notes) >= 2


def test_refusals(found: Crossings) -> None:
    unstable, _ = found.manifolds
    with pytest.raises(InputError, match=r"two curves W\^u"):
        crossings(unstable, unstable)
    with pytest.raises(InputError, match="give a result of si"):
        crossings(unstable, "x")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="a saddle of the same model"):
        si.homoclinic_points(saddle_of(CHAOTIC, 1), saddle_of(TWO_BASINS, 3))
    with pytest.raises(InputError, match="the saddles are of two models"):
        crossings(unstable, si.manifold(saddle_of(TWO_BASINS, 3), length=1))


def test_drawn(found: Crossings) -> None:
    axes = si.plot(found)
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels[:2] == ["$W^u$ of the (1, 1) saddle", "cut by a graze"]
    assert labels[-1] == "homoclinic points, one of each orbit"
