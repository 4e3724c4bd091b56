"""Truncation measured: remainders of v_c, p and phi on true flights fall off with the degree of the first omitted term.

That degree is computed in balls before it is measured: a part of the series counts as present when its ball excludes
zero, and as absent when the ball contains zero and is narrower than 1e-50.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.jets import Jet
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES, Multiprecision
from singimpact.algebra.solving import secant
from singimpact.contact.contact import Contact, contact_order
from singimpact.contact.points import tangency_points
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.true_sheet import Place, regular, swans, tangencies
from singimpact.theory.impact_sheet import Sheet, sheet

RAY = (Fraction(-1), Fraction(7, 10))  # (sigma, t) = h RAY: inside the visible part, off every curve named in the paper
STEPS = (0.02, 0.01, 0.005)  # h for DOP853: small enough for one term to rule, remainders well above rounding
DIGIT_STEPS = (-5, -6)  # powers of ten for the closed form
BITS = 256
WIDTH = 1e-50  # the largest radius of a part that counts as zero; balls of 256 bits have 1e-75


@dataclass(frozen=True)
class RemainderCase:
    """One remainder: `expected` degree from the exact series, `measured` on true flights.

    Attributes
    ----------
    name : the model, the contact and the flow. quantity : "v_c" or "phi". order : the last degree kept.
    """

    name: str
    quantity: str
    order: int
    expected: int
    measured: float

    @property
    def agrees(self) -> bool:
        """Whether the measured degree is the expected one, to a quarter of a degree."""
        return abs(self.measured - self.expected) < 0.25

    def line(self) -> str:
        """One line for a table."""
        return f"{self.quantity} on {self.name}: O({self.expected}), measured {self.measured:.2f}"


PLACES = regular, tangencies, swans  # by the order of the contact
RATIONAL = {0: Fraction(6, 5), 2: Fraction(0)}  # the contact points of an order that are rational numbers


def setting(name: str, j: int) -> Place:
    """A model of `true_orbits.MODELS` at a regular point, at its tangency, or at its own swan (tau = 0)."""
    return next(point for point in PLACES[j]() if point.name == name)


def in_balls(point: Place, j: int, balls: Balls) -> Any:
    """The contact point in balls."""
    if j in RATIONAL:
        return balls.rational(RATIONAL[j])
    return next(at for at in tangency_points(point.model) if at.kind == "gamma").ball(BITS)


def first_omitted(point: Place, j: int, order: int, quantity: str, search: int = 4) -> int:
    """The degree of the first term after `order` that does not vanish along `RAY`, in balls.

    Raises
    ------
    ArithmeticError : a ball contains zero and is no narrower than WIDTH, or all parts are zero.
    """
    balls = Balls(BITS)
    with balls_at(BITS):
        contact = Contact.of(point.model, in_balls(point, j, balls), j, order + search, balls)
        series = sheet(contact, order + search)
        jet = series.v if quantity == "v_c" else series.xdot
        for degree in range(order + 1, order + search + 1):
            coefficient = balls.rational(Fraction(0))
            for (i, k), value in jet.terms.items():
                if i + k == degree:
                    coefficient = coefficient + value * balls.rational(RAY[0] ** i * RAY[1] ** k)
            if not coefficient.contains(0):
                return degree
            if coefficient.rad() > WIDTH:
                raise ArithmeticError(f"the part of degree {degree} of {quantity} at {point.name} is not decided")
    raise ArithmeticError(f"no part of degree up to {order + search} is left in {quantity} at {point.name}")


def _numeric(jet: Jet, sigma: Any, t: Any) -> Any:
    return sum((value * sigma**i * t**k for (i, k), value in jet.terms.items()), sigma * 0)


def measured(series: Sheet, flow: true_orbits.Flow, quantity: str, steps: list[Any]) -> float:
    """The order of the remainder along RAY as h falls: the slope between the two smallest h.

    v_c: a flight launched with the truncated v_c misses c after t by t y, and dy/dv = 1 + O(h), so y is the remainder.
    phi: the launch velocity is first made true, then the impact velocity is compared.
    """
    misses = []
    for h in steps:
        sigma, t = h * RAY[0].numerator, h * RAY[1].numerator / RAY[1].denominator
        v = _numeric(series.v, sigma, t)
        if quantity == "phi":
            v = _true_launch(flow, sigma, v, t)
            misses.append(abs(flow(sigma, v, t)[1] - _numeric(series.xdot, sigma, t)))
        else:
            misses.append(abs(flow(sigma, v, t)[0]))
    return float(np.log(float(misses[-2] / misses[-1])) / np.log(float(steps[-2] / steps[-1])))


def _true_launch(flow: true_orbits.Flow, sigma: Any, v: Any, t: Any) -> Any:
    """The launch velocity whose flight is back after t, by the secant method from the truncated one."""
    return secant(lambda speed: flow(sigma, speed, t)[0], v, v * (1 + v * 0 + 1e-6))


@lru_cache(maxsize=16)
def remainders(j: int | str, order: int) -> tuple[RemainderCase, ...]:
    """Remainders of v_c (which is p) and of phi on both models by DOP853, on the linear one in many digits too."""
    j = contact_order(j)
    cases: list[RemainderCase] = []
    for point in PLACES[j]():
        series = sheet(Contact.of(point.model, point.tau, j, order, DOUBLES), order)
        flow = true_orbits.scipy_flow(point.model, point.tau)
        cases += _both(f"{point.name}, DOP853", point, series, flow, list(STEPS))
    return (*cases, *_with_digits(j, order))


def _both(name: str, point: Place, series: Sheet, flow: true_orbits.Flow, steps: list[Any]) -> list[RemainderCase]:
    """The remainders of v_c and of phi."""
    return [
        RemainderCase(
            name,
            quantity,
            series.order,
            first_omitted(point, series.contact.order, series.order, quantity),
            measured(series, flow, quantity, steps),
        )
        for quantity in ("v_c", "phi")
    ]


def _with_digits(j: int, order: int) -> list[RemainderCase]:
    """The linear model in closed form with true_orbits.SETTINGS.digits digits."""
    point = setting("linear, omega 2", j)
    context, origin, clearance = true_orbits.many_digits(j)
    model = point.model.replace(clearance=clearance)
    series = sheet(Contact.of(model, origin, j, order, Multiprecision(context)), order)
    flow = true_orbits.closed_flow(Fraction(2), clearance, origin, context)
    steps = [context.mpf(10) ** power for power in DIGIT_STEPS]
    return _both("linear, closed form, 40 digits and more", point, series, flow, steps)
