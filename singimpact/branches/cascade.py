"""The cascade beside a border orbit: where the number of impacts before the release changes, and what attracts between.

At distance d from the border orbit the released orbit stays near gamma for N(d) impacts and then passes its end.  N
changes where an impact falls exactly on the end of gamma.  Each impact multiplies the distance from gamma by mu, in the
coordinates of the blow-up, so the distances of these edges shrink by mu(r).
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.balls import as_rational
from singimpact.algebra.numbers import EPSILON, Array, as_float, exact
from singimpact.algebra.precision import digits_at, for_user
from singimpact.algebra.solving import halved
from singimpact.branches.border_digits import DigitOrbits
from singimpact.branches.orbits import PeriodicOrbit, chatter_orbit
from singimpact.branches.resting import SAME_PHASE, Return
from singimpact.dynamics.lift_off import turns_between
from singimpact.dynamics.orbit import Orbit, orbit
from singimpact.flights.derivative import derivative
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result
from singimpact.status import Status
from singimpact.theory.fixed_points import tangency

# The periodic orbit on which an orbit settles, with its multipliers: its impacts may be as weak as doubles allow.


@dataclass(frozen=True)
class SettledSettings:
    """When an orbit has settled.

    Parameters
    ----------
    impacts, rounds : flown at a time, and how often, where the orbit comes nearer to a periodic one.
    most : impacts of the periodic orbits that are looked for.
    near : two states nearer than this are one, in periods and in units of the largest velocity. nearing : those of an
        orbit on its way to a periodic one are so near.
    """

    impacts: int = 2000
    rounds: int = 8
    most: int = 250
    near: float = 1e-10
    nearing: float = 1e-5


SETTLED = SettledSettings()


def settled_orbit(osc: Oscillator, tau: Any, v: Any = 0) -> PeriodicOrbit | None:
    """The periodic orbit on which the orbit of a state settles; None where none of at most 250 impacts is found.

    Notes
    -----
    Multipliers are those of the product of D G along the orbit, which keeps the relative accuracy of weak impacts;
    closing conditions lose it where x - c is below a rounding of x.

    Examples
    --------
    >>> found = settled_orbit(Oscillator("x", "cos(4*t)", 0, "1/2"), 0, 1)
    >>> print(found.n, found.k, f"{found.v[0]:.12f}")
    1 2 0.533333333333
    """
    period, n = as_float(osc.period), 0
    for _ in range(SETTLED.rounds):
        flown = orbit(osc, tau, v, impacts=SETTLED.impacts)
        if (lifted := flown.tau[flown.kind == "release"]).size > 1:
            return _with_rest(osc, lifted, period)
        if flown.tau.size <= SETTLED.impacts or not (flown.kind[-2 * SETTLED.most :] == "impact").all():
            return None
        distance = _distances(flown, period)
        # an orbit that turns as it comes nearer is sooner near after two rounds than after one: the first n counts
        near = np.flatnonzero(distance < SETTLED.nearing)
        if not near.size:
            return None
        n = int(near[0]) + 1
        if distance[n - 1] < SETTLED.near:
            return _closed(osc, flown, n, period)
        tau, v = float(flown.tau[-1]), float(flown.v[-1])
        tau -= period * np.floor(tau / period)
    near = np.flatnonzero(distance < SETTLED.near)
    return _closed(osc, flown, int(near[0]) + 1, period) if near.size else None


def _distances(flown: Orbit, period: float) -> Array:
    """Distances of the last state from those 1, 2, ... impacts before, phases apart from whole periods."""
    times, speeds = flown.tau, flown.v
    before = slice(-2, -SETTLED.most - 2, -1)
    apart = (times[-1] - times[before]) / period
    fast = float(speeds[-SETTLED.most :].max())
    return np.asarray(np.maximum(np.abs(apart - np.rint(apart)), np.abs(speeds[before] - speeds[-1]) / fast))


def _closed(osc: Oscillator, flown: Orbit, n: int, period: float) -> PeriodicOrbit:
    """The last n impacts as a periodic orbit, the one of the least phase first."""
    times, speeds = flown.tau, flown.v
    turns = (times[-1] - times[-1 - n]) / period
    k, first = int(np.rint(turns)), int(np.argmin(np.mod(times[-n:], period)))
    at = slice(-2 * n + first, -n + first) if first else slice(-n, None)
    tau, v = times[at] - period * np.floor(times[at][0] / period), speeds[at]
    miss = max(abs(float(turns) - k) * period, abs(float(speeds[-1] - speeds[-1 - n])))
    return PeriodicOrbit(tau, v, _multipliers(osc, tau, v), miss, np.int8(Status.hit), osc, n, k)


def _multipliers(osc: Oscillator, tau: Array, v: Array) -> Array:
    """The eigenvalues of the product of D G, the larger first."""
    product, determinant = np.eye(2), 1.0
    for matrix in derivative(osc, tau, v).matrix:
        product = matrix @ product
        determinant *= float(np.linalg.det(matrix))
    half = float(np.trace(product)) / 2
    root = np.sqrt(complex(half * half - determinant))
    first = half + root if half > 0 else half - root
    eigenvalues = np.array([first, determinant / first if first else 0.0])
    return eigenvalues.real if not eigenvalues.imag.any() else eigenvalues


def _with_rest(osc: Oscillator, lifted: Array, period: float) -> PeriodicOrbit | None:
    """The orbit of a mass that lifts off again and again at the same phases."""
    last = float(lifted[-1])
    for earlier in lifted[-2::-1].tolist():
        k, miss = turns_between(earlier, last, period)
        if miss < SAME_PHASE * period:
            return chatter_orbit(osc, last, k, miss)
    return None


@dataclass(frozen=True)
class CascadeSettings:
    """The number of edges, and the tolerances of their search."""

    # the largest distance searched, as a fraction of that at which v/gamma itself changes; never beyond the search for
    # border orbits
    start: float = 0.25
    # of one distance to the next; between those with two edges or more there are others, down to a relative width
    factor: float = 0.7
    narrow: float = 1e-3
    # edges that are found by counting impacts; each next one is extrapolated from the three before
    regular: int = 5
    # edges are searched down to this many times the error of the border orbit, and at most this many
    least: float = 1e5
    most: int = 400
    # they end where so many ratios in a row differ from the one before by less, as a part of ratio - 1: the difference
    # from their limit loses about this part in one step
    settled: float = 1e-8
    still: int = 3
    # steps of the secant method
    steps: int = 12
    # times the error of a limit: the least of many estimates was too low by 2.4 at r = 0.97
    safety: float = 3.0
    # digits of mu
    digits: int = 20
    # rounding units of the parameter between the border orbit and the nearest model flown
    apart: float = 1e3


SETTINGS = CascadeSettings()


@dataclass(frozen=True)
class CascadeWindow(Result):
    """The attractor of the orbit from lift-off between two edges.

    Parameters
    ----------
    impacts : of the released orbit before it passes the end of gamma. parameter, distance : where it was flown, and how
        far that is from the border orbit.
    orbit : the orbit on which the released one settles, with its multipliers; None where none is seen.
    """

    impacts: int
    parameter: float
    distance: float
    orbit: PeriodicOrbit | None

    def as_dict(self) -> dict[str, Any]:
        """Impacts, parameter, n ("inf" for chatter), k and multipliers; null where no orbit is seen."""
        values: dict[str, Any] = {
            "impacts": self.impacts,
            "parameter": self.parameter,
            "n": None,
            "k": None,
            "multipliers": None,
        }
        orbit = self.orbit
        if orbit is not None:
            pairs = [[complex(multiplier).real, complex(multiplier).imag] for multiplier in orbit.multipliers]
            values |= {"n": "inf" if orbit.kind == "chatter" else int(orbit.n), "k": orbit.k, "multipliers": pairs}
        return values


@dataclass(frozen=True, eq=False, repr=False)
class Cascade(Result):
    """Edges between numbers of impacts, from the farthest to the nearest to the border orbit.

    Parameters
    ----------
    over : the number that is varied.
    impacts : of the released orbit before the end of gamma, on the near side of an edge.
    parameter, distance : of each edge, and from the border orbit; doubles, or mpmath numbers with digits.
    ratios : of the distance of each edge to that of the next. errors : of the ratios, from those of the edges.
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

    def as_dict(self) -> dict[str, Any]:
        """Edges in doubles, ratios and their limit, the attractors between edges, and notes."""
        limit, error = self.limit
        return {
            "impacts": self.impacts,
            "distance": np.array([float(distance) for distance in self.distance]),
            "ratios": np.array([float(ratio) for ratio in self.ratios]),
            "limit": limit,
            "limit_error": error,
            "mu": float(self.mu),
            "attractors": [window.as_dict() for window in self.windows],
            "notes": list(self.notes),
        }

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Array]]:
        """Edges, and the ratios between them."""
        values = self.as_dict()
        edges = {name: (("edge",), values[name]) for name in ("impacts", "distance")}
        return edges | {"ratios": (("pair",), values["ratios"])}

    @property
    def limit(self) -> tuple[float, float]:
        """The limit of the ratios, and an estimate of its error: three ratios extrapolated by Aitken's method.

        The error is made of the spread of three such numbers in a row and of the errors of the ratios in them; where it
        is least they are taken. mu(r) is not used. nan where there are fewer than five ratios.
        """
        best = (np.nan, np.inf)
        ratios, errors = (np.array(column, dtype=float) for column in (self.ratios, self.errors))
        steps = np.diff(ratios)
        for i in range(len(ratios) - 4):
            three = [_aitken(*ratios[j : j + 3].tolist()) for j in range(i, i + 3)]
            # nearly equal steps amplify rounding twice, and amplify the remaining distance alike
            same = steps[i + 3] == steps[i + 2] or not steps[i + 2]
            grown = np.inf if same else max(1.0, 1 / abs(1 - steps[i + 3] / steps[i + 2])) ** 2
            error = SETTINGS.safety * grown * float(max(three) - min(three) + errors[i : i + 5].sum())
            if error < best[1]:
                best = three[-1], error
        return best

    @cached_property
    def windows(self) -> tuple[CascadeWindow, ...]:
        """The attractor of the released orbit in the middle of each window between two edges, read lazily."""
        return self.sampled(1)

    def sampled(self, count: int) -> tuple[CascadeWindow, ...]:
        """Attractors at so many values in each window, whose distances divide the window evenly in logarithms.

        Parameters
        ----------
        count : of values in a window. Those that doubles do not tell from the border orbit are left out.
        """
        windows: list[CascadeWindow] = []
        side = -self.returned.side
        border = float(self.parameter[-1] + self.returned.side * self.distance[-1]) if len(self) else np.nan
        for i in range(len(self) - 1):
            far, near = float(self.distance[i]), float(self.distance[i + 1])
            for j in range(count):
                distance = far * (near / far) ** ((j + 0.5) / count)
                if distance < SETTINGS.apart * (EPSILON * abs(border) + 5e-324):
                    return tuple(windows)
                orbit = self.returned.flown(border + side * distance)
                settled = settled_orbit(orbit.model, orbit.tau)
                windows.append(CascadeWindow(int(self.impacts[i]), border + side * distance, distance, settled))
        return tuple(windows)

    def __repr__(self) -> str:
        if not len(self):
            return f"<cascade without edges: {'; '.join(self.notes)}>"
        value, error = self.limit
        ends = f"{self.impacts[0] - 1} to {self.impacts[-1]} impacts, {len(self)} edges"
        last = f"distances {float(self.distance[0]):.3g} to {float(self.distance[-1]):.3g}"
        ratios = f"last ratio {float(self.ratios[-1]):.10g} +- {float(self.errors[-1]):.1e}" if len(self) > 1 else ""
        limit = f"limit {value:.10g} +- {error:.1e}, " if np.isfinite(value) else ""
        shown = f"{limit}mu = {float(self.mu):.10g}"
        return f"<cascade in {self.over}: {'; '.join(part for part in (ends, last, ratios, shown) if part)}>"


