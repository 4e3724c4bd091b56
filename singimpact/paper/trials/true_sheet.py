"""The sheet V_c' of two models found on true flights: launch and impact velocities of flights that are back after t."""

from dataclasses import dataclass
from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np
import sympy

from singimpact.algebra.numbers import as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.algebra.solving import secant
from singimpact.contact.contact import force_jet
from singimpact.contact.points import tangency_points
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.trials import true_orbits

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
