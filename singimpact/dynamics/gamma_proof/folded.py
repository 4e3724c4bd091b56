"""Taylor models: polynomials in S and in d = lambda - lambda_0 whose last coefficients are balls for whole intervals.

f(S, d) lies in f_0 + ... + f_D S^D for 0 <= S <= s0, each f_i in p_0 + p_1 d + p_2 d^2 for |d| <= h.  The coefficients
below the last power, of S and of d, are those of f; what a product has beyond it is folded into the last one.
A model is one polynomial in which S is z^n and d is z, so that flint multiplies both variables at once.
"""

from dataclasses import dataclass
from typing import Any

from flint import arb, arb_poly


def symmetric(bound: Any) -> Any:
    """All numbers of at most this size."""
    return arb(0, arb(bound.upper()))


def between(low: Any, high: Any) -> Any:
    """The smallest ball round two numbers."""
    return arb(low).union(arb(high))


@dataclass(frozen=True)
class Models:
    """Arithmetic of Taylor models.

    Parameters
    ----------
    D : the last power of S. s0 : S <= s0, a ball. h : |d| <= h, a ball; 0 for one lambda. order : the last power of d.
    """

    D: int
    s0: Any
    h: Any
    order: int

    @property
    def stride(self) -> int:
        """The power of z that S is."""
        return 2 * self.order + 1

    @property
    def S(self) -> Any:
        """The model of S."""
        return arb_poly([0] * self.stride + [1])

    def model(self, rows: list[list[Any]]) -> Any:
        """The model with these coefficients, by power of S and of d."""
        pad = [arb(0)] * self.stride
        return arb_poly([part for row in rows for part in (row + pad)[: self.stride]])

    def folded_last(self, ball: Any) -> Any:
        """The model of a ball times S^D."""
        return self.model([[arb(0)]] * self.D + [[ball]])

    def row(self, p: Any, i: int) -> list[Any]:
        """The coefficients of S^i by power of d."""
        return [p[i * self.stride + k] for k in range(self.order + 1)]

    def range(self, p: Any, i: int) -> Any:
        """The coefficient of S^i for all d."""
        return self.value(self.row(p, i))

    def value(self, row: list[Any]) -> Any:
        """A polynomial in d for all d; of a quadratic from its ends and its vertex."""
        whole, d = arb(0), symmetric(self.h)
        for part in reversed(row[1:]):
            whole = (whole + part) * d
        return row[0] + whole

    def mul(self, p: Any, q: Any) -> Any:
        """The product of two models."""
        c, n, m = (p * q).coeffs(), self.stride, self.order
        if n == 1 and len(c) <= self.D + 1:
            return arb_poly(c)
        rows = [c[i : i + n] for i in range(0, len(c), n)]
        if m:
            rows = [self._narrow(row) for row in rows]
        if len(rows) > self.D + 1:
            last, power = list(rows[self.D]), arb(1)
            for row in rows[self.D + 1 :]:
                power = power * self.s0
                w = between(0, power)
                last = [a + b * w for a, b in zip(last, row, strict=False)] + last[len(row) :]
            rows = [*rows[: self.D], last]
        return self.model(rows)

    def _narrow(self, row: list[Any]) -> list[Any]:
        m = self.order
        if len(row) <= m + 1:
            return [*row, *[arb(0)] * (m + 1 - len(row))]
        extra, d = arb(0), symmetric(self.h)
        for part in reversed(row[m + 1 :]):
            extra = (extra + part) * d
        return [*row[:m], row[m] + extra]

    def reciprocal(self, row: list[Any]) -> list[Any]:
        """1/f of a polynomial f in d, f_0 (1 + d v): 1 - d v + d^2 (v^2 - d v^3/(1 + d v)) over f_0."""
        first = 1 / row[0]
        if not self.order:
            return [first]
        v = [coefficient * first for coefficient in row[1:]]
        flat, d = self.value(v), symmetric(self.h)
        linear = self._narrow([arb(1), *(-coefficient for coefficient in v)])
        square = self._narrow(list((arb_poly(v) * arb_poly(v)).coeffs()) or [arb(0)])
        rest = d * flat**3 / (1 + d * flat)
        bent = self._narrow([arb(0), arb(0), square[0] - rest, *square[1:]])
        return [(a + b) * first for a, b in zip(linear, bent, strict=True)]

    def compose(self, rows: list[Any], q: Any) -> Any:
        """sum of p_i(d) q^i; the p_i are models that do not contain S."""
        z = arb_poly([0])
        for part in reversed(rows):
            z = self.mul(z, q) + part
        return z
