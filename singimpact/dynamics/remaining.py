"""The chatter left at a state with a short rest, summed up: the terms of tau_inf - tau in powers of v, in doubles.

The terms are frozen from the theory (`generated.completion`); the jets that a model fixes are computed once.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, evaluate, number, substitute
from singimpact.algebra.numbers import as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.contact.contact import Contact
from singimpact.dynamics.fractional_chatter import left_of_chatter
from singimpact.generated.completion import chatter_terms
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration

Array = np.ndarray[Any, Any]
ORDER = 4


def remaining(osc: Oscillator, tau: Array, v: Array, a: Array | None = None) -> tuple[Array, Array]:
    """The time left of a chatter from states with a_c < 0, and the size of the last term of its series.

    Parameters
    ----------
    osc : the model, with `fractional_chatter.chatter_completes`. tau, v : states. a : a_c there, when it is known.

    Examples
    --------
    >>> osc = Oscillator("0", "-2", 0, "1/2")
    >>> [part.tolist() for part in remaining(osc, np.array([0.0]), np.array([1.0]))]
    [[2.0], [0.0]]
    """
    forces, rebounds, slopes = _jets(osc)
    push = acceleration(osc, tau) if a is None else a
    with np.errstate(all="ignore"):
        jets = {f"a_d{n}": evaluate(tree, {"t": tau}, DOUBLES) + 0.0 * tau for n, tree in enumerate(slopes, 1)}
        if not osc.smooth_at_rest:
            return left_of_chatter(osc, v, push, jets, forces)  # type: ignore[no-any-return]
        terms = chatter_terms(v=v, lambda_=as_float(osc.slope_at_rest()), a=push, **jets, **forces, **rebounds)
        first, *_, before, last = terms
        # a coefficient may happen to be small: the term before lets expect this one
        likely = np.abs(before) * np.abs(before / first) ** (1 / (ORDER - 2))
    return sum(reversed(terms)), np.maximum(np.abs(last), likely)


@lru_cache(maxsize=256)
def _jets(osc: Oscillator) -> tuple[dict[str, float], dict[str, float], tuple[Expression, ...]]:
    """Derivatives of f at (c, 0), coefficients of rho, and the first derivatives of g as trees."""
    at = Contact.of(osc, 0.0, 0, ORDER, DOUBLES).f
    names = {(0, 1): "f_01", (0, 2): "f_02", (0, 3): "f_03", (1, 0): "f_10", (1, 1): "f_11"}
    forces = {name: float(at.get(key, 0.0)) * factorial(key[0]) * factorial(key[1]) for key, name in names.items()}
    rebounds = _coefficients(osc)
    trees = []
    forcing = osc.forcing()
    for _ in range(ORDER - 1):
        forcing = derivative(forcing, "t")
        trees.append(forcing)
    return forces, rebounds, tuple(trees)


def _coefficients(osc: Oscillator) -> dict[str, float]:
    """rho_2, rho_3, ... of a law that is smooth at rest; zeros of one that is not, which has other terms."""
    coefficients = {f"rho_{n}": 0.0 for n in range(2, ORDER + 1)}
    if not osc.smooth_at_rest:
        return coefficients
    law = osc.rho_at_rest()
    if law is not None and (law.bound is None or law.bound > ORDER):
        terms = {int(exponent): as_float(value) for exponent, value in law.terms}
        return {f"rho_{n}": (-1) ** n * terms.get(n, 0.0) for n in range(2, ORDER + 1)}
    slope = osc.rho()
    for n in range(1, ORDER + 1):
        slope = derivative(slope, "v")
        if n > 1:
            coefficients[f"rho_{n}"] = as_float(substitute(slope, {"v": number(0)})) / factorial(n)
    return coefficients
