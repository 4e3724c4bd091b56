"""Pseudo-arclength continuation: a predictor along the tangent, then Newton's method across it (Keller 1977)."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.inputs import need
from singimpact.progress import ProgressLine

# Of a point of m + 1 unknowns: m values and derivatives, shapes (m,) and (m, m + 1); nan where there are none.
Equations = Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True)
class ContinuationSettings:
    """Steps are lengths in unknowns divided by their scales."""

    # the first step, of the largest one
    first: float = 0.3
    # the curve ends if the step falls below this part of the largest step
    least: float = 1e-6
    # Newton's method: rounds, and the tolerance relative to the scales
    rounds: int = 8
    arrived: float = 1e-13
    # the tolerance after two rounds: conditions that are computed from a cubic of the number were off by 1e-12
    rounded: float = 1e-11
    # numbers of rounds after which the next step is longer, or shorter
    easy: int = 4
    longer: float = 1.5
    # the largest angle between two tangents, as a cosine
    turn: float = 0.95
    # a step passes a point that is nearer to it than this part of its length
    beside: float = 0.1


SETTINGS = ContinuationSettings()


@dataclass(frozen=True)
class Point:
    """A point of the curve, its unit tangent in scaled unknowns, and its distance along the last step."""

    at: Array
    tangent: Array


@dataclass
class Curve:
    """Solutions of some equations along a curve.

    Parameters
    ----------
    equations : of the curve. scales : of the unknowns. step : the largest one.
    speeds : the place of the velocities, which may grow by orders of magnitude on the way: where they are larger than
        their scale the largest step is a part of them.
    """

    equations: Equations
    scales: Array
    step: float
    speeds: slice = field(default_factory=lambda: slice(0, 0))
    note: str = field(default="", init=False)
    following: float = field(default=0.0, init=False)

    def longest(self, here: Point) -> float:
        """The largest step from a point.

        Examples
        --------
        >>> slow, fast = (Point(np.array([0.0, v]), np.array([0.0, 1.0])) for v in (0.5, 40.0))
        >>> curve = Curve(None, np.ones(2), 0.02, slice(1, 2))
        >>> curve.longest(slow), round(curve.longest(fast), 12)
        (0.02, 0.8)
        """
        growth = float(np.abs(here.at[self.speeds] / self.scales[self.speeds]).max(initial=1.0))
        weights = np.ones(len(here.at))
        weights[self.speeds] = 1 / growth
        return self.step / float(np.linalg.norm(here.tangent * weights))

    def begin(self, at: Array, towards: Array | None = None) -> Point | None:
        """The point of the curve next to a guess; its tangent points along `towards`."""
        point = at.copy()
        direction = None
        for count in range(1, 4 * SETTINGS.rounds + 1):
            values, slopes = self._scaled(point)
            if not _finite(values, slopes):
                return None
            change = np.linalg.lstsq(slopes, values, rcond=None)[0]
            point = point - change * self.scales
            if _converged(float(np.abs(change).max()), count):
                direction = null_vector(self._scaled(point)[1])
                break
        if direction is None:
            return None
        if towards is not None and direction @ (towards / self.scales) < 0:
            direction = -direction
        return Point(point, direction)

    def beyond(self, start: Point, length: float) -> tuple[Point, int] | None:
        """The point at a distance along the tangent of another, and the rounds that it took."""
        point = start.at + length * start.tangent * self.scales
        base = start.at / self.scales
        for count in range(1, SETTINGS.rounds + 1):
            values, slopes = self._scaled(point)
            if not _finite(values, slopes):
                return None
            bordered = np.vstack([slopes, start.tangent])
            miss = np.append(values, start.tangent @ (point / self.scales - base) - length)
            try:
                change = np.linalg.solve(bordered, miss)
            except np.linalg.LinAlgError:
                return None
            point = point - change * self.scales
            size = float(np.abs(change).max())
            if _converged(size, count):
                return self._with_tangent(point, start.tangent), count
            if size > 4 * max(self.step, abs(length)):
                return None
        return None

    def walk(self, start: Point, most: int, first: float | None = None) -> Iterator[tuple[Point, float, Point]]:
        """Points after a start: the one before, the step from it, the new one; `note` says why it ended.

        Parameters
        ----------
        most : points. first : the length of the first step; `following` is that of the next one after each point.
        """
        length, here = SETTINGS.first * self.step if first is None else first, start
        with ProgressLine() as line:
            for count in range(most):
                line.show(count, None, "points of a curve")
                corrected = self.beyond(here, length)
                while corrected is None or here.tangent @ corrected[0].tangent < SETTINGS.turn:
                    length /= 2
                    if length < SETTINGS.least * self.step:
                        self.note = self._ended(here, length)
                        return
                    corrected = self.beyond(here, length)
                after, rounds = corrected
                grown = length * (SETTINGS.longer if rounds <= SETTINGS.easy else 1.0)
                self.following = min(grown, self.longest(after))
                yield here, length, after
                here, length = after, self.following
        self.note = f"{most} points are spent: the curve goes on (points=)"

    def located(
        self, here: Point, length: float, test: Callable[[Point], float], ends: tuple[float, float]
    ) -> tuple[float, Point] | None:
        """Where a test of points changes sign along a step: the part of its length, and the point.

        Parameters
        ----------
        here, length : the step. test : nan where it has no value. ends : its values at both ends of the step.

        Returns
        -------
        None : the test, or the curve, has no value on the way.
        """
        return self.zero(
            {0.0: here}, lambda _, point: test(point), lambda value: root_between(value, 0.0, length, ends)
        )

    def zero(
        self,
        points: dict[float, Point],
        test: Callable[[float, Point], float],
        method: Callable[[Callable[[float], float]], float],
    ) -> tuple[float, Point] | None:
        """The zero of a test of points of the curve, and the point there; None where either has no value on the way.

        Parameters
        ----------
        points : by their distance, the first of which is that from which the curve is followed; others are added.
        test : of the distance and the point. method : finds a zero of a function of the distance.
        """
        here = next(iter(points.values()))

        def value(along: float) -> float:
            if along not in points:
                corrected = self.beyond(here, along)
                if corrected is None:
                    raise ArithmeticError
                points[along] = corrected[0]
            return test(along, points[along])

        try:
            along = method(value)
            value(along)
        except ArithmeticError:
            return None
        return along, points[along]

    def passes(self, start: Point, here: Point, after: Point, gap: Array | None = None) -> bool:
        """Whether a step passes the start in the direction in which it was left.

        Parameters
        ----------
        gap : from `here` to the start in scaled unknowns, where periods are taken off.
        """
        gap = (start.at - here.at) / self.scales if gap is None else gap
        move = (after.at - here.at) / self.scales
        share = float(gap @ move / (move @ move))
        near = float(np.linalg.norm(gap - share * move)) < SETTINGS.beside * float(np.linalg.norm(move))
        return 0 <= share < 1 and near and float(start.tangent @ after.tangent) > 0

    def _scaled(self, point: Array) -> tuple[Array, Array]:
        values, slopes = self.equations(point)
        return values, slopes * self.scales

    def _with_tangent(self, point: Array, before: Array) -> Point:
        slopes = self._scaled(point)[1]
        right = np.zeros(len(before))
        right[-1] = 1.0
        try:
            tangent = np.linalg.solve(np.vstack([slopes, before]), right)
        except np.linalg.LinAlgError:
            tangent = null_vector(slopes)
            tangent = tangent if tangent @ before > 0 else -tangent
        return Point(point, tangent / np.linalg.norm(tangent))

    def _ended(self, here: Point, length: float) -> str:
        values, slopes = self._scaled(here.at + length * here.tangent * self.scales)
        if not _finite(values, slopes):
            return "just beyond the last point a flight leaves the domain of f or g, or a number that the model accepts"
        return "steps shrink to nothing at the last point: the equations are singular there"


def _finite(values: Array, slopes: Array) -> bool:
    return bool(np.isfinite(values).all() and np.isfinite(slopes).all())


def null_vector(slopes: Array) -> Array:
    """The unit vector that a matrix with one row fewer than columns takes to zero."""
    return np.asarray(np.linalg.svd(slopes)[2][-1])


def null_plane(slopes: Array, tangent: Array) -> Array:
    """At a branch point, where a matrix takes a plane to zero, the unit vector of that plane across a tangent in it.

    Examples
    --------
    >>> null_plane(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]), np.array([1.0, 0.0, 0.0])).round(9).tolist()
    [0.0, 1.0, 0.0]
    """
    plane = np.linalg.svd(slopes)[2][-2:]
    shares = plane @ tangent
    across = plane.T @ np.array([-shares[1], shares[0]])
    return np.asarray(across / np.linalg.norm(across) * (1.0 if across[np.argmax(np.abs(across))] > 0 else -1.0))


def _converged(size: float, count: int) -> bool:
    """Whether Newton's method has come to the end of its digits, by its last change and its number of rounds."""
    return size <= SETTINGS.arrived or (count > 2 and size <= SETTINGS.rounded)


