"""`Certified`: a real number with a radius within which the true value lies, made from a ball."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any


@dataclass(frozen=True)
class Certified:
    """A real number known to lie within `radius` of `value`.

    Attributes
    ----------
    value, radius : mpmath numbers. digits : how many significant digits were asked for.
    """

    value: Any
    radius: Any
    digits: int

    def __str__(self) -> str:
        return _text(self.value, self.digits)

    def as_dict(self) -> dict[str, str]:
        """value and radius as decimal text; the radius covers the rounding of the text, which has two more digits."""
        import mpmath

        with mpmath.workprec(64):
            radius = 1.01 * (self.radius + abs(self.value) * mpmath.mpf(10) ** (-self.digits - 1))
            return {"value": _text(self.value, self.digits + 2), "radius": _text(radius, 3)}

    def contains(self, number: Any) -> bool:
        """Whether a number, taken exactly, lies within the radius.

        Examples
        --------
        >>> import mpmath
        >>> third = Certified(mpmath.mpf(1) / 3, mpmath.mpf("1e-15"), 15)
        >>> third.contains(Fraction(1, 3)), third.contains(0.3)
        (True, False)
        """
        from singimpact.algebra.numbers import exact

        return abs(exact("value", self.value) - exact("number", number)) <= exact("radius", self.radius)


def _text(value: Any, digits: int) -> str:
    import mpmath

    return str(mpmath.nstr(value, digits, strip_zeros=False))


def as_certified(ball: Any, digits: int) -> Certified | None:
    """A ball as a certified number; None when it is too wide for so many significant digits.

    What a ball does not tell from zero passes when it is far below the digits asked for.
    """
    import mpmath

    if not ball.is_finite():
        return None
    value, radius = _exact(ball.mid()), _exact(ball.rad())
    with mpmath.workprec(64):
        small = mpmath.mpf(10) ** -digits
        narrow = 2 * radius <= small * abs(value) or abs(value) + radius <= small**2
    return Certified(value, radius, digits) if narrow else None


def from_ends(low: Fraction, high: Fraction, digits: int) -> Certified:
    """The certified number that two rationals enclose, the middle rounded and the radius enlarged for it."""
    import mpmath

    middle, half = (low + high) / 2, (high - low) / 2
    with mpmath.workdps(digits + 10):
        value = mpmath.mpf(middle.numerator) / middle.denominator
    from singimpact.algebra.numbers import exact

    off = half + abs(exact("value", value) - middle)
    with mpmath.workprec(64):
        radius = mpmath.mpf(off.numerator) / off.denominator * (1 + mpmath.mpf(2) ** -50)
    return Certified(value, radius, digits)


def _exact(number: Any) -> Any:
    """The mpmath number that an exact ball is, with all its bits."""
    import mpmath

    mantissa, exponent = number.man_exp()
    with mpmath.workprec(int(mantissa).bit_length() + 8):
        return mpmath.ldexp(mpmath.mpf(int(mantissa)), int(exponent))
