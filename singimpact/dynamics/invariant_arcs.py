"""Invariant curves beyond their series: gamma and the stable manifolds W^s_tau, grown by the inverse of the map.

A fundamental piece lies where the series is good; its inverse images follow one another without a gap, and errors
across the curve shrink.  A piece is a function of one number s; where two neighbours are torn apart, the flight run
back grazes between them, and the curve is split there by its hit history.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import as_float
from singimpact.contact.points import tangency_points
from singimpact.flights.impact_map import first_hit
from singimpact.flights.inverse_map import backwards, inverse_map
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status
from singimpact.surface.curve import STATES, Curve, Mark, Window, distances
from singimpact.theory.contact_points import points_of
from singimpact.theory.formulas import arc_in_numbers
from singimpact.theory.power_series import PowerSeries

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class GrowthSettings:
    """How curves are grown; lengths are in resolutions of the window."""

    order: int = 12  # of the series
    trust: float = 1e-13  # relative truncation error of the series on the fundamental piece
    tolerance: float = 1e-13  # of a flight: thousands are flown, and more digits change no curve visibly
    start: int = 100  # resolutions between two points of the fundamental piece
    least: int = 4  # points of the fundamental piece
    longest: float = 8.0  # a chord
    bend: float = 0.5  # deviation of a vertex from the chord of its neighbours that is refined
    jump: float = 8.0  # a step between neighbours in s that are torn apart
    graze: float = 0.01  # an arc ends at a graze like a square root: its end is located to within this length
    most: int = 4000  # points of one generation
    distinct: float = 0.25  # a piece nearer than this to the generation before is the end of the growth
    generations: int = 60  # inverse images at most


SETTINGS = GrowthSettings()
CURVED = {"tangency": 1, "swan": 2}  # contact orders of the points where gamma may end


def held(window: Window, points: Array) -> Array:
    """Which points lie in the window; v has no lower end, for no state has v < 0."""
    tau, v = points.T
    return np.asarray((tau >= window.x[0]) & (tau <= window.x[1]) & (v <= window.y[1]))


def _closest(window: Window) -> float:
    """Neighbours in s nearer than this share of a piece, still far apart in the window, are torn."""
    return float((SETTINGS.graze * window.resolution) ** 2)


@dataclass(frozen=True)
class Piece:
    """A stretch of one generation: parameters s in order, their points, how often the map takes them to the start."""

    s: Array
    points: Array
    generation: int


def grown_gamma(model: Oscillator, window: Window, tau: Any = None, trust: float = SETTINGS.trust) -> list[Curve]:
    """gamma from its series at a tangency (or swan) point to the edge of the window [t:t2, t:t3].

    Parameters
    ----------
    tau : the point; without one the first that has an invariant curve. trust : relative truncation error of the series
        where its inverse images begin.

    Returns
    -------
    curves in (tau, v) in order of hit history, the first with the mark "foot" at (tau_*, 0).

    Examples
    --------
    >>> curve = grown_gamma(Oscillator("0", "12*(t**2 - 1)", 0, "1/2"), Window((-2, 1), (0, 20)), 1)[0]
    >>> round(float(curve.points[-1, 0]), 3), bool(curve.points[-1, 1] < 1e-3)
    (-1.385, True)
    """
    at = _curved(model, tau)
    series, motion = arc_in_numbers(SETTINGS.order, CURVED[at], model, tau)
    foot = _foot(model, tau, at)
    # a series that ends is exact everywhere
    size = min(series.valid_within(trust), motion.valid_within(trust), float(window.sides[0]))
    return _grown(model, window, foot, series, -size, float(motion(-size)))


def gammas_within(model: Oscillator, window: Window) -> list[Curve]:
    """gamma from every tangency point with a' > 0, and every swan point with a'' < 0, whose tau lies in the window.

    Examples
    --------
    >>> curves = gammas_within(Oscillator("x", "cos(2*t)", "0.3", "1/2"), Window((2, 6), (0, 1)))
    >>> [round(float(curve.points[0, 0]), 3) for curve in curves if curve.marked("foot").size]
    [2.509, 5.65]
    """
    found: list[Curve] = []
    for point in tangency_points(model):
        bent = float(acceleration(model, np.array([point.tau]), 2)[0])
        if point.kind == "foliation" or (point.kind == "degenerate" and bent > 0):
            continue
        for shift in _turns(model, point.tau, window):
            moved = replace(window, x=(window.x[0] - shift, window.x[1] - shift))
            grown = grown_gamma(model, moved, repr(point.tau))
            found += [replace(curve, points=curve.points + np.array([shift, 0.0])) for curve in grown]
    return found


def _turns(model: Oscillator, tau: float, window: Window) -> list[float]:
    """Multiples of the period that bring a time into the window."""
    if model.period is None:
        return [0.0] if window.x[0] <= tau <= window.x[1] else []
    period = as_float(model.period)
    first, last = np.ceil((window.x[0] - tau) / period), np.floor((window.x[1] - tau) / period)
    return [n * period for n in np.arange(first, last + 1).tolist()]


def stable_manifold(model: Oscillator, window: Window, tau: Any) -> list[Curve]:
    """W^s_tau of a regular point with a_c(tau) < 0, grown backwards across discontinuities [t:t1].

    Examples
    --------
    >>> curves = stable_manifold(Oscillator("0", "12*(t**2 - 1)", 0, "1/2"), Window((-2, 1), (0, 20)), "0.5")
    >>> curves[0].points[0].tolist()
    [0.5, 0.0]
    """
    foot = _foot(model, tau, None)
    if not float(acceleration(model, np.array([foot]))[0]) < 0:
        raise refuse("tau", tau, "a time with a_c < 0: chatter comes to rest there, and W^s_tau exists")
    series, _ = arc_in_numbers(SETTINGS.order, 0, model, tau)
    size = series.valid_within(SETTINGS.trust)
    # along the fibre the map contracts by r to first order; the exact image bounds the fundamental piece
    landed = model_step(model, np.array([[foot - size, float(series(-size))]]))[0, 0] - foot
    return _grown(model, window, foot, series, -size, float(landed))


def _curved(model: Oscillator, tau: Any) -> str:
    """Whether the point is a tangency or a swan; a swan is asked for first, for a_c vanishes there too."""
    order = points_of(model, tau)[0]
    if order == 0:
        raise InputError(f"tau = {tau}: a_c does not vanish there, so that no invariant curve ends there")
    if order == 2 and acceleration(model, np.array([_foot(model, tau, "swan")]), 2)[0] > 0:
        raise InputError(f"tau = {tau}: a_c'' > 0 at this swan, and no invariant curve ends at a positive one")
    return {j: at for at, j in CURVED.items()}[order]


def _foot(model: Oscillator, tau: Any, at: str | None) -> float:
    if tau is not None:
        from singimpact.algebra.numbers import constant

        return as_float(constant("tau", tau))
    kind = "gamma" if at == "tangency" else "degenerate"
    return next(point.tau for point in tangency_points(model) if point.kind == kind)


def model_step(model: Oscillator, points: Array) -> Array:
    """The impact map on points (tau, v), shape (n, 2); nan where there is no next impact."""
    from singimpact.flights.impact_map import impact_map

    found, known = np.full(points.shape, np.nan), np.isfinite(points).all(axis=1)
    step = impact_map(model, points[known, 0], points[known, 1], tolerance=SETTINGS.tolerance)
    good = np.isin(step.status, (Status.hit, Status.graze))
    found[known] = np.where(good[:, None], np.stack([step.tau, step.v], axis=1), np.nan)
    return found


def before(model: Oscillator, points: Array) -> Array:
    """The inverse map on points, shape (n, 2); nan where nothing lands there."""
    found, known = np.full(points.shape, np.nan), np.isfinite(points).all(axis=1)
    at, v_at = points[known].T
    if names_in(model.restitution):
        step = inverse_map(model, at, v_at)
        tau, v, status = step.tau, step.v, step.status
    else:
        hit = first_hit(backwards(model), -at, v_at / as_float(model.restitution), tolerance=SETTINGS.tolerance)
        tau, v, status = at - hit.flight_time, -hit.velocity, hit.status
    good = np.isin(status, (Status.hit, Status.graze))
    found[known] = np.where(good[:, None], np.stack([tau, v + 0.0], axis=1), np.nan)
    return found


def _grown(
    model: Oscillator, window: Window, foot: float, series: PowerSeries, outer: float, inner: float
) -> list[Curve]:
    """The series from its foot to the fundamental piece, then the inverse images of that."""

    def start(s: Array) -> Array:
        return np.stack([foot + s, series(s)], axis=1)

    count = max(SETTINGS.least, round(1 / window.resolution) // SETTINGS.start + 1)
    s = np.linspace(inner, outer, count)
    whole = np.linspace(0.0, inner, 2 * count)
    pieces, done = [Piece(s, start(s), 0)], [Piece(whole, start(whole), 0)]
    for generation in range(SETTINGS.generations):
        if not pieces:
            break
        done += pieces
        new = [image for piece in pieces for image in _images(model, window, start, piece, generation + 1)]
        pieces = [piece for piece in new if _adds(piece, pieces, window)]
    return list(_joined(done, window))


def _adds(piece: Piece, before: list[Piece], window: Window) -> bool:
    """Whether a piece is resolved from those of one generation before, so that growing it on adds something new.

    Loops of stable manifolds accumulate on gamma: each generation has one more, soon nearer than a line is wide.
    """
    seen = piece.points[held(window, piece.points)] / window.sides
    gaps = [distances(seen, old.points / window.sides) for old in before]
    return not len(seen) or bool(np.min(gaps, axis=0).max() > SETTINGS.distinct * window.resolution)


def _images(
    model: Oscillator, window: Window, start: Callable[[Array], Array], piece: Piece, generation: int
) -> list[Piece]:
    """The inverse image of a piece, with points added to the resolution, in stretches without a tear."""

    def image(s: Array) -> Array:
        points = start(s)
        for _ in range(generation):
            points = before(model, points)
        return points

    s, points = piece.s, before(model, piece.points)
    s, points = _refined(s, points, image, window)
    known = np.isfinite(points).all(axis=1) & (points[:, 0] >= window.x[0] - 0.2 * window.sides[0])
    jump = np.hypot(*(np.diff(points, axis=0) / window.sides).T) > SETTINGS.jump * window.resolution
    torn = jump & (np.abs(np.diff(s)) <= _closest(window) * np.ptp(piece.s))
    cuts = np.flatnonzero(torn | ~known[1:] | ~known[:-1]) + 1
    parts = np.split(np.arange(len(s)), cuts)
    return [Piece(s[part], points[part], generation) for part in parts if len(part) > 1 and known[part].all()]


def _refined(s: Array, points: Array, image: Callable[[Array], Array], window: Window) -> tuple[Array, Array]:
    """Midpoints put in until chords are short or straight enough for the resolution, or their ends close in s."""
    least = _closest(window) * np.ptp(s)
    for _ in range(60):
        wanted = _too_coarse(points, window) & (np.abs(np.diff(s)) > least)
        at = np.flatnonzero(wanted)
        if not at.size or len(s) + at.size > SETTINGS.most:
            break
        middle = (s[at] + s[at + 1]) / 2
        s, points = np.insert(s, at + 1, middle), np.insert(points, at + 1, image(middle), axis=0)
    return s, points


def _too_coarse(points: Array, window: Window) -> Array:
    """Chords too long for the resolution, or at a bend beyond it; or with one end that is not known."""
    known: Array = np.asarray(np.isfinite(points).all(axis=1))
    near: Array = np.logical_or(held(window, points), ~known)
    step = np.diff(points, axis=0) / window.sides
    length = np.hypot(*step.T)
    with np.errstate(all="ignore"):
        cross = np.abs(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0])
        off = cross / np.maximum(np.hypot(*(step[:-1] + step[1:]).T), 1e-300)
    bend = np.zeros(len(length), dtype=bool)
    bend[:-1] |= off > SETTINGS.bend * window.resolution
    bend[1:] |= off > SETTINGS.bend * window.resolution
    coarse = (length > min(SETTINGS.longest * window.resolution, 1 / 25)) | (bend & (length > window.resolution))
    return np.asarray((near[:-1] | near[1:]) & ((known[:-1] != known[1:]) | (known[:-1] & known[1:] & coarse)))


def _joined(pieces: list[Piece], window: Window) -> list[Curve]:
    """Pieces that follow one another as curves, cut to the window."""
    chains: list[list[Piece]] = []
    for piece in pieces:
        for chain in chains:
            if np.hypot(*((chain[-1].points[-1] - piece.points[0]) / window.sides)) < window.resolution:
                chain.append(piece)
                break
        else:
            chains.append([piece])
    curves = []
    for n, chain in enumerate(chains):
        points = np.vstack([chain[0].points, *(piece.points[1:] for piece in chain[1:])])
        marks = (Mark(0, "foot"),) if n == 0 else ()
        whole = Curve(f"history {chain[0].generation}", points, STATES, marks, first_hits=held(window, points))
        curves += [replace(part, first_hits=np.ones(len(part), dtype=bool)) for part in whole.parts(whole.visible)]
    return [curve for curve in curves if len(curve) > 1]
