"""Transitions of P over the clearance or a parameter: all events of codimension one, visible or not.

P and Pi_0 together are the preimage of one curve of flights, those at rest at the wall.  An event belongs to a flight:

    swan         a_c = a_c' = 0: two tangency points are born; P appears or vanishes there in a lips transition at t = 0
    swallowtail  the same, seen at each further crossing t of the flight from rest at tau_*
    lips, beaks  at rest twice, once at a tangency point: Z has an isolated point there, or crosses itself
    tacnode      at rest twice with dx/dv = 0 between: two branches of P touch
    triple point at rest three times.  periodic graze: at rest once a period
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import DOUBLES
from singimpact.contact.points import tangency_points
from singimpact.inputs import refuse
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION, UPPER, with_number
from singimpact.result import Results
from singimpact.surface.curve import window_ends
from singimpact.surface.followed_rests import FollowedRests, doubts_of_rests, gaps_of, met_rests
from singimpact.surface.proved_touches import doubts_left
from singimpact.surface.rest_flights import RestFlights
from singimpact.surface.swan_families import STEPS, Family, Transition, bracketed, in_first_period, swans_met, told
from singimpact.surface.two_rests import Rests, linear_rests, newton

# Samples of a flight in the window of t
FLIGHT_SAMPLES = 400
# Relative distance below which two of them are one; Newton's method ends at a thousandth of it
SAME = 1e-9
# A Hessian below this share of its terms decides nothing; of t, to which Newton's method meets a double zero
FLAT, DOUBLE = 1e-6, 1e-2


# What is looked for; "tangency" are lips, beaks and flights from tangency to tangency.
KINDS = ("swan", "swallowtail", "tangency", "tacnode", "triple point", "periodic graze")


class Transitions(Results, tuple[Transition, ...]):
    """Transitions in order, with notes on their completeness.

    Swans are isolated by balls.  Lips, beaks and swallowtails are met on a grid of the number; balls then show that
    there are no more, when `complete` or `doubts` is first asked for.  Of linear models over the clearance tacnodes and
    periodic grazes are isolated by balls, triple points met on a grid; of others all three are.

    Attributes
    ----------
    notes : why a swan may be missing.
    """

    called = "found"
    notes: tuple[str, ...] = ()
    _proof: "Callable[[Transitions], tuple[str, ...]] | None" = None

    def as_dict(self) -> dict[str, Any]:
        """The dictionaries of all transitions, whether a swan may be missing, and why."""
        return super().as_dict() | {"swans_complete": self.swans_complete, "notes": list(self.notes)}

    @property
    def swans_complete(self) -> bool:
        """Whether it is proved that no swan between the ends is missing."""
        return not self.notes

    @kept_property
    def doubts(self) -> tuple[str, ...]:
        """Why a transition of a kind that was looked for may be missing; nothing where it is proved that none is."""
        return self.notes + (() if self._proof is None else self._proof(self))

    @property
    def complete(self) -> bool:
        """Whether it is proved that no transition of these kinds is missing in the window; takes 1 s to 1 minute."""
        return not self.doubts

    @property
    def visible(self) -> tuple[Transition, ...]:
        """The transitions at which first hits change."""
        return tuple(each for each in self if each.visible)


def transitions(model: Oscillator, over: str, between: Any, t: Any = (-6, 6), kinds: Any = None) -> Transitions:
    """The transitions of P over a parameter, for one period of tau, in order of the parameter.

    Parameters
    ----------
    over : clearance, a parameter; "amplitude" and "damping" of any model, "stiffness" and "phase" of `si.linear`, need
        not be parameters of it. No flight depends on the "restitution": P scales with it, and there are no transitions.
        A second wall is no part of P: events whose flights meet it are not visible.
    between : its two ends. t : window of flight times; of flights with two rests or more the time from the first to the
        last one or its negative lies in it, so that wider windows have more of them.
    kinds : some of `KINDS`; all without it.

    Returns
    -------
    Transitions : a tuple, each with its flight, whether it is visible, and what it does; `.complete` says whether it is
        proved that none is missing in the window, `.doubts` why one may be; `.swans_complete` and `.notes` say so of
        swans alone.

    Raises
    ------
    InputError : no number of the model; ends that are no numbers in rising order; a kind that is none.

    Notes
    -----
    Values are roots of the equations of the event to 1e-12. Events nearer to one another than the grid is fine can be
    missed where `.doubts` says that they rest on a grid. Without a period there are swans, swallowtails, lips and beaks
    alone.

    Examples
    --------
    >>> found = transitions(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", ("-0.9", "1.1"))
    >>> [(each.kind, round(each.value, 9), each.visible) for each in found]
    [('periodic graze', -0.333333333, True), ('periodic graze', 0.333333333, False), ('swan, negative', 1.0, True)]
    >>> found.visible[0].rests, found.visible[0].launch
    ((0.0, 3.141592653589793), None)
    >>> transitions(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", ("0.9", "1.1"), kinds="swan").complete
    True
    """
    model = with_number(model, over)
    ends, times, wanted = window_ends(over, between), window_ends("t", t), _kinds(kinds)
    if over in (RESTITUTION, UPPER[1]):
        return Transitions()
    values = np.linspace(*ends, STEPS + 1)
    family = whole = Family(model, over)
    if model.upper is not None:
        family = Family(model.one_wall(), over)
        for end in ends:  # refused where the wall is moved beyond the other one
            whole.at(end)
    swans, notes = swans_met(family, values)
    events = [*swans, *(_swallowtails(family, swans, times) if "swallowtail" in wanted else ())]
    if "tangency" in wanted:
        events += _tangencies(family, values, times)
    events += _with_more_rests(family, times, ends, wanted)
    kinds_met = ["tangency" if event.event.startswith("tangency") else event.event for event in events]
    visible_events = [
        told(event, whole.at(event.value)) for event, kind in zip(events, kinds_met, strict=True) if kind in wanted
    ]
    result = Transitions(sorted(visible_events, key=lambda event: (event.value, event.tau, event.t)))
    result.notes = notes if {"swan", "swallowtail"} & wanted else ()
    result._proof = partial(_doubts, family, ends, times, wanted, tuple(swans))
    return result


def at_wall(
    model: Oscillator, wall: object, over: str, between: object, t: object, kinds: object = None
) -> Transitions:
    """The transitions of P at a wall of a model, where "upper" is the place of an upper one; others as `transitions`.

    Raises
    ------
    InputError : `over` is the place of the other wall, which moves no P.

    Examples
    --------
    >>> pair = Oscillator("x", "cos(2*t)", -2, "1/2", upper=2)
    >>> [(each.kind, each.value) for each in at_wall(pair, "upper", "upper", ("0.9", "1.1"), (-1, 1), "swan")]
    [('swan, positive', 1.0)]
    """
    seen = model.seen_from(wall)
    if model.upper is None:
        return transitions(model, over, between, t, kinds)
    own, other = (CLEARANCE, UPPER[0]) if seen is model else (UPPER[0], CLEARANCE)
    if over == other:
        raise refuse("over", over, f"{own!r}, the place of this wall, or another number: P does not depend on {other}")
    if over != UPPER[0]:
        return transitions(seen, over, between, t, kinds)
    low, high = window_ends(over, between)
    mirrored = transitions(seen, CLEARANCE, (-high, -low), t, kinds)
    turned = Transitions(replace(event, value=-event.value) for event in reversed(mirrored))
    turned.notes, turned._proof = mirrored.notes, lambda _: mirrored.doubts[len(mirrored.notes) :]
    return turned


def _kinds(given: Any) -> frozenset[str]:
    asked = KINDS if given is None else (given,) if isinstance(given, str) else given
    try:
        unknown = [kind for kind in asked if kind not in KINDS]
    except TypeError:
        unknown = [given]
    if unknown:
        raise refuse("kinds", unknown[0], f"some of {', '.join(KINDS)}")
    return frozenset(asked)


def _doubts(
    family: Family,
    ends: tuple[float, float],
    times: tuple[float, float],
    wanted: frozenset[str],
    swans: tuple[Transition, ...],
    listed: Transitions,
) -> tuple[str, ...]:
    doubts: tuple[str, ...] = ()
    if {"swallowtail", "tangency"} & wanted:
        doubts += doubts_left(family, ends, times, [*(() if "swan" in wanted else swans), *listed])
    return doubts + doubts_of_rests(family, times, wanted)


def _with_more_rests(
    family: Family, times: tuple[float, float], ends: tuple[float, float], wanted: frozenset[str]
) -> list[Transition]:
    """Tacnodes, triple points and periodic grazes."""
    met = [meeting for meeting in met_rests(family, ends, times, wanted) if ends[0] <= meeting.value <= ends[1]]
    events = []
    # both ends of the window of t belong to it, of which one may be a period
    low, high = (end * (1 + np.sign(end) * side * SAME) for side, end in zip((-1, 1), times, strict=True))
    for meeting in met:
        gap, kind = meeting.gaps[-1], meeting.kind
        if kind == "tacnode":
            back = RestFlights(family.at(meeting.value)).by_speed(np.array([meeting.first]), np.array([gap]))[0, 1]
            kind = "tacnode, opposite" if back < 0 else "tacnode, same"
        (first,) = in_first_period((meeting.first,), family.at(meeting.value))
        rests = (first, *(first + offset for offset in meeting.gaps))
        if any(low <= sign * gap <= high for sign in (1, -1)):
            events.append(Transition(kind, meeting.value, first, gap, rests))
    return _each_once(events, ends)


def _tangencies(family: Family, values: Array, times: tuple[float, float]) -> list[Transition]:
    """Two rests with a tangency point among them: from the flights of tangency points, and by elimination of c."""
    ends, linear, events = (float(values[0]), float(values[-1])), linear_rests(family), list[Transition]()
    if linear is not None:
        met = [rests for rests in linear.tangencies(*gaps_of(times)) if ends[0] <= rests.value <= ends[1]]
        both = [rests for rests in met if rests.kind == "tangency to tangency"]
        for rests in met:
            s, d = rests.first, rests.gaps[0]
            tau, t = (s + d, -d) if rests.kind == "tangency last" else (s, d)
            if rests not in both and times[0] <= t <= times[1]:
                point = np.array([*in_first_period((tau,), family.model), t, rests.value])
                kind = _lips_or_beaks(RestFlights(family.at(rests.value)), point)
                events.append(Transition(kind, rests.value, float(point[0]), t, _two(tau, t)))
    else:
        events += _touches(family, values, times)
        followed = FollowedRests(family, ends, gaps_of(times))
        undecided = [rests for rests in events if rests.kind == "undecided"]
        near = [(rests.value, min(rests.tau, rests.tau + rests.t), abs(rests.t)) for rests in undecided]
        both = [pair for pair in (followed.both_ends(*point) for point in near) if pair is not None]
    changes = [rests for rests in events if not any(_is_that(rests, other) for other in both)]
    changes += [
        Transition(
            rests.kind,
            rests.value,
            s := in_first_period((rests.first,), family.at(rests.value))[0],
            rests.gaps[0],
            (s, s + rests.gaps[0]),
        )
        for rests in both
        if any(times[0] <= sign * rests.gaps[0] <= times[1] for sign in (1, -1))
    ]
    return _each_once(changes, ends)


def _two(tau: float, t: float) -> tuple[float, float]:
    return (tau, tau + t) if t > 0 else (tau + t, tau)


def _is_that(found: Transition, both: Rests) -> bool:
    """Whether what Newton's method met is the flight from tangency to tangency, a double zero of its equations."""
    return abs(found.value - both.value) < 1e-6 and abs(abs(found.t) - both.gaps[0]) < DOUBLE


def _each_once(found: Iterable[Transition], ends: tuple[float, float]) -> list[Transition]:
    """The distinct ones between the ends: Newton's method may leave the interval, or find one point twice."""
    kept: list[Transition] = []
    for each in found:
        if ends[0] <= each.value <= ends[1] and not any(_same(each, old) for old in kept):
            kept.append(each)
    return kept


def _same(one: Transition, other: Transition) -> bool:
    """Whether two flights are one; triple points may differ in the rest between the first and the last alone."""
    if len(one.rests) != len(other.rests):
        return False
    pairs = zip((one.value, one.tau, one.t, *_gaps(one)), (other.value, other.tau, other.t, *_gaps(other)), strict=True)
    return all(abs(a - b) < SAME for a, b in pairs)


def _gaps(found: Transition) -> list[float]:
    return [rest - found.rests[0] for rest in found.rests[1:]]


def _swallowtails(family: Family, swans: list[Transition], times: tuple[float, float]) -> Iterator[Transition]:
    for swan in swans:
        flights = RestFlights(family.at(swan.value))
        for t in _crossings(flights, swan.tau, times):
            yield Transition("swallowtail", swan.value, swan.tau, t, (swan.tau,))


def _samples(flights: RestFlights, tau: float, times: tuple[float, float]) -> tuple[Array, Array]:
    """t != 0 and y there, of the flight from rest at a zero of a_c; the first samples beside t = 0 are left out."""
    t = np.linspace(*times, FLIGHT_SAMPLES)
    t = t[np.abs(t) > 4 * (times[1] - times[0]) / FLIGHT_SAMPLES]
    return t, flights.grid(np.array([tau]), t)[:, 0]


def _crossings(flights: RestFlights, tau: float, times: tuple[float, float]) -> list[float]:
    def ends(at: float) -> tuple[float, float]:
        height, velocity = flights.ends(np.array([tau]), np.array([at]))
        return float(height[0]), float(velocity[0])

    t, y = _samples(flights, tau, times)
    turned = np.flatnonzero((y[:-1] * y[1:] < 0) & (t[:-1] * t[1:] > 0)).tolist()
    return [bracketed(ends, t[i], t[i + 1]) for i in turned]


def _touches(family: Family, values: Array, times: tuple[float, float]) -> Iterator[Transition]:
    """Where an extremum of the flight from rest at a tangency point passes through c."""
    before: list[tuple[float, float, float]] = []
    for value in values.tolist():
        if family.model.period is not None and family.at(value).period is None:
            continue  # constant forcing, as at amplitude = 0: a_c has no zeros, or only them
        now = [(tau, t, height) for tau, t, height in _humps(family.at(value), times)]
        for tau, t, height in now:
            near = min(before, key=lambda each: abs(each[0] - tau) + abs(each[1] - t), default=None)
            if near is not None and (near[2] >= 0) != (height >= 0) and abs(near[0] - tau) + abs(near[1] - t) < 0.5:
                share = height / (height - near[2])
                step = values[1] - values[0]
                start = np.array([tau + share * (near[0] - tau), t + share * (near[1] - t), value - share * step])
                point = _touch(family, start)
                if point is not None:
                    yield point
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


def _touch(family: Family, start: Array) -> Transition | None:
    """a = 0, x = c, x' = 0 by Newton's method in (tau, t, value)."""
    tree = family.acceleration()

    def missed(point: Array) -> Array:
        height, velocity = RestFlights(family.at(float(point[2]))).ends(point[:1], point[1:2])
        a = evaluate(tree, {"t": float(point[0]), family.over: float(point[2])}, DOUBLES)
        return np.array([float(a), float(height[0]), float(velocity[0])])

    met = newton(lambda points: np.array([missed(point) for point in points]), start[None])
    if not len(met):
        return None
    tau, t, value = met[0].tolist()
    return Transition(_lips_or_beaks(RestFlights(family.at(value)), met[0]), value, tau, t, _two(tau, t))


def _lips_or_beaks(flights: RestFlights, point: Array) -> str:
    """By the Hessian of y, from differences of its exact gradient."""
    h, at = 1e-4, point[:2]
    gradient = flights.y_and_gradient(at + h * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]))[1]
    (tt, tm), (mt, mm) = (gradient[0] - gradient[1]) / (2 * h), (gradient[2] - gradient[3]) / (2 * h)
    mixed = (tm + mt) / 2
    determinant = tt * mm - mixed**2
    if abs(determinant) <= FLAT * (abs(tt * mm) + mixed**2):
        return "undecided"
    return "lips" if determinant > 0 else "beaks"
