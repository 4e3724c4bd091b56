"""Flights with two rests or more of a linear model, over the clearance: the clearance is eliminated.

The flight at rest at the wall at s is at rest there again d later where E1 = x - c = 0 and E2 = x' = 0.  Both are
linear in c.  With the solutions C, S of the free equation at d and the motion q with the period of the forcing

    F(s, d) = A1 k S + A2 (C - 1) = 0,     c = (A2 k S - A1 (C - 1))/((C - 1)^2 + k^2 S^2)

    A1 = q(s + d) - q(s) C - q'(s) S,     A2 = q'(s + d) + k q(s) S - q'(s) S'

Along F = 0 is dc = 0 exactly where a(s) a(s + d) S(d) = 0 [b:events-critical].
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.balls import refined
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Pi,
    Power,
    add,
    evaluate,
    multiply,
    negate,
    number,
    substitute,
    subtract,
)
from singimpact.algebra.isolated_zeros import isolate
from singimpact.algebra.numbers import Array, as_float, sign_of
from singimpact.algebra.rings import DOUBLES
from singimpact.oscillator.linear import LinearForm, at_rest, form_of, steady_motion, waves
from singimpact.oscillator.moving_number import CLEARANCE
from singimpact.surface.swan_families import Family


@dataclass(frozen=True)
class GridSettings:
    """Settings of the grid on which events are met.

    step : of the times s and d. least : d from which on two rests are told apart; nearer ones begin at a positive swan.
    most : of Newton's steps. longest : Newton's longest step. aside : of its differences.
    near : of d on neighbouring values of s, for the same branch of F = 0. jump : of c there.
    whole : of d/T, from a whole number, that is none. same : events nearer are one. wide : F is no zero above this.
    degenerate : distance from a flight from tangency to tangency below which the equations of one tangency have a
        double zero.
    """

    step: float = 0.02
    least: float = 0.05
    most: int = 40
    longest: float = 0.2
    aside: float = 1e-6
    near: float = 0.15
    jump: float = 0.3
    whole: float = 1e-7
    same: float = 1e-7
    degenerate: float = 1e-3
    wide: float = 1e-9


GRID = GridSettings()


@dataclass(frozen=True)
class Rests:
    """A flight with rests at times first, first + gaps[0], ..., at a value of the number; two of a kind are equal."""

    kind: str
    value: float
    first: float
    gaps: tuple[float, ...]


class LinearRests:
    """Flights of a linear model that are at rest at the wall twice, over the clearance.

    Parameters
    ----------
    form : x'' + damping x' + k x = forcing, underdamped or not, k != 0. steady : its motion with the period T, a
        formula in t. period : T.

    Attributes
    ----------
    undecided : why grazes or tacnodes may be missing, of those that were asked for.
    """

    def __init__(self, form: LinearForm, steady: Expression, period: Expression) -> None:
        self.form, self.turn, self.undecided = form, as_float(period), list[str]()
        self.k, self.half = as_float(form.stiffness), as_float(form.damping) / 2
        self.square = self.k - self.half**2
        self.steady = steady, derivative(steady, "t")
        forcing = waves(form, Name("t"), [(w.cosine, w.sine) for w in form.harmonics])
        self.push = add(forcing, at_rest(form, number(0)))  # a_c at c = 0

    def q(self, t: Array, order: int = 0) -> Array:
        """The motion with the period of the forcing, or its derivative."""
        return np.asarray(evaluate(self.steady[order], {"t": t}, DOUBLES) + 0.0 * t)

    def a(self, t: Array, c: Array) -> Array:
        """The acceleration at the wall."""
        return np.asarray(evaluate(self.push, {"t": t}, DOUBLES) - self.k * c)

    def free(self, d: Array) -> tuple[Array, Array, Array]:
        """C, S and S' at d: C(0) = S'(0) = 1, C'(0) = S(0) = 0."""
        rate = np.sqrt(abs(self.square))
        if self.square > 0:
            even, odd = np.cos(rate * d), np.sin(rate * d) / rate
        elif self.square < 0:
            even, odd = np.cosh(rate * d), np.sinh(rate * d) / rate
        else:
            even, odd = 1 + 0 * d, d + 0.0
        decay = np.exp(-self.half * d)
        return decay * (even + self.half * odd), decay * odd, decay * (even - self.half * odd)

    def eliminated(self, s: Array, d: Array) -> tuple[Array, Array]:
        """F over a power of its size, so that it does not vanish at d = 0, and c."""
        C, S, D = self.free(d)
        q, p = self.q(s), self.q(s, 1)
        one, two = self.q(s + d) - q * C - p * S, self.q(s + d, 1) + self.k * q * S - p * D
        size = (C - 1) ** 2 + (self.k * S) ** 2
        with np.errstate(all="ignore"):
            return (one * self.k * S + two * (C - 1)) / size**1.5, (two * self.k * S - one * (C - 1)) / size

    def grazes(self) -> list[Rests]:
        """The clearances at which the motion with the period T touches the wall: all, isolated with proof."""
        return [Rests("periodic graze", float(self.q(s)), float(s), (self.turn,)) for s in self._zeros(self.steady[1])]

    def tacnodes(self, longest: float) -> list[Rests]:
        """Two rests with S(d) = 0, d = n pi/w, w^2 = k - half^2: zeros of q'(s + d) - C q'(s), isolated with proof."""
        if self.square <= 0:
            return []
        half, events = multiply(number(Fraction(1, 2)), self.form.damping), []
        rate = Power(subtract(self.form.stiffness, multiply(half, half)), number(Fraction(1, 2)))
        for n in range(1, int(longest * np.sqrt(self.square) / np.pi + GRID.whole) + 1):
            d = multiply(number(n), Pi(), Power(rate, number(-1)))
            C = multiply(number((-1) ** n), Call("exp", negate(multiply(half, d)))) if self.half else number((-1) ** n)
            gap, ratio = as_float(d), as_float(C)
            if ratio == 1 or is_whole(gap / self.turn):
                continue  # every flight is at the wall again, at any c; or the flight with the period T
            later = substitute(self.steady[1], {"t": add(Name("t"), d)})
            for s in self._zeros(subtract(later, multiply(C, self.steady[1]))):
                c = (self.q(s + gap) - self.q(s) * ratio) / (1 - ratio)
                events.append(Rests("tacnode", float(c), float(s), (gap,)))
        return events

    def _zeros(self, tree: Expression) -> Iterator[Array]:
        """The simple zeros of a tree over one period, to the last bit."""
        turn = Fraction(self.turn)
        for zero in isolate(tree, "t", -turn / 97, turn * Fraction(98, 97)):
            if not zero.slope:
                refusal = "are not told apart: tacnodes or periodic grazes may be missing"
                self.undecided.append(f"rests near s = {float(zero.low):.6g} {refusal}")
                continue
            at = float(refined(tree, "t", zero, 128).mid())
            if -1e-12 * self.turn <= at < self.turn * (1 - 1e-12):
                yield np.array(at + 0.0)

    def tangencies(self, shortest: float, longest: float) -> list[Rests]:
        """Two rests of which one or both are tangency points; from a grid."""
        s, d = self._grid(shortest, longest)
        if not d.size:
            return []
        F, c = self.eliminated(s[:, None], d[None, :])
        first, last = self.a(s[:, None], c), self.a(s[:, None] + d[None, :], c)
        met = self._in_cells((first, last), s, d, lambda z: np.stack(self._pushes(z), axis=1))
        both = met[np.abs(self.eliminated(*met.T)[0]) < GRID.wide]
        events = [self._as_rests("tangency to tangency", z) for z in both]
        for kind, end in (("tangency first", 0), ("tangency last", 1)):
            met = self._in_cells((F, (first, last)[end]), s, d, partial(self._one_pushed, end=end))
            apart = np.hypot(*(met[:, None, :] - both[None, :, :]).T).min(axis=0, initial=np.inf)
            events += [self._as_rests(kind, z) for z in met[apart > GRID.degenerate]]
        return events

    def _as_rests(self, kind: str, z: Array) -> Rests:
        return Rests(kind, float(self.eliminated(z[0], z[1])[1]), float(z[0]), tuple(z[1:].tolist()))

    def _pushes(self, z: Array) -> tuple[Array, Array]:
        s, d = z.T[:2]
        c = self.eliminated(s, d)[1]
        return self.a(s, c), self.a(s + d, c)

    def _one_pushed(self, z: Array, end: int) -> Array:
        return np.stack([self.eliminated(*z.T)[0], self._pushes(z)[end]], axis=1)

    def _grid(self, shortest: float, longest: float) -> tuple[Array, Array]:
        low = max(GRID.least, shortest - GRID.step)
        return (
            np.arange(0, self.turn + 2 * GRID.step, GRID.step) - GRID.step / 19,
            # off 0, where models have symmetries
            np.arange(low, longest + 2 * GRID.step, GRID.step) + 3e-4,
        )

    def _in_cells(self, values: tuple[Array, Array], s: Array, d: Array, missed: Callable[[Array], Array]) -> Array:
        """Zeros of two functions, shape (n, 2): Newton's method from each cell over which both change sign."""
        i, j = np.nonzero(_changes(values[0]) & _changes(values[1]))
        met = newton(missed, np.stack([s[i], d[j]], axis=1) + GRID.step / 2)
        # beyond the period, for a zero on its edge
        inside = (np.abs(met[:, 0] - self.turn / 2) < self.turn / 2 + 0.1) & (met[:, 1] > GRID.least)
        return distinct(met[inside & ~is_whole(met[:, 1] / self.turn)])

    def triples(self, longest: float) -> list[Rests]:
        """Three rests: two branches of F = 0 over s with one clearance; from a grid."""
        s, d = self._grid(GRID.least, longest)
        F, c = self.eliminated(s[:, None], d[None, :])
        rows = [_crossings(d, F[i], c[i]) for i in range(len(s))]
        starts = [
            [s[i], *sorted(rows[i][0][[j, k]])] for i in range(len(s) - 1) for j, k in _meeting(rows[i], rows[i + 1])
        ]
        met = newton(self._three, np.array(starts).reshape(-1, 3))
        gaps = np.stack([met[:, 1], met[:, 2], met[:, 2] - met[:, 1]], axis=1)
        apart_ = (gaps > GRID.least).all(axis=1) & ~is_whole(gaps / self.turn).any(axis=1)
        return [self._as_rests("triple point", z) for z in distinct(met[apart_])]

    def _three(self, z: Array) -> Array:
        s, *gaps = z.T
        (F, c), (G, b) = (self.eliminated(s, d) for d in gaps)
        return np.stack([F, G, b - c], axis=1)


