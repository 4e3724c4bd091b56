"""A hit of a linear model placed to the last bit of a double, where double-double arithmetic does not place it.

The model with its waves is one linear system, whose exponential has no small divisors: resonance needs no care.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.precision import balls_at
from singimpact.flights.limits import LIMITS
from singimpact.flights.states import States
from singimpact.oscillator.linear import at_rest, linear_form
from singimpact.oscillator.model import Oscillator

NEAR = Fraction(1, 10**7)  # of its size is as far as a hit in doubles is from the true one, where it is isolated
STEPS = 6  # of Halley's method at most: next to a graze the first ones are not short


class LinearSystem(NamedTuple):
    """The matrix of (z, z', 1, cosine and sine of each wave), and rate and phase of each wave; balls."""

    matrix: Any
    waves: tuple[tuple[Any, Any], ...]


@lru_cache(maxsize=64)
def _system(osc: Oscillator, bits: int) -> LinearSystem:
    """The system of a linear model in balls of so many bits."""
    import flint

    form, balls = linear_form(osc), Balls(bits)
    assert form is not None
    with balls_at(bits):
        damping, stiffness, rest = (
            evaluate(tree, {}, balls) for tree in (form.damping, form.stiffness, at_rest(form, osc.clearance))
        )
        size = 3 + 2 * len(form.harmonics)
        rows, waves = [[flint.arb(0)] * size for _ in range(size)], []
        rows[0][1], rows[1][0], rows[1][1], rows[1][2] = flint.arb(1), -stiffness, -damping, rest
        for n, wave in enumerate(form.harmonics):
            rate, phase, cosine, sine = (
                evaluate(tree, {}, balls) for tree in (wave.rate, wave.phase, wave.cosine, wave.sine)
            )
            at = 3 + 2 * n
            rows[1][at], rows[1][at + 1], rows[at][at + 1], rows[at + 1][at] = cosine, sine, -rate, rate
            waves.append((rate, phase))
        return LinearSystem(flint.arb_mat(rows), tuple(waves))


def refined_hit(osc: Oscillator, states: States, index: int, time: float) -> list[float] | None:
    """Flight time and velocity of a hit of a linear model, correctly rounded up to a unit.

    Which root is the first has been decided; here it is only placed. None where balls do not confirm it.
    """
    balls = Balls(LIMITS.refine_bits)
    system = _system(osc, balls.bits)
    with balls_at(balls.bits):
        tau, v = (evaluate(tree, {}, balls) for tree in (states.exact_tau(index), states.exact_v(index)))
        try:
            hit = _halley(system, tau, v, balls.rational(Fraction(time)))
        except (ArithmeticError, ValueError, TypeError):  # a ball that left the domain of log or a root
            return None
        return None if hit is None else [float(ball.mid()) for ball in hit]


def _halley(system: LinearSystem, tau: Any, v: Any, time: Any) -> tuple[Any, Any] | None:
    """Time and velocity of the hit next to a time, one step of Halley's method away; None when no step is small."""
    import flint

    angles = [(rate * tau + phase).sin_cos() for rate, phase in system.waves]
    start = flint.arb_mat([[0], [v], [1], *([value] for sine, cosine in angles for value in (cosine, sine))])
    for _ in range(STEPS):
        state = (system.matrix * time).exp() * start
        height, speed = state[0, 0], state[1, 0]
        change = system.matrix * state
        curve, jerk = change[1, 0], (system.matrix * change)[1, 0]
        if not abs(height) < abs(speed * time) * NEAR.numerator / NEAR.denominator:
            return None
        step = -height / speed
        # next to a graze the step is not short beside speed/curve; the error left is of third order in the step
        near_enough = bool(abs(step * curve) < abs(speed) / 10**9)
        step *= 1 - step * curve / (2 * speed)
        if near_enough:
            return time + step, speed + step * (curve + step * jerk / 2)
        time = (time + step).mid()
    return None
