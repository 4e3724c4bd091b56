"""A polynomial in (sigma, t) evaluated by sympy's own means: `lambdify` for numpy, and `subs` point by point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any


def expression(terms: Mapping[tuple[int, ...], Any]) -> tuple[Any, Any, Any]:
    """sigma, t and the expanded sum, as sympy keeps it."""
    import sympy

    sigma, t = sympy.symbols("sigma t")
    rational = {key: sympy.Rational(c.numerator, c.denominator) for key, c in terms.items()}
    return sigma, t, sympy.expand(sympy.Add(*(c * sigma**i * t**k for (i, k), c in rational.items())))


def function(terms: Mapping[tuple[int, ...], Any], shared: bool) -> Callable[[Any, Any], Any]:
    """By `lambdify`, with or without common subexpressions taken out."""
    import sympy

    sigma, t, total = expression(terms)
    found: Callable[[Any, Any], Any] = sympy.lambdify((sigma, t), total, "numpy", cse=shared)
    return found


def substituting(terms: Mapping[tuple[int, ...], Any]) -> Callable[[Any, Any], list[float]]:
    """By `subs` at each point."""
    sigma, t, total = expression(terms)
    return lambda at, times: [float(total.subs({sigma: s, t: u})) for s, u in zip(at, times, strict=True)]
