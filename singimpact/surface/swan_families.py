"""Swans of a model over one parameter, isolated with proof, and their curves over two."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, Name
from singimpact.algebra.isolated_zeros import DoubleZero, DoubleZeros, double_zeros
from singimpact.algebra.numbers import as_float
from singimpact.contact.contact import acceleration, rest_acceleration
from singimpact.contact.swans import swan_points_over_clearance
from singimpact.inputs import InputError, unknown
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result
from singimpact.surface.curve import Curve, window_ends

Array = np.ndarray[Any, Any]
STEPS = 60  # between the ends of a number that is sampled: rows of a picture of curves, places where others are met
SLACK = 1e-12  # of a period: a zero at 0 is found with a tiny sign
MARGIN = 97  # the window of tau is longer than a period by this part at both ends, so that no zero falls on one


@dataclass(frozen=True)
class Transition(Result):
    """A change of P.

    Attributes
    ----------
    kind : "swan, positive", "swan, negative", "swallowtail", "lips", "beaks" ("undecided" where the Hessian is flat),
        "tangency to tangency", "tacnode, opposite", "tacnode, same", "triple point", "periodic graze".
    value : of the parameter. tau, t : the flight from rest at tau is at the wall again after t; for "swallowtail",
        "lips" and "beaks" a_c(tau) = 0, for the kinds below "lips" it is at rest after t > 0.
    rests : all times, in order, at which this flight is at rest at the wall; the first lies in [0, T).
    visible : whether the map of first hits changes; None where that is not decided.
    launch : (tau, v) with v > 0 from which a visible flight comes, in the same time as `rests`; None without one.
    effect : the change in words.

    Examples
    --------
    >>> Transition("lips", 0.1, 2.0, -1.5).event
    'tangency last'
    """

    kind: str
    value: float
    tau: float
    t: float
    rests: tuple[float, ...] = ()
    visible: bool | None = None
    launch: tuple[float, float] | None = None
    effect: str = ""

    def as_dict(self) -> dict[str, Any]:
        """The fields, with `event`; null where visibility is not decided or no launch leads there."""
        names = ("kind", "event", "value", "tau", "t", "rests", "visible", "launch", "effect")
        return {name: getattr(self, name) for name in names}

    @property
    def event(self) -> str:
        """The event of the flight alone, whatever P looks like.

        "swan", "swallowtail", "tangency first" (the first of two rests is a tangency point), "tangency last", "tangency
        to tangency", "tacnode", "triple point", "periodic graze".
        """
        if self.kind in ("lips", "beaks", "undecided"):
            return "tangency first" if self.t > 0 else "tangency last"
        return self.kind.split(",")[0]


@dataclass(frozen=True)
class Family:
    """A model with one free parameter."""

    model: Oscillator
    over: str

    def at(self, value: float) -> Oscillator:
        """The model at a value, taken as its exact binary number."""
        return self.model.replace(**{self.over: value})

    def periods(self, values: Array) -> dict[float, float]:
        """The periods of the forcing by value; those are left out at which it is constant, as at amplitude = 0."""
        known = {value: self.at(value).period for value in values.tolist()}
        return {value: as_float(period) for value, period in known.items() if period is not None}

    def acceleration(self) -> Expression:
        """a_c as a tree in t and the free parameter."""
        if self.over != "clearance":
            return acceleration(self.model, (self.over,))
        return rest_acceleration(self.model.force(), self.model.forcing(), Name("clearance"))


def swans_met(family: Family, values: Array) -> tuple[list[Transition], tuple[str, ...]]:
    """Double zeros of a_c, isolated with proof, and the reasons why one may be missing."""
    between = Fraction(float(values[0])), Fraction(float(values[-1]))
    if family.over == "clearance":
        swans = swan_points_over_clearance(family.model, between)
        inside = [swan for swan in swans if between[0] <= Fraction(swan.clearance) <= between[1]]
        return [Transition(f"swan, {swan.kind}", swan.clearance, swan.tau, 0.0, (swan.tau,)) for swan in inside], ()
    periods = set(family.periods(values).values())
    if not periods:
        raise InputError(f"g = {family.model.g} is not seen to be periodic: give period=")
    longest = Fraction(max(periods))
    window = (-longest / MARGIN, longest * Fraction(MARGIN + 1, MARGIN), *between)
    zeros = double_zeros(family.acceleration(), ("t", family.over), window)
    inside_period = [zero for zero in zeros.found if _in_period(family, zero, float(longest))]
    return [_as_transition(zero) for zero in inside_period], _doubts(zeros, family.over, len(periods))


def _in_period(family: Family, zero: DoubleZero, longest: float) -> bool:
    value = float(zero.value)
    period = family.periods(np.array([value])).get(value, longest)
    return -SLACK * period <= float(zero.at) < period * (1 - SLACK)


def _as_transition(zero: DoubleZero) -> Transition:
    sign = "positive" if zero.curvature > 0 else "negative"  # not 0: the matrix of derivatives is regular there
    at = float(zero.at) + 0.0
    return Transition(f"swan, {sign}", float(zero.value), at, 0.0, (at,))


def _doubts(zeros: DoubleZeros, over: str, periods: int) -> tuple[str, ...]:
    notes = []
    if periods > 1:
        notes.append(f"the period moves with {over}: swans are listed in a window that is the longest one sampled")
    if zeros.undecided:
        low, high = (float(f(box[k] for box in zeros.undecided)) for f, k in ((min, 2), (max, 3)))
        notes.append(
            f"a_c may have zeros of order 3, or double ones that stay, for {over} from {low:.9g} to {high:.9g}: "
            "swans there are not decided"
        )
    return tuple(notes)


def swan_curves(model: Oscillator, over: tuple[str, str], between: tuple[Any, Any]) -> list[Curve]:
    """Curves of swan points in the plane of two parameters.

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
    along, across = (window_ends(name, ends) for name, ends in zip(over, between, strict=True))
    rows: list[list[tuple[float, float, Transition]]] = []
    for value in np.linspace(*across, STEPS + 1).tolist():
        family = Family(Family(model, second).at(value), first)
        swans, _ = swans_met(family, np.linspace(*along, STEPS + 1))
        rows.append([(swan.value, value, swan) for swan in swans])
    return [Curve("swan", np.array(line), over) for line in _linked(rows) if len(line) > 1]


def _linked(rows: list[list[tuple[float, float, Transition]]]) -> list[list[tuple[float, float]]]:
    """Join swans of adjacent rows whose times and kinds agree."""
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
