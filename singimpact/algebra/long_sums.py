"""Long sums of monomials as sympy objects, built and written without sympy's own passes over every term.

sympy multiplies a term together factor by factor and sorts sums by comparing trees, which takes 0.3 ms a term; here the
factors come sorted and the terms are sorted by keys that give sympy's order.  Loads sympy.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import sympy
from sympy.core.basic import Basic

Exponents = tuple[int, ...]
Key = tuple[Any, ...]

MULTIPLE = 2  # sums sort symbols first, then powers, then products


class Monomials:
    """Sums of monomials in distinct symbols, equal to what sympy makes of them.

    Examples
    --------
    >>> a, b = sympy.symbols("a b")
    >>> made = Monomials([a, b]).summed({(1, 2): sympy.Rational(1, 2), (0, 1): sympy.Integer(3)})
    >>> made, made == a * b**2 / 2 + 3 * b
    (a*b**2/2 + 3*b, True)
    """

    def __init__(self, symbols: Sequence[Any]) -> None:
        self._symbols = list(symbols)
        ranked = sorted(range(len(symbols)), key=lambda n: symbols[n].name)
        self._rank = {n: rank for rank, n in enumerate(ranked)}
        self._factors: dict[tuple[int, int], tuple[Key, Any]] = {}

    def summed(self, terms: Mapping[Exponents, Any]) -> Any:
        """The sum of the terms: exponents, all >= 0 -> sympy rational, not 0."""
        constant = [value for key, value in terms.items() if not any(key)]
        made = [self._term(key, value) for key, value in terms.items() if any(key)]
        if not made:
            return constant[0] if constant else sympy.S.Zero
        made.sort(key=lambda pair: pair[0])
        return sympy.Add._from_args([*constant, *(term for _, term in made)], is_commutative=True)

    def _factor(self, place: int, exponent: int) -> tuple[Key, Any]:
        """A power of a symbol, with the key by which sympy sorts it among others."""
        found = self._factors.get((place, exponent))
        if found is None:
            symbol = self._symbols[place]
            power = symbol if exponent == 1 else sympy.Pow(symbol, exponent)
            found = self._factors[(place, exponent)] = ((int(exponent > 1), self._rank[place], exponent), power)
        return found

    def _term(self, exponents: Exponents, value: Any) -> tuple[Key, Any]:
        factors = sorted(self._factor(place, exponent) for place, exponent in enumerate(exponents) if exponent)
        keys, args = [key for key, _ in factors], [factor for _, factor in factors]
        if value is sympy.S.One:
            if len(args) == 1:
                return keys[0], args[0]
        else:
            keys, args = [_rational_key(value.p, value.q), *keys], [value, *args]
        return (MULTIPLE, len(args), keys), sympy.Mul._from_args(args, is_commutative=True)


SINGLE_CLASSES: dict[tuple[int, int], Key] = {(1, 2): (-4,), (-1, 1): (-3,)}  # rationals with a class of their own


def _rational_key(p: int, q: int) -> Key:
    """The key of a rational: sympy sorts by its classes first, and numbers before symbols."""
    return SINGLE_CLASSES.get((p, q)) or (-2 if q == 1 else -1, p, q)


CLASSES = {
    "Zero": 0,
    "One": 1,
    "Half": 2,
    "NegativeOne": 5,
    "Integer": 7,
    "Rational": 8,
    "Symbol": 13,
    "Pow": 15,
    "Mul": 16,
    "Add": 17,
}
"""Places of sympy's classes in the order of its arguments."""


def order_key(expression: Any) -> Key:
    """The key by which sympy sorts expressions of rationals, plain symbols, powers, products and sums.

    Examples
    --------
    >>> x, y = sympy.symbols("x y")
    >>> parts = [y**2 + x, y**3, x, 1 / (x + 1), sympy.Rational(2, 3)]
    >>> tuple(sorted(parts, key=order_key)) == sympy.Mul(*parts).args
    True
    """
    rank = CLASSES[type(expression).__name__]
    if rank < CLASSES["Symbol"]:
        return rank, expression.p, expression.q
    if rank == CLASSES["Symbol"]:
        return rank, expression.name
    if rank == CLASSES["Add"]:
        return rank, len(expression.args), _Terms(expression)
    return rank, len(expression.args), *(order_key(argument) for argument in expression.args)