def cubic_between(before: Any, rate: Any, after: Any, later: Any) -> tuple[Any, Any]:
    """The coefficients of s^2 and s^3 of the cubic with these values and derivatives at 0 and 1 (Hermite).

    Parameters
    ----------
    before, rate : value and derivative at 0, numbers or arrays. after, later : at 1.

    Examples
    --------
    >>> cubic_between(0.0, 0.0, 1.0, 0.0)  # 3 s^2 - 2 s^3
    (3.0, -2.0)
    """
    rise = after - before
    return 3 * rise - 2 * rate - later, rate + later - 2 * rise


def root_between(test: Callable[[float], float], low: float, high: float, ends: tuple[float, float]) -> float:
    """Where a test changes sign between two lengths, by Brent's method.

    Raises
    ------
    ArithmeticError : the test has no value on the way.

    Examples
    --------
    >>> root_between(lambda length: length - 0.25, 0.0, 1.0, (-0.25, 0.75))
    0.25
    >>> root_between(lambda length: float("nan"), 0.0, 1.0, (-0.25, 0.75))
    Traceback (most recent call last):
    ArithmeticError: no value at 0.25
    """
    from scipy.optimize import brentq

    if ends[0] == 0:
        return low
    if ends[1] == 0:
        return high

    def defined(length: float) -> float:
        value = ends[0] if length == low else ends[1] if length == high else test(length)
        need(not np.isnan(value), ArithmeticError(f"no value at {length:.9g}"))
        return value

    return float(brentq(defined, low, high, xtol=1e-15 * max(high, 1e-300), rtol=8.9e-16, maxiter=1000))
