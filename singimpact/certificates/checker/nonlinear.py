"""A nonlinear model before a zero of a_c: the speeds of its flights as power series, the rest bounded.

At the time S u before tau let x - c = S^(j+2) X, and p = 1 - u.  A flight from p = 0 to p = d = 1 - l has

    S^j X'' = sum A_k S^k (1-p)^k - f(c + S^(j+2) X, S^(j+1) X') + f(c, 0),     X(0) = X(d) = 0,

with a_c(tau - s) = sum A_k s^k.  It is launched with S^(j+1) d W and lands
with S^(j+1) d U; each power of S of W and U is a polynomial in d.

For complex |S| <= R and l within 1/4 of [-1, 1]: if |x - c| <= a, |v| <= b on the flight, |f_x| <= A and |f_v| <= B
there, and |a_c| <= C for |t - tau| <= 5R/4, then |X''| <= Z = C R^-j/(1 - q), q = (9R/4)^2 A/8 + (9R/4) B/2, wherever
q < 1, (9/4)^2 R^(j+2) Z/8 < a and (9/4) R^(j+1) Z/2 < b: the problem is a contraction.  |W|, |U| <= Z/2, and Cauchy
bounds their coefficients.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import mul
from typing import Any

from flint import acb, arb, arb_poly, arb_series

from .formulas import Dual, Refused, Wrong
from .motion import Model, size, within

TERMS = 28
SIDES = [arb(2) ** k for k in range(-4, 5)]
WIDE, MOST = arb(5) / 4, arb(9) / 4


class Plane:
    """Polynomials in p and d as one: p^i d^e stands at i + e M."""

    def __init__(self, degree: int) -> None:
        self.M = degree

    def twice_integrated(self, P: Any) -> Any:
        found = [arb(0)] * (P.degree() + 3)
        for at, part in enumerate(P.coeffs()):
            i = at % self.M
            found[at + 2] = part / ((i + 1) * (i + 2))
        return arb_poly(found)

    def derivative(self, P: Any) -> Any:
        return arb_poly([P[at + 1] * ((at + 1) % self.M) for at in range(max(P.degree(), 0))])

    def at_d(self, P: Any) -> Any:
        """p = d."""
        found = [arb(0)] * (2 * self.M)
        for at, part in enumerate(P.coeffs()):
            found[at % self.M + at // self.M] += part
        return arb_poly(found)

    def of_d(self, P: Any) -> Any:
        found = [arb(0)] * (self.M * (P.degree() + 1))
        for e, part in enumerate(P.coeffs()):
            found[self.M * e] = part
        return arb_poly(found)


def lowered(P: Any, by: int) -> Any:
    """P/d^by, where it is a polynomial."""
    return arb_poly(P.coeffs()[by:])


class Flights:
    """W and U with their derivatives, and what the certificate of gamma asks beside them."""

    def __init__(self, model: Model, tau: Any, j: int, reach: Any) -> None:
        self.model, self.tau, self.j, self.s0, self.K = model, tau, j, reach, TERMS + j
        self.series()
        self.lead = self.W[0][0] / (j + 1)
        if not self.lead > 0:
            raise Refused("that gamma ends at tau is not shown: a_c has no coefficient of the right sign")
        boxes = [(a, b, *self.slopes(a, b)) for a in SIDES for b in SIDES]
        radii = [R for R in (arb((4 * reach * (arb(5) / 6) ** n).mid()) for n in range(24)) if reach < R]
        discs = [(R, Z) for R in radii for Z in self.bounds(R, boxes)]
        here = self.bounds(reach, boxes)
        if not discs or not here:
            raise Refused("that the flights are analytic far enough is not shown")
        self.R, self.Z = min(discs, key=lambda disc: float(disc[1]) * float(reach / disc[0]) ** TERMS)
        self.fastest = self.fast(boxes)
        self.launched = reach ** (j + 1) * min(here, key=float) / 2
        self.rest = within(self.tail(0, TERMS).max(self.tail(1, TERMS)).max(4 * self.tail(0, TERMS)))

    def series(self) -> None:
        """W and U by powers of S, polynomials in l."""
        j, model = self.j, self.model
        plane, c, heights = Plane(TERMS + j + 4), model.c(), (list[Any](), list[Any]())
        pressed = model.g(t=arb_series([self.tau, -1], prec=TERMS + j + 1)) - model.f(x=c, xdot=arb(0))
        force = model.f(x=late(c, heights[0], j + 2), xdot=late(arb(0), heights[1], j + 1))
        self.W, self.U = [], []
        for n in range(TERMS + 1):
            right = arb_poly([1, -1]) ** (j + n) * pressed[j + n]
            if isinstance(force, Growing) and n:
                right -= force.at(j + n)
            Q = plane.twice_integrated(right)
            end, slope = plane.at_d(Q), plane.at_d(plane.derivative(Q))
            launch = -lowered(end, 1)
            heights[0].append(Q + plane.of_d(launch) * arb_poly([0, 1]))
            heights[1].append(plane.derivative(heights[0][-1]))
            self.W.append(lowered(launch, 1)(arb_poly([1, -1])))
            self.U.append(lowered(-slope - launch, 1)(arb_poly([1, -1])))

    def slopes(self, a: Any, b: Any) -> tuple[Any, Any]:
        """Bounds of |f_x| and |f_v| for complex |x - c| <= a, |v| <= b."""
        found = self.model.f(
            x=Dual(round_about(self.model.c(), a), [acb(1), acb(0)]),
            xdot=Dual(round_about(arb(0), b), [acb(0), acb(1)]),
        )
        by_x, by_v = found.slopes if isinstance(found, Dual) else (arb(0), arb(0))
        return size(by_x), size(by_v)

    def bounds(self, R: Any, boxes: list[Any]) -> list[Any]:
        """Z on |S| <= R, of the boxes where there is one."""
        j, accepted = self.j, []
        push = self.model.g(t=round_about(self.tau, R * WIDE)) - self.model.f(x=self.model.c(), xdot=arb(0))
        for a, b, A, B in boxes:
            q = (R * MOST) ** 2 * A / 8 + R * MOST * B / 2
            if q < 1:
                Z = size(size(push) / R**j / (1 - q))
                if R ** (j + 2) * MOST**2 * Z / 8 < a and R ** (j + 1) * MOST * Z / 2 < b:
                    accepted.append(Z)
        return accepted

    def fast(self, boxes: list[Any]) -> Any:
        """A launch speed up to which flights stay until tau in a box where no two of them join the same two impacts."""
        found, s0 = arb(0), self.s0
        for a, b, A, B in boxes:
            if s0**2 * A / 8 + s0 * B / 2 < 1:
                push = self.model.g(t=round_about(self.tau, s0))
                most = size(push - self.model.f(x=round_about(self.model.c(), a), xdot=round_about(arb(0), b)))
                found = found.max((b - s0 * most).min(a / s0 - s0 * most))
        return arb(found.lower())

    def tail(self, slope: int, n: int, over: int = 0) -> Any:
        """A bound of what follows S^n, or of its derivative by S, over S^over."""
        q = self.s0 / self.R
        many = (n + 1) / (1 - q) / self.s0 if slope else arb(1)
        return size(self.Z / 2 * q ** (n + 1) * many / (1 - q) / self.s0**over)

    def speeds(self, S: Any, x: Any) -> list[Any]:
        """W and U at (S, l = x), then their derivatives by S, then by l."""
        value, by_S, by_x = [], [], []
        for series in (self.W, self.U):
            P, PS = arb_poly([0]), arb_poly([0])
            for coefficient in reversed(series):
                PS, P = PS * S + P, P * S + coefficient
            value.append(P(x) + self.rest)
            by_S.append(PS(x) + self.rest)
            by_x.append(P.derivative()(x) + self.rest)
        return [*value, *by_S, *by_x]

    def fall(self, speeds: list[Any], x: Any) -> Any:
        """Minus the derivative of (1 - l) W by l."""
        return speeds[0] - (1 - x) * speeds[4]

    def folded(self, ring: Any, S: Any, x: Any) -> tuple[Any, Any]:
        """W and U of polynomials."""
        if ring.D > TERMS:
            raise Wrong("the order D is larger than the series")
        W, U, power, powers = 0, 0, 1, [1]
        for n in range(ring.D + 1):
            power = power * S if n else power
            while len(powers) <= max(self.W[n].degree(), self.U[n].degree()):
                powers.append(x * powers[-1])
            W, U = (
                power * sum(map(mul, powers, coefficient.coeffs())) + value
                for value, coefficient in ((W, self.W[n]), (U, self.U[n]))
            )
        last = ring(arb_poly([0] * ring.D + [within(self.tail(0, ring.D, ring.D))]))
        return W + last, U + last

    def factor(self, S: Any) -> Any:  # noqa: ARG002
        """v over the speed in these units."""
        return arb(1)


def late(first: Any, known: list[Any], by: int) -> Growing:
    """first + S^by (known[0] + known[1] S + ...)."""
    return Growing(lambda _, n: arb_poly([first]) if n == 0 else known[n - by] if n >= by else arb_poly([0]))


def round_about(value: Any, width: Any) -> Any:
    """Complex numbers at most this far from a ball."""
    return acb(value + within(width), within(width))


# Power series whose coefficients are polynomials, each made when it is asked for: those of a motion come one by one.


Rule = Callable[["Growing", int], Any]


class Growing:
    """A power series; `rule` makes a coefficient from those before, the first of which is a number."""

    def __init__(self, rule: Rule) -> None:
        self.rule, self.known = rule, list[Any]()

    def at(self, n: int) -> Any:
        """The coefficient of power n."""
        while len(self.known) <= n:
            self.known.append(self.rule(self, len(self.known)))
        return self.known[n]

    def first(self) -> Any:
        """The constant term, as a number."""
        return self.at(0)[0]

    def __add__(self, other: Any) -> Growing:
        if isinstance(other, Growing):
            return Growing(lambda _, n: self.at(n) + other.at(n))
        return Growing(lambda _, n: self.at(n) if n else self.at(0) + arb_poly([other]))

    def __mul__(self, other: Any) -> Growing:
        if isinstance(other, Growing):
            return Growing(lambda _, n: total(self.at(k) * other.at(n - k) for k in range(n + 1)))
        return Growing(lambda _, n: self.at(n) * other)

    __radd__, __rmul__ = __add__, __mul__

    def __rtruediv__(self, one: Any) -> Growing:
        first = one / self.first()
        return led(first, lambda y, n: total(self.at(k) * y.at(n - k) for k in range(1, n + 1)) * (-1 / self.first()))

    def exp(self) -> Growing:
        return led(self.first().exp(), lambda y, n: self._slope(y, n))

    def sin(self) -> Growing:
        return self._turned()[0]

    def cos(self) -> Growing:
        return self._turned()[1]

    def log(self) -> Growing:
        return led(self.first().log(), lambda y, n: self._inner(y, n, self))

    def atan(self) -> Growing:
        return led(self.first().atan(), lambda y, n: self._inner(y, n, self * self + 1))

    def sqrt(self) -> Growing:
        root = self.first().sqrt()
        return led(
            root, lambda y, n: (self.at(n) - total(y.at(k) * y.at(n - k) for k in range(1, n))) * (1 / (2 * root))
        )

    def _turned(self) -> tuple[Growing, Growing]:
        """sin and cos: each is the derivative of the other, up to a sign."""
        cos = led(self.first().cos(), lambda _, n: self._slope(sin, n) * -1)
        sin = led(self.first().sin(), lambda _, n: self._slope(cos, n))
        return sin, cos

    def _slope(self, y: Growing, n: int) -> Any:
        """The coefficient n of the integral of u' y."""
        return total(self.at(k) * y.at(n - k) * k for k in range(1, n + 1)) * (arb(1) / n)

    def _inner(self, y: Growing, n: int, under: Growing) -> Any:
        """The coefficient n of the integral of u'/under, from those before."""
        before = total(y.at(k) * under.at(n - k) * k for k in range(1, n))
        return (self.at(n) - before * (arb(1) / n)) * (1 / under.first())


def led(first: Any, rule: Rule) -> Growing:
    """A series with this constant term."""
    return Growing(lambda y, n: rule(y, n) if n else arb_poly([first]))


def total(parts: Any) -> Any:
    return sum(parts, arb_poly([0]))