class _Terms:
    """The keys of the terms of a sum, found when two sums of one length are compared: most are told apart before."""

    __slots__ = ("_keys", "total")

    def __init__(self, total: Any) -> None:
        self.total = total
        self._keys: list[Key] | None = None

    def keys(self) -> list[Key]:
        if self._keys is None:
            self._keys = [order_key(part) for part in self.total.args]
        return self._keys

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Terms) and (self.total is other.total or self.keys() == other.keys())

    def __lt__(self, other: "_Terms") -> bool:
        return self.keys() < other.keys()

    __hash__ = None  # type: ignore[assignment]


def polynomial(symbol: Any, coefficients: Sequence[tuple[int, int]]) -> Any:
    """The polynomial in a symbol with these coefficients, from the constant one: numerators and denominators without
    common factor.

    Examples
    --------
    >>> x = sympy.Symbol("x")
    >>> polynomial(x, [(1, 2), (0, 1), (-3, 1)]) == sympy.Rational(1, 2) - 3 * x**2
    True
    """
    powers = _powers(symbol, len(coefficients))
    monomials = []
    for n, (p, q) in enumerate(coefficients[1:], 1):
        power = (int(n > 1), n)
        if p:
            monomials.append(
                ((0, *power), n, p, q) if p == q == 1 else ((MULTIPLE, _rational_key(p, q), *power), n, p, q)
            )
    monomials.sort()
    parts = [sympy.Rational(*coefficients[0])] if coefficients[0][0] else []
    for _, n, p, q in monomials:
        power = powers[n]
        value = sympy.Integer(p) if q == 1 else sympy.Rational.from_coprime_ints(p, q)
        parts.append(power if p == q == 1 else sympy.Mul._from_args([value, power], is_commutative=True))
    return sympy.Add._from_args(parts, is_commutative=True)


@lru_cache(maxsize=64)
def _powers(symbol: Any, count: int) -> list[Any]:
    """The powers of a symbol, from 1 on."""
    return [sympy.Pow(symbol, n) for n in range(count)]


class Products:
    """Sums of products of a rational and of distinct bases to whole powers, equal to what sympy makes of them.

    Examples
    --------
    >>> a, x = sympy.symbols("a x")
    >>> made = Products()
    >>> made.summed([made.term(sympy.Rational(2, 3), [(1 + x, -2), (a, 1)]), made.term(sympy.S.One, [(a, 2)])])
    a**2 + 2*a/(3*(x + 1)**2)
    """

    def __init__(self) -> None:
        self._powers: dict[tuple[Any, int], tuple[Key, Any]] = {}

    def term(self, coefficient: Any, factors: Sequence[tuple[Any, int]]) -> tuple[Key, Any]:
        """One product, with the key by which sympy sorts it; the coefficient is not 0."""
        parts = sorted((self._power(base, exponent) for base, exponent in factors), key=lambda pair: pair[0])
        if coefficient is not sympy.S.One:
            parts.insert(0, (order_key(coefficient), coefficient))
        if len(parts) == 1:
            return parts[0]
        if len(parts) == 2 and coefficient is not sympy.S.One and parts[1][1].is_Add:
            coefficient_ = coefficient * parts[1][1]  # a rational goes into a sum
            return order_key(coefficient_), coefficient_
        keys, args = zip(*parts, strict=True) if parts else ((), ())
        return (CLASSES["Mul"], len(args), *keys), sympy.Mul._from_args(args, is_commutative=True)

    def _power(self, base: Any, exponent: int) -> tuple[Key, Any]:
        if exponent == 1 and base.is_Add:  # nearly all of these come once, and it takes long to find that out
            return order_key(base), base
        found = self._powers.get((base, exponent))
        if found is None:
            # sympy would ask whether a sum is infinite, and load a room of its own for the answer
            power = sympy.Pow(base, exponent, evaluate=False) if base.is_Add else base**exponent
            found = self._powers[(base, exponent)] = order_key(power), power
        return found

    def summed(self, terms: Sequence[tuple[Key, Any]]) -> Any:
        """The sum of different terms."""
        if any(term.is_Add or term.is_Number for _, term in terms):
            return sympy.Add(*(term for _, term in terms))
        found = sorted(terms, key=lambda pair: pair[0])
        return sympy.Add._from_args([term for _, term in found], is_commutative=True)


