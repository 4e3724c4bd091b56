"""Flights that are too fast for a bounded, oscillating force to turn them back before the horizon: rotating pendulums.

Let f(x) = V'(x) with |V| bounded and g(t) = m + G'(t) with |G| bounded and m >= 0 (constant parts of f in m).  Then
y = x' - G(t) + V(x)/x' has y' = m - V x''/x'^2, so with |x''| <= B and the launch velocity u, as long as x' >= u/2,

    x' >= u - 2 sup|G| - 4 sup|V|/u - 4 t sup|V| B/u^2 .
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Call, Expression, Product, Sum, add, multiply, names_in, negate, number
from singimpact.algebra.numbers import Array, as_float, sign_of
from singimpact.oscillator.model import Oscillator

MARGIN = 1e-9  # of every sum here, which is a few roundings


@dataclass(frozen=True)
class Bounds:
    """sup|V|, sup|G| and B of the bound above."""

    potential: float
    impulse: float
    force: float


def stays_up(osc: Oscillator, v: Array, horizon: Any) -> Array:
    """Whether flights launched with velocities v are proved not to return before the horizon.

    Examples
    --------
    >>> stays_up(Oscillator("sin(x)", "cos(t)", 0, 1), np.array([10.0, 100.0]), 6000.0).tolist()
    [False, True]
    """
    bounds = bounds_of(osc)
    if bounds is None:
        return np.zeros(v.shape, dtype=bool)
    with np.errstate(all="ignore"):
        left = v / 2 - 2 * bounds.impulse - 4 * bounds.potential / v
        lost = 4 * horizon * bounds.potential * bounds.force / v**2
        return np.asarray((v > 0) & (left > lost + MARGIN * v))


@lru_cache(maxsize=256)
def bounds_of(osc: Oscillator) -> Bounds | None:
    """The bounds of a model whose f and g are sums of sines and cosines; None for any other."""
    force, forcing = _waves(osc.force(), "x"), _waves(osc.forcing(), "t")
    if force is None or forcing is None or sign_of(add(forcing[0], negate(force[0]))) < 0:
        return None
    sizes = [(abs(as_float(size)), abs(as_float(rate))) for part in (force, forcing) for size, rate in part[1]]
    count, mean = len(force[1]), abs(as_float(add(forcing[0], negate(force[0]))))
    turned = [size / rate for size, rate in sizes]
    return Bounds(sum(turned[:count]), sum(turned[count:]), sum(size for size, _ in sizes) + mean)


def _waves(tree: Expression, variable: str) -> tuple[Expression, list[tuple[Expression, Expression]]] | None:
    """A tree as a constant and waves (amplitude, rate), sin or cos of linear arguments; None for any other."""
    constant: Expression = number(0)
    waves = []
    for term in tree.terms if isinstance(tree, Sum) else (tree,):
        if not names_in(term):
            constant = add(constant, term)
            continue
        factors = term.factors if isinstance(term, Product) else (term,)
        moving = [factor for factor in factors if names_in(factor)]
        if len(moving) != 1 or not isinstance(moving[0], Call) or moving[0].function not in ("sin", "cos"):
            return None
        rate = derivative(moving[0].argument, variable)
        if names_in(rate) or names_in(moving[0].argument) != {variable} or sign_of(rate) == 0:
            return None
        waves.append((multiply(number(1), *(factor for factor in factors if not names_in(factor))), rate))
    return constant, waves
