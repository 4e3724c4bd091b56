"""The impact map over boxes in balls of one precision."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate, number
from singimpact.flights.enclosures.certified_hit import Launch, ProvedImpact, certified_hit
from singimpact.flights.horizons import horizon_of
from singimpact.oscillator.model import Oscillator

SPARE = 6
"""Digits of a flight beside those of the states."""
POINT = (Fraction(0), Fraction(0))


class EnclosedMap:
    """G and D G of a model.

    Parameters
    ----------
    osc : the model. digits : of the image of a point. bits : of the balls.
    """

    def __init__(self, osc: Oscillator, digits: int, bits: int) -> None:
        assert osc.period is not None
        self.osc, self.digits, self.balls = osc, digits, Balls(bits)
        self.period = evaluate(osc.period, {}, self.balls)
        self.horizon = Fraction(horizon_of(osc, None))

    def __call__(self, state: Sequence[Fraction], radii: Sequence[Fraction] = POINT) -> ProvedImpact:
        """The image of a box, with D G unless it is a point; `Refused` where a member is not shown to hit."""
        box = any(radii)
        launch = Launch(number(state[0]), number(state[1]), 1, {"tau": radii[0], "v": radii[1]} if box else {})
        return certified_hit(self.osc, launch, self.digits + SPARE, self.horizon, derivative=box)