class LongSum(sympy.Add):
    """A sum whose text is written in one pass, character by character the text that sympy gives, fifty times sooner.

    It is equal to the plain sum of the same terms, hashes like it, and whatever is computed from it is plain.

    Examples
    --------
    >>> x, y = sympy.symbols("x y")
    >>> plain = x * y + y * (x**2 - x / 3)
    >>> long = LongSum.of(plain)
    >>> long == plain, plain == long, str(long) == str(plain), type(long + 1) is sympy.Add
    (True, True, True, True)
    """

    __slots__ = ()

    @classmethod
    def of(cls, total: Any) -> Any:
        """A sum as one of these objects; anything else is returned unchanged."""
        made: Any = cls._from_args
        return made(total.args, is_commutative=True) if type(total) is sympy.Add else total

    @property
    def func(self) -> Any:
        """The function from which sympy builds a sum of changed terms."""
        return sympy.Add

    def __eq__(self, other: object) -> Any:
        return self._args == other._args if type(other) is sympy.Add else Basic.__eq__(self, other)

    def __ne__(self, other: object) -> Any:
        equal = self.__eq__(other)
        return equal if equal is NotImplemented else not equal

    def __hash__(self) -> int:
        return Basic.__hash__(self)

    def __reduce_ex__(self, protocol: Any) -> Any:
        return sympy.Add._from_args, (self.args,)

    def __str__(self) -> str:
        text = _written(self)
        return sympy.sstr(sympy.Add._from_args(self.args)) if text is None else text

    __repr__ = __str__

    def _latex(self, printer: object) -> str:  # noqa: ARG002
        """The formula that `sympy.latex` writes, derivatives of a with primes."""
        letters = {symbol: primed(str(symbol)) for symbol in self.free_symbols if str(symbol).startswith("a_d")}
        return str(sympy.latex(sympy.Add._from_args(self.args), symbol_names=letters))


LongSum.__name__ = "Add"  # sympy sorts, hashes and prints an object by the name of its class


def primed(name: str) -> str:
    """LaTeX of a derivative of a, whose name in source is a_d1, a_d2, ...

    Examples
    --------
    >>> primed("a_d2"), primed("a_d4")
    ("a''", 'a^{(4)}')
    """
    order = int(name[3:])
    return "a" + "'" * order if order < 4 else f"a^{{({order})}}"


MARK = chr(0x10FFFF)  # a name that begins with it sorts behind all others


def _written(total: Any) -> str | None:
    """The text of a sum of products of powers of symbols, each with at most one sum of such products; else None."""
    texts: list[str] = []
    shown, seen = [], set()
    for term in total.args:
        coefficient, factors = term.as_coeff_Mul()
        plain: list[Any] = []
        for factor in sympy.Mul.make_args(factors):
            text = _polynomial_written(factor) if factor.is_Add else None
            if text is not None:
                plain.append(sympy.Symbol(f"{MARK}{len(texts)}{MARK}"))
                texts.append(text)
            elif _power_of(factor) is None:
                return None
            else:
                plain.append(factor)
        seen.add(tuple(factor for factor in plain if factor.is_Pow or not factor.name.startswith(MARK)))
        shown.append(sympy.Mul(coefficient, *plain))
    if len(seen) < len(total.args):  # sympy would order these terms by their sums
        return None
    frame = sympy.sstr(sympy.Add(*shown)).split(MARK)
    return "".join(f"({texts[int(piece)]})" if n % 2 else piece for n, piece in enumerate(frame))


def _polynomial_written(total: Any) -> str | None:
    """The text of a sum of rational multiples of monomials in symbols, highest powers of the first letter first."""
    terms = []
    for term in total.args:
        coefficient, factors = term.as_coeff_Mul()
        powers = [_power_of(factor) for factor in sympy.Mul.make_args(factors)]
        if not coefficient.is_Rational or any(power is None for power in powers):
            return None
        terms.append((coefficient, dict(powers)))  # type: ignore[arg-type]
    names = sorted({name for _, powers in terms for name in powers})
    terms.sort(key=lambda pair: [-pair[1].get(name, 0) for name in names])
    monomials = [
        "*".join(name if powers[name] == 1 else f"{name}**{powers[name]}" for name in sorted(powers))
        for _, powers in terms
    ]
    parts = [(int(c.p), int(c.q), monomial) for (c, _), monomial in zip(terms, monomials, strict=True)]
    first = _term_written(*parts[0])
    return (
        ("-" if parts[0][0] < 0 else "")
        + first
        + "".join(f" {'-' if piece[0] < 0 else '+'} {_term_written(*piece)}" for piece in parts[1:])
    )


def _power_of(factor: Any) -> tuple[str, int] | None:
    """The name and the exponent of a positive whole power of a symbol."""
    if type(factor) is sympy.Symbol:
        return factor.name, 1
    if factor.is_Pow and type(factor.base) is sympy.Symbol and factor.exp.is_Integer and factor.exp > 0:
        return factor.base.name, int(factor.exp)
    return None


def _term_written(above: int, below: int, monomial: str) -> str:
    size = abs(above)
    return (monomial if size == 1 else f"{size}*{monomial}") + ("" if below == 1 else f"/{below}")
