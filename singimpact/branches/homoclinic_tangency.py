"""Tangencies of W^u and W^s, at which two homoclinic orbits meet and end: over a number of the model, along another.

    F(s_u, z_1, ..., z_{N-1}, s_s; a) = 0,   da/ds_u = 0

F are the conditions of an orbit that leaves a saddle and comes to one (`homoclinic`).  With s_u given and the number a
among the unknowns they have one solution also at a tangency, where a(s_u) has an extremum.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.branches.homoclinic import Crossing, Ends
from singimpact.branches.periodic import periodic
from singimpact.branches.saddle_arcs import checked_saddle, local_arc
from singimpact.branches.solutions import orbit_period
from singimpact.inputs import InputError, checked_keywords, need, refuse
from singimpact.oscillator.moving_number import value_of, with_number
from singimpact.result import Result

NUDGE = 1e-6  # half the width of the difference by the number
# Of Newton's method and of the search for the extremum: rounds, and when they have arrived, the first in the unknowns,
# the second relative to s_u; of the second the number is an even function.
ROUNDS, ARRIVED, SETTLED = 24, 1e-10, 1e-6
FURTHEST, RESIDUAL = 0.02, 1e-11  # change of s_u in a round at most, relative; the largest miss that is accepted


@dataclass(frozen=True, eq=False)
class Tangencies(Result):
    """Where W^u and W^s of saddles touch.

    Parameters
    ----------
    over : the number that has an extremum there, and the one along which it is followed. parameters : their values,
        shape (m, 1) or (m, 2). states : the impacts of the orbit, from next to one saddle to next to the other, shape
        (m, N + 1, 2), tau within a period. weakest : the least v of each, shape (m,): above 0 no impact grazes.
    notes : why values are missing.
    """

    over: tuple[str, ...]
    parameters: Array
    states: Array
    notes: tuple[str, ...]

    @property
    def weakest(self) -> Array:
        """The least velocities."""
        return np.asarray(self.states[..., 1].min(axis=1))

    def table(self) -> dict[str, Array]:
        """One row for each tangency: the numbers, and the least velocity."""
        return dict(zip(self.over, self.parameters.T, strict=True)) | {"weakest": self.weakest}

    def __repr__(self) -> str:
        rows = [
            ", ".join(f"{name} = {at:.10g}" for name, at in zip(self.over, row, strict=True)) for row in self.parameters
        ]
        lines = [*rows, f"least v {self.weakest.min():.4g}", *self.notes]
        return "\n  ".join([f"<tangency of {self.states.shape[1]} impacts", *lines]) + ">"


Orbit = tuple[Array, float, Array]
"""s of both ends, the number at which an orbit with this s_u exists, and its impacts."""


@checked_keywords
def homoclinic_tangency(crossing: Crossing, over: Any, values: Any = None) -> Tangencies:
    """The tangency at which a homoclinic (or heteroclinic) orbit meets another one, and both end.

    Parameters
    ----------
    crossing : an orbit of `homoclinic_points`, not far from the tangency. over : the number of the model that moves, or
        two: the tangency is then found over the first one at each of the values of the second.
    values : of the second number, in the order in which they are followed, each near the one before.

    Returns
    -------
    Tangencies : `.parameters`, `.states`, `.weakest`; it ends before the values do where one has none, and says so.

    Raises
    ------
    InputError : no orbit of `homoclinic_points`; an unknown number; no tangency is found next to the orbit.

    Notes
    -----
    A homoclinic orbit can also end where an impact grazes and a manifold is torn: `.weakest` tends to 0 there.

    Examples
    --------
    >>> from singimpact.branches.homoclinic import homoclinic_points
    >>> from singimpact.impact_oscillator import linear
    >>> (saddle,) = linear("2.8", 0, "0.5722").periodic(1, 1)
    >>> homoclinic_tangency(homoclinic_points(saddle)[0], "restitution")
    <tangency of 23 impacts
      restitution = 0.5719922606
      least v 0.1734>
    """
    if not isinstance(crossing, Crossing):
        raise refuse("crossing", crossing, "an orbit of si.homoclinic_points")
    names = (over,) if isinstance(over, str) else tuple(over)
    if len(names) != (1 if values is None else 2):
        raise refuse("over", over, "one number of the model, or two and the values of the second")
    walk = _Walk(crossing, names)
    orbit: Orbit = np.array(crossing.s), value_of(walk.model, names[0]), crossing.states
    numbers, states, notes = list[list[float]](), list[Array](), []
    for value in [None] if values is None else [as_float(constant("values", value)) for value in values]:
        beside = {} if value is None else {names[1]: value}
        try:
            orbit = walk.extremum(orbit, beside)
        except InputError as reason:
            notes.append(f"no tangency is found{f' at {names[1]} = {value:.6g}' if beside else ''}: {reason}")
            break
        numbers.append([orbit[1], *beside.values()])
        states.append(orbit[2])
    if not numbers:
        raise InputError(f"{notes[0]}; begin with an orbit that is nearer to it")
    impacts = np.array(states)
    impacts[..., 0] = np.mod(impacts[..., 0], orbit_period(crossing.unstable))
    return Tangencies(names, np.array(numbers), impacts, tuple(notes))


class _Walk:
    """Orbits near one another, at numbers near one another."""

    def __init__(self, crossing: Crossing, names: tuple[str, ...]) -> None:
        self.saddles = (crossing.unstable,) if crossing.kind == "homoclinic" else (crossing.unstable, crossing.stable)
        self.name, self.model = names[0], crossing.unstable.oscillator
        for name in names:
            self.model = with_number(self.model, name)

    def ends(self, number: float, beside: dict[str, float]) -> Ends:
        """The arcs at the saddles of a model."""
        model = self.model.replace(**{self.name: number}, **beside)
        lists = [periodic(model, saddle.impacts, saddle.k, start=saddle) for saddle in self.saddles]
        need(all(lists), InputError(f"the saddle is lost at {self.name} = {number:.9g}"))
        saddles = [checked_saddle(orbits[0]) for orbits in lists]
        return Ends(local_arc(saddles[0], False), local_arc(saddles[-1], True), orbit_period(saddles[0]))

    def extremum(self, orbit: Orbit, beside: dict[str, float]) -> Orbit:
        """The orbit with da/ds_u = 0, by the secant method."""
        orbit, before = self.with_place(orbit, beside)
        s_u = orbit[0][0] * 1.01
        for _ in range(ROUNDS):
            last, start = orbit[0][0], (np.array([s_u, orbit[0][1]]), orbit[1], orbit[2])
            orbit, rate = self.with_place(start, beside)
            step = -rate * (s_u - last) / (rate - before) if rate != before else 0.0
            if abs(step) < SETTLED * abs(s_u):
                return orbit
            before, s_u = rate, s_u + float(np.clip(step, -FURTHEST * abs(s_u), FURTHEST * abs(s_u)))
        raise InputError(f"{self.name} as a function of the place on W^u has no extremum near by")

    def with_place(self, orbit: Orbit, beside: dict[str, float]) -> tuple[Orbit, float]:
        """The orbit with this s_u near an orbit, and da/ds_u."""
        (s, number, states), by_number = orbit, None
        for _ in range(ROUNDS):
            miss, matrix, states = self._conditions(self.ends(number, beside), states, s)
            if by_number is None:
                one, other = (self._conditions(self.ends(number + e, beside), states, s)[0] for e in (NUDGE, -NUDGE))
                by_number = (one - other) / (2 * NUDGE)
            by_place, matrix[:, 0] = matrix[:, 0].copy(), by_number
            if not (np.isfinite(miss).all() and np.isfinite(matrix).all() and (states[:, 1] > 0).all()):
                raise InputError(f"a flight grazes at {self.name} = {number:.9g}")
            step, rate = np.linalg.solve(matrix, np.column_stack([miss, by_place])).T
            if np.abs(step).max() < ARRIVED and np.abs(miss).max() < RESIDUAL:
                return (s, number, states), -float(rate[0])
            number, s = number - float(step[0]), np.array([s[0], s[1] - step[-1]])
            states[1:-1] -= step[1:-1].reshape(-1, 2)
        raise InputError(f"Newton's method does not end at {self.name} = {number:.9g}")

    def _conditions(self, ends: Ends, states: Array, s: Array) -> tuple[Array, Array, Array]:
        """Misses, their derivatives, and the states with both ends on their arcs."""
        from scipy.sparse import dia_array

        states = np.vstack([ends.unstable.points(s[:1]), states[1:-1], ends.stable.points(s[1:])])
        miss, slopes = ends.missed(states)
        size = miss.size
        return miss.ravel(), dia_array((ends.matrix(slopes, s), (1, 0, -1, -2)), shape=(size, size)).toarray(), states
