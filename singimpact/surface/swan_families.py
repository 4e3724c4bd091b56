"""Swans of a model over one parameter, isolated with proof, and their curves over two."""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, Name
from singimpact.algebra.isolated_zeros import RepeatedZero, RepeatedZeros, repeated_zeros
from singimpact.algebra.numbers import Array, as_float
from singimpact.contact.contact import acceleration, rest_acceleration
from singimpact.contact.swans import swan_points_over_clearance, swans_are_listed
from singimpact.flights.flight_path import many_paths
from singimpact.flights.impact_map import first_hit
from singimpact.flights.inverse_map import backwards
from singimpact.inputs import InputError, require_known
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration as wall_acceleration, largest_push
from singimpact.result import Result
from singimpact.status import Status
from singimpact.surface.curve import Curve, window_ends
from singimpact.surface.other_wall import OtherWall

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
    if family.over == "clearance" and swans_are_listed(family.model):
        swans = swan_points_over_clearance(family.model, between)
        inside = [swan for swan in swans if between[0] <= Fraction(swan.clearance) <= between[1]]
        return [Transition(f"swan, {swan.kind}", swan.clearance, swan.tau, 0.0, (swan.tau,)) for swan in inside], ()
    periods = set(family.periods(values).values())
    if not periods:
        raise InputError(f"g = {family.model.g} is not seen to be periodic: give period=")
    longest = Fraction(max(periods))
    window = (-longest / MARGIN, longest * Fraction(MARGIN + 1, MARGIN)), between
    zeros = repeated_zeros(family.acceleration(), ("t", family.over), window)
    inside_period = [zero for zero in zeros.found if _in_period(family, zero, float(longest))]
    return [_as_transition(zero) for zero in inside_period], _doubts(zeros, family.over, len(periods))


def _in_period(family: Family, zero: RepeatedZero, longest: float) -> bool:
    value = float(zero.values[0])
    period = family.periods(np.array([value])).get(value, longest)
    return -SLACK * period <= float(zero.at) < period * (1 - SLACK)


def _as_transition(zero: RepeatedZero) -> Transition:
    sign = "positive" if zero.sign > 0 else "negative"  # not 0: the matrix of derivatives is regular there
    at = float(zero.at) + 0.0
    return Transition(f"swan, {sign}", float(zero.values[0]), at, 0.0, (at,))


def _doubts(zeros: RepeatedZeros, over: str, periods: int) -> tuple[str, ...]:
    notes = []
    if periods > 1:
        notes.append(f"the period moves with {over}: swans are listed in a window that is the longest one sampled")
    if zeros.undecided:
        low, high = (float(f(box[1][k] for box in zeros.undecided)) for f, k in ((min, 0), (max, 1)))
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
    require_known("parameter", over, ["clearance", *model.parameters])
    along, across = (window_ends(name, ends) for name, ends in zip(over, between, strict=True))
    rows: list[list[tuple[float, float, Transition]]] = []
    for value in np.linspace(*across, STEPS + 1).tolist():
        swans, _ = swans_met(Family(Family(model, second).at(value), first), np.linspace(*along, STEPS + 1))
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


# Which transitions of P change the map of first hits, from where they are launched, and what they do, in words.
#
# A visible rest at s is reached from above: a(s) > 0, or a = 0 > a', or a = a' = 0 < a''.  All but the last are left
# upwards too; between the rests x > c.  So everything is decided by signs and by one flight, run back to its launch.

Launch = tuple[float, float] | None


# a_c or a_c' below this, of the largest a_c, is zero: rests are known to 1e-12
FLAT = 1e-7
# Of a rest, where x - c is too flat to be compared
ASIDE = 0.02
# x - c below which a minimum is one more rest; launches below this velocity, in parts of the largest a_c, are too
NEAR, SLOW = 1e-8, 1e-7
# What a visible transition does in one direction of the number; in the other one it is undone.
EFFECTS = tomllib.loads(Path(__file__).with_name("effects.toml").read_text(encoding="utf-8"))
BEYOND = "no first hit changes between impacts with this wall: the flight meets the other one"
HIDDEN = "no first hit changes: the flight meets the wall from below, or passes through it between its rests"
UNDECIDED = "the flight touches the wall once more, so that it is not decided whether first hits change"


def told(event: Transition, model: Oscillator) -> Transition:
    """A transition with its rests moved to one period, whether it is visible, its launch, and its effect.

    Parameters
    ----------
    event : with its rests. model : at the value of the transition; its upper wall, if it has one, takes away flights.
    """
    rests = in_first_period(event.rests, model)
    visible, launch = _seen(event, rests, model if model.upper is None else model.one_wall())
    words = UNDECIDED if visible is None else (EFFECTS.get(event.kind) or EFFECTS[event.event]) if visible else HIDDEN
    if visible and model.upper is not None:
        ends = np.array([rests[-1], rests[0] if launch is None else launch[0]])
        if OtherWall(model).is_met(np.full(2, rests[0]), ends - rests[0]).any():
            visible, launch, words = False, None, BEYOND
    return replace(event, rests=rests, visible=visible, launch=launch, effect=words)


