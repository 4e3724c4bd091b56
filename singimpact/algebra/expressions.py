"""Expression trees of a whitelisted language: exact numbers, pi, names, + - * / ** and a few smooth functions.

A tree is data: it is never run as code.  `evaluate` walks it over a ring (floats, arrays, mpf, balls, jets, sympy).
Trees are immutable, compare and hash by structure, and print as text that parses back to the same tree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from operator import add as add_, mul
from typing import Any, Protocol

from singimpact.handed_on import flint

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "tanh", "atan", "abs")


@dataclass(frozen=True)
class Folding:
    """Limits of the sums and products that are computed as rationals.

    Parameters
    ----------
    bits : of a power that is multiplied out; (1e-300)**17000 has 17 million bits and takes 4 s. rational : bits of a
        sum or product that is written as one number; a product of 1400 factors 1e4000 took 67 s.
    """

    bits: int = 16_000
    rational: int = 100_000


FOLDING = Folding()
PLACES = 60  # digits after the point of a number that is written as a decimal


@dataclass(frozen=True, slots=True)
class Number:
    """An exact rational."""

    value: Fraction

    def __str__(self) -> str:
        return decimal_text(self.value)


@dataclass(frozen=True, slots=True)
class Pi:
    """The number pi."""

    def __str__(self) -> str:
        return "pi"


@dataclass(frozen=True, slots=True)
class Name:
    """A variable or a parameter."""

    name: str

    def __str__(self) -> str:
        return self.name


class Inner:
    """A part that has parts. Its hash and its names are computed once, because all levels of a deep tree are asked."""

    __slots__ = ("_hash", "_names")
    _hash: int
    _names: frozenset[str]

    def _hashed(self) -> int:
        try:
            return self._hash
        except AttributeError:
            parts = tuple(getattr(self, name) for name in type(self).__match_args__)  # type: ignore[attr-defined]
            object.__setattr__(self, "_hash", hash((type(self), parts)))
            return self._hash


@dataclass(frozen=True, slots=True)
class Sum(Inner):
    """terms[0] + terms[1] + ..."""

    terms: tuple[Expression, ...]
    __hash__ = Inner._hashed

    def __str__(self) -> str:
        parts = [str(self.terms[0])]
        for term in self.terms[1:]:
            text = str(term)
            parts.append(f" - {text[1:]}" if text.startswith("-") else f" + {text}")
        return "".join(parts)


@dataclass(frozen=True, slots=True)
class Product(Inner):
    """factors[0] * factors[1] * ...; a factor with exponent -1 prints as a division."""

    factors: tuple[Expression, ...]
    __hash__ = Inner._hashed

    def __str__(self) -> str:
        head, *rest = self.factors
        text = "-" if head == MINUS_ONE and rest and not _inverse_of(rest[0]) else _bracketed(head, first=True)
        for factor in rest:
            inverse = _inverse_of(factor)
            if inverse is not None:
                text += f"/{_bracketed(inverse)}"
            else:
                text += _bracketed(factor) if text == "-" else f"*{_bracketed(factor)}"
        return text


@dataclass(frozen=True, slots=True)
class Power(Inner):
    """base ** exponent."""

    base: Expression
    exponent: Expression
    __hash__ = Inner._hashed

    def __str__(self) -> str:
        base = str(self.base)
        plain = isinstance(self.base, Name | Pi | Call) or (isinstance(self.base, Number) and base.isdigit())
        exponent = str(self.exponent)
        simple = isinstance(self.exponent, Name | Pi) or exponent.isdigit()
        return f"{base if plain else f'({base})'}**{exponent if simple else f'({exponent})'}"


@dataclass(frozen=True, slots=True)
class Call(Inner):
    """function(argument) for a function of the whitelist."""

    function: str
    argument: Expression
    __hash__ = Inner._hashed

    def __str__(self) -> str:
        return f"{self.function}({self.argument})"


@dataclass(frozen=True, slots=True)
class Root:
    """The one zero of a function of u between two rationals: a number without another name; a leaf, for u is bound."""

    function: Expression
    low: Fraction
    high: Fraction

    def __str__(self) -> str:
        return f"root({self.function}, {decimal_text(self.low)}, {decimal_text(self.high)})"


Expression = Number | Pi | Name | Sum | Product | Power | Call | Root
BOUND = "u"  # the variable of the function in a `Root`
ZERO, ONE, MINUS_ONE = Number(Fraction(0)), Number(Fraction(1)), Number(Fraction(-1))


def _inverse_of(factor: Expression) -> Expression | None:
    return factor.base if isinstance(factor, Power) and factor.exponent == MINUS_ONE else None


def _bracketed(part: Expression, first: bool = False) -> str:
    text = str(part)
    if isinstance(part, Sum | Product) or (isinstance(part, Number) and "/" in text):
        return f"({text})"
    return f"({text})" if text.startswith("-") and not first else text


def decimal_text(value: Fraction) -> str:
    """A rational as a terminating decimal if it is short, else as a quotient.

    Examples
    --------
    >>> decimal_text(Fraction(1, 10)), decimal_text(Fraction(1, 3))
    ('0.1', '1/3')
    """
    if value.denominator == 1:
        return _digits(value.numerator)
    rest, twos, fives = value.denominator, 0, 0
    while rest % 2 == 0 and twos <= PLACES:
        rest, twos = rest // 2, twos + 1
    while rest % 5 == 0 and fives <= PLACES:
        rest, fives = rest // 5, fives + 1
    places = max(twos, fives)
    if rest != 1 or places > PLACES:
        return f"{_digits(value.numerator)}/{_digits(value.denominator)}"
    digits = _digits(abs(value.numerator) * 10**places // value.denominator).rjust(places + 1, "0")
    return f"{'-' if value < 0 else ''}{digits[:-places]}.{digits[-places:]}"


def _digits(value: int) -> str:
    try:
        return str(value)
    except ValueError:  # Python writes no more than 4300
        return str(flint.fmpz(value))


def number(value: int | Fraction) -> Number:
    """An exact rational as a tree."""
    return Number(Fraction(value))


def add(*terms: Expression) -> Expression:
    """The sum, with sums flattened and rationals collected, unless their sum is huge."""
    flat = [summand for term in terms for summand in (term.terms if isinstance(term, Sum) else (term,))]
    constant, others = Fraction(0), list[Expression]()
    for summand in flat:
        if isinstance(summand, Number) and _is_short(constant, summand.value):
            constant += summand.value
        else:
            others.append(summand)
    if constant or not others:
        others.append(Number(constant))
    return others[0] if len(others) == 1 else Sum(tuple(others))


def multiply(*factors: Expression) -> Expression:
    """The product, with products flattened and rationals collected in front, unless their product is huge."""
    flat = [operand for factor in factors for operand in (factor.factors if isinstance(factor, Product) else (factor,))]
    constant, others = Fraction(1), list[Expression]()
    for operand in flat:
        if isinstance(operand, Number) and (not operand.value or _is_short(constant, operand.value)):
            constant *= operand.value
        else:
            others.append(operand)
    if not constant:
        return ZERO
    if constant != 1 or not others:
        others.insert(0, Number(constant))
    return others[0] if len(others) == 1 else Product(tuple(others))


def _is_short(left: Fraction, right: Fraction) -> bool:
    """Whether sum and product of two rationals are written as one number."""
    wholes = (left.numerator, left.denominator, right.numerator, right.denominator)
    return sum(whole.bit_length() for whole in wholes) <= FOLDING.rational


def power(base: Expression, exponent: Expression) -> Expression:
    """The power; rational ** integer is folded unless it is huge."""
    if isinstance(exponent, Number):
        if exponent.value == 1:
            return base
        if isinstance(base, Number) and exponent.value.denominator == 1:
            if exponent.value < 0 and not base.value:
                raise ZeroDivisionError("division by zero")
            if bits_of_power(base, exponent) <= FOLDING.bits:
                return Number(base.value ** int(exponent.value))
    return Power(base, exponent)


def bits_of_power(base: Number, exponent: Number) -> Fraction:
    """About how many bits numerator or denominator of rational ** exponent have; 0 of a power of 1, 0 and -1."""
    largest = max(abs(base.value.numerator), base.value.denominator)
    return largest.bit_length() * abs(exponent.value) if largest > 1 else Fraction(0)


def negate(part: Expression) -> Expression:
    """-part."""
    return multiply(MINUS_ONE, part)


def subtract(left: Expression, right: Expression) -> Expression:
    """left - right."""
    return add(left, negate(right))


def children(tree: Expression) -> tuple[Expression, ...]:
    """The direct parts of a tree."""
    match tree:
        case Sum(parts) | Product(parts):
            return parts
        case Power(base, exponent):
            return (base, exponent)
        case Call(_, argument):
            return (argument,)
    return ()


def walk(tree: Expression) -> Iterator[Expression]:
    """Every part of a tree, itself first."""
    stack = [tree]
    while stack:
        part = stack.pop()
        yield part
        stack.extend(children(part))


def names_in(tree: Expression) -> frozenset[str]:
    """The names that occur."""
    if not isinstance(tree, Inner):
        return frozenset((tree.name,)) if isinstance(tree, Name) else frozenset()
    try:
        return tree._names
    except AttributeError:
        object.__setattr__(tree, "_names", frozenset[str]().union(*map(names_in, children(tree))))
        return tree._names


class Ring(Protocol):
    """Operations that `evaluate` needs besides + and * of the values."""

    def rational(self, value: Fraction) -> Any: ...
    def pi(self) -> Any: ...
    def power(self, base: Any, exponent: Fraction) -> Any: ...
    def call(self, function: str, argument: Any) -> Any: ...
    def root(self, tree: Root) -> Any: ...


def evaluate(tree: Expression, values: Mapping[str, Any], ring: Ring) -> Any:
    """The value of a tree over a ring.

    Parameters
    ----------
    tree : the expression.
    values : name -> element of the ring.
    ring : how rationals, pi, powers and functions are made there.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> from singimpact.algebra.rings import EXACT
    >>> evaluate(parse("x**2/4 + 0.5", ["x"]), {"x": Fraction(3)}, EXACT)
    Fraction(11, 4)
    """
    match tree:
        case Number(value):
            return ring.rational(value)
        case Pi():
            return ring.pi()
        case Name(name):
            return values[name]
        case Sum(terms):
            return reduce(add_, (evaluate(term, values, ring) for term in terms))
        case Product(factors):
            return reduce(mul, (evaluate(factor, values, ring) for factor in factors))
        case Power(base, Number(exponent)):
            return ring.power(evaluate(base, values, ring), exponent)
        case Power(base, general):
            logarithm = ring.call("log", evaluate(base, values, ring))
            return ring.call("exp", evaluate(general, values, ring) * logarithm)
        case Call(function, argument):
            return ring.call(function, evaluate(argument, values, ring))
        case Root():
            return ring.root(tree)
    raise TypeError(f"not an expression: {tree!r}")


def function_of(tree: Expression, names: Sequence[str], ring: Ring) -> Callable[..., Any]:
    """The tree as a function of elements of a ring, in the order of `names`: `evaluate` without its walk.

    What is constant is evaluated once; the operations and their order are those of `evaluate`.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> from singimpact.algebra.rings import EXACT
    >>> function_of(parse("x**2/4 + y", ["x", "y"]), ["x", "y"], EXACT)(Fraction(3), 1)
    Fraction(13, 4)
    """
    if not names_in(tree):
        value = evaluate(tree, {}, ring)
        return lambda *_: value
    match tree:
        case Name(name):
            index = names.index(name)
            return lambda *given: given[index]
        case Sum(terms):
            first, *others = (function_of(term, names, ring) for term in terms)

            def summed(*given: Any) -> Any:
                total = first(*given)
                for other in others:
                    total = total + other(*given)
                return total

            return summed
        case Product(factors):
            first, *others = (function_of(factor, names, ring) for factor in factors)

            def multiplied(*given: Any) -> Any:
                total = first(*given)
                for other in others:
                    total = total * other(*given)
                return total

            return multiplied
        case Power(base, Number(exponent)):
            inner = function_of(base, names, ring)
            if exponent.denominator == 1 and 0 < exponent <= 64:
                whole = int(exponent)
                return lambda *given: inner(*given) ** whole
            return lambda *given: ring.power(inner(*given), exponent)
        case Call(function, argument):
            inner = function_of(argument, names, ring)
            return lambda *given: ring.call(function, inner(*given))
    return lambda *given: evaluate(tree, dict(zip(names, given, strict=True)), ring)


def substitute(tree: Expression, values: Mapping[str, Expression]) -> Expression:
    """The tree with names replaced by trees."""
    match tree:
        case Name(name):
            return values.get(name, tree)
        case Sum(parts):
            return add(*(substitute(child, values) for child in parts))
        case Product(parts):
            return multiply(*(substitute(child, values) for child in parts))
        case Power(base, exponent):
            return power(substitute(base, values), substitute(exponent, values))
        case Call(function, argument):
            return Call(function, substitute(argument, values))
    return tree
