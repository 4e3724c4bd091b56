"""A derived expression laid out as a sum: by degree, or in powers of one symbol.  Arranging never changes a value.

Every function checks that the pieces it shows add up to the expression it was given.
"""

from typing import Any

import sympy

from singimpact.theory.notation import first_positive, joined, latex, parenthesised


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
