"""The sheet V_c' of two models found on true flights: launch and impact velocities of flights that are back after t.

Remainders of v_c, p and phi on true flights fall off with the degree of the first omitted term. That degree is computed
in balls before it is measured: a part of the series counts as present when its ball excludes zero, and as absent when
the ball contains zero and is narrower than 1e-50.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np
import sympy

from singimpact.algebra import DOUBLES, Balls, Jet, Multiprecision, as_float, balls_at, secant
from singimpact.contact import Contact, contact_order, force_jet, tangency_points
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.trials import true_orbits
from singimpact.theory.impact_sheet import Sheet, sheet

STEPS = (0.04, 0.02, 0.01, 0.005)  # of the distance from the point; the rest is extrapolated to distance 0
PAIRS = ((1, 0), (0, 1), (0, 2), (1, 1))  # derivatives of f that v_c contains to third order
REGULAR = 1.2  # a phase at which every model here presses, a_c < 0
DAMPED = {
    "damped linear, omega 2": ImpactOscillator("x + 0.4*xdot", "cos(2*t)", "0.3", "0.5"),
    "damped Duffing, omega 1.7": true_orbits.DUFFING,
}


@dataclass(frozen=True)
class Place:
    """A model at a time `tau`; launch times sigma are counted from there."""

    name: str
    model: ImpactOscillator
    tau: float

    @property
    def r(self) -> float:
        """The restitution."""
        return as_float(self.model.restitution)

    @property
    def multiplier(self) -> float:
        """lambda at a tangency: the factor by which sigma shrinks in an impact on gamma."""
        return true_orbits.lambda_of(self.r, 1)

    @property
    def coefficient(self) -> float:
        """The coefficient of sigma^2 in v on gamma, at a tangency with a' > 0."""
        rate = self.multiplier
        return float(self.model.acceleration(self.tau, order=1)) * (1 - rate) * (2 + rate) / 6

    def jets(self) -> dict[str, float]:
        """Values of the paper's letters: a and its derivatives, b = -f_v, r, k = a'/6, ell = -a''/24."""
        a = [float(self.model.acceleration(self.tau, order=n)) for n in range(4)]
        names = dict(zip(("a", "a_d1", "a_d2", "a_d3"), a, strict=True))
        force = force_jet(self.model, 0, 4, DOUBLES)
        names |= {f"f_{i}{k}": float(force.get((i, k), 0.0)) * factorial(i) * factorial(k) for i, k in PAIRS}
        return names | {"b": -names["f_01"], "r": self.r, "k": a[1] / 6, "ell": -a[2] / 24}

    def launch(self, sigma: float, t: float) -> float:
        """v_c(sigma, t): the v whose flight is back after t, t < 0 too, by the secant method."""
        flow = true_orbits.scipy_flow(self.model, self.tau)
        guess = -float(flow(sigma, 0.0, t)[0])
        return float(secant(lambda v: float(flow(sigma, v, t)[0]), 0.0, guess, small=1e-15 * abs(guess)))

    def impact(self, sigma: float, t: float) -> float:
        """x-dot at the return of that flight."""
        return float(true_orbits.scipy_flow(self.model, self.tau)(sigma, self.launch(sigma, t), t)[1])

    def leading(self, quantity: Any) -> float:
        """quantity(h) in the limit h -> 0."""
        return float(true_orbits.extrapolated([(h, quantity(h)) for h in STEPS]))

    def taylor(self, sigma: float, power: int) -> float:
        """The coefficient of t^power of v_c(sigma, t), from a polynomial through flights forwards and backwards."""
        t = 0.35 * np.cos(np.pi * (np.arange(14) + 0.5) / 14)
        values = [self.launch(sigma, float(time)) / float(time) for time in t]
        return float(np.polynomial.Polynomial.fit(t, values, 13).convert().coef[power - 1])


@lru_cache(maxsize=1)
def regular() -> tuple[Place, ...]:
    """Both models where a < 0."""
    return tuple(Place(name, model, REGULAR) for name, model in true_orbits.MODELS.items())


@lru_cache(maxsize=1)
def damped() -> tuple[Place, ...]:
    """Two models with f_v != 0, where a < 0."""
    return tuple(Place(name, model, REGULAR) for name, model in DAMPED.items())


@lru_cache(maxsize=1)
def tangencies() -> tuple[Place, ...]:
    """Both models at their tangency with a' > 0."""
    return tuple(Place(name, *true_orbits.contact_model(model, 1)) for name, model in true_orbits.MODELS.items())


@lru_cache(maxsize=1)
def foliated() -> tuple[Place, ...]:
    """Both models at their tangency with a' < 0."""
    return tuple(Place(name, model, foliation(model)) for name, model in true_orbits.MODELS.items())


def foliation(model: ImpactOscillator) -> float:
    """The first tangency of a model with a' < 0."""
    return next(point.tau for point in tangency_points(model) if point.kind == "foliation")


@lru_cache(maxsize=1)
def swans() -> tuple[Place, ...]:
    """Both models at their own negative swan."""
    return tuple(Place(name, *true_orbits.contact_model(model, 2)) for name, model in true_orbits.MODELS.items())


def number(expression: Any, values: dict[str, float]) -> float:
    """A sympy expression at values of its letters."""
    found = sympy.sympify(expression)
    return float(sympy.N(found.subs({name: values[str(name)] for name in found.free_symbols}, simultaneous=True)))


RAY = (Fraction(-1), Fraction(7, 10))  # (sigma, t) = h RAY: inside the visible part, off every curve named in the paper
REMAINDER_STEPS = (0.02, 0.01, 0.005)  # h for DOP853: small enough for one term to rule, remainders well above rounding
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
        cases += _both(f"{point.name}, DOP853", point, series, flow, list(REMAINDER_STEPS))
    return (*cases, *_with_digits(j, order))


def _both(name: str, point: Place, series: Sheet, flow: true_orbits.Flow, steps: list[Any]) -> list[RemainderCase]:
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
