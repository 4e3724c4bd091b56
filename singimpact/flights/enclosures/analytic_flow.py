"""Flights of an analytic model in balls, impact after impact, at one precision: the flow that orbits use."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.precision import series_of_any_length
from singimpact.flights.enclosures.ball_flight import first_hit
from singimpact.flights.enclosures.certified_hit import ENCLOSURE
from singimpact.flights.enclosures.equation import Equation, NoHit, Refused, programs_of
from singimpact.flights.enclosures.motion import CarriedMotion, Start
from singimpact.flights.enclosures.short_flight import ShortFlights
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import RESTITUTION


class FlownHit(NamedTuple):
    """A proved first hit: flight time and the velocity there, x-dot < 0; both None when none comes before the limit."""

    time: Any
    velocity: Any


class AnalyticFlow:
    """The numbers of a model as balls, and its flights from launches that are balls.

    Parameters
    ----------
    osc : the model, its restitution a number. bits : of the balls, at which the flow is made and used.
    number : name and ball of a number of the model that takes every value in the ball; what is returned then holds for
        each of them.

    Examples
    --------
    >>> from singimpact.algebra.precision import balls_at
    >>> with balls_at(200):
    ...     flow = AnalyticFlow(Oscillator("x + x**3", "cos(2*t)", "0.3", "0.5"), 200)
    ...     hit = flow.first_hit(flow.number(Fraction(0)), flow.number(Fraction(1)))
    ...     print(hit.time.str(25, radius=False))
    1.769788982840214783740587
    """

    def __init__(self, osc: Oscillator, bits: int, number: tuple[str, Any] | None = None) -> None:
        moving = dict([number] if number else [])
        self.balls, self.equation = Balls(bits), Equation(programs_of(osc, tuple(moving)), moving)
        self.r = moving[RESTITUTION] if RESTITUTION in moving else evaluate(osc.restitution, moving, self.balls)
        self.longest = Fraction(10_000)
        self.short = ShortFlights(self.equation, bits)

    def number(self, value: Fraction) -> Any:
        """A rational as a ball."""
        return self.balls.rational(value)

    def acceleration(self, tau: Any, order: int = 0) -> Any:
        """a_c, or its derivative of order 1, at tau."""
        if order:
            return self.equation.run("forcing", t=tau)[order]
        with series_of_any_length():  # an orbit asks for a_c where it flies next
            return self.short.drive(tau)[0] - self.equation.at_wall()[0]

    def pressing(self, tau: Any, window: Any, v: Any) -> tuple[Any, Any]:
        """Bounds of -x'' while t is in the window after tau, |x'| <= 2 v and 0 <= x - c <= 2 v window."""
        fast = (2 * v).upper()
        high = (2 * v * window).upper()
        zero = self.number(Fraction(0))
        f = self.equation.run("force", x=zero.union(high), xdot=(-fast).union(fast))[0]
        pull = f - self.equation.run("drive", t=tau.union(tau + window))[0]
        return pull.lower(), pull.upper()

    def first_hit(self, tau: Any, v: Any, limit: Any = None, removed: int = 1) -> FlownHit | None:
        """The first t > 0 with x = c.

        Parameters
        ----------
        tau, v : the launch. limit : no hit is looked for beyond. removed : the power p of t in x - c; above 1 from
            rest.

        Returns
        -------
        FlownHit or None : None where these balls do not decide it.
        """
        with series_of_any_length():
            if removed == 1 and (soon := self.short.hit(tau, v)) is not None:
                return FlownHit(None, None) if limit is not None and soon[0] > limit else FlownHit(*soon)
            a = self.acceleration(tau)
            expected = float((2 * v / -a).mid()) if removed == 1 and a < 0 else 0.0
            horizon = self.number(self.longest) if limit is None else limit
            equations, bits = (self.equation, self.equation), self.balls.bits - ENCLOSURE.guard
            motion = CarriedMotion(equations, Start(tau, v, removed, expected), bits)
            try:
                hit = first_hit(motion, horizon, ENCLOSURE.idle_steps)
            except NoHit:
                return FlownHit(None, None)
            except Refused:
                return None
        return FlownHit(hit.flight_time, hit.velocity)
