"""`classify`: the singular points of p and phi in a window of V_c', each with its germ, and the fold lines between.

(tau_*, 0)   a_c = 0: p and phi are folded; at a swan, a_c' = 0 too, both have a lips point
(tau_*, t)   on Z, t != 0: phi has a cusp, p has one at the mirror image; above a swan, swallowtails
H, Z         between these: p is folded along H, phi along Z
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.contact.points import tangency_points
from singimpact.contact.swans import SwanPoint, swan_points_over_clearance
from singimpact.inputs import InputError, require
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.result import Result
from singimpact.surface.curve import Curve
from singimpact.surface.impact_surface import ImpactSurface
from singimpact.surface.rest_flights import RestFlights

Point = tuple[float, float]
REACH = 1.5  # of the times between the outermost zeros of a_c: the default window of a forcing without a period
SINGULAR = 1e-6  # dx/dv and x' below this: curves are traced to 1e-8 beside a singular point of V_c'
NEAR = 1e-9  # a cusp this near to a degenerate zero in tau stands above it


@dataclass(frozen=True)
class SingularPoint(Result):
    """A point of V_c' where p or phi is no local diffeomorphism, other than a fold.

    Attributes
    ----------
    name : "tangency", "swan", "cusp", "swallowtail"; "singular" where V_c' itself has no
        tangent plane. maps : "p", "phi" or "p, phi". tau, t : where on V_c'.
    image : (tau, v) under p, (tau, x') under phi. kind : of a tangency "gamma", "foliation"; of a swan its sign; "".
    """

    name: str
    maps: str
    tau: float
    t: float
    image: Point
    kind: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Name, map, kind, place on V_c' and its image."""
        names = ("name", "maps", "kind", "tau", "t")
        return {name: getattr(self, name) for name in names} | {"image": list(self.image)}


@dataclass(frozen=True)
class FoldLine(Result):
    """A stretch of H (for p) or Z (for phi) between singular points, the edge of the window, or round.

    Attributes
    ----------
    maps : "p" or "phi". start, end : (tau, t). bounds : what stands there: "cusp", "edge"; "cut" where the flights
        beyond meet a second wall; "closed" when it is round.
    """

    maps: str
    start: Point
    end: Point
    bounds: tuple[str, str]

    def as_dict(self) -> dict[str, Any]:
        """The map, both ends and what stands there."""
        return {"maps": self.maps, "from": list(self.start), "to": list(self.end), "bounds": list(self.bounds)}


@dataclass(frozen=True)
class Classification(Result):
    """The result of `classify`.

    Attributes
    ----------
    tau, t : the window. points : in order of tau, t. folds : of p, then of phi.
    swans : where the clearance would have to be, for a swan. notes : what was not decided, and why. flights : computed.
    """

    tau: Point
    t: Point
    points: tuple[SingularPoint, ...]
    folds: tuple[FoldLine, ...]
    swans: tuple[SwanPoint, ...]
    notes: tuple[str, ...]
    flights: int

    def as_dict(self) -> dict[str, Any]:
        """The window, its singular points and fold lines, swans over the clearance, notes, and flights computed."""
        return {
            "window": {"tau": list(self.tau), "t": list(self.t)},
            "points": [point.as_dict() for point in self.points],
            "folds": [line.as_dict() for line in self.folds],
            "swans": [swan.as_dict() for swan in self.swans],
            "notes": list(self.notes),
            "flights": self.flights,
        }

    def __repr__(self) -> str:
        kinds = Counter(point.name for point in self.points)
        told = ", ".join(f"{name} {count}" for name, count in kinds.items()) or "no singular points"
        return f"Classification({told}; fold lines {len(self.folds)}; swans over the clearance {len(self.swans)})"


def classify(model: Oscillator, tau: Any = None, t: Any = None, between: Any = None) -> Classification:
    """The singular points of p and phi in a window.

    Parameters
    ----------
    tau, t : ends of the window of Z, whose mirror images are listed with it; without them one period and as much on
        both sides of t = 0, or what holds all zeros of a_c when g is a polynomial.
    between : clearances to look for swans between, as two Fractions.

    Examples
    --------
    >>> found = classify(Oscillator("0", "-12*(t**2 - 1)", 0, "1/2"))
    >>> [(point.name, point.maps, point.tau, round(point.t, 9)) for point in found.points][:3]
    [('cusp', 'p', -3.0, 4.0), ('tangency', 'p, phi', -1.0, 0.0), ('cusp', 'phi', -1.0, 4.0)]
    """
    require(isinstance(model, Oscillator), "model", model, "an ImpactOscillator")
    usual_tau, usual_t = default_window(model)
    surface = ImpactSurface(model, usual_tau if tau is None else tau, usual_t if t is None else t)
    singular = _of_the_surface(surface)
    points = sorted([*_on_the_axis(surface), *_off_the_axis(surface), *singular], key=lambda each: (each.tau, each.t))
    folds = [
        line for maps, curves in (("p", surface.horizon), ("phi", surface.zero_set)) for line in _folds(maps, curves)
    ]
    swans, notes = tuple[SwanPoint, ...](), tuple[str, ...]()
    try:
        swans = swan_points_over_clearance(model if model.upper is None else model.one_wall(), between)
    except InputError as error:  # where no list is possible, the reason instead of an empty one
        notes = (f"swan points over the clearance: {error}",)
    if left_out := surface.divided[1]:
        notes += (f"of H and of Z {len(left_out)} parts are left out, whose flights meet the other wall",)
    if singular:
        notes += (f"V_c' is singular at {len(singular)} flights from rest to rest: curves are cut there",)
    return Classification(
        surface.window.x, surface.window.y, tuple(points), tuple(folds), swans, notes, surface.flights
    )


def default_window(model: Oscillator) -> tuple[Point, Point]:
    """One period in tau and in t to both sides; or, of a polynomial, the zeros of a_c with a margin."""
    if model.period is not None:
        period = as_float(model.period)
        return (0.0, period), (-period, period)
    places = [point.tau for point in tangency_points(model)] or [0.0]
    middle, half = (places[0] + places[-1]) / 2, (places[-1] - places[0]) / 2 or 1.0
    # an unfolded swan reaches to three half distances in tau and to four in t
    return (middle - 2 * REACH * half - half, middle + 2 * REACH * half + half), (-4 * REACH * half, 4 * REACH * half)


def _on_the_axis(surface: ImpactSurface) -> Iterator[SingularPoint]:
    for point, tau in surface.placed_tangencies:
        if point.kind != "degenerate":
            yield SingularPoint("tangency", "p, phi", tau, 0.0, (tau, 0.0), point.kind)
            continue
        curvature = float(acceleration(surface.model, np.array([tau]), 2)[0])
        kind = "positive" if curvature > 0 else "negative" if curvature < 0 else "undecided"
        yield SingularPoint("swan", "p, phi", tau, 0.0, (tau, 0.0), kind)


def _off_the_axis(surface: ImpactSurface) -> Iterator[SingularPoint]:
    double = [tau for point, tau in surface.placed_tangencies if point.kind == "degenerate"]
    for cusp in surface.cusps:
        name = "swallowtail" if any(abs(cusp.tau - tau) < NEAR for tau in double) else "cusp"
        yield SingularPoint(name, "phi", cusp.tau, cusp.t, cusp.image)
        yield SingularPoint(name, "p", *cusp.of_p, cusp.image)


def _of_the_surface(surface: ImpactSurface) -> list[SingularPoint]:
    """Where x = c has no tangent plane in (tau, v, t): x' = 0 at the end, dx/dv = 0, and so dx/dtau = -v dx/dx_0 = 0.

    The launch is at rest too, for the derivatives by place and velocity do not vanish together.  Z crosses itself
    there or shrinks to the point: what was traced of it ends beside the point, or has it as a vertex.
    """
    flights, singular = RestFlights(surface.model), list[SingularPoint]()
    places = [tuple(vertex) for curve in surface.zero_set for name in ("rest", "end") for vertex in curve.marked(name)]
    for tau, t in places:
        at, end = np.array([tau]), np.array([t])
        _, velocity = flights.ends(at, end)
        by_speed = flights.by_speed(at, end)[0]
        listed = any(abs(point.tau - tau) + abs(point.t - t) < SINGULAR for point in singular)
        if abs(by_speed[0]) + abs(velocity[0]) < SINGULAR * abs(by_speed[1]) and t and not listed:
            singular.append(SingularPoint("singular", "p, phi", float(tau), float(t), (float(tau), 0.0)))
    return singular


def _folds(maps: str, curves: list[Curve]) -> Iterator[FoldLine]:
    for curve in curves:
        cuts = sorted(mark.index for mark in curve.marks if mark.name == "cusp")
        edges = {mark.index: "cut" for mark in curve.marks if mark.name == "cut"}
        if curve.closed:
            pairs = list(zip(cuts, cuts[1:] + cuts[:1], strict=True)) or [(0, len(curve) - 1)]
        else:
            pairs = list(pairwise([0, *cuts, len(curve) - 1]))
        for pair in pairs:
            kinds = ["cusp" if i in cuts else "closed" if curve.closed else edges.get(i, "edge") for i in pair]
            start, end = ((float(curve.points[i, 0]), float(curve.points[i, 1])) for i in pair)
            yield FoldLine(maps, start, end, (kinds[0], kinds[1]))
