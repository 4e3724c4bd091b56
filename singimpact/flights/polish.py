"""A hit of doubles made exact to their last digit: the flight once more in balls, up to the hit and one step beyond.

Which root is the first has been decided; here it is only placed.  A linear model is one exponential of a matrix; other
models take the kernel's own Taylor steps in wider numbers, at a tolerance far below a double's.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.univariate import precision_of
from singimpact.codegen.interpreted import in_floats
from singimpact.codegen.kernels import FUNCTIONS, plain
from singimpact.flights.flow.balls import linear_flow
from singimpact.flights.kernel import kernel_of
from singimpact.flights.launch import States, workspace
from singimpact.flights.limits import LIMITS
from singimpact.oscillator.model import Oscillator

NEAR = 1e-6  # a step of Newton beyond this part of the flight is no polishing: the balls do not see that root


def polished(osc: Oscillator, states: States, index: int, time: float, steps: float) -> list[float] | None:
    """Flight time and velocity of a hit, correctly rounded up to a unit; None where balls do not confirm it.

    Parameters
    ----------
    time : of the hit in doubles. steps : that it took; nan for a closed form.
    """
    balls = Balls(LIMITS.polish_bits)
    flow = linear_flow(osc, balls.bits)
    budget = int(2 * steps + 100) if steps == steps else LIMITS.steps
    with precision_of(balls):
        tau, v = (evaluate(tree, {}, balls) for tree in (states.exact_tau(index), states.exact_v(index)))
        try:
            found = flow.polished(tau, v, time) if flow is not None else _by_steps(osc, balls, tau, v, time, budget)
        except (ArithmeticError, ValueError, TypeError):  # a ball that left the domain of log or a root
            return None
        return None if found is None else [float(part.mid()) for part in found]


def _by_steps(osc: Oscillator, balls: Balls, tau: Any, v: Any, near: float, budget: int) -> tuple[Any, Any] | None:
    """The hit by Taylor steps whose cut-off is bounded far below the last digit of a double.

    The state is a number without a radius at the start of each step: what is wanted is a better double, and radii would
    grow with the steps.
    """
    kernel = kernel_of(osc)
    space = plain(kernel.text, {name: lambda x, name=name: getattr(x, name)() for name in FUNCTIONS})
    step_size = in_floats(kernel.text)["step_size"]
    p = [evaluate(tree, {}, balls) for tree in kernel.constants]
    numbers = [float(part.mid()) for part in p]
    zero, order = balls.rational(Fraction(0)), LIMITS.polish_order
    X, W = workspace(zero, order, kernel.rows, 0)
    goal, at, z, u = balls.rational(Fraction(near)), zero, zero, v
    longest, pace = 1.0, (1e300, 4.3, 1.0, 8.0)
    for _ in range(budget):
        space["coefficients"]([tau], at, z, u, zero, order, p, X, W)
        centres, rows = [float(part.mid()) for part in X], [[float(row[0].mid())] for row in W]
        step, _overlap, pace = step_size(centres, rows, float(z.mid()), order, longest, 2.0**-110, numbers, pace)
        X[0], left = z, goal - at
        if not step > 0:
            return None
        if float(left.mid()) <= step:
            break
        h = balls.rational(Fraction(step))
        z, u = (part.mid() for part in _moved(X, order, h))
        at, longest = at + h, 2 * step
    else:
        return None
    for _ in range(3):  # three steps of Newton from a double reach all digits
        z, u = _moved(X, order, left)
        left -= z / u
    moved = abs(at + left - goal)
    return (at + left, u) if bool(moved < NEAR * goal) else None


def _moved(X: Any, order: int, h: Any) -> tuple[Any, Any]:
    """x - c and x' after h, by Horner's rule."""
    value, slope = X[order], 0 * h
    for n in range(order - 1, -1, -1):
        slope = slope * h + value
        value = value * h + X[n]
    return value, slope