def linear_rests(family: Family) -> LinearRests | None:
    """The flights of a linear model over the clearance; None for others, or without a motion of period T."""
    if family.over != CLEARANCE or family.model.period is None:
        return None
    form = form_of(family.model.force(), family.model.forcing())
    if form is None or not form.harmonics or sign_of(form.stiffness) == 0:
        return None
    steady = steady_motion(form, Name("t"))
    return None if steady is None else LinearRests(form, steady, family.model.period)


def newton(missed: Callable[[Array], Array], starts: Array) -> Array:
    """Zeros near starts by Newton's method with central differences.

    Parameters
    ----------
    missed : n functions of n unknowns, for many places at once: shapes (m, n) to (m, n). starts : shape (m, n).

    Returns
    -------
    shape (at most m, n) : those that settle.

    Examples
    --------
    >>> found = newton(lambda z: z**2 - [2, 3], np.array([[1.0, 2.0], [-1.0, 2.0]]))
    >>> (found**2).round(12).tolist()
    [[2.0, 3.0], [2.0, 3.0]]
    """
    places, settled, size = starts.astype(float), list[Array](), starts.shape[1]
    for _ in range(GRID.most):
        if not len(places):
            break
        sides = [(missed(places + h) - missed(places - h)) / (2 * GRID.aside) for h in GRID.aside * np.eye(size)]
        matrices, values = np.stack(sides, axis=2), missed(places)
        sound = np.isfinite(matrices).all(axis=(1, 2)) & np.isfinite(values).all(axis=1)
        places, matrices, values = places[sound], matrices[sound], values[sound]
        moves = -np.einsum("ijk,ik->ij", np.linalg.pinv(matrices), values)
        places = places + np.clip(moves, -GRID.longest, GRID.longest)
        done = np.abs(moves).max(axis=1, initial=0) < 1e-12 * (1 + np.abs(places).max(axis=1, initial=0))
        done &= np.abs(values).max(axis=1, initial=0) < GRID.wide  # no move is made where the derivative vanishes
        settled.append(places[done])
        places = places[~done]
    return np.vstack([np.empty((0, size)), *settled])


