"""Derived sympy objects as LaTeX in the paper's letters."""

from __future__ import annotations

from typing import Any

import sympy

_PRIMES = {f"a_d{n}": "a" + "'" * n for n in range(1, 4)} | {f"a_d{n}": f"a^{{({n})}}" for n in range(4, 41)}
_LETTERS = {"mbar": r"\bar m", "ell": r"\ell", "sigma": r"\sigma", "tau": r"\tau", "*": "*"}


def latex(expression: Any) -> str:
    """LaTeX of an expression, a tuple or a matrix.

    Examples
    --------
    >>> a1, sigma, t = sympy.symbols("a_d1 sigma t")
    >>> latex(-a1 * sigma * t / 2)
    "- \\\\tfrac{a' \\\\sigma t}{2}"
    """
    if isinstance(expression, tuple):
        return r"\bigl(" + r",\ ".join(latex(part) for part in expression) + r"\bigr)"
    names: dict[Any, str] = {}
    for symbol in expression.free_symbols:
        shown = _PRIMES.get(symbol.name) or _LETTERS.get(symbol.name)
        if symbol.name.startswith("f_"):
            shown = f"f_{{{symbol.name[2:]}}}"
        if shown:
            names[symbol] = shown
    return str(sympy.latex(expression, symbol_names=names, fold_short_frac=False)).replace(r"\frac", r"\tfrac")
