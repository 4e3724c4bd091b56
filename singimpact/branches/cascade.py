"""The cascade beside a border orbit: where the number of impacts before the release changes, and what attracts between.

At distance d from the border orbit the released orbit stays near gamma for N(d) impacts and then passes its end.  N
changes where an impact falls exactly on the end of gamma.  Each impact multiplies the distance from gamma by mu, in the
coordinates of the blow-up, so the distances of these edges shrink by mu(r).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from singimpact.algebra.balls import as_rational
from singimpact.algebra.numbers import exact
from singimpact.algebra.precision import balls_at, digits_at, for_user
from singimpact.algebra.solving import halved, secant
from singimpact.branches.border_digits import DigitOrbits
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.released import Return
from singimpact.branches.settled import settled_orbit
from singimpact.oscillator.model import Oscillator
from singimpact.theory.fixed_points import tangency

EPSILON = 2.0**-52
Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class CascadeSettings:
    """How edges are found.

    Parameters
    ----------
    start : the largest distance, as a part of that at which v/gamma changes by itself. factor : of one distance to the
        next, before those between which two edges lie are halved. narrow : two edges nearer than this, relative, end
        the search. least : edges are looked for down to so many times the error of the border orbit.
    most : edges at most. settled : with digits, edges are looked for until two ratios differ by less.
    spare : digits that a ratio keeps where the last edge is. digits : of mu.
    """

    start: float = 0.25
    factor: float = 0.7
    narrow: float = 1e-3
    least: float = 1e4
    most: int = 400
    settled: float = 1e-10
    spare: int = 10
    digits: int = 20


SETTINGS = CascadeSettings()


@dataclass(frozen=True)
class Window:
    """What attracts the released orbit between two edges.

    Parameters
    ----------
    impacts : of the released orbit before it passes the end of gamma. parameter : in the middle of the logarithms of
        the distances of its edges. distance : of it from the border orbit.
    orbit : the orbit on which the released one settles, with its multipliers; None where none is seen.
    """

    impacts: int
    parameter: float
    distance: float
    orbit: PeriodicOrbit | None


@dataclass(frozen=True, eq=False, repr=False)
class Cascade:
    """Edges between numbers of impacts, from the farthest to the nearest to the border orbit.

    Parameters
    ----------
    over : the number that moves. impacts : of the released orbit before the end of gamma, on the near side of each edge.
    parameter, distance : of each edge, and from the border orbit; doubles, or mpmath numbers with digits.
    ratios : of the distance of each edge to that of the next. errors : of the ratios, estimated from those of the edges.
    mu : the multiplier across gamma at a tangency, to which they tend. notes : where the edges end, and why.
    """

    over: str
    impacts: Array
    parameter: Array
    distance: Array
    ratios: Array
    errors: Array
    mu: Any
    notes: tuple[str, ...]
    returned: Return

    def __len__(self) -> int:
        return len(self.impacts)

    @property
    def limit(self) -> tuple[float, float]:
        """What the ratios tend to, and an estimate of its error: three ratios extrapolated by Aitken's method.

        Of all triples the one of least error is taken; mu(r) is not used. nan where there are fewer than four ratios.
        """
        best = (np.nan, np.inf)
        rows = [(float(one), float(two)) for one, two in zip(self.ratios, self.errors, strict=True)]
        for (a, e), (b, f), (c, g), (d, h) in zip(rows, rows[1:], rows[2:], rows[3:], strict=False):
            one, two = _aitken(a, b, c), _aitken(b, c, d)
            # rounding of the ratios is enlarged by the division, and the last step tells how far the limit moves
            grown = max(1.0, abs((d - c) / ((d - c) - (c - b)))) if d - c != c - b else np.inf
            error = abs(two - one) + 4 * grown * (e + f + g + h)
            if error < best[1]:
                best = two, error
        return best

    @cached_property
    def windows(self) -> tuple[Window, ...]:
        """What attracts the released orbit in each window between two edges, found when asked for."""
        found, side = [], -self.returned.side
        border = self._border()
        for i in range(len(self) - 1):
            distance = float(self.distance[i] * self.distance[i + 1]) ** 0.5
            value = border + side * distance
            if not abs(value - border) > 1e3 * EPSILON * abs(border):
                break
            orbit = self.returned.flown(value)
            found.append(Window(int(self.impacts[i]), value, distance, settled_orbit(orbit.model, orbit.tau)))
        return tuple(found)

    def _border(self) -> float:
        return float(self.parameter[-1] + self.returned.side * self.distance[-1]) if len(self) else self.returned.value

    def __repr__(self) -> str:
        if not len(self):
            return f"<cascade without edges: {'; '.join(self.notes)}>"
        value, error = self.limit
        ends = f"{self.impacts[0] - 1} to {self.impacts[-1]} impacts, {len(self)} edges"
        last = f"distances {float(self.distance[0]):.3g} to {float(self.distance[-1]):.3g}"
        ratios = f"last ratio {float(self.ratios[-1]):.10g} +- {float(self.errors[-1]):.1e}" if len(self) > 1 else ""
        shown = f"limit {value:.10g} +- {error:.1e}, mu = {float(self.mu):.10g}"
        return f"<cascade in {self.over}: {'; '.join(part for part in (ends, last, ratios, shown) if part)}>"


def _aitken(a: float, b: float, c: float) -> float:
    """The limit of a, b, c as terms of a geometric approach."""
    lost = (c - b) - (b - a)
    return c - (c - b) ** 2 / lost if lost else c


def cascade(found: Return, osc: Oscillator, border: tuple[Any, Any, float], digits: int | None) -> Cascade:
    """The edges beside a border orbit.

    Parameters
    ----------
    found : the border orbit in doubles. osc : the model there. border : its value (None: that of doubles), the error
        of it, and the change of the number that changes v by itself. digits : None for doubles.
    """
    value, error, scale = border
    search = _Edges(found, scale, float(error))
    edges = search.in_doubles()
    notes = search.notes
    mu = tangency(osc.slope_at_rest(), digits=SETTINGS.digits).mu.value
    centre, wrong = Fraction(found.value), Fraction(float(error)) + Fraction(EPSILON * abs(found.value))
    if digits is not None and value is not None and edges:
        deeper = _Deeper(found, digits, exact("parameter", value))
        edges, note = deeper.edges(edges)
        centre, wrong = deeper.border, exact("error", error) + abs(deeper.border) / 10**digits
        notes = [note]
    numbers = np.array([number for number, _ in edges], dtype=int)
    places = [place for _, place in edges]
    distances = [abs(place - centre) for place in places]
    ratios = [one / two for one, two in zip(distances, distances[1:], strict=False)]
    errors = [float(ratio * wrong * (1 / one + 1 / two)) for ratio, one, two in zip(ratios, distances, distances[1:],
                                                                                  strict=False)]  # fmt: skip
    rows = [_array(each, digits) for each in (places, distances, ratios)]
    return Cascade(found.releases.over, numbers, *rows, np.array(errors), mu, tuple(notes), found)


def _array(values: list[Fraction], digits: int | None) -> Array:
    if digits is None:
        return np.array([float(value) for value in values])
    with digits_at(digits) as mp:
        return np.array([for_user(mp.mpf(value.numerator) / value.denominator) for value in values], dtype=object)


class _Edges:
    """The search for edges in doubles: distances d with N(d) impacts, and the places between where N changes."""

    def __init__(self, found: Return, scale: float, error: float) -> None:
        self.found, self.side = found, -found.side
        self.start = SETTINGS.start * scale
        self.least = max(SETTINGS.least * (error + EPSILON * abs(found.value)), SETTINGS.least * 5e-324)
        self.notes: list[str] = []

    def in_doubles(self) -> list[tuple[int, Fraction]]:
        """(N on the near side, value of the number) of each edge, from the farthest on."""
        rows = self._counted()
        edges = []
        for (far, fewer), (near, more) in zip(rows, rows[1:], strict=False):
            if more > fewer:
                edges.append((more, Fraction(self._refined(more, near, far))))
        self.notes.append(
            f"edges nearer than {self.least:.2g} to the border orbit are not told from it in doubles: digits= goes on"
        )
        return edges[: SETTINGS.most]

    def _counted(self) -> list[tuple[float, int]]:
        """Distances and numbers of impacts, from where on one more impact comes at a time."""
        rows: list[tuple[float, int]] = []
        distance = self.start
        while distance > self.least:
            count = self._count(distance)
            if count is not None:
                rows += self._between(rows[-1], (distance, count)) if rows else []
                rows.append((distance, count))
            else:
                rows = []
            distance *= SETTINGS.factor
        first = 0
        for i in range(len(rows) - 1):
            if not 0 <= rows[i + 1][1] - rows[i][1] <= 1:
                first = i + 1
        return rows[first:]

    def _between(self, far: tuple[float, int], near: tuple[float, int]) -> list[tuple[float, int]]:
        """Distances between two, where there is more than one edge."""
        if near[1] - far[1] <= 1 or near[1] < far[1] or near[0] > far[0] * (1 - SETTINGS.narrow):
            return []
        distance = float(np.sqrt(far[0] * near[0]))
        count = self._count(distance)
        if count is None:
            return []
        middle = distance, count
        return [*self._between(far, middle), middle, *self._between(middle, near)]

    def _count(self, distance: float) -> int | None:
        """Impacts before the end of gamma; None where the chatter completes before it, or is not decided."""
        orbit = self.found.flown(self.found.value + self.side * distance)
        if orbit.place == self.found.place or not orbit.zeros.size >= self.found.place:
            return None
        return orbit.impacts_before(self.found.place)

    def _refined(self, number: int, near: float, far: float) -> float:
        """The value between two distances at which an impact falls on the end of gamma."""
        ends = (self.found.value + self.side * near, self.found.value + self.side * far)

        def landing(value: float) -> float:
            return self.found.flown(value).landing(number, self.found.place)

        place = secant(landing, *ends)
        inside = min(ends) <= place <= max(ends)
        if inside and abs(landing(place)) < 1e-13 * abs(landing(ends[0])) + 1e-14:
            return float(place)
        return halved(lambda value: landing(value) < 0, *ends)[0]


class _Deeper:
    """Edges in many digits: those that doubles know, refined, and the next ones, each from the two before."""

    def __init__(self, found: Return, digits: int, border: Fraction) -> None:
        self.found, self.digits, self.border = found, digits, border
        self.orbits = DigitOrbits(found, digits)

    def edges(self, known: list[tuple[int, Fraction]]) -> tuple[list[tuple[int, Fraction]], str]:
        """The edges, and why there are no more."""
        rows: list[tuple[int, Fraction]] = []
        for number, place in known:
            distance = abs(place - self.border)
            refined = self._solved(number, place, distance / 10**8)
            if refined is None:
                break
            rows.append((number, refined))
        if len(rows) < 3:
            return rows, "fewer than three edges are resolved"
        while len(rows) < SETTINGS.most:
            (_, a), (_, b), (number, c) = rows[-3:]
            distances = [abs(each - self.border) for each in (a, b, c)]
            one, two = distances[0] / distances[1], distances[1] / distances[2]
            if abs(one - two) < SETTINGS.settled * two:
                return rows, f"two ratios differ by less than {SETTINGS.settled:.0e}: the edges go on"
            following = distances[2] / two
            if following < abs(self.border) / 10 ** (self.digits - SETTINGS.spare):
                return rows, f"the next edges have fewer than {SETTINGS.spare} of the {self.digits} digits"
            guess = self.border - self.found.side * following
            place = self._solved(number + 1, guess, following / 10**3)
            if place is None:
                return rows, f"the edge of {number + 1} impacts is not resolved"
            rows.append((number + 1, place))
        return rows, f"only {SETTINGS.most} edges are given"

    def _solved(self, number: int, guess: Fraction, step: Fraction) -> Fraction | None:
        """The value at which an impact falls on the end of gamma."""
        small = abs(self.border) / 10 ** (self.digits + 2)
        landing = self._landing(number)
        with balls_at(self.orbits.bits):
            first, value = guess, landing(guess)
            second = guess + (step if self.found.side > 0 else -step)
            for _ in range(12):
                other = landing(second)
                if value is None or other is None or not abs(other - value) > 0:
                    return None
                change = as_rational(other * self.orbits.balls.rational(second - first) / (other - value))
                # to the digits that are there: a rational of a hundred digits makes the model's text long
                after = self._short(second - change)
                first, value, second = second, other, after
                if abs(second - first) < small:
                    return second
        return None

    def _landing(self, number: int) -> Callable[[Fraction], Any]:
        def landing(value: Fraction) -> Any:
            rows = self.orbits.landings(value, number)
            return rows[-1].sigma if len(rows) == number else None

        return landing

    def _short(self, value: Fraction) -> Fraction:
        return as_rational(self.orbits.balls.rational(value))


