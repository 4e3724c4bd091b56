"""A hit of doubles made exact to their last digit: the flight once more in balls, up to the hit and one step beyond.

Which root is the first has been decided; here it is only placed.  A linear model is one exponential of a matrix; other
models take the kernel's own Taylor steps in wider numbers, at a tolerance far below a double's.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.univariate import precision_of
from singimpact.codegen.kernels import FUNCTIONS, plain
from singimpact.flights.flow.balls import linear_flow
from singimpact.flights.kernel import kernel_of
from singimpact.flights.launch import States
from singimpact.flights.limits import LIMITS
from singimpact.oscillator.model import Oscillator

NEAR = 1e-6  # a step of Newton beyond this part of the flight is no polishing: the balls do not see that root


def polished(osc: Oscillator, states: States, index: int, time: float) -> list[float] | None:
    """Flight time and velocity of a hit, correctly rounded up to a unit; None where balls do not confirm it."""
    balls = Balls(LIMITS.polish_bits)
    flow = linear_flow(osc, balls.bits)
    with precision_of(balls):
        tau, v = (evaluate(tree, {}, balls) for tree in (states.exact_tau(index), states.exact_v(index)))
        try:
            found = flow.polished(tau, v, time) if flow is not None else _by_steps(osc, balls, tau, v, time)
        except (ArithmeticError, ValueError, TypeError):  # a ball that left the domain of log or a root
            return None
        return None if found is None else [float(part.mid()) for part in found]


def _by_steps(osc: Oscillator, balls: Balls, tau: Any, v: Any, near: float) -> tuple[Any, Any] | None:
    """Taylor steps to the hit, whose last terms are below the last digit of two doubles."""
    kernel = kernel_of(osc, exact_restart=False)
    space = plain(kernel.text, {name: lambda x, name=name: getattr(x, name)() for name in FUNCTIONS})
    p = [evaluate(tree, {}, balls) for tree in kernel.constants]
    zero, order = balls.rational(Fraction(0)), LIMITS.polish_order
    X = np.full(order + 2, zero, dtype=object)
    W = np.full((kernel.rows, order + 2), zero, dtype=object)
    goal, at, z, u = balls.rational(Fraction(near)), zero, zero, v
    while True:
        space["coefficients"]([tau], at, z, u, zero, order, p, X, W)
        X[0] = z
        step = _step(X, order)
        left = goal - at
        if float(left.mid()) <= step:
            break
        h = balls.rational(Fraction(step))
        z, u = _moved(X, order, h)
        at += h
    for _ in range(3):  # three steps of Newton from a double reach all digits
        z, u = _moved(X, order, left)
        left -= z / u
    moved = abs(at + left - goal)
    return (at + left, u) if bool(moved < NEAR * goal) else None


def _step(X: Any, order: int) -> float:
    """The step whose last two terms are below 2^-110 of the size of the flight."""
    size = max(abs(float(X[n].mid())) for n in range(4)) or 1.0
    last = (max(abs(float(X[n].mid())) / size, 1e-300) ** (1 / n) for n in (order - 1, order))
    return float(2.0 ** (-110 / order) / max(last))


def _moved(X: Any, order: int, h: Any) -> tuple[Any, Any]:
    """x - c and x' after h, by Horner's rule."""
    value, slope = X[order], 0 * h
    for n in range(order - 1, -1, -1):
        slope = slope * h + value
        value = value * h + X[n]
    return value, slope
