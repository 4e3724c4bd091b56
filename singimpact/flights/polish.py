"""A hit of a linear model made exact to its last digit: the flight once more in balls, one exponential of a matrix.

Which root is the first has been decided; here it is only placed.
"""

from __future__ import annotations

from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.univariate import precision_of
from singimpact.flights.balls import linear_flow
from singimpact.flights.limits import LIMITS
from singimpact.flights.states import States
from singimpact.oscillator.model import Oscillator


def polished(osc: Oscillator, states: States, index: int, time: float) -> list[float] | None:
    """Flight time and velocity of a hit, correctly rounded up to a unit; None where balls do not confirm it."""
    balls = Balls(LIMITS.polish_bits)
    flow: Any = linear_flow(osc, balls.bits)
    with precision_of(balls):
        tau, v = (evaluate(tree, {}, balls) for tree in (states.exact_tau(index), states.exact_v(index)))
        try:
            found = flow.polished(tau, v, time)
        except (ArithmeticError, ValueError, TypeError):  # a ball that left the domain of log or a root
            return None
        return None if found is None else [float(part.mid()) for part in found]
