"""The expansion of an expression in rational powers of one variable w > 0 at 0, exact: w - 3/10 w^(6/5), say.

Coefficients are constant trees, so pi and sqrt(2) may occur in them; their signs are decided by balls.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, reduce
from math import factorial, prod

from singimpact.algebra.expressions import (
    MINUS_ONE,
    ONE,
    ZERO,
    Call,
    Expression,
    Name,
    Number,
    Power,
    Product,
    Sum,
    add,
    evaluate,
    multiply,
    names_in,
    number,
    power,
    walk,
)
from singimpact.algebra.numbers import sign_of
from singimpact.algebra.rings import EXACT
from singimpact.inputs import InputError, need


class NoExpansion(ArithmeticError):
    """The expression has no expansion in rational powers with real coefficients at 0."""


@dataclass(frozen=True)
class Puiseux:
    """c_1 w^e_1 + c_2 w^e_2 + ..., e_1 < e_2 < ... .

    Parameters
    ----------
    terms : pairs (exponent, coefficient other than 0), exponents increasing.
    bound : what is left out begins with this power or a higher one; None where nothing is left out.
    """

    terms: tuple[tuple[Fraction, Expression], ...]
    bound: Fraction | None = None

    @property
    def lead(self) -> tuple[Fraction, Expression]:
        """The first term.

        Raises
        ------
        NoExpansion : no term is known.
        """
        need(self.terms, NoExpansion("no term is known"))
        return self.terms[0]

    @property
    def whole(self) -> bool:
        """Whether every exponent that is known is a whole number >= 0."""
        return all(exponent.denominator == 1 and exponent >= 0 for exponent, _ in self.terms)

    def __str__(self) -> str:
        parts = [f"{c}*w**({e})" if str(c).isdigit() else f"({c})*w**({e})" for e, c in self.terms]
        return " + ".join([*parts, *([f"O(w**({self.bound}))"] if self.bound is not None else [])]) or "0"


def expansion(tree: Expression, variable: str, sign: int = 1, count: int = 6) -> Puiseux:
    """The first terms of a tree in one variable, at 0 from one side.

    Parameters
    ----------
    tree : with this name alone. sign : the variable is sign w, w > 0. count : terms kept of every part.

    Raises
    ------
    NoExpansion : log(0), an even root of a negative number, powers that are not rational, or terms that all cancel.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> print(expansion(parse("-v*(1 - 0.3*(-v)**(1/5))", ["v"]), "v", -1))
    1*w**(1) + (-0.3)*w**(6/5)
    >>> print(expansion(parse("sin(sqrt(v))/v", ["v"]), "v", 1, 3))
    1*w**(-1/2) + (-1/6)*w**(1/2) + O(w**(1))
    """
    return _Expander(variable, sign, count).of(tree)


@dataclass(frozen=True)
class _Expander:
    variable: str
    sign: int
    count: int

    def of(self, tree: Expression) -> Puiseux:
        if self.variable not in names_in(tree):
            return self.kept({Fraction(0): tree}, None)
        match tree:
            case Name():
                return self.kept({Fraction(1): number(self.sign)}, None)
            case Sum(terms):
                return reduce(self.sum, map(self.of, terms))
            case Product(factors):
                return reduce(self.product, map(self.of, factors))
            case Power(base, Number(exponent)):
                return self.raised(self.of(base), exponent)
            case Power(base, exponent_tree):
                logarithm = self.product(self.of(exponent_tree), self.called("log", self.of(base)))
                return self.called("exp", logarithm)
            case Call("sqrt", argument):
                return self.raised(self.of(argument), Fraction(1, 2))
            case Call(function, argument):
                return self.called(function, self.of(argument))
        raise NoExpansion(f"{tree} is not expanded")

    def kept(self, terms: dict[Fraction, Expression], bound: Fraction | None) -> Puiseux:
        """The terms below the bound that are not 0, the first of them."""
        powers: list[tuple[Fraction, Expression]] = []
        for exponent in sorted(terms):
            if bound is not None and exponent >= bound:
                break
            value = _plain(terms[exponent])
            if value == ZERO:
                continue
            if len(powers) == self.count:
                return Puiseux(tuple(powers), exponent)
            powers.append((exponent, value))
        return Puiseux(tuple(powers), bound)

    def sum(self, left: Puiseux, right: Puiseux) -> Puiseux:
        total = dict(left.terms)
        for exponent, value in right.terms:
            total[exponent] = add(total[exponent], value) if exponent in total else value
        return self.kept(total, _least(left.bound, right.bound))

    def product(self, left: Puiseux, right: Puiseux) -> Puiseux:
        total: dict[Fraction, Expression] = {}
        for e, c in left.terms:
            for f, d in right.terms:
                total[e + f] = add(total[e + f], multiply(c, d)) if e + f in total else multiply(c, d)
        return self.kept(total, _least(_shifted(left, right), _shifted(right, left)))

    def raised(self, base: Puiseux, exponent: Fraction) -> Puiseux:
        """base^exponent = c^n w^(n e) (1 + u)^n by the binomial series."""
        if not base.terms and base.bound is None and exponent > 0:
            return base
        first, value = base.lead
        if exponent.denominator > 1 and sign_of(value) < 0:
            raise NoExpansion("a root of a negative number")
        if abs(exponent) > EXPONENTS and exponent.denominator == 1 and not isinstance(value, Number):
            raise NoExpansion("a large power")
        head = Puiseux(((first * exponent, _power(value, exponent)),))
        terms = {e - first: multiply(c, power(value, MINUS_ONE)) for e, c in base.terms[1:]}
        tail = self.kept(terms, None if base.bound is None else base.bound - first)
        return self.product(
            head,
            self.composed(
                tail, lambda k: number(prod(((exponent - i) / (i + 1) for i in range(k)), start=Fraction(1)))
            ),
        )

    def composed(self, u: Puiseux, coefficient: Callable[[int], Expression]) -> Puiseux:
        """sum c_k u^k for u without a constant term."""
        total = self.kept({Fraction(0): coefficient(0)}, None)
        if not u.terms:
            return Puiseux(total.terms, u.bound)
        step, factor = u.lead[0], Puiseux(((Fraction(0), ONE),))
        for k in range(1, self.count + 1):
            factor = self.product(factor, u)
            total = self.sum(total, self.product(Puiseux(((Fraction(0), coefficient(k)),)), factor))
        rest = any(coefficient(k) != ZERO for k in range(self.count + 1, self.count + 3))
        return self.kept(dict(total.terms), _least(total.bound, step * (self.count + 1) if rest else None))

    def called(self, function: str, argument: Puiseux) -> Puiseux:
        """f(c + u) by Taylor's formula; |u| by the sign of its first term."""
        if function == "abs":
            if not argument.terms and argument.bound is None:
                return argument
            return argument if sign_of(argument.lead[1]) > 0 else self.product(_MINUS, argument)
        if argument.terms and argument.terms[0][0] < 0:
            raise NoExpansion(f"{function} of an infinite number")
        if argument.bound is not None and argument.bound <= 0:
            raise NoExpansion("no term is known")
        parts = dict(argument.terms)
        coefficients = _taylor(function, parts.pop(Fraction(0), ZERO), self.count + 2)
        return self.composed(Puiseux(tuple(sorted(parts.items())), argument.bound), lambda k: coefficients[k])


