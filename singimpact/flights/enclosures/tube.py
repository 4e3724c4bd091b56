"""A function known as a polynomial and a bound of the distance from it; and what balls are read as."""

from __future__ import annotations

from typing import Any, NamedTuple


class Tube(NamedTuple):
    """A function within sum e s^k of a polynomial on [0, h], with (e, k) its errors.

    Examples
    --------
    >>> import flint
    >>> tube = Tube(flint.arb_poly([1, 2]), ((flint.arb(1) / 8, 2),))
    >>> print(tube(flint.arb(1)))
    [3e+0 +/- 0.126]
    """

    polynomial: Any
    errors: tuple[tuple[Any, int], ...]

    def __call__(self, s: Any) -> Any:
        return self.polynomial(s) + ball(sum((e * s**k for e, k in self.errors), s * 0))


def height(coefficients: list[Any], bound: Any) -> Tube:
    """z on a step: |z - P| <= K s^(n+1)/(n+1), n the degree of P."""
    import flint

    n = len(coefficients) - 1
    return Tube(flint.arb_poly(coefficients), ((bound / (n + 1), n + 1),))


def speed(coefficients: list[Any], bound: Any) -> Tube:
    """z' on a step: |z' - P'| <= K s^n."""
    import flint

    return Tube(flint.arb_poly(coefficients).derivative(), ((bound, len(coefficients) - 1),))


def divided(tube: Tube, slope: Tube, removed: int) -> tuple[Tube, Tube]:
    """y = z/s^p and y' = (z' - p z/s)/s^p, where the first p coefficients of z are exactly 0."""
    import flint

    y = flint.arb_poly([tube.polynomial[k] for k in range(removed, tube.polynomial.degree() + 1)])
    value = tuple((e, k - removed) for e, k in tube.errors)
    rate = tuple((e, k - removed) for e, k in slope.errors)
    rate += tuple((removed * e, k - removed - 1) for e, k in tube.errors)
    return Tube(y, value), Tube(y.derivative(), rate)


def upper(value: Any) -> Any:
    """An exact upper bound of the modulus of a ball or of a complex ball."""
    import flint

    return flint.arb(abs(value).upper())


def ball(bound: Any) -> Any:
    """The ball round 0 of a radius."""
    import flint

    return flint.arb(0, upper(bound))


def centre(value: Any) -> Any:
    """The midpoint of a ball, exact."""
    import flint

    return flint.arb(value.mid())
