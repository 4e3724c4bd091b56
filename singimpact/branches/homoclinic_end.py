"""Where homoclinic orbits end as a number of the model moves: in pairs at a tangency of W^u and W^s, or at a graze.

    F(s_u, z_1, ..., z_{N-1}, s_s, a) = 0,   and   da/ds_u = 0   or   v_i = 0

F are the conditions of an orbit that leaves a saddle and comes to one (`homoclinic`), flight by flight: smooth through
grazes.  With one more unknown held, s_u or a velocity v_i, they have one solution where the orbit ends too: at a
tangency a(s_u) has an extremum; where an impact grazes, a manifold is torn.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.branches.homoclinic import Crossing
from singimpact.branches.periodic import periodic
from singimpact.branches.saddle_arcs import checked_saddle, local_arc
from singimpact.branches.solutions import orbit_period
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.flights.family import family
from singimpact.inputs import InputError, checked_keywords, need, require
from singimpact.oscillator import Oscillator, value_of, with_number
from singimpact.result import Result

NUDGE = 1e-6  # half the width of the difference by the number
# Of Newton's method and of the search for the extremum: rounds, and when they have arrived, the first in the unknowns,
# the second relative to s_u; of the second the number is an even function.
ROUNDS, ARRIVED, SETTLED = 24, 1e-10, 1e-6
FURTHEST, RESIDUAL = 0.02, 1e-11  # change of s_u in a round at most, relative; the largest miss that is accepted
VISIBLE = 1e-8  # distance behind the wall that is rounding
LEAST = 1 / 32  # part of its velocity by which the weakest impact is lowered at least, on the way to a graze


@dataclass(frozen=True, eq=False)
class HomoclinicEnds(Result):
    """Where homoclinic or heteroclinic orbits end.

    Parameters
    ----------
    model : to start from. kind : "tangency" or "graze".
    over : the number that moves, and the one along which it is followed. parameters :
        their values, shape (m, 1) or (m, 2). states : the impacts of the orbit, from next to one saddle to next to the
        other, shape (m, N + 1, 2), tau within a period. visible : whether no flight is below the wall, shape (m,).
    notes : why values are missing.
    """

    heads_csv = True
    model: Oscillator
    kind: str
    over: tuple[str, ...]
    parameters: Array
    states: Array
    visible: Array
    notes: tuple[str, ...]

    @property
    def weakest(self) -> Array:
        """The least velocities, shape (m,): at a tangency above 0, for no impact grazes."""
        return np.asarray(self.states[..., 1].min(axis=1))

    def table(self) -> dict[str, Array]:
        """One row for each end: the numbers, the least velocity, visible."""
        numbers = dict(zip(self.over, self.parameters.T, strict=True))
        return numbers | {"weakest": self.weakest, "visible": self.visible.astype(int)}

    def __repr__(self) -> str:
        rows = [
            ", ".join(f"{name} = {at:.10g}" for name, at in zip(self.over, row, strict=True))
            + ("" if visible else ", a flight is below the wall")
            for row, visible in zip(self.parameters, self.visible, strict=True)
        ]
        lines = [*rows, f"least v {self.weakest.min():.4g}", *self.notes]
        return "\n  ".join([f"<{self.kind} of {self.states.shape[1]} impacts", *lines]) + ">"


@checked_keywords
def homoclinic_end(
    crossing: Crossing, over: str | Sequence[str], values: Any = None, kind: str = "tangency"
) -> HomoclinicEnds:
    """Where a homoclinic (or heteroclinic) orbit meets another one and both end, or where its weakest impact grazes.

    Parameters
    ----------
    crossing : an orbit of `homoclinic_points`, not far from its end. over : the number of the model that moves, or two:
        the end is then found over the first one at each of the values of the second.
    values : of the second number, in the order in which they are followed, each near the one before.
    kind : "tangency", of W^u and W^s, or "graze".

    Returns
    -------
    HomoclinicEnds : `.parameters`, `.states`, `.weakest`; it ends before the values do where one has none, and says so.

    Raises
    ------
    InputError : no orbit of `homoclinic_points`; an unknown number; no end is found next to the orbit.

    Examples
    --------
    >>> from singimpact.branches.homoclinic import homoclinic_points
    >>> from singimpact.impact_oscillator import linear
    >>> (saddle,) = linear("2.8", 0, "0.5722").periodic(1, 1)
    >>> homoclinic_end(homoclinic_points(saddle)[0], "restitution")
    <tangency of 23 impacts
      restitution = 0.5719922606
      least v 0.1734>
    """
    require(isinstance(crossing, Crossing), "crossing", crossing, "an orbit of si.homoclinic_points")
    names = (over,) if isinstance(over, str) else tuple(over)
    require(len(names) == 1 + (values is not None), "over", over, "one number of the model, or two and values=")
    require(kind in ("tangency", "graze"), "kind", kind, "'tangency' or 'graze'")
    walk = _Walk(crossing, names)
    orbit, notes, rows = walk.begin(crossing.states), [], list[tuple[list[float], Array, bool]]()
    for value in [None] if values is None else [as_float(constant("values", value)) for value in values]:
        beside = {} if value is None else {names[1]: value}
        try:
            orbit = walk.extremum(orbit, beside) if kind == "tangency" else walk.graze(orbit, beside)
        except InputError as reason:
            notes.append(f"no {kind} is found{f' at {names[1]} = {value:.6g}' if beside else ''}: {reason}")
            break
        rows.append(([orbit[-1], *beside.values()], *walk.states(orbit, beside)))
    need(rows, InputError(f"{''.join(notes)}; begin with an orbit that is nearer to it"))
    numbers, states, visible = (np.array(column) for column in zip(*rows, strict=True))
    return HomoclinicEnds(walk.model, kind, names, numbers, states, visible, tuple(notes))


class _Walk:
    """Orbits at numbers near one another, each an array of s_u, z_1, ..., z_{N-1}, s_s and the number.

    The times of its impacts are in periods of the forcing: those of another period lie near them.
    """

    def __init__(self, crossing: Crossing, names: tuple[str, ...]) -> None:
        self.saddles = (crossing.unstable,) if crossing.kind == "homoclinic" else (crossing.unstable, crossing.stable)
        self.name, self.s = names[0], crossing.s
        self.model = reduce(with_number, names, crossing.unstable.oscillator)
        self.moving = family(self.model, names)

    def begin(self, states: Array) -> Array:
        """The unknowns of an orbit whose times are within a period."""
        times = np.cumsum(np.append(states[0, 0], model_step(self.model, states[:-1])[:, 0] - states[:-1, 0]))
        period = orbit_period(self.saddles[0])
        self.turns = float(np.rint((times[-1] - states[-1, 0]) / period))
        inner = np.column_stack([times / period, states[:, 1]])
        return np.array([self.s[0], *inner[1:-1].ravel(), self.s[1], value_of(self.model, self.name)])

    def states(self, orbit: Array, beside: dict[str, float]) -> tuple[Array, bool]:
        """The impacts, with times within a period, and whether no flight between them is below the wall."""
        states, _, period = self.impacts(orbit, beside)
        flights = zip(*states[:-1].T.tolist(), np.diff(states[:, 0]).tolist(), strict=True)
        lowest = min(
            float(self.moving.path({self.name: orbit[-1], **beside}, *flight)[:, 0].min()) for flight in flights
        )
        states[:, 0] = np.mod(states[:, 0], period)
        return states, bool(lowest > -VISIBLE and states[:, 1].min() > -VISIBLE)

    def impacts(self, orbit: Array, beside: dict[str, float], more: float = 0.0) -> tuple[Array, list[Array], float]:
        """All impacts, the first and the last on the arcs at the saddles of a model; slopes of the arcs; the period."""
        number = float(orbit[-1]) + more
        model = self.model.replace(**{self.name: number}, **beside)
        lists = [periodic(model, saddle.impacts, saddle.k, start=saddle) for saddle in self.saddles]
        need(all(lists), InputError(f"the saddle is lost at {self.name} = {number:.9g}"))
        saddles = [checked_saddle(orbits[0]) for orbits in lists]
        away, home, period = local_arc(saddles[0], False), local_arc(saddles[-1], True), orbit_period(saddles[0])
        inner = orbit[1:-2].reshape(-1, 2) * [period, 1]
        states = np.vstack(
            [away.points(orbit[:1]), inner, home.points(orbit[-2:-1]) + np.array([self.turns * period, 0])]
        )
        return states, [away.slope(float(orbit[0])), home.slope(float(orbit[-2]))], period

    def extremum(self, orbit: Array, beside: dict[str, float]) -> Array:
        """The orbit with da/ds_u = 0, by the secant method."""
        orbit, before = self.held(orbit, beside, 0, orbit[0])
        s_u = orbit[0] * 1.01
        for _ in range(ROUNDS):
            last, (orbit, rate) = orbit[0], self.held(orbit, beside, 0, s_u)
            step = -rate * (s_u - last) / (rate - before) if rate != before else 0.0
            if abs(step) < SETTLED * abs(s_u):
                return orbit
            before, s_u = rate, s_u + float(np.clip(step, -FURTHEST * abs(s_u), FURTHEST * abs(s_u)))
        raise InputError(f"{self.name} as a function of the place on W^u has no extremum near by")

    def graze(self, orbit: Array, beside: dict[str, float]) -> Array:
        """The orbit whose weakest impact has v = 0."""
        # above 0, so that an orbit that grazes already, at other numbers, is solved once more
        slot, v = 2 + 2 * int(np.argmin(orbit[2:-2:2])), max(float(orbit[2:-2:2].min()), 1e-300)
        step = max(v / 4, 1e-9)
        while v > 0:
            try:
                orbit, v = self.held(orbit, beside, slot, max(v - step, 0.0))[0], v - step
            except InputError:
                step /= 2
                if step < LEAST * v:
                    raise
        return orbit

    def held(self, orbit: Array, beside: dict[str, float], slot: int, value: float) -> tuple[Array, float]:
        """The orbit near an orbit of which one of the unknowns has a value, and the rate of the number by it."""
        one, other = (self.impacts(orbit, beside, e)[0].ravel() for e in (NUDGE, -NUDGE))
        row, by_number = np.eye(len(orbit))[slot], (one - other) / (2 * NUDGE)
        for _ in range(ROUNDS):
            miss, matrix = self._conditions(orbit, beside, by_number)
            matrix, unit = np.vstack([matrix, row]), np.append(0.0 * miss, 1.0)
            need(np.isfinite(matrix).all(), InputError(f"a flight is lost at {self.name} = {orbit[-1]:.9g}"))
            step, rate = np.linalg.solve(matrix, np.column_stack([np.append(miss, orbit[slot] - value), unit])).T
            orbit = orbit - step
            if np.abs(step).max() < ARRIVED and np.abs(miss).max() < RESIDUAL:
                return np.where(row == 1, value, orbit), float(rate[-1])
        raise InputError(f"Newton's method does not end at {self.name} = {orbit[-1]:.9g}")

    def _conditions(self, orbit: Array, beside: dict[str, float], by_number: Array) -> tuple[Array, Array]:
        """Misses of the flights, and their derivatives by the unknowns."""
        states, slopes, period = self.impacts(orbit, beside)
        count, values = 2 * len(states) - 2, {self.name: float(orbit[-1]), **beside}
        miss, matrix = np.empty(count), np.zeros((count, count + 3))
        for i, pair in enumerate(pairwise(states)):
            miss[2 * i : 2 * i + 2], columns = self.moving.link(values, *pair)
            matrix[2 * i : 2 * i + 2, 2 * i : 2 * i + 4], matrix[2 * i : 2 * i + 2, -1] = columns[:, :4], columns[:, 4]
        number, inner = matrix[:, -1] + matrix[:, :-1] @ by_number, np.tile([period, 1.0], len(states) - 2)
        first, last = matrix[:, :2] @ slopes[0], matrix[:, -3:-1] @ slopes[1]
        return miss, np.column_stack([first, matrix[:, 2:-3] * inner, last, number])
