"""Power series whose coefficients are polynomials, each coefficient made when it is asked for.

The coefficients of a motion are known one after the other; f of it is asked for as far as they go.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from flint import arb, arb_poly

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