EXPONENTS = 1000  # above this a power of an irrational coefficient costs more digits than a model needs
PARTS = 200  # of a coefficient that is not rational: such coefficients grow with every product
_MINUS = Puiseux(((Fraction(0), MINUS_ONE),))


def _least(left: Fraction | None, right: Fraction | None) -> Fraction | None:
    return min((bound for bound in (left, right) if bound is not None), default=None)


def _shifted(cut: Puiseux, other: Puiseux) -> Fraction | None:
    """Where what `cut` leaves out begins once it is multiplied by `other`."""
    if cut.bound is None:
        return None
    if other.terms:
        return cut.bound + other.terms[0][0]
    return None if other.bound is None else cut.bound + other.bound


def _plain(tree: Expression) -> Expression:
    """A constant as a rational where it is one; ZERO where it is zero."""
    if isinstance(tree, Number):
        return tree
    if sum(1 for _ in walk(tree)) > PARTS:
        raise NoExpansion("the coefficients become too long")
    try:
        return number(Fraction(evaluate(tree, {}, EXACT)))
    except ArithmeticError:
        pass
    try:
        return tree if sign_of(tree) else ZERO
    except InputError as error:
        raise NoExpansion(f"whether {tree} is 0 is not decided") from error


def _power(value: Expression, exponent: Fraction) -> Expression:
    """c^n, as a rational where both c^(1/denominator) and c are."""
    if isinstance(value, Number) and exponent.denominator > 1:
        parts = [_root(part, exponent.denominator) for part in (value.value.numerator, value.value.denominator)]
        if all(part is not None for part in parts):
            return power(number(Fraction(parts[0] or 0, parts[1] or 1)), number(exponent.numerator))
    return power(value, number(exponent))


def _root(value: int, degree: int) -> int | None:
    """The whole root of a small whole number, None where it has none."""
    if value == 1:
        return 1
    if value.bit_length() > 52 or degree > 52:
        return None
    near = round(value ** (1 / degree))
    return near if near**degree == value else None


@lru_cache(maxsize=256)
def _taylor(function: str, start: Expression, count: int) -> tuple[Expression, ...]:
    """f^(k)(start)/k! for k = 0, ..., count, from the differential equation of f."""
    if function == "log" and sign_of(start) <= 0:
        raise NoExpansion(f"log of {start}")
    value = _plain(Call(function, start))
    if function == "exp":
        return tuple(multiply(value, number(Fraction(1, factorial(k)))) for k in range(count + 1))
    if function == "log":
        return (
            value,
            *(multiply(number(Fraction((-1) ** (k + 1), k)), power(start, number(-k))) for k in range(1, count + 1)),
        )
    if function in ("sin", "cos"):
        other = _plain(Call("cos" if function == "sin" else "sin", start))
        turned = multiply(number(1 if function == "sin" else -1), other)
        cycle = value, turned, multiply(MINUS_ONE, value), multiply(MINUS_ONE, turned)
        return tuple(multiply(cycle[k % 4], number(Fraction(1, factorial(k)))) for k in range(count + 1))
    coefficients = [value]
    if function == "atan":  # (1 + z^2) f' = 1
        slopes = [below := power(add(ONE, multiply(start, start)), MINUS_ONE)]
        for k in range(1, count):
            more = slopes[k - 2] if k > 1 else ZERO
            slopes.append(multiply(MINUS_ONE, add(multiply(number(2), start, slopes[k - 1]), more), below))
        return (value, *(multiply(slope, number(Fraction(1, k))) for k, slope in enumerate(slopes, 1)))
    sign = number(1 if function == "tan" else -1)  # f' = 1 + f^2 for tan, 1 - f^2 for tanh
    for k in range(count):
        square = add(*(multiply(coefficients[i], coefficients[k - i]) for i in range(k + 1)))
        slope = add(ONE if k == 0 else ZERO, multiply(sign, square))
        coefficients.append(multiply(slope, number(Fraction(1, k + 1))))
    return tuple(coefficients)
