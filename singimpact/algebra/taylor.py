"""Taylor coefficients of the elementary functions at a point, over any ring, by their differential equations."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from singimpact.inputs import InputError


class NotSmooth(InputError):
    """A function has no Taylor series at the point asked for."""


def taylor_coefficients(
    function: str, start: Any, order: int, ring: Any, exponent: Fraction | None = None
) -> list[Any]:
    """Coefficients c_0..c_order of function(start + h) in powers of h.

    Parameters
    ----------
    function : a name of the whitelist, or "power" with its rational exponent.
    start : ring element. order : int >= 0. ring : the ring of `start`.

    Raises
    ------
    NotSmooth : abs, sqrt, log or a negative or broken power at 0 (for a ball: at a ball that contains 0).

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> [str(c) for c in taylor_coefficients("power", Fraction(2), 2, EXACT, Fraction(-1))]
    ['1/2', '-1/4', '1/8']
    """
    if function in ("power", "sqrt"):
        return _power(start, Fraction(1, 2) if exponent is None else exponent, order, ring)
    return _SERIES[function](start, order, ring)


def dot(left: Sequence[Any], right: Sequence[Any]) -> Any:
    """left[0] right[0] + left[1] right[1] + ..., added in this order, over any ring.

    Examples
    --------
    >>> dot([1, 2], [3, 4])
    11
    """
    total = left[0] * right[0]
    for a, b in zip(left[1:], right[1:], strict=True):
        total = total + a * b
    return total


def _nonzero(function: str, start: Any) -> None:
    if start == 0 or not (start != 0):
        raise NotSmooth(f"{function} has no Taylor series where its argument is 0: the model must be smooth there")


def _power(start: Any, exponent: Fraction, order: int, ring: Any) -> list[Any]:
    _nonzero("a root or a negative power", start)
    inverse = ring.power(start, Fraction(-1))
    terms = [ring.call("sqrt", start) if exponent == Fraction(1, 2) else ring.power(start, exponent)]
    for k in range(order):
        terms.append(terms[-1] * inverse * ring.rational((exponent - k) / (k + 1)))
    return terms


def _exp(start: Any, order: int, ring: Any) -> list[Any]:
    terms = [ring.call("exp", start)]
    for k in range(order):
        terms.append(terms[-1] * ring.rational(Fraction(1, k + 1)))
    return terms


def _circular(start: Any, order: int, ring: Any, first: str) -> list[Any]:
    sine, cosine = ring.call("sin", start), ring.call("cos", start)
    cycle = [sine, cosine, -sine, -cosine] if first == "sin" else [cosine, -sine, -cosine, sine]
    terms, factorial = [], Fraction(1)
    for k in range(order + 1):
        factorial /= max(k, 1)
        terms.append(cycle[k % 4] * ring.rational(factorial))
    return terms


def _log(start: Any, order: int, ring: Any) -> list[Any]:
    _nonzero("log", start)
    terms, inverse, power = [ring.call("log", start)], ring.power(start, Fraction(-1)), ring.rational(Fraction(1))
    for k in range(1, order + 1):
        power = power * inverse
        terms.append(power * ring.rational(Fraction((-1) ** (k - 1), k)))
    return terms


def _riccati(function: str, sign: int, start: Any, order: int, ring: Any) -> list[Any]:
    terms = [ring.call(function, start)]  # y' = 1 + sign y^2
    for k in range(order):
        slope = dot(terms, terms[::-1]) * ring.rational(Fraction(sign)) + ring.rational(Fraction(int(k == 0)))
        terms.append(slope * ring.rational(Fraction(1, k + 1)))
    return terms


def _atan(start: Any, order: int, ring: Any) -> list[Any]:
    one = ring.rational(Fraction(1))  # (1 + u^2) y' = 1 with u = start + h
    inverse = ring.power(one + start * start, Fraction(-1))
    slopes: list[Any] = []
    for k in range(order):
        value = one if k == 0 else one * ring.rational(Fraction(0))
        if k >= 1:
            value = value - start * slopes[k - 1] * ring.rational(Fraction(2))
        if k >= 2:
            value = value - slopes[k - 2]
        slopes.append(value * inverse)
    return [ring.call("atan", start)] + [slopes[k] * ring.rational(Fraction(1, k + 1)) for k in range(order)]


def _abs(start: Any, order: int, ring: Any) -> list[Any]:
    _nonzero("abs", start)
    zero, sign = ring.rational(Fraction(0)), 1 if start > 0 else -1
    slope = [ring.rational(Fraction(sign))] if order else []
    return [ring.call("abs", start), *slope, *[zero] * max(order - 1, 0)]


_SERIES = {
    "exp": _exp,
    "sin": lambda start, order, ring: _circular(start, order, ring, "sin"),
    "cos": lambda start, order, ring: _circular(start, order, ring, "cos"),
    "log": _log,
    "tan": lambda start, order, ring: _riccati("tan", 1, start, order, ring),
    "tanh": lambda start, order, ring: _riccati("tanh", -1, start, order, ring),
    "atan": _atan,
    "abs": _abs,
}