def _aitken(a: float, b: float, c: float) -> float:
    """The limit of a, b, c as terms of a geometric approach."""
    lost = (c - b) - (b - a)
    return c - (c - b) ** 2 / lost if lost else c


def cascade(returned: Return, osc: Oscillator, border: tuple[Any, Any, float], digits: int | None) -> Cascade:
    """The edges beside a border orbit.

    Parameters
    ----------
    returned : the border orbit in doubles. osc : the model there. border : its value (None: that of doubles), the error
        of it, and the change of the number that changes v by itself. digits : None for doubles.
    """
    value, error, scale = border
    flights: _InDoubles | _InDigits
    if digits is None or value is None:
        centre, flights, digits = Fraction(returned.value), _InDoubles(returned), None
        wrong = Fraction(float(error)) + Fraction(EPSILON * abs(returned.value))
    else:
        centre, flights = exact("parameter", value), _InDigits(returned, digits)
        wrong = exact("error", error) + abs(centre) / 10**digits
    edges, note = _Edges(returned, flights, centre, wrong).edges(scale)
    places = [edge for _, edge in edges]
    distances = [abs(edge - centre) for edge in places]
    pairs = list(pairwise(distances))
    ratios = [one / two for one, two in pairs]
    errors = [float(one / two * wrong * (1 / one + 1 / two)) for one, two in pairs]
    parameter, distance, ratio = (_array(column, digits) for column in (places, distances, ratios))
    mu = tangency(osc.slope_at_rest(), digits=SETTINGS.digits).mu.value
    numbers = np.array([number for number, _ in edges], dtype=int)
    return Cascade(returned.releases.over, numbers, parameter, distance, ratio, np.array(errors), mu, (note,), returned)


