"""W^s and W^u of saddles: carried into themselves, the boundary of basins, torn where flights graze."""

from __future__ import annotations

import csv
from functools import cache

import numpy as np
import pytest
from witness import integrate

import singimpact as si
from singimpact.branches import Manifold, PeriodicOrbit, distances, expansion, local_arc, returned
from singimpact.dynamics import before, model_step
from singimpact.inputs import InputError

TWO_BASINS = si.linear("2.8", "0.1", "0.8", amplitude=-1)
CHAOTIC = si.linear("2.8", 0, "0.8")
DUFFING = si.ImpactOscillator("x + 0.2*x**3", "cos(2.8*t)", "0", "0.8")
PERIOD = 2 * np.pi / 2.8
SLOW = pytest.mark.slow


NEAR = {DUFFING: [(0.1303, 0.3290), (2.0361, 0.3348)]}  # a search from a grid would take seconds


@cache
def saddle_of(osc: si.ImpactOscillator, n: int, k: int) -> PeriodicOrbit:
    return next(orbit for orbit in osc.periodic(n, k, NEAR.get(osc)) if not orbit.stable)


@pytest.fixture(scope="module")
def bounding() -> Manifold:
    return si.manifold(saddle_of(TWO_BASINS, 3, 3), v=1)


@pytest.fixture(scope="module")
def found() -> si.basins:
    return si.basins(TWO_BASINS, ((0, "2*pi/2.8"), (0, 1)), 300)


def hit_by_scipy(osc: si.ImpactOscillator, tau: float, v: float) -> tuple[float, float]:
    """The next impact by DOP853: no code of the package's flights."""
    from scipy.optimize import brentq

    times = np.linspace(1e-3, 6, 3000)
    below = np.flatnonzero(integrate(osc, tau, v, times)[0] < 0 + float(osc.clearance.value))
    first = times[below[0]]
    root = brentq(lambda t: integrate(osc, tau, v, [t])[0, 0] - float(osc.clearance.value), first - 0.01, first)
    return tau + root, -0.8 * float(integrate(osc, tau, v, [root])[1, 0])


@pytest.mark.parametrize("stable", [True, False])
def test_directions_are_eigenvectors_of_differences_by_scipy(stable: bool) -> None:
    """D G by central differences of a flow that shares nothing with the package."""
    saddle = saddle_of(CHAOTIC, 1, 1)
    state, h = np.array([saddle.tau[0], saddle.v[0]]), 1e-5
    moved = [[np.array(hit_by_scipy(CHAOTIC, *(state + s * h * unit))) for s in (1, -1)] for unit in np.eye(2)]
    matrix = np.stack([(up - down) / (2 * h) for up, down in moved], axis=1)
    grown = si.manifold(saddle, stable, length=0.01)
    (direction,) = grown.directions
    assert matrix @ direction == pytest.approx(grown.multiplier * direction, abs=1e-6)


def test_directions_at_every_impact_are_carried_to_one_another() -> None:
    saddle = saddle_of(TWO_BASINS, 3, 3)
    for stable in (True, False):
        units = si.manifold(saddle, stable, length=0.01).directions
        for i in range(3):
            image = TWO_BASINS.derivative(saddle.tau[i], saddle.v[i]).matrix @ units[i]
            following = units[(i + 1) % 3]
            assert abs(image[0] * following[1] - image[1] * following[0]) < 1e-10 * np.linalg.norm(image)


@pytest.mark.parametrize(("osc", "n"), [(TWO_BASINS, 3), (CHAOTIC, 1), pytest.param(DUFFING, 2, marks=SLOW)])
def test_the_expansion_at_a_saddle_is_of_third_order(osc: si.ImpactOscillator, n: int) -> None:
    """The miss of G^n(K(s)) against K(mu s) falls eightfold with half of s; without the bend fourfold."""
    saddle = saddle_of(osc, n, n)
    for stable in (True, False):
        near = expansion(saddle, stable)
        assert near.error < 5e-12

        def missed(s: float, bent: float = 1.0, near=near) -> float:
            ends = (near.state + x * near.direction + bent * x * x * near.bend for x in (s, near.multiplier * s))
            point, image = ends
            return float(np.linalg.norm((returned(saddle, point[None])[0] - image) / near.scales))

        s = 2e-3 if stable else 1e-3 / abs(near.multiplier)
        assert np.log2(missed(s) / missed(s / 2)) == pytest.approx(3, abs=0.3)
        assert np.log2(missed(s, 0.0) / missed(s / 2, 0.0)) == pytest.approx(2, abs=0.3)


