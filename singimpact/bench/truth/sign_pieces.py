"""The first root of a polynomial that is known up to a bound, on pieces where its sign or its slope is certain."""

from __future__ import annotations

from typing import Any


class Refused(ArithmeticError):
    """A flight that balls of the precision at hand do not decide."""


def first_root(polynomial: Any, bounds: tuple[Any, Any], length: Any, bits: int) -> Any:
    """The first root on (0, length] of a function that is positive at 0, as a ball.

    Parameters
    ----------
    polynomial : within `bounds` of the function and of its slope.
    bits : a piece shorter than length 2^(-2 bits/3) that is not decided is a graze.

    Returns
    -------
    ball : that holds exactly one root, the first; None when there is none; "end" when the sign at `length` is open.

    Notes
    -----
    Existence is a change of sign where the slope is negative. Newton's method only narrows what is already shown.
    """
    from flint import arb

    derivative, error, slope_error = polynomial.derivative(), arb(0, bounds[0]), arb(0, bounds[1])

    def value(s: Any) -> Any:
        return polynomial(s) + error

    def slope(s: Any) -> Any:
        return derivative(s) + slope_error

    stack, least = [(arb(0), length)], length * arb(2) ** (-2 * bits // 3)
    while stack:
        begin, end = stack.pop()
        piece = begin.union(end)
        middle, steepness = arb((begin + (end - begin) * 0.4817).mid()), slope(piece)
        rises = steepness > 0 and value(begin) > 0
        if rises or value(middle) + steepness * (piece - middle) > 0:
            continue
        if steepness < 0:
            last = value(end)
            if last > 0:
                continue
            if last < 0 and value(begin) > 0:
                return _narrowed(piece, value, slope)
            if not stack:
                return "end"
            # the root lies where two pieces meet: they are made to meet elsewhere
            _, after = stack.pop()
            end = arb((end + (after - end) * 0.3).mid())
            stack += [(end, after), (begin, end)]
            if after - begin < least:
                raise Refused(f"x - c and x' both vanish near {float(begin.mid()):.6g}, as far as the digits tell")
            continue
        if end - begin < least:
            raise Refused(f"x - c and x' both vanish near {float(begin.mid()):.6g}, as far as the digits tell")
        stack += [(middle, end), (begin, middle)]
    return None


def _narrowed(piece: Any, value: Any, slope: Any) -> Any:
    """A smaller ball with the one root of a piece."""
    from flint import arb

    for _ in range(100):
        middle = arb(piece.mid())
        smaller = piece.intersection(middle - value(middle) / slope(piece))
        if smaller.rad() * 1.5 > piece.rad():
            return smaller
        piece = smaller
    return piece
