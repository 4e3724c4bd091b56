"""Transitions of P over the clearance or a parameter: swans, swallowtails, lips and beaks.

In flights launched at rest at a tangency point tau_*, a_c(tau_*) = 0:

    swan         a_c' = 0 too: two tangency points are born; P appears or vanishes there in a lips transition at t = 0
    swallowtail  the same, seen at each further crossing t of the flight from rest at tau_*
    lips, beaks  the flight touches c again, x = c and x' = 0 at t: Z has an isolated point there, or crosses itself
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import DOUBLES
from singimpact.contact.points import tangency_points
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import RESTITUTION, with_number
from singimpact.surface.curve import window_ends
from singimpact.surface.proved_touches import doubts_left
from singimpact.surface.rest_flights import RestFlights
from singimpact.surface.swan_families import STEPS, Family, Transition, swans_met

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class TransitionSettings:
    """same : relative distance below which two of them are one; Newton's method ends at a thousandth of it.
    samples : of a flight in the window of t. settled : Newton's last step. flat : a Hessian below this share of its
    terms decides nothing.
    """

    samples: int = 400
    settled: float = 1e-12
    same: float = 1e-9
    flat: float = 1e-6


SETTINGS = TransitionSettings()


class Transitions(tuple[Transition, ...]):
    """Transitions in order, with notes on their completeness.

    Swans are isolated by balls.  The other kinds are met on a grid of the number; balls then show that there are no
    more, when `complete` or `doubts` is first asked for.
    Flights from rest to rest with dx/dv = 0, over which V_c' itself is singular, are no transitions of this list:
    `classify` marks them.

    Attributes
    ----------
    notes : why a swan may be missing.
    """

    notes: tuple[str, ...] = ()
    _proof: Callable[[Transitions], tuple[str, ...]] | None = None

    @property
    def swans_complete(self) -> bool:
        """Whether it is proved that no swan between the ends is missing."""
        return not self.notes

    @kept_property
    def doubts(self) -> tuple[str, ...]:
        """Why a transition of any kind may be missing in the window; nothing where it is proved that none is."""
        return self.notes + (() if self._proof is None else self._proof(self))

    @property
    def complete(self) -> bool:
        """Whether it is proved that no transition in the window is missing; it takes 1 s to 1 minute."""
        return not self.doubts


def transitions(model: Oscillator, over: str, between: Any, t: Any = (-6, 6)) -> Transitions:
    """The transitions of P over a parameter, for one period of tau, in order of the parameter.

    Parameters
    ----------
    over : clearance, a parameter; "amplitude" and "damping" of any model, "stiffness" and "phase" of `si.linear`, need
        not be parameters of it. No flight depends on the "restitution": P scales with it, and there are no transitions.
    between : its two ends. t : window of flight times.

    Returns
    -------
    Transitions : a tuple; `.complete` says whether it is proved that none is missing in the window, `.doubts` why one
        may be; `.swans_complete` and `.notes` say so of swans alone.

    Raises
    ------
    InputError : no number of the model; ends that are no numbers in rising order.

    Examples
    --------
    >>> found = transitions(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", ("0.9", "1.1"))
    >>> [(each.kind, round(each.value, 9), round(each.t, 6)) for each in found][:1]
    [('swan, negative', 1.0, 0.0)]
    >>> found.complete
    True
    """
    model = with_number(model, over)
    ends, times = window_ends(over, between), window_ends("t", t)
    if over == RESTITUTION:
        return Transitions()
    values = np.linspace(*ends, STEPS + 1)
    family = Family(model, over)
    swans, notes = swans_met(family, values)
    found = [*swans, *_swallowtails(family, swans, times), *_each_once(_touches(family, values, times), ends)]
    made = Transitions(sorted(found, key=lambda each: (each.value, each.tau, each.t)))
    made.notes = notes
    made._proof = partial(doubts_left, family, ends, times)
    return made


def _each_once(found: Iterable[Transition], ends: tuple[float, float]) -> list[Transition]:
    """The distinct ones between the ends: Newton's method may leave the interval, or find one point twice."""
    kept: list[Transition] = []
    for each in found:
        twice = any(
            max(abs(each.value - old.value), abs(each.tau - old.tau), abs(each.t - old.t)) < SETTINGS.same
            for old in kept
        )  # fmt: skip
        if ends[0] <= each.value <= ends[1] and not twice:
            kept.append(each)
    return kept


def _swallowtails(family: Family, swans: list[Transition], times: tuple[float, float]) -> Iterator[Transition]:
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
    """Newton's method, kept in a bracket."""
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


def _touch(family: Family, start: Array) -> Transition | None:
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
