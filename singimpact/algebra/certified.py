"""`Certified`: a real number with a radius within which the true value lies, made from a ball."""

from dataclasses import dataclass
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

from singimpact.algebra.numbers import exact
from singimpact.algebra.precision import bits_at, digits_at, for_user, negative


@dataclass(frozen=True)
class Certified:
    """A real number known to lie within `radius` of `value`.

    Attributes
    ----------
    value, radius : mpmath numbers. digits : how many significant digits were asked for.

    Examples
    --------
    >>> import mpmath
    >>> Certified(mpmath.mpf(1) / 3, mpmath.mpf("1e-16"), 15)
    Certified(0.333333333333333 +- 1.0e-16)
    """

    value: Any
    radius: Any
    digits: int

    def __str__(self) -> str:
        return text_of(self.value, self.digits)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self} +- {text_of(self.radius, 2)})"

    def as_dict(self) -> dict[str, str]:
        """value and radius as decimal text; the radius covers the rounding of the text, which has two more digits.

        Examples
        --------
        >>> import mpmath
        >>> Certified(mpmath.mpf(0), mpmath.mpf(0), 20).as_dict()
        {'value': '0.0', 'radius': '1.01e-21'}
        """
        with bits_at(64) as mp:
            value, radius, unit = mp.convert(self.value), mp.convert(self.radius), mp.mpf(10) ** (-self.digits - 1)
            # a ball of one point would be no ball for another enclosure to lie in
            radius = 1.01 * (radius + abs(value) * unit or unit)
            return {"value": text_of(self.value, self.digits + 2), "radius": text_of(radius, 3)}

    @property
    def negative(self) -> "Certified":
        """The number times -1.

        Examples
        --------
        >>> import mpmath
        >>> Certified(mpmath.mpf("0.5"), mpmath.mpf("1e-16"), 15).negative
        Certified(-0.500000000000000 +- 1.0e-16)
        """
        return Certified(negative(self.value), self.radius, self.digits)

    def contains(self, number: Any) -> bool:
        """Whether a number, taken exactly, lies within the radius.

        Examples
        --------
        >>> import mpmath
        >>> third = Certified(mpmath.mpf(1) / 3, mpmath.mpf("1e-15"), 15)
        >>> third.contains(Fraction(1, 3)), third.contains(0.3)
        (True, False)
        """
        return abs(exact("value", self.value) - exact("number", number)) <= exact("radius", self.radius)


def text_of(value: Any, digits: int) -> str:
    """An mpmath number as decimal text of so many significant digits, whatever the precision that is set."""
    from mpmath.libmp import to_str

    return str(to_str(value._mpf_, digits, strip_zeros=False))


def as_certified(ball: Any, digits: int) -> Certified | None:
    """A ball as a certified number; None when it is too wide for so many significant digits.

    What a ball does not tell from zero passes when it is far below the digits asked for.
    """
    if not ball.is_finite():
        return None
    number = from_ball(ball, digits)
    with bits_at(64) as mp:
        value, radius = mp.convert(number.value), mp.convert(number.radius)
        small = mp.mpf(10) ** -digits
        narrow = 2 * radius <= small * abs(value) or abs(value) + radius <= small**2
    return number if narrow else None


def from_ball(ball: Any, digits: int) -> Certified:
    """A finite ball as a certified number, however wide; `digits` are those that it prints.

    Examples
    --------
    >>> import flint
    >>> from_ball(flint.arb("1.5", "0.25"), 3)
    Certified(1.50 +- 0.25)
    """
    return Certified(_exact(ball.mid()), _exact(ball.rad()), digits)


def from_ends(low: Fraction, high: Fraction, digits: int) -> Certified:
    """The certified number that two rationals enclose, the middle rounded and the radius enlarged for it."""
    middle, half = (low + high) / 2, (high - low) / 2
    with digits_at(digits + 10) as mp:
        value = mp.mpf(middle.numerator) / middle.denominator
    off = half + abs(exact("value", value) - middle)
    with bits_at(64) as mp:
        radius = mp.mpf(off.numerator) / off.denominator * (1 + mp.mpf(2) ** -50)
    return Certified(for_user(value), for_user(radius), digits)


def _exact(number: Any) -> Any:
    """The mpmath number that an exact ball is, with all its bits, whatever the precision that is set."""
    from mpmath.libmp import from_man_exp

    mantissa, exponent = number.man_exp()
    return for_user(SimpleNamespace(_mpf_=from_man_exp(int(mantissa), int(exponent))))
