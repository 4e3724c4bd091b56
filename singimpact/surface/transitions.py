"""Where P changes its kind as the clearance, or a parameter, moves: swans, swallowtails, lips and beaks.

In flights launched at rest at a tangency point tau_*, a_c(tau_*) = 0:

    swan         a_c' = 0 too: two tangency points are born; P appears or vanishes there in a lips transition at t = 0
    swallowtail  the same, seen at each further crossing t of the flight from rest at tau_*
    lips, beaks  the flight touches c again, x = c and x' = 0 at t: Z has an isolated point there, or crosses itself
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, Name, evaluate
from singimpact.algebra.numbers import as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.algebra.zeros import isolate, refined
from singimpact.contact.contact import acceleration, rest_acceleration
from singimpact.contact.points import tangency_points
from singimpact.contact.swans import swan_points_over_clearance
from singimpact.inputs import InputError, unknown
from singimpact.oscillator.model import Oscillator
from singimpact.surface.curve import Curve, Window
from singimpact.surface.rest_flights import RestFlights

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class TransitionSettings:
    """steps : of the parameter between its ends; a pair of transitions closer than one is not seen.
    samples : of a flight in the window of t. settled : Newton's last step. flat : a Hessian below this share of its
    terms decides nothing.
    """

    steps: int = 60
    samples: int = 400
    settled: float = 1e-12
    flat: float = 1e-6


SETTINGS = TransitionSettings()


@dataclass(frozen=True)
class Transition:
    """A change of P.

    Attributes
    ----------
    kind : "swan, positive", "swan, negative", "swallowtail", "lips", "beaks"; "undecided" where the Hessian is flat.
    value : of the parameter. tau, t : the flight from rest; its mirror image is where P changes.
    """

    kind: str
    value: float
    tau: float
    t: float


def transitions(model: Oscillator, over: str, between: Any, t: Any = (-6, 6)) -> list[Transition]:
    """The transitions of P as a parameter moves, one period of tau, in order of the parameter.

    Parameters
    ----------
    over : "clearance" or the name of a parameter. between : its two ends. t : window of flight times.

    Raises
    ------
    InputError : not a parameter; ends that are no numbers in rising order.

    Examples
    --------
    >>> found = transitions(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", ("0.9", "1.1"))
    >>> [(each.kind, round(each.value, 9), round(each.t, 6)) for each in found][:1]
    [('swan, negative', 1.0, 0.0)]
    """
    if over != "clearance" and over not in model.parameters:
        raise unknown("parameter", over, ["clearance", *model.parameters])
    low, high = Window.read(between, t).tau
    values = np.linspace(low, high, SETTINGS.steps + 1)
    family = _Family(model, over)
    swans = list(_swans(family, values))
    times = Window.read(between, t).t
    found = [*swans, *_swallowtails(family, swans, times), *_touches(family, values, times)]
    return sorted(found, key=lambda each: (each.value, each.tau, each.t))


def swan_curves(model: Oscillator, over: tuple[str, str], between: tuple[Any, Any]) -> list[Curve]:
    """Curves of swan points in the plane of two numbers of a model.

    Parameters
    ----------
    over : two names of parameters, or "clearance". between : the two ends of each.

    Returns
    -------
    curves with the axes `over`; every vertex solves a_c = a_c' = 0.  Along a curve the second number rises.

    Examples
    --------
    >>> model = Oscillator("x", "h*cos(2*t)", 0, "1/2", {"h": 1})
    >>> curves = swan_curves(model, ("clearance", "h"), ((0, 2), ("0.5", "1.5")))
    >>> [bool(abs(curve.points[:, 0] - curve.points[:, 1]).max() < 1e-12) for curve in curves]
    [True]
    """
    first, second = over
    for name in over:
        if name != "clearance" and name not in model.parameters:
            raise unknown("parameter", name, ["clearance", *model.parameters])
    window = Window.read(between[0], between[1])
    rows: list[list[tuple[float, float, Transition]]] = []
    for value in np.linspace(*window.t, SETTINGS.steps + 1).tolist():
        family = _Family(_Family(model, second).at(value), first)
        found = list(_swans(family, np.linspace(*window.tau, SETTINGS.steps + 1)))
        rows.append([(swan.value, value, swan) for swan in found])
    return [Curve("swan", np.array(line), over) for line in _linked(rows) if len(line) > 1]


def _linked(rows: list[list[tuple[float, float, Transition]]]) -> list[list[tuple[float, float]]]:
    """Swans of neighbouring rows joined when their times and kinds agree."""
    open_: list[tuple[Transition, list[tuple[float, float]]]] = []
    done: list[list[tuple[float, float]]] = []
    for row in rows:
        following = []
        for value, other, swan in row:
            same = [pair for pair in open_ if pair[0].kind == swan.kind]
            near = min(same, key=lambda pair: abs(pair[0].tau - swan.tau), default=None)
            line = near[1] if near is not None and abs(near[0].tau - swan.tau) < 0.3 else []
            if near is not None and line:
                open_.remove(near)
            following.append((swan, [*line, (value, other)]))
        done += [line for _, line in open_]
        open_ = following
    return done + [line for _, line in open_]


@dataclass(frozen=True)
class _Family:
    """A model in which one number moves."""

    model: Oscillator
    over: str

    def at(self, value: float) -> Oscillator:
        """The model at a value, taken as its exact binary number."""
        return self.model.replace(**{self.over: value})

    def acceleration(self) -> Expression:
        """a_c as a tree in t and the moving number."""
        if self.over != "clearance":
            return acceleration(self.model, (self.over,))
        return rest_acceleration(self.model.force(), self.model.forcing(), Name("clearance"))


def _swans(family: _Family, values: Array) -> Iterator[Transition]:
    """Where a_c gets a double zero: over the clearance all of them, isolated with proof; else those that are met."""
    if family.over == "clearance":
        between = Fraction(float(values[0])), Fraction(float(values[-1]))
        for swan in swan_points_over_clearance(family.model, between):
            yield Transition(f"swan, {swan.kind}", swan.clearance, swan.tau, 0.0)
    else:
        yield from _met(family, values)


def _met(family: _Family, values: Array) -> Iterator[Transition]:
    """Extrema of a_c are followed from value to value; where one passes through zero Newton's method ends it."""
    tree = family.acceleration()
    before: list[tuple[float, float]] = []
    for value in values.tolist():
        now = _extrema(family.at(value))
        for tau, height in now:
            near = min(before, key=lambda each: abs(each[0] - tau), default=None)
            if near is not None and (near[1] >= 0) != (height >= 0):
                place = _double_zero(tree, family.over, (tau + near[0]) / 2, value)
                if place is not None:
                    yield place
        before = now


def _extrema(model: Oscillator) -> list[tuple[float, float]]:
    """Zeros of a_c' in one period with a_c there."""
    tree = acceleration(model)
    if model.period is None:
        raise InputError(f"g = {model.g} is not seen to be periodic: give period=")
    end = Fraction(as_float(model.period))
    zeros = isolate(tree, "t", Fraction(-1, 97) * end, Fraction(96, 97) * end, order=1)
    tau = [float(refined(tree, "t", zero, 128, order=1).mid()) for zero in zeros if zero.slope]
    return [(each, float(evaluate(tree, {"t": each}, DOUBLES))) for each in tau]


def _double_zero(tree: Expression, over: str, tau: float, value: float) -> Transition | None:
    """a = a' = 0 by Newton's method in (tau, value)."""
    first = derivative(tree, "t")
    second = derivative(first, "t")
    parts = [tree, first, first, derivative(tree, over), second, derivative(first, over)]
    for _ in range(40):
        a, a1, a_t, a_p, a1_t, a1_p = (float(evaluate(part, {"t": tau, over: value}, DOUBLES)) for part in parts)
        move = np.linalg.solve(np.array([[a_t, a_p], [a1_t, a1_p]]), [-a, -a1])
        tau, value = tau + float(move[0]), value + float(move[1])
        if np.abs(move).max() < SETTINGS.settled:
            sign = "positive" if float(evaluate(second, {"t": tau, over: value}, DOUBLES)) > 0 else "negative"
            return Transition(f"swan, {sign}", value, tau, 0.0)
    return None


def _swallowtails(family: _Family, swans: list[Transition], times: tuple[float, float]) -> Iterator[Transition]:
    for swan in swans:
        flights = RestFlights(family.at(swan.value))
        for t in _crossings(flights, swan.tau, times):
            yield Transition("swallowtail", swan.value, swan.tau, t)


def _samples(flights: RestFlights, tau: float, times: tuple[float, float]) -> tuple[Array, Array]:
    """t != 0 and y there, of the flight from rest at a zero of a_c; the first samples beside t = 0 are left out."""
    t = np.linspace(*times, SETTINGS.samples)
    t = t[np.abs(t) > 4 * (times[1] - times[0]) / SETTINGS.samples]
    return t, flights.grid(np.array([tau]), t)[:, 0]


def _crossings(flights: RestFlights, tau: float, times: tuple[float, float]) -> list[float]:
    t, y = _samples(flights, tau, times)
    found = []
    for i in np.flatnonzero((y[:-1] * y[1:] < 0) & (t[:-1] * t[1:] > 0)).tolist():
        at = _root(lambda s: flights.ends(np.array([tau]), np.array([s])), t[i], t[i + 1])
        found.append(at)
    return found


def _root(ends: Callable[[float], tuple[Array, Array]], low: float, high: float) -> float:
    """Newton's method kept between two ends of unlike sign."""
    start = float(ends(low)[0][0])
    at = (low + high) / 2
    for _ in range(80):
        height, velocity = (float(part[0]) for part in ends(at))
        low, high = (at, high) if height * start > 0 else (low, at)
        newton = at - height / velocity if velocity else low
        following = newton if min(low, high) < newton < max(low, high) else (low + high) / 2
        if abs(following - at) < 1e-14 * (1 + abs(at)):
            return float(following)
        at = following
    return float(at)


def _touches(family: _Family, values: Array, times: tuple[float, float]) -> Iterator[Transition]:
    """Where an extremum of the flight from rest at a tangency point passes through c."""
    before: list[tuple[float, float, float]] = []
    for value in values.tolist():
        now = [(tau, t, height) for tau, t, height in _humps(family.at(value), times)]
        for tau, t, height in now:
            near = min(before, key=lambda each: abs(each[0] - tau) + abs(each[1] - t), default=None)
            if near is not None and (near[2] >= 0) != (height >= 0) and abs(near[0] - tau) + abs(near[1] - t) < 0.5:
                share = height / (height - near[2])
                step = values[1] - values[0]
                start = np.array([tau + share * (near[0] - tau), t + share * (near[1] - t), value - share * step])
                place = _touch(family, start)
                if place is not None:
                    yield place
        before = now


def _humps(model: Oscillator, times: tuple[float, float]) -> Iterator[tuple[float, float, float]]:
    """(tau, t, x - c) of the extrema in t of the flights from rest at each tangency point."""
    flights = RestFlights(model)
    for point in tangency_points(model):
        t, y = _samples(flights, point.tau, times)
        height = y * t**2
        slope = np.diff(height)
        for i in np.flatnonzero(slope[:-1] * slope[1:] < 0).tolist():
            if t[i] * t[i + 2] > 0:
                yield point.tau, float(t[i + 1]), float(height[i + 1])


def _touch(family: _Family, start: Array) -> Transition | None:
    """a = 0, x = c, x' = 0 by Newton's method in (tau, t, value), the matrix by central differences."""
    tree = family.acceleration()

    def missed(place: Array) -> Array:
        flights = RestFlights(family.at(float(place[2])))
        height, velocity = flights.ends(place[:1], place[1:2])
        a = evaluate(tree, {"t": float(place[0]), family.over: float(place[2])}, DOUBLES)
        return np.array([float(a), float(height[0]), float(velocity[0])])

    place = start.copy()
    for _ in range(40):
        matrix = np.stack([(missed(place + h) - missed(place - h)) / 2e-6 for h in 1e-6 * np.eye(3)], axis=1)
        move = np.linalg.solve(matrix, -missed(place))
        place = place + np.clip(move, -0.2, 0.2)
        if np.abs(move).max() < SETTINGS.settled * (1 + np.abs(place).max()):
            flights = RestFlights(family.at(float(place[2])))
            return Transition(_lips_or_beaks(flights, place), float(place[2]), float(place[0]), float(place[1]))
    return None


def _lips_or_beaks(flights: RestFlights, place: Array) -> str:
    """By the Hessian of y, from differences of its exact gradient."""
    h, at = 1e-4, place[:2]
    points = at + h * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    gradient = flights.y_and_gradient(points)[1]
    (tt, tm), (mt, mm) = (gradient[0] - gradient[1]) / (2 * h), (gradient[2] - gradient[3]) / (2 * h)
    mixed = (tm + mt) / 2
    determinant = tt * mm - mixed**2
    if abs(determinant) <= SETTINGS.flat * (abs(tt * mm) + mixed**2):
        return "undecided"
    return "lips" if determinant > 0 else "beaks"