def distinct(places: Array) -> Array:
    """The first of those that are nearer than Newton's method can tell apart."""
    keys = np.unique(np.round(places / GRID.same), axis=0, return_index=True)[1]
    kept: list[Array] = []
    for place in places[np.sort(keys)]:
        if not any(np.abs(place - other).max() < 4 * GRID.same for other in kept):
            kept.append(place)
    return np.array(kept).reshape(-1, places.shape[1])


def is_whole(turns: Any) -> Any:
    """Whether times are whole periods: rests that far apart belong to the motion with the period T."""
    return np.abs(turns - np.round(turns)) < GRID.whole


def _changes(value: Array) -> Array:
    """Whether a function on a grid changes sign over each cell."""
    corners = np.stack([value[:-1, :-1], value[1:, :-1], value[:-1, 1:], value[1:, 1:]])
    return np.asarray((corners.min(axis=0) <= 0) & (corners.max(axis=0) >= 0))


def _crossings(d: Array, F: Array, c: Array) -> tuple[Array, Array]:
    at = np.flatnonzero(F[:-1] * F[1:] < 0)
    share = F[at] / (F[at] - F[at + 1])
    return d[at] + share * GRID.step, c[at] + share * (c[at + 1] - c[at])


def _meeting(before: tuple[Array, Array], after: tuple[Array, Array]) -> list[tuple[int, int]]:
    """Pairs of branches whose clearances change their order between two rows."""
    (d, c), (later, other) = before, after
    if not d.size or not later.size:
        return []
    to = np.abs(d[:, None] - later[None, :]).argmin(axis=1)
    near = np.abs(d - later[to]) < GRID.near
    gap, then = c[:, None] - c[None, :], other[to][:, None] - other[to][None, :]
    pairs = np.triu(gap * then <= 0, 1) & near[:, None] & near[None, :] & (np.abs(gap) < GRID.jump)
    return [(int(j), int(k)) for j, k in np.argwhere(pairs)]
