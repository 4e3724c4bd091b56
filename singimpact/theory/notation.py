"""Derived expressions as LaTeX: the order of terms and factors that a reader expects, the same in every run.

Terms are sorted by total degree in the small variables, then with the highest power first; in a product numbers come
first, then k, a, a', ..., then lambda, m, sigma, t, then sums in parentheses.

Laying out an expression as a sum, by degree or in powers of one symbol, never changes its value: the pieces shown are
checked to add up to it.
"""

from typing import Any

import sympy

from singimpact.algebra.long_sums import primed

_NAMES = {"mbar": r"\bar m", "ell": r"\ell", "Qrest": r"Q_r(\sigma, \eta) + O(3)", "Qdot": "Q'"}
_GREEK = {"kappa", "rho", "sigma", "tau", "eta", "lambda", "mu", "omega"}
SHOWN_DIGITS = 15
SMALL = ("v", "eta", "sigma", "s", "t")
_FALLING = ("mbar", "m", "lambda", "r")
_FIRST = ("r", "k", "ell")
_LAST = ("lambda", "v", "sigma", "eta", "s", "t", "mbar", "m")


def latex(value: Any) -> str:
    """LaTeX of an expression, a tuple or a matrix.

    Examples
    --------
    >>> a1, sigma, t = sympy.symbols("a_d1 sigma t")
    >>> print(latex(-a1 * t * (3 * sigma + t) / 6))
    -\\tfrac{1}{6} a' t (3 \\sigma + t)
    """
    if isinstance(value, tuple):
        return r"\bigl(" + r",\ ".join(latex(entry) for entry in value) + r"\bigr)"
    if isinstance(value, sympy.MatrixBase):
        rows = [
            " & ".join(latex(entry).replace(r"\frac", r"\dfrac") for entry in value.row(n)) for n in range(value.rows)
        ]
        between = r"\\[0.6em] " if any(r"\dfrac" in row for row in rows) else r"\\ "
        return r"\begin{pmatrix}" + between.join(rows) + r"\end{pmatrix}"
    value = sympy.sympify(value)
    if value.is_Symbol:
        return name_of(value)
    if value.is_Function or value.is_NumberSymbol:
        return str(sympy.latex(value))
    if value.is_Float:
        digits, _, exponent = str(sympy.Float(value, SHOWN_DIGITS)).partition("e")
        return rf"{digits} \cdot 10^{{{int(exponent)}}}" if exponent else digits
    return joined([latex(term) for term in _sorted(value)]) if value.is_Add else _product(value)


def joined(terms: list[str]) -> str:
    """Terms as a sum: a term that brings its minus is subtracted.

    Examples
    --------
    >>> joined(["a", "-b", "c"])
    'a - b + c'
    """
    first, *rest = terms
    return first + "".join(f" - {term[1:]}" if term.startswith("-") else f" + {term}" for term in rest)


def name_of(symbol: Any) -> str:
    """A symbol in the paper's letters.

    Examples
    --------
    >>> name_of(sympy.Symbol("a_d2")), name_of(sympy.Symbol("f_01"))
    ("a''", 'f_{01}')
    """
    name = str(symbol)
    if name.startswith("a_d"):
        return primed(name)
    head, _, index = name.partition("_")
    if index:
        return f"{name_of(head)}_{{{index}}}"
    return "\\" + name if name in _GREEK else _NAMES.get(name, name)


def _sorted(total: Any) -> list[Any]:
    """The terms of a sum; of two, a positive one comes first."""
    terms = sorted(total.args, key=_term_key)
    if len(terms) == 2 and _negative(terms[0]) and not _negative(terms[1]):
        terms.reverse()
    return terms


def _term_key(term: Any) -> tuple[Any, ...]:
    powers = {str(base): power for base, power in term.as_powers_dict().items()}
    other = sorted((name for name in powers if name[0] in "abf" and len(name) < 6), reverse=True)
    return (
        sum(powers.get(name, 0) for name in SMALL),
        [-powers.get(name, 0) for name in SMALL],
        [-powers.get(name, 0) for name in _FALLING],
        sum(powers[name] for name in other),
        # of one degree the highest derivative of a comes first
        [-int(name[3:]) if name.startswith("a_d") else 0 for name in other],
        str(term),
    )


def _negative(term: Any) -> bool:
    return bool(term.as_coeff_Mul()[0].is_negative)


def _product(value: Any) -> str:
    number, rest = value.as_coeff_Mul()
    sign = -1 if number.is_negative else 1
    above: list[tuple[Any, Any]] = []
    below: list[tuple[Any, Any]] = []
    for factor in sympy.Mul.make_args(rest):
        base, power = factor.as_base_exp()
        base, turned = first_positive(base, power, sign)
        sign *= turned
        if base != 1:
            (below if power.is_negative else above).append((base, abs(power)))
    top, bottom = _factors(above), _factors(below)
    return ("-" if sign < 0 else "") + _fraction(abs(number), top, bottom)


def first_positive(base: Any, power: Any, sign: int) -> tuple[Any, int]:
    """A sum turned so that its first term is positive, and the sign that this costs; 1 - x rather than -(x - 1)."""
    if not base.is_Add or not power.is_Integer or power % 2 == 0:
        return base, 1
    terms = sorted(base.args, key=_term_key)
    absorbs = sign < 0 and len(terms) == 2 and terms[1].is_Rational and terms[1] < 0
    return (-base, -1) if _negative(terms[0]) or absorbs else (base, 1)


