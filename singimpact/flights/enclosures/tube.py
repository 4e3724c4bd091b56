"""A function known as a polynomial and a bound of the distance from it; and what balls are read as."""

from __future__ import annotations

from typing import Any


class Tube:
    """A function within sum e s^k of a polynomial on [0, h], with (e, k) its errors.

    Examples
    --------
    >>> import flint
    >>> tube = Tube(flint.arb_poly([1, 2]), ((flint.arb(1) / 8, 2),))
    >>> print(tube(flint.arb(1)))
    [3e+0 +/- 0.126]
    """

    __slots__ = ("_whole", "errors", "polynomial")

    def __init__(self, polynomial: Any, errors: tuple[tuple[Any, int], ...]) -> None:
        import flint

        self.polynomial, self.errors, self._whole = polynomial, errors, polynomial
        # an error e s^k is a ball in the coefficient of s^k: one evaluation then gives polynomial and errors
        for e, k in errors:
            self._whole += flint.arb_poly([*[0] * k, ball(e)])

    def __call__(self, s: Any) -> Any:
        return self._whole(s)


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
    return abs(value).upper()


def ball(bound: Any) -> Any:
    """The ball round 0 of a radius."""
    import flint

    return flint.arb(0, upper(bound))


def centre(value: Any) -> Any:
    """The midpoint of a ball, exact."""
    import flint

    return flint.arb(value.mid())