def _array(values: list[Fraction], digits: int | None) -> Array:
    if digits is None:
        return np.array([float(value) for value in values])
    with digits_at(digits) as mp:
        return np.array([for_user(mp.mpf(value.numerator) / value.denominator) for value in values], dtype=object)


class _InDoubles:
    """Landings by doubles: times of impacts less that of the end of gamma, and values as these flights take them."""

    def __init__(self, found: Return) -> None:
        self.found = found

    def landing(self, number: int, value: Fraction) -> Fraction | None:
        orbit = self.found.flown(float(value))
        gap = orbit.landing(number, self.found.place)
        near = orbit.impacts_before(self.found.place) in (number - 1, number)
        return Fraction(gap) if near and np.isfinite(gap) else None

    def rounded(self, value: Fraction) -> Fraction:
        return Fraction(float(value))


class _InDigits:
    """Landings by balls or in many digits."""

    def __init__(self, found: Return, digits: int) -> None:
        self.orbits = DigitOrbits(found, digits)

    def landing(self, number: int, value: Fraction) -> Fraction | None:
        rows = self.orbits.landings(value, number)
        return as_rational(rows[-1].sigma) if len(rows) == number else None

    def rounded(self, value: Fraction) -> Fraction:
        return as_rational(self.orbits.balls.rational(value))