@pytest.mark.parametrize(("osc", "n"), [(TWO_BASINS, 3), (CHAOTIC, 1), pytest.param(DUFFING, 2, marks=SLOW)])
@pytest.mark.parametrize("stable", [True, False])
def test_the_arc_at_a_saddle_is_longer_and_no_worse(osc: si.ImpactOscillator, n: int, stable: bool) -> None:
    """G^n(K(s)) lies on the arc at K(mu s), for |mu s| up to its size: a hundred times beyond the expansion."""
    saddle = saddle_of(osc, n, n)
    near, arc = expansion(saddle, stable), local_arc(saddle, stable)
    assert arc.size > 100 * near.size
    assert arc.error < 5e-12
    s = arc.size / max(1, abs(arc.multiplier)) * np.linspace(-1, 1, 21)
    image, expected = returned(saddle, arc.points(s)), arc.points(arc.multiplier * s)
    tangents = np.array([arc.slope(each) for each in arc.multiplier * s]) / arc.scales

    def across(points: np.ndarray) -> float:
        away = (points - expected) / arc.scales
        return float(np.abs(away[:, 0] * tangents[:, 1] - away[:, 1] * tangents[:, 0]).max())

    assert across(image) < 1e-11
    assert np.abs((image - expected) / arc.scales).max() < 1e-8  # along the curve errors of s are stretched
    slope = (arc.points(np.array([1e-6]))[0] - arc.points(np.array([-1e-6]))[0]) / 2e-6
    assert arc.slope(0.0) == pytest.approx(slope, rel=1e-6)
    assert slope == pytest.approx(arc.direction, rel=1e-6)
    assert across(image + np.array([1e-9, 0]) * arc.scales) > 1e-11


@pytest.mark.parametrize(
    ("osc", "n", "sides"), [(TWO_BASINS, 3, 6), (CHAOTIC, 1, 2), pytest.param(DUFFING, 2, 4, marks=SLOW)]
)
@pytest.mark.parametrize("stable", [True, False])
def test_a_manifold_is_carried_into_itself(osc: si.ImpactOscillator, n: int, sides: int, stable: bool) -> None:
    grown = si.manifold(saddle_of(osc, n, n), stable, v=1, length=3 if osc is DUFFING else 8)
    starts = [piece.points[0] for piece in grown.pieces if piece.marked("saddle").size]
    assert len(starts) == sides  # two sides at every impact, whatever the sign of the multiplier
    points = np.vstack([piece.points[3:-3] for piece in grown.pieces])
    points = points[(points[:, 1] > 0.02) & (points[:, 1] < 0.98)][::7]
    # towards the saddle, where all of the image is known
    image = model_step(osc, points) if stable else before(osc, points)
    chosen = image[:, 1] < 0.98
    assert chosen.sum() > 40
    assert grown.distance(image[chosen]).max() < 1e-3  # half the resolution and the jump of a cut
    beside = model_step(osc, points + np.array([0, 0.02])) if stable else before(osc, points + np.array([0, 0.02]))
    assert np.nanmax(grown.distance(beside[beside[:, 1] < 0.98])) > 1e-2