def in_first_period(rests: tuple[float, ...], model: Oscillator) -> tuple[float, ...]:
    """Times moved by whole periods of a model, where it has one, the first of them into [0, T)."""
    if model.period is None:
        return rests
    period = as_float(model.period)
    back = np.floor(rests[0] / period + 1e-9) * period
    return tuple(float(rest - back) if abs(rest - back) > 1e-12 * period else 0.0 for rest in rests)


def _seen(
    event: Transition, rests: tuple[float, ...], model: Oscillator
) -> tuple[bool | None, tuple[float, float] | None]:
    """Whether first hits change there, and the launch with v > 0."""
    if event.kind == "swan, negative":
        return True, None
    size = (largest_push(model) if model.period is not None else 0.0) or 1.0
    jets = np.array([wall_acceleration(model, np.array(rests), order) for order in range(3)]) / size
    if not all(_from_above(jet, n == 0 < len(rests) - 1, n == len(rests) - 1) for n, jet in enumerate(jets.T)):
        return False, None
    clear = [_clear(model, *pair) for pair in pairwise(rests)]
    if False in clear:
        return False, None
    if None in clear:
        return None, None
    if event.kind == "periodic graze":
        return True, None
    launch = _launch(model, rests[0], jets[:, 0], size, len(rests))
    if event.kind == "swallowtail":
        there = launch is not None and abs(launch[0] - rests[0] - event.t) < ASIDE
        return there, launch if there else None
    return True, launch


def _from_above(jet: Array, first: bool, last: bool) -> bool:
    """Whether the flight is above the wall before a rest, if it is not the first, and after it, if not the last."""
    a, slope, curvature = jet.tolist()
    if abs(a) > FLAT:
        return bool(a > 0)
    return (first or slope < 0) and (last or slope > 0) if abs(slope) > FLAT else bool(curvature > 0)


def _clear(model: Oscillator, start: float, end: float) -> bool | None:
    """Whether x > c between two rests; None where a minimum touches c."""
    # steps of the flight in time
    t = np.linspace(0, end - start, max(40, int((end - start) / 2e-3)))[1:]
    t = t[(t > ASIDE) & (t < end - start - ASIDE)]
    if t.size < 3:
        return True  # one arch of a flight that is left and reached from above
    x = many_paths(model, np.array([start]), np.zeros(1), [t])[0][:, 0]
    before, at, after = x[:-2], x[1:-1], x[2:]
    least = at - (after - before) ** 2 / np.where((bend := before - 2 * at + after) > 0, 8 * bend, np.inf)
    inner = least[(at <= before) & (at <= after)]
    if (x < -NEAR).any() or (inner < -NEAR).any():
        return False
    return None if (inner < NEAR).any() else True


def _launch(model: Oscillator, rest: float, jet: Array, size: float, count: int) -> Launch:
    """(tau, v) of the launch from which a rest is reached; None where none is, or at the foot of gamma."""
    if jet[0] > FLAT:
        hit = first_hit(backwards(model), -rest, 0.0)
        if int(hit.status) != Status.hit or not -float(hit.velocity) > SLOW * size:
            return None
        return rest - float(hit.flight_time), -float(hit.velocity)
    return None if count > 1 and jet[1] > FLAT else _back_from_swan(model, rest, size)


def _back_from_swan(model: Oscillator, rest: float, size: float) -> Launch:
    # periods that the flight from a swan is run back; other flights are run back as `first_hit` says
    reach = 40 * (as_float(model.period) if model.period is not None else 1.0)
    t = -np.arange(10 * ASIDE, reach, ASIDE)
    x = many_paths(model, np.array([rest]), np.zeros(1), [t])[0][:, 0]
    under = np.flatnonzero(~(x > 0))
    if not under.size or under[0] == 0 or not np.isfinite(x[under[0]]):
        return None

    def ends(at: float) -> tuple[float, float]:
        height, velocity = many_paths(model, np.array([rest]), np.zeros(1), [np.array([at])])[0][0].tolist()
        return height, velocity

    at = bracketed(ends, float(t[under[0] - 1]), float(t[under[0]]))
    velocity = ends(at)[1]
    return (rest + at, velocity) if velocity > SLOW * size else None


def bracketed(ends: Callable[[float], tuple[float, float]], low: float, high: float) -> float:
    """The zero of a function that is given with its derivative: Newton's method, kept in a bracket."""
    start = ends(low)[0]
    at = (low + high) / 2
    for _ in range(80):
        height, velocity = ends(at)
        low, high = (at, high) if height * start > 0 else (low, at)
        newton = at - height / velocity if velocity else low
        following = newton if min(low, high) < newton < max(low, high) else (low + high) / 2
        if abs(following - at) < 1e-14 * (1 + abs(at)):
            return float(following)
        at = following
    return float(at)