class _Edges:
    """The search for edges: the first ones by counting impacts, then each from the three before.

    Parameters
    ----------
    found : a return. flights : of the orbits. border : the value of the border orbit. wrong : its error.
    """

    def __init__(self, found: Return, flights: _InDoubles | _InDigits, border: Fraction, wrong: Fraction) -> None:
        self.found, self.flights, self.border, self.wrong = found, flights, border, wrong
        self.side = -found.side

    def edges(self, scale: float) -> tuple[list[tuple[int, Fraction]], str]:
        """N on the near side and the value of the number of each edge, and why there are no more."""
        rows: list[tuple[int, Fraction]] = []
        for number, near, far in self._counted(min(SETTINGS.start * scale, self.found.reach)):
            edge = self._solved(number, *self._halved(number, near, far))
            if edge is None:
                return rows, f"the edge of {number} impacts is not resolved"
            rows.append((number, edge))
        if len(rows) < 3:
            return rows, "fewer than three edges are resolved"
        still = 0
        while len(rows) < SETTINGS.most:
            distances = [abs(edge - self.border) for _, edge in rows[-3:]]
            before, ratio = distances[0] / distances[1], distances[1] / distances[2]
            still = still + 1 if abs(before - ratio) < SETTINGS.settled * (ratio - 1) else 0
            if still == SETTINGS.still:
                return rows, "the ratios have settled: the edges go on"
            number, following = rows[-1][0] + 1, distances[2] / ratio
            if following < SETTINGS.least * self.wrong:
                return rows, ("nearer edges are not told from the border orbit: digits=, or more of them, goes on")
            guess = self.border + self.side * following
            # from the side where the impact is still before the end of gamma
            edge = self._solved(number, guess, guess - self.side * following / 1000)
            if edge is None:
                return rows, f"the edge of {number} impacts is not resolved"
            rows.append((number, edge))
        return rows, f"only {SETTINGS.most} edges are given"

    def _solved(self, number: int, first: Fraction, second: Fraction) -> Fraction | None:
        """The value at which an impact falls on the end of gamma, by secants."""
        first, second = self.flights.rounded(first), self.flights.rounded(second)
        value, small = self.flights.landing(number, first), self.wrong / 4
        for _ in range(SETTINGS.steps):
            other = self.flights.landing(number, second)
            if value is None or other is None:
                return None
            if other == value or abs(second - first) <= small:
                return second
            after = self.flights.rounded(second - other * (second - first) / (other - value))
            first, value, second = second, other, after
        return None

    def _halved(self, number: int, near: float, far: float) -> tuple[Fraction, Fraction]:
        """Values next to the edge between two distances: secants fail beyond a graze, where the impact is elsewhere."""
        low, high = halved(lambda distance: self._count(distance) >= number, near, far, SETTINGS.narrow)
        place = self.border + self.side * Fraction(low)
        return place, place - self.side * Fraction(high - low) / 1000

    # ---- the first edges, in doubles

    def _counted(self, start: float) -> list[tuple[int, float, float]]:
        """N on the near side, and distances on both sides, of edges from where on one more impact comes at a time."""
        rows: list[tuple[float, int]] = []
        distance = start
        while distance > SETTINGS.least * float(self.wrong):
            count = self._count(distance)
            rows += self._between(rows[-1], (distance, count)) if rows else []
            rows.append((distance, count))
            regular = _regular(rows)
            # edges farther away are kept too, once their ratios are regular
            if len(regular) >= 2 * SETTINGS.regular:
                return regular[: SETTINGS.regular]
            distance *= SETTINGS.factor
        return _regular(rows)[: SETTINGS.regular]

    def _between(self, far: tuple[float, int], near: tuple[float, int]) -> list[tuple[float, int]]:
        """Distances between two, where there is more than one edge."""
        if near[1] - far[1] <= 1 or far[1] < 0 or near[0] > far[0] * (1 - SETTINGS.narrow):
            return []
        distance = float(np.sqrt(far[0] * near[0]))
        middle = distance, self._count(distance)
        return [*self._between(far, middle), middle, *self._between(middle, near)]

    def _count(self, distance: float) -> int:
        """Impacts before the end of gamma; -1 where the chatter completes before it, or is not decided."""
        try:
            orbit = self.found.flown(float(self.border) + self.side * distance)
        except InputError:  # a number that is none of a model's
            return -1
        passed = orbit.decided and orbit.place != self.found.place
        return orbit.impacts_before(self.found.place) if passed else -1


def _regular(rows: list[tuple[float, int]]) -> list[tuple[int, float, float]]:
    """Where one impact more comes, in the last rows in which never more than one does at a time.

    Examples
    --------
    >>> _regular([(0.5, 4), (0.4, 3), (0.3, 4), (0.2, 4), (0.1, 5)])
    [(4, 0.3, 0.4), (5, 0.1, 0.2)]
    """
    first = max((i + 1 for i in range(len(rows) - 1) if not 0 <= rows[i + 1][1] - rows[i][1] <= 1), default=0)
    tail = [row for row in rows[first:] if row[1] >= 0]
    return [(near[1], near[0], far[0]) for far, near in pairwise(tail) if near[1] > far[1]]
