"""A truncated power series in one variable: its coefficients, its value, and how far it may be trusted."""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil, inf
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.certified import Certified, as_certified
from singimpact.algebra.precision import Ladder, digits_at, for_user, kept_property
from singimpact.algebra.solving import halved
from singimpact.algebra.univariate import precision_of
from singimpact.handed_on import flint, sympy
from singimpact.inputs import InputError, refuse


@dataclass(frozen=True)
class TrustSettings:
    """Settings of the estimate of terms beyond those that are computed, which `valid_within` uses.

    root : part of the radius estimated from the last terms that is used; 0.7 holds on the reference models with margin.
    further : terms beyond the last one that are computed for the judgement; enough to see past zeros by parity.
    tail : the share of the tolerance that the known terms of the tail may use.
    """

    root: float = 0.7
    further: int = 12
    tail: float = 0.5


TRUST = TrustSettings()


@dataclass(frozen=True)
class PowerSeries:
    """sum coefficients[n] variable^n for n up to `order`.

    Attributes
    ----------
    variable : the letter. order : the last power kept.
    coefficients : n -> sympy expression, or mpmath number for a model without exact numbers; zeros may be left out.
    digits : of the numbers.
    further : sizes of the coefficients beyond the order, for `valid_within`; empty for a series with symbols.
    numbers : gives the coefficients as mpmath numbers, when they are long exact expressions.
    enclosures : gives them as certified numbers with so many digits.

    Examples
    --------
    >>> import sympy
    >>> series = PowerSeries("sigma", 3, {1: sympy.Integer(2), 3: sympy.Rational(1, 2)})
    >>> series.as_expr(), series[2]
    (sigma**3/2 + 2*sigma, 0)
    """

    variable: str
    order: int
    coefficients: Mapping[int, Any]
    digits: int = 30
    further: Mapping[int, float] = field(default_factory=dict, repr=False)
    numbers: Callable[[], Mapping[int, Any]] | None = field(default=None, repr=False, compare=False)
    enclosures: Callable[[int], Mapping[int, Certified]] | None = field(default=None, repr=False, compare=False)

    def __getitem__(self, power: int) -> Any:
        if isinstance(power, bool) or not isinstance(power, int) or not 0 <= power <= self.order:
            raise refuse("power", power, f"a whole number from 0 to {self.order}: the series is cut there")
        return self.coefficients[power] if power in self.coefficients else sympy.Integer(0)

    def __len__(self) -> int:
        return self.order + 1

    def __call__(self, value: Any) -> Any:
        """The value of the truncated series, by Horner's rule; at a sympy object exactly, at a number by numbers."""
        exact = self.numbers is None or hasattr(value, "free_symbols")
        known = self.coefficients if exact else self._numbers
        total = value * 0
        for power in range(self.order, -1, -1):
            total = total * value + known.get(power, 0)
        return total

    @kept_property
    def _numbers(self) -> Mapping[int, Any]:
        return self.coefficients if self.numbers is None else self.numbers()

    def certified(self, digits: int | None = None) -> dict[int, Certified]:
        """n -> coefficient with a certified radius, from balls; `digits` significant ones, else as many as the series has.

        Raises
        ------
        InputError : the series has symbols.
        """  # noqa: E501
        if self.enclosures is None:
            raise InputError("certified needs numbers: the coefficients of this series have symbols; give model=")
        return dict(self.enclosures(self.digits if digits is None else digits))

    def as_expr(self) -> Any:
        """The series as a sympy expression in its variable."""
        letter = sympy.Symbol(self.variable)
        shown = {
            n: sympy.Float(c, self.digits) if hasattr(c, "_mpf_") and not hasattr(c, "free_symbols") else c
            for n, c in self.coefficients.items()
        }
        return sympy.Add(*(value * letter**power for power, value in shown.items()))

    def _repr_latex_(self) -> str:
        return f"${self._latex()}$"

    def _latex(self, printer: object = None) -> str:  # noqa: ARG002
        """The series in the paper's letters, for `sympy.latex`."""
        from singimpact.theory.notation import joined, latex, name_of

        letter = sympy.Symbol(self.variable)
        terms = sorted(sympy.Add.make_args(self.as_expr()), key=lambda term: term.as_coeff_exponent(letter)[1])
        return joined([*map(latex, terms), rf"O({name_of(letter)}^{{{self.order + 1}}})"])

    def valid_within(self, tolerance: float) -> float:
        """A radius within which the cut series is off by at most `tolerance`, and by `tolerance` times its value.

        Parameters
        ----------
        tolerance : > 0.

        Raises
        ------
        InputError : the series has symbols, so it has no radius.

        Notes
        -----
        An estimate from the terms that follow, not a proof: they are computed, and what lies beyond them is judged by
        the radius of convergence that they show, less a margin.  The suite measures it against series of order 48.
        """
        if not isinstance(tolerance, int | float) or isinstance(tolerance, bool) or not 0 < tolerance < inf:
            raise refuse("tolerance", tolerance, "a number > 0")
        if not self.further:
            raise InputError("valid_within needs numbers: the coefficients of this series have symbols; give model=")
        sizes = {n: abs(float(c)) for n, c in self._numbers.items()}
        every = {**sizes, **dict(self.further)}
        # the radius of convergence that the last terms show, by roots: the least of them
        roots = (size ** (-1 / n) for n, size in every.items() if size and n >= max(every) // 2)
        most = TRUST.root * min(roots, default=inf)
        return inf if most == inf else halved(lambda radius: self._good(radius, tolerance, sizes), 0.0, most)[0]

    def _good(self, radius: float, tolerance: float, sizes: Mapping[int, float]) -> bool:
        lead = min(n for n, size in sizes.items() if size)
        value = sizes[lead] * radius**lead - sum(size * radius**n for n, size in sizes.items() if n > lead)
        tail = sum(size * radius**n for n, size in self.further.items())
        last = max(self.further)
        beyond = (
            TRUST.root ** (last + 1)
            / (1 - TRUST.root)
            * max((size * (radius / TRUST.root) ** n for n, size in self.further.items()), default=0.0)
        )
        return tail + beyond <= TRUST.tail * tolerance * min(1.0, value)


# Certified digits: a computation in balls is done again with more bits until each result has its digits.

MOST_DIGITS = 2000  # that are given
MOST_BITS = 1 << 16  # that are worked with, reached when a result cancels


def with_digits(
    compute: Callable[[Balls], Any],
    digits: int,
    show: Callable[[Any, int], Any],
    balls_in: Callable[[Any], Iterable[Any]] = lambda enclosure: enclosure.values(),
) -> Any:
    """The numbers of `compute(ring)` in balls, at growing precision until each number has its digits.

    Parameters
    ----------
    show : makes the result of what was computed and the digits. balls_in : its numbers.
    """
    if isinstance(digits, bool) or not isinstance(digits, int) or not 1 <= digits <= MOST_DIGITS:
        raise refuse("digits", digits, f"an integer from 1 to {MOST_DIGITS}")
    for bits in Ladder(ceil(digits * 3.33) + 128, MOST_BITS):
        with precision_of(Balls(bits)):
            enclosure = compute(Balls(bits))
        if all(as_certified(ball, digits) is not None for ball in balls_in(enclosure)):
            return show(enclosure, digits)
    raise InputError(f"{digits} digits are not reached with {MOST_BITS} bits: ask for fewer, or a lower order")


def all_certified(found: Mapping[int, flint.arb], digits: int) -> dict[int, Certified | None]:
    """Every ball of a series as a value with a radius."""
    return {n: as_certified(ball, digits) for n, ball in found.items()}


def all_digits(found: Mapping[int, flint.arb], digits: int) -> dict[int, Any]:
    """Every ball of a series as an mpmath number."""
    return {n: as_digits(ball, digits) for n, ball in found.items()}


def as_digits(ball: flint.arb, digits: int) -> Any:
    """A ball as an mpmath number with this many digits; zero when it holds zero, for then it is far below them."""
    with digits_at(digits + 3) as mp:
        value = Fraction(0) if ball.contains(0) else as_rational(ball)
        return for_user(mp.mpf(value.numerator) / value.denominator)


def sympy_digits(ball: flint.arb, digits: int) -> Any:
    """A ball as a sympy Float with this many digits."""
    return sympy.Float(as_digits(ball, digits), digits)