def _fraction(number: Any, top: list[str], bottom: list[str]) -> str:
    if not bottom:
        head = [] if number == 1 and top else [_number(number)]
        return " ".join(head + top)
    above = ([] if number.p == 1 and top else [str(number.p)]) + _bare(top, number.p == 1)
    below = ([] if number.q == 1 else [str(number.q)]) + _bare(bottom, number.q == 1)
    return rf"\frac{{{' '.join(above)}}}{{{' '.join(below)}}}"


def _bare(factors: list[str], alone: bool) -> list[str]:
    """A single sum needs no parentheses above or below a line."""
    if not alone or len(factors) != 1:
        return factors
    for left, right in (("(", ")"), (r"\bigl(", r"\bigr)")):
        if factors[0].startswith(left) and factors[0].endswith(right):
            return [factors[0].removeprefix(left).removesuffix(right)]
    return factors


def _number(number: Any) -> str:
    return str(number.p) if number.q == 1 else rf"\tfrac{{{number.p}}}{{{number.q}}}"


def _factors(pairs: list[tuple[Any, Any]]) -> list[str]:
    return [_power(base, power) for base, power in sorted(pairs, key=lambda pair: _factor_key(*pair))]


def _factor_key(base: Any, power: Any) -> tuple[Any, ...]:
    name = str(base)
    rank = _FIRST.index(name) if name in _FIRST else len(_FIRST)
    return (
        not power.is_Integer,
        not base.is_Symbol,
        _LAST.index(name) + 1 if name in _LAST else 0,
        rank,
        -power if base.is_Add else 0,
        len(name) if base.is_Add else 0,
        name,
    )


def _power(base: Any, power: Any) -> str:
    if power.is_Rational and power.q == 2:
        root = rf"\sqrt{{{latex(base)}}}"
        return root if power.p == 1 else rf"{parenthesised(base)}^{{{power.p}/2}}"
    shown = parenthesised(base)
    if power == 1:
        return shown
    return rf"{{{shown}}}^{{{power}}}" if "'" in shown else rf"{shown}^{{{power}}}"


def parenthesised(base: Any) -> str:
    """An expression as a factor: a sum stands in parentheses.

    Examples
    --------
    >>> print(parenthesised(sympy.Symbol("m") - sympy.Rational(1, 2)))
    \\bigl(m - \\tfrac{1}{2}\\bigr)
    """
    shown = latex(base)
    if not base.is_Add:
        return shown
    return rf"\bigl({shown}\bigr)" if r"\tfrac" in shown or "(" in shown else f"({shown})"


def by_degree(expression: sympy.Expr, *variables: sympy.Symbol) -> list[str]:
    """The homogeneous parts of a polynomial in the variables, lowest degree first, each as a sum of monomials.

    Examples
    --------
    >>> a, b, t = sympy.symbols("a b t")
    >>> by_degree(a * t / 2 + t**2 * (a * b - 2 * b) / 6, t)
    ['\\\\tfrac{1}{2} a t', '-\\\\tfrac{1}{6} b (2 - a) t^{2}']
    """
    terms = sympy.Poly(expression, *variables).terms()
    _same(expression, [coefficient * _monomial(powers, variables) for powers, coefficient in terms])
    degrees = sorted({sum(powers) for powers, _ in terms})
    return [_part([term for term in terms if sum(term[0]) == degree], variables) for degree in degrees]


def _part(terms: list[tuple[tuple[int, ...], sympy.Expr]], variables: tuple[sympy.Symbol, ...]) -> str:
    shown = []
    for powers, coefficient in terms:
        monomial = _monomial(powers, variables)
        factored = sympy.factor(coefficient)
        shown.append(latex(factored) if monomial == 1 else _beside(factored, monomial))
    return joined(shown)


def _beside(coefficient: sympy.Expr, monomial: sympy.Expr) -> str:
    """A coefficient before its monomial: a sum in it stays in front, unlike in a product."""
    if not coefficient.has(sympy.Add):
        return latex(coefficient * monomial)
    if coefficient.is_Add:
        turned, sign = first_positive(coefficient, sympy.Integer(1), 1)
        return f"{'-' if sign < 0 else ''}{parenthesised(turned)} {latex(monomial)}"
    return f"{latex(coefficient)} {latex(monomial)}"


def _monomial(powers: tuple[int, ...], variables: tuple[sympy.Symbol, ...]) -> Any:
    return sympy.prod(x**n for x, n in zip(variables, powers, strict=True))


def in_powers(expression: sympy.Expr, symbol: sympy.Symbol, rising: bool = False) -> str:
    """A polynomial in one symbol, highest power first unless `rising`, each coefficient in factors.

    Examples
    --------
    >>> m, r = sympy.symbols("m r")
    >>> in_powers(2 * m**2 * r - 3 * m * r + m**2 + 2 * m + 1, r)
    'r m (2 m - 3) + (m + 1)^{2}'
    """
    terms = sympy.Poly(expression, symbol).terms()
    pieces = [sympy.factor(coefficient) * symbol ** powers[0] for powers, coefficient in terms]
    _same(expression, pieces)
    return joined([latex(piece) for piece in (pieces[::-1] if rising else pieces)])


def factored(expression: sympy.Expr | tuple[sympy.Expr, ...]) -> str:
    """An expression, or each part of a tuple, in factors."""
    if isinstance(expression, tuple):
        return r"\bigl(" + r",\ ".join(factored(part) for part in expression) + r"\bigr)"
    return latex(sympy.factor(expression))


def _same(expression: sympy.Expr, pieces: list[sympy.Expr]) -> None:
    if sympy.expand(expression - sympy.Add(*pieces)) != 0:
        raise ArithmeticError("the pieces shown do not add up to the expression")