def test_vertices_far_along_the_stable_manifold_come_to_the_saddle(bounding: Manifold) -> None:
    """By flights in 50 digits, to the arc and three turns more."""
    saddle = bounding.saddle
    far = [piece for side, piece in bounding.grown if piece.generation >= 6][:4]
    assert far
    for piece in far:
        tau, v = (float(each) for each in piece.points[len(piece.s) // 2])
        for _ in range(piece.generation + 9):
            step = TWO_BASINS.impact_map(tau, v, digits=50)
            tau, v = step.tau, step.v
        away = np.abs(np.array([float(tau) % PERIOD, float(v)]) - [saddle.tau[0] % PERIOD, saddle.v[0]]).max()
        assert away < 1e-3


@pytest.mark.slow
def test_the_boundary_of_the_basins_is_the_stable_manifold_place_by_place(found: si.basins, bounding: Manifold) -> None:
    """All 6535 places between unlike neighbours of 300 x 300 states lie within 0.52 of a cell of W^s."""
    assert {name for _, name, _ in found.classes} == {"(3, 3) orbit", "(1, 1) orbit"}
    boundary = found.boundary
    assert len(boundary) == 6535
    cells = bounding.distance(boundary) * 300
    assert cells.max() < 0.55
    assert (
        bounding.distance(boundary + np.array([0.02, 0.0])) * 300 > 1
    ).mean() > 0.5  # W^s moved by three cells is not it
    # nor is a part of it, and W^s of another model
    shorter = si.manifold(bounding.saddle, v=1, length=8)
    assert (shorter.distance(boundary) * 300 > 2).any()
    moved = si.manifold(saddle_of(TWO_BASINS.replace(clearance="0.11"), 3, 3), v=1)
    assert (moved.distance(boundary) * 300 > 2).mean() > 0.1


def beside(curves: list, found: si.basins) -> tuple[np.ndarray, np.ndarray]:
    """Places a quarter of a cell apart along curves, and whether the classes a cell to both sides differ."""
    places, unlike, sides = [], [], np.array([PERIOD, 1.0])
    for curve in curves:
        line = curve.points / sides
        for start, step in zip(line[:-1], np.diff(line, axis=0), strict=True):
            count = max(1, int(np.hypot(*step) * 1200))
            at = start + step * ((np.arange(count) + 0.5) / count)[:, None]
            across = np.array([-step[1], step[0]]) / max(np.hypot(*step), 1e-300) / 300
            codes = [
                found.codes[np.clip((each[:, 1] * 300).astype(int), 0, 299), np.floor(each[:, 0] % 1 * 300).astype(int)]
                for each in (at + across, at - across)
            ]
            inside = (at[:, 1] > 1 / 300) & (at[:, 1] < 1 - 1 / 300)
            places.append(at[inside] * sides)
            unlike.append((codes[0] != codes[1])[inside])
    return np.vstack(places), np.concatenate(unlike)


@pytest.mark.slow
def test_neither_gamma_nor_tears_bound_the_basins(found: si.basins, bounding: Manifold) -> None:
    """The flow is continuous there: both sides of gamma, of P and of the tears of G are one basin, but where W^s is."""
    (tangency,) = [t for t, kind in zip(*[si.tangency_points(TWO_BASINS).tau, si.tangency_points(TWO_BASINS).kind],
                                        strict=True) if kind == "gamma"]  # fmt: skip
    gamma = si.grown_gamma(TWO_BASINS, ((float(tangency) - 6 * PERIOD, float(tangency) + 0.1), (0, 1)))
    scene = si.Scene(TWO_BASINS, ("discontinuities", "outline"), (0, PERIOD), v=(0, 1), pixels=600)
    kinds = {
        "gamma": gamma, "tears": scene.results.get("discontinuities"), "outline": scene.results.get("outline")
    }  # fmt: skip
    counts = {}
    for name, curves in kinds.items():
        places, unlike = beside(curves, found)
        assert len(places) > 1000
        assert (bounding.distance(places[unlike]) * 300).max() < 1.5
        near = distances(found.boundary, [curve.points for curve in curves], np.array([PERIOD, 1.0]), 1 / 800) * 300 < 1
        counts[name] = (int(unlike.sum()), int(near.sum()))
    # of more than 1000 places a quarter of a cell apart, and of 6535 places of the boundary
    expected = {"gamma": (38, 16), "tears": (127, 104), "outline": (146, 113)}
    for name, pair in expected.items():
        assert counts[name] == pytest.approx(pair, abs=8)


@pytest.mark.slow
def test_the_boundary_at_600_states_a_side(bounding: Manifold) -> None:
    boundary = si.basins(TWO_BASINS, ((0, "2*pi/2.8"), (0, 1)), 600).boundary
    assert len(boundary) > 13_000
    assert (bounding.distance(boundary) * 600).max() < 0.6


@pytest.mark.parametrize("stable", [True, False])
def test_cuts_are_grazes_and_the_flow_goes_on_across_them(stable: bool) -> None:
    """One side ends at rest on the wall; the state there goes on to where the other side is."""
    grown = si.manifold(saddle_of(CHAOTIC, 1, 1), stable, v=1, length=20)
    assert len(grown.cuts) >= 5
    assert {cut.kind for cut in grown.cuts} == {"graze"}
    assert repr(grown.cuts[0]).startswith("<graze at (")
    for cut in grown.cuts:
        slow, fast = cut.sides[np.argsort(cut.sides[:, 1])]
        assert slow[1] < 1e-3 < fast[1]
        step = CHAOTIC.impact_map(*slow) if stable is False else CHAOTIC.inverse_map(*slow)
        gap = np.array([step.tau, step.v]) - fast
        gap[0] -= PERIOD * np.rint(gap[0] / PERIOD)
        assert np.abs(gap).max() < 20 * slow[1] + 1e-9
        # the torn state itself: to either side a flight that grazes and one that hits there
        torn = CHAOTIC.impact_map(cut.tau, cut.v) if not stable else CHAOTIC.inverse_map(cut.tau, cut.v)
        ends = np.array([torn.tau % PERIOD, torn.v])
        assert min(np.abs(ends - side).max() for side in cut.sides) < 1e-2
    marks = [mark.name for piece in grown.pieces for mark in piece.marks]
    assert marks.count("cut") >= len(grown.cuts)


def test_pieces_are_within_a_period_and_resolved(bounding: Manifold) -> None:
    assert bounding.spacing <= 8.1 / 800
    for piece in bounding.pieces:
        assert piece.axes == ("tau", "v")
        assert (piece.points[1:-1, 0] >= 0).all()
        assert (piece.points[1:-1, 0] < PERIOD).all()
        assert (piece.points[1:-1, 1] <= 1).all()
    fine = si.manifold(bounding.saddle, v=1, resolution=1 / 3000)
    assert fine.spacing < 0.3 * bounding.spacing
    coarse = np.vstack([piece.points[1:-1] for piece in bounding.pieces])
    assert fine.distance(coarse).max() < 1.5 / 800  # ends of arcs at grazes are located to the resolution
    assert np.quantile(fine.distance(coarse), 0.98) < 0.05 / 800


def test_unstable_sides_end_in_the_attractors() -> None:
    grown = si.manifold(saddle_of(TWO_BASINS, 3, 3), stable=False, v=1)
    assert grown.cuts == ()
    assert "quarter of the resolution" in grown.notes[-1]
    sinks = [np.stack([orbit.tau % PERIOD, orbit.v], axis=1) for n in (1, 3) for orbit in TWO_BASINS.periodic(n, n)
             if orbit.stable]  # fmt: skip
    ends = [piece.points[-1] for piece in grown.pieces]
    for states in sinks:
        for state in states:
            assert min(np.abs(end - state).max() for end in ends) < 0.02


def test_it_is_told_why_the_growth_ended_and_written_to_a_file(tmp_path) -> None:
    grown = si.manifold(saddle_of(CHAOTIC, 1, 1), stable=False, length=3)
    assert grown.length > 3
    assert grown.flights > 500
    assert any("its length passes 3: it goes on (length=)" in note for note in grown.notes)
    assert repr(grown).startswith("<W^u of a (1, 1) saddle, multiplier -2.9581: ")
    grown.to_csv(tmp_path / "w.csv")
    rows = list(csv.DictReader((tmp_path / "w.csv").read_text().splitlines()))
    assert len(rows) == sum(len(piece) for piece in grown.pieces)
    assert {row["mark"] for row in rows} <= {"", "saddle", "cut", "leaves", "end"}
    assert {row["mark"] for row in rows} >= {"", "saddle"}


def test_restitution_that_depends_on_the_velocity() -> None:
    osc = si.ImpactOscillator("x", "cos(2.8*t)", "0", "-0.8*v + 0.05*v**2")
    saddle = saddle_of(osc, 1, 1)
    grown = si.manifold(saddle, length=2)
    points = np.vstack([piece.points[3:-3] for piece in grown.pieces])
    image = model_step(osc, points[points[:, 1] > 0.02])
    assert grown.distance(image[image[:, 1] < grown.window.y[1]]).max() < 1e-3


STABLE = next(orbit for orbit in TWO_BASINS.periodic(1, 1))
RESTING = si.linear(2, "0.7", "0.5").periodic(np.inf, 1)


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: si.manifold("x"), "saddle = 'x' is not accepted: give an unstable orbit of osc.periodic"),
        (lambda: si.manifold(STABLE), "saddle has the multipliers -0.610516-0.516982i"),
        (lambda: si.manifold(RESTING[0]), "an orbit with finitely many impacts"),
        (lambda: si.manifold(saddle_of(CHAOTIC, 1, 1), v=0.1), "v = 0.1 is not accepted: give a velocity above"),
        (lambda: si.manifold(saddle_of(CHAOTIC, 1, 1), length=0), "length = 0"),
        (lambda: si.manifold(saddle_of(CHAOTIC, 1, 1), resolution=1), "resolution = 1"),
        (lambda: si.manifold(saddle_of(CHAOTIC, 1, 1), "yes"), "stable = 'yes'"),
    ],
)
def test_refusals(ask, told: str) -> None:
    with pytest.raises(InputError) as caught:
        ask()
    assert told in str(caught.value)


def test_a_virtual_orbit_is_refused() -> None:
    from dataclasses import replace

    with pytest.raises(InputError, match="pass through the wall"):
        si.manifold(replace(saddle_of(CHAOTIC, 1, 1), visible=False))


@pytest.mark.slow
def test_drawn_alone_and_over_basins(found: si.basins, bounding: Manifold) -> None:
    alone = si.plot(bounding)
    assert alone.get_xlim() == (0.0, pytest.approx(PERIOD))
    labels = [text.get_text() for text in alone.get_legend().get_texts()]
    assert labels == ["$W^s$ of the (3, 3) saddle", "cut by a graze", "saddle"]
    axes = si.plot(found)
    limits = axes.get_xlim(), axes.get_ylim()
    both = si.plot([bounding, si.manifold(bounding.saddle, stable=False, v=1)], ax=axes)
    assert (both.get_xlim(), both.get_ylim()) == limits
    labels = [text.get_text() for text in both.get_legend().get_texts()]
    assert labels[0].startswith("(3, 3) orbit")
    assert "$W^u$ of the (3, 3) saddle" in labels
    with pytest.raises(InputError, match="manifolds of one model"):
        si.plot([bounding, si.manifold(saddle_of(CHAOTIC, 1, 1), length=1)])
