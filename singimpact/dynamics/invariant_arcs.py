"""Invariant curves beyond their series: gamma and the stable manifolds W^s_tau, grown by the inverse of the map.

A fundamental piece lies where the series is accurate; its inverse images follow one another (`growth`), and errors
across the curve shrink.  Curves of a model with two walls are those of its lower one, without the states from which the
upper one is met.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.contact.points import tangency_points
from singimpact.dynamics.growth import SETTINGS as GROWTH, Carried, Piece, adds, held
from singimpact.flights.impact_map import first_hit, impact_map
from singimpact.flights.inverse_map import backwards, inverse_map
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.status import Wall
from singimpact.surface.curve import STATES, Curve, Mark, Window
from singimpact.surface.other_wall import at_lower_wall
from singimpact.theory.contact_points import points_of
from singimpact.theory.formulas import arc_in_numbers
from singimpact.theory.power_series import PowerSeries


@dataclass(frozen=True)
class ArcSettings:
    """The series that a curve begins with, and its flights."""

    order: int = 12  # of the series
    trust: float = 1e-13  # relative truncation error of the series on the fundamental piece
    tolerance: float = 1e-13  # of a flight: thousands are flown, and more digits change no curve visibly
    # a series is halved until flights from this number of its states, or from all of this length, meet no other wall
    samples: int = 64
    least: float = 1e-3


SETTINGS = ArcSettings()
CURVED = {"tangency": 1, "swan": 2}  # contact orders of the points where gamma may end


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
    size = _below_the_other_wall(model, foot, series, size)
    return _grown(model, window, foot, series, -size, float(motion(-size)))


def gammas_within(model: Oscillator, window: Window) -> list[Curve]:
    """gamma from every tangency point with a' > 0, and every swan point with a'' < 0, whose tau lies in the window.

    Examples
    --------
    >>> curves = gammas_within(Oscillator("x", "cos(2*t)", "0.3", "1/2"), Window((2, 6), (0, 1)))
    >>> [round(float(curve.points[0, 0]), 3) for curve in curves if curve.marked("foot").size]
    [2.509, 5.65]
    """
    curves: list[Curve] = []
    for point in tangency_points(model):
        bent = float(acceleration(model, np.array([point.tau]), 2)[0])
        if point.kind == "foliation" or (point.kind == "degenerate" and bent > 0):
            continue
        for shift in _turns(model, point.tau, window):
            moved = replace(window, x=(window.x[0] - shift, window.x[1] - shift))
            grown = grown_gamma(model, moved, repr(point.tau))
            curves += [replace(curve, points=curve.points + np.array([shift, 0.0])) for curve in grown]
    return curves


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
    size = _below_the_other_wall(model, foot, series, series.valid_within(SETTINGS.trust))
    # along the fibre the map contracts by r to first order; the computed image bounds the fundamental piece
    landed = model_step(model, np.array([[foot - size, float(series(-size))]]))[0, 0] - foot
    return _grown(model, window, foot, series, -size, float(landed))


def _below_the_other_wall(model: Oscillator, foot: float, series: PowerSeries, size: float) -> float:
    """A part of the length of a series from whose states no flight meets an upper wall."""
    while model.upper is not None and size > SETTINGS.least:
        s = -size * (np.arange(SETTINGS.samples) + 1) / SETTINGS.samples
        if not (impact_map(model, foot + s, np.maximum(series(s), 0.0)).wall == Wall.upper).any():
            break
        size /= 2
    return size


def _curved(model: Oscillator, tau: Any) -> str:
    """Whether the point is a tangency or a swan. A swan is tested first, because a_c vanishes there too."""
    order = points_of(model, tau)[0]
    if order == 0:
        raise InputError(f"tau = {tau}: a_c does not vanish there, so that no invariant curve ends there")
    if order == 2 and acceleration(model, np.array([_foot(model, tau, "swan")]), 2)[0] > 0:
        raise InputError(f"tau = {tau}: a_c'' > 0 at this swan, and no invariant curve ends at a positive one")
    return {j: at for at, j in CURVED.items()}[order]


def _foot(model: Oscillator, tau: Any, at: str | None) -> float:
    if tau is not None:
        return as_float(constant("tau", tau))
    kind = "gamma" if at == "tangency" else "degenerate"
    return next(point.tau for point in tangency_points(model) if point.kind == kind)


def model_step(model: Oscillator, points: Array, horizon: float | None = None) -> Array:
    """The impact map on points (tau, v), shape (n, 2); nan where there is no next impact, and where v < 0.

    `horizon` : time after which a flight is given up.
    """
    images, regular = np.full(points.shape, np.nan), np.isfinite(points).all(axis=1) & (points[:, 1] >= 0)
    at, v_at = points[regular].T
    step = impact_map(model, at, v_at, tolerance=SETTINGS.tolerance, horizon=horizon)
    images[regular] = np.where(at_lower_wall(step)[:, None], np.stack([step.tau, step.v], axis=1), np.nan)
    return images


def before(model: Oscillator, points: Array, horizon: float | None = None) -> Array:
    """The inverse map on points, shape (n, 2); nan where nothing lands there, and where v < 0."""
    images, regular = np.full(points.shape, np.nan), np.isfinite(points).all(axis=1) & (points[:, 1] >= 0)
    at, v_at = points[regular].T
    if names_in(model.restitution):
        step = inverse_map(model, at, v_at, horizon=horizon)
        tau, v, good = step.tau, step.v, at_lower_wall(step)
    else:
        speeds = v_at / as_float(model.restitution)
        hit = first_hit(backwards(model), -at, speeds, tolerance=SETTINGS.tolerance, horizon=horizon)
        tau, v, good = at - hit.flight_time, -hit.velocity, at_lower_wall(hit)
    images[regular] = np.where(good[:, None], np.stack([tau, v + 0.0], axis=1), np.nan)
    return images


def _grown(
    model: Oscillator, window: Window, foot: float, series: PowerSeries, outer: float, inner: float
) -> list[Curve]:
    """The series from its foot to the fundamental piece, then the inverse images of that."""

    def start(s: Array) -> Array:
        return np.stack([foot + s, series(s)], axis=1)

    carried = Carried(
        window,
        start,
        lambda points, _: before(model, points),
        lambda points: held(window, points),
        lambda points: points[:, 0] >= window.x[0] - 0.2 * window.sides[0],
    )
    pieces = [carried.first(inner, outer)]
    s = np.append(0.0, pieces[0].s)
    done = [carried.refined(Piece(s, start(s), 0))]
    for _ in range(GROWTH.generations):
        new = [image for piece in pieces for image in carried.images(piece)]
        pieces = [piece for piece in new if adds(piece, pieces, window)]
        if not pieces:
            break
        done += pieces
    return list(_joined(done, window))


def _joined(pieces: list[Piece], window: Window) -> list[Curve]:
    """Curves made of consecutive pieces, cut to the window."""
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
        curves += [
            replace(stretch, first_hits=np.ones(len(stretch), dtype=bool)) for stretch in whole.parts(whole.visible)
        ]
    return [curve for curve in curves if len(curve) > 1]
