"""First hits in balls soon after a launch: the flights of a linear model as sums of polynomials prepared once.

    z = v V(t) + rest U(t) + sum_j (p_j C_j(t) + q_j S_j(t)),   z = x - c,   z = t y

with p_j cos + q_j sin the wave j since the launch; V, U, C_j, S_j have the impulse, the force 1 and the waves alone.
A hit is the first one where y > 0 at the launch, y' < 0 on a window, and y < 0 at its end.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import frexp, ldexp, log2
from operator import mul
from typing import Any


@dataclass(frozen=True)
class ShortSettings:
    """Which flights are short.

    Parameters
    ----------
    degrees : of the polynomials. reach : of a window, over the flight time that doubles expect.
    expected : coefficients and steps of that expectation. steps : of Newton's method in balls.
    """

    degrees: tuple[int, ...] = (8, 10, 12, 14, 16, 18, 20, 22, 24, 27, 30, 34, 38, 44, 50, 60, 80)
    reach: float = 1.125
    expected: int = 10
    steps: int = 8


SETTINGS = ShortSettings()
GROWTH = 3
"""Above e^(L t), for L t <= 1."""


@dataclass(frozen=True)
class Cut:
    """The polynomials in y cut after a degree, and what bounds the rest.

    Parameters
    ----------
    impulse, steady, waves : V/t, U/t, C_j/t and S_j/t. last, slope : the first power cut, and that of y'.
    by_v, alone, forced : the coefficient of that power is below growth (v by_v + alone + t forced).
    """

    impulse: Any
    steady: Any
    waves: list[tuple[Any, Any]]
    last: Any
    slope: Any
    by_v: Any
    alone: Any
    forced: Any


class ShortFlights:
    """The polynomials of a flow, see `flights.balls`, at the precision at which they are made.

    Examples
    --------
    >>> from fractions import Fraction
    >>> from singimpact.algebra.precision import balls_at
    >>> from singimpact.flights.balls import LinearFlow
    >>> from singimpact.oscillator.model import Oscillator
    >>> with balls_at(200):
    ...     flow = LinearFlow(Oscillator("x", "-2 + cos(2*t)", 0, "0.5"), 200)
    ...     time, velocity = ShortFlights(flow).hit(flow.number(Fraction(0)), flow.number(Fraction(1, 4)))
    ...     print(time.str(25, radius=False))
    0.4594169732219930318921990
    """

    def __init__(self, flow: Any) -> None:
        self.flow, self.bits, self.zero = flow, flow.balls.bits, flow.number(0)
        one = flow.number(1)
        self.longest = 1 / float(max(abs(flow.d).upper() + abs(flow.k).upper(), one))
        terms = SETTINGS.degrees[-1] + 3
        zero = [self.zero] * terms
        waves = [_harmonics(wave[0], terms, zero[0]) for wave in flow.waves]
        self.impulse = self._coefficients(zero, one)
        self.steady = self._coefficients([one, *zero[1:]], zero[0])
        self.waves = [(self._coefficients(c, zero[0]), self._coefficients(s, zero[0])) for c, s in waves]
        self.sizes = [abs(cosine).upper() + abs(sine).upper() for _, _, cosine, sine in flow.waves]
        self.cuts: dict[int, tuple[Cut, tuple[float, float, float]]] = {}
        self.degrees: dict[tuple[int, int], int] = {}
        parts = self.impulse, self.steady, *(each for pair in self.waves for each in pair)
        self.floats = [[float(part[n]) for part in parts] for n in range(1, SETTINGS.expected)]

    def _coefficients(self, forced: list[Any], v: Any) -> list[Any]:
        """Taylor coefficients of z from z = 0, z' = v under a force."""
        d, k = self.flow.d, self.flow.k
        z = [self.zero, v]
        for n in range(len(forced) - 2):
            z.append((forced[n] - d * (n + 1) * z[n + 1] - k * z[n]) / ((n + 1) * (n + 2)))
        return z

    def _cut(self, degree: int) -> tuple[Cut, tuple[float, float, float]]:
        """The polynomials of z to t^(degree - 1), and the sizes of the bound as logarithms."""
        import flint

        if degree in self.cuts:
            return self.cuts[degree]

        def size(z: list[Any]) -> Any:
            return max(abs(z[degree]).upper(), ((degree + 1) * abs(z[degree + 1])).upper())

        def kept(z: list[Any]) -> Any:
            return flint.arb_poly(z[1:degree])

        alone, forced, factor = abs(self.flow.rest) * size(self.steady), self.zero, self.zero + 1
        for n in range(1, degree + 1):
            factor *= n
        for (rate, _, _, _), strength, (c, s) in zip(self.flow.waves, self.sizes, self.waves, strict=True):
            alone += strength * (size(c) + size(s))
            forced += strength * abs(rate) ** degree / factor
        last, slope = (flint.arb_poly([*[0] * power, 1]) for power in (degree - 1, degree - 2))
        waves = [(kept(c), kept(s)) for c, s in self.waves]
        cut = Cut(kept(self.impulse), kept(self.steady), waves, last, slope, size(self.impulse), alone.upper(),
                  forced.upper())  # fmt: skip
        self.cuts[degree] = cut, (float(cut.by_v), float(cut.alone), float(cut.forced))
        return self.cuts[degree]

    def hit(self, tau: Any, v: Any) -> tuple[Any, Any] | None:
        """Flight time and velocity of the first hit, both proved; None where the flight is not short."""
        pairs = self._phases(tau)
        a = self.flow.rest + sum((p for p, _ in pairs), self.zero)
        if not (a < 0 and v > 0):
            return None
        guess = self._expected(float(v), float(a), pairs)
        reach = guess * SETTINGS.reach
        if not 0 < reach <= self.longest:
            return None
        cut = self._enough(reach, float(v))
        return None if cut is None else self._proved(cut, v, pairs, guess, reach)

    def _phases(self, tau: Any) -> list[tuple[Any, Any]]:
        """p_j, q_j of every wave."""
        found = []
        for rate, phase, cosine, sine in self.flow.waves:
            s, c = (rate * tau + phase).sin_cos()
            found.append((cosine * c + sine * s, sine * c - cosine * s))
        return found

    def _expected(self, v: float, a: float, pairs: list[tuple[Any, Any]]) -> float:
        """The flight time in doubles; 0 where Newton's method does not find it."""
        weights = [v, float(self.flow.rest), *(float(part) for pair in pairs for part in pair)]
        y = [sum(map(mul, weights, row)) for row in self.floats]
        y[0], y[1] = v, (a - float(self.flow.d) * v) / 2  # a cancels near a tangency
        if not y[1] < 0:
            return 0.0
        t = -v / y[1]
        for _ in range(SETTINGS.expected):
            value, slope = 0.0, 0.0
            for c in reversed(y):
                slope = slope * t + value
                value = value * t + c
            if not slope < 0:
                return 0.0
            change = value / slope
            t -= change
            if abs(change) < 1e-13 * t:
                return float(t)
        return 0.0

    def _enough(self, reach: float, v: float) -> Cut | None:
        """The lowest degree whose rest is below the rounding of v; found once for flights of nearly the same size."""
        size = frexp(reach)[1], frexp(v)[1]
        known = self.degrees.get(size)
        if known is not None:
            return self._cut(known)[0]
        # the longest reach and the least v of that size: the degree does not depend on which flight came first
        reach, v = ldexp(1.0, size[0]), ldexp(1.0, size[1] - 1)
        for degree in SETTINGS.degrees:
            cut, (by_v, alone, forced) = self._cut(degree)
            left = GROWTH * (2 * v * by_v + alone + reach * forced)
            if left == 0 or log2(left) + (degree - 1) * log2(reach) < log2(v) - self.bits:
                self.degrees[size] = degree
                return cut
        return None

    def _proved(
        self, cut: Cut, v: Any, pairs: list[tuple[Any, Any]], guess: float, reach: float
    ) -> tuple[Any, Any] | None:
        end, zero = self.zero + reach, self.zero
        bound = GROWTH * (v.upper() * cut.by_v + cut.alone + end * cut.forced)
        tail = zero.union(bound).union(-bound)
        y = cut.impulse * v + cut.steady * self.flow.rest
        for (c, s), (p, q) in zip(cut.waves, pairs, strict=True):
            y += c * p + s * q
        slope = y.derivative() + cut.slope * (tail * (cut.last.degree() + 2))
        y += cut.last * tail
        rate = slope(zero.union(end))
        if not (rate < 0 and y(end) < 0):
            return None
        # the mean value theorem: the root is t - y(t)/y'(s), with s between t and the root
        middle = zero + guess
        root = middle - y(middle) / rate
        for _ in range(SETTINGS.steps):
            closer = middle - y(middle) / slope(root.union(middle))
            if not closer.rad() * 4 < root.rad():
                root = closer
                break
            root, middle = closer, closer.mid()
        return (root, slope(root) * root) if root > 0 and root < end else None


def _harmonics(rate: Any, terms: int, zero: Any) -> tuple[list[Any], list[Any]]:
    """Taylor coefficients of cos(rate t) and sin(rate t)."""
    size, cosine, sine = zero + 1, [], []
    for n in range(terms):
        signed = -size if n % 4 > 1 else size
        cosine.append(zero if n % 2 else signed)
        sine.append(signed if n % 2 else zero)
        size = size * rate / (n + 1)
    return cosine, sine
