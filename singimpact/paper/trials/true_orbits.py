"""Witnesses that share no code with the theory: true flights by scipy's DOP853, and in closed form with many digits.

A flow gives (y, x') of a flight from (tau, v) after t, where y = (x - c)/t; impacts are zeros of y, found by Newton's
method from the classical guesses.  On these, gamma is reached by following the impact map backwards, which attracts
to it, from a point that is not on it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import DOUBLES, Array, as_float, as_fraction, function_of, halved
from singimpact.contact import acceleration, acceleration_jet, force_jet, swan_points_over_clearance, tangency_points
from singimpact.flights.impact_map import impact_map
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.oscillator import wall_acceleration
from singimpact.oscillator.model import Oscillator

Flow = Callable[[Any, Any, Any], tuple[Any, Any]]

LINEAR = ImpactOscillator("x", "cos(2*t)", "0.3", "0.5")
DUFFING = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")
MODELS = {"linear, omega 2": LINEAR, "damped Duffing, omega 1.7": DUFFING}


class System(NamedTuple):
    """An oscillator but for its restitution; a contact point of some order, and a phase before it."""

    name: str
    f: str
    g: str
    clearance: str = "0"
    order: int = 1
    tau: float = 0.0

    def over(self, clearance: str, rate: str) -> Oscillator:
        """The oscillator over a wall at a clearance, with a restitution."""
        return Oscillator(self.f, self.g, clearance, rate)


@dataclass(frozen=True)
class WitnessTolerances:
    """Settings of the witnesses.

    relative : of DOP853; near the smallest it accepts (2.3e-14).
    noise : rounding of the acceleration, a difference of numbers of size 1; DOP853 halves its step for ever below it.
    newton : a step below this part of t ends the search. stalled : or one below this part that no longer shrinks.
    start : |sigma| where a backward orbit begins in doubles, at a tangency and at a swan; a_c is above the noise there.
    digits : guard and working digits of the closed form; y loses as many as sigma has, here at most 3 x 25.
    """

    relative: float = 3e-14
    noise: float = 3e-15
    newton: float = 1e-13
    stalled: float = 1e-5
    start: tuple[float, float] = (1e-8, 3e-4)
    turns: int = 60
    digits: int = 160


SETTINGS = WitnessTolerances()


def force_and_forcing(model: Oscillator) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """f(x, x') and g(t) in doubles."""
    return function_of(model.force(), ("x", "xdot"), DOUBLES), function_of(model.forcing(), ("t",), DOUBLES)


def scipy_flow(model: Oscillator, origin: float) -> Flow:
    """The flow with launch times counted from `origin`, by DOP853 on z = x - c."""
    from scipy.integrate import solve_ivp

    clearance, (force, forcing) = as_float(model.clearance), force_and_forcing(model)

    def field(s: float) -> Callable[[float, Any], list[float]]:
        return lambda u, z: [z[1], float(forcing(origin + (s + u))) - float(force(clearance + z[0], z[1]))]

    def flow(s: float, v: float, t: float) -> tuple[float, float]:
        place = max(SETTINGS.relative * abs(v * t), SETTINGS.noise * t * t)
        speed = max(SETTINGS.relative * abs(v), SETTINGS.noise * abs(t))
        found = solve_ivp(field(s), (0.0, t), [0.0, v], method="DOP853", rtol=SETTINGS.relative, atol=[place, speed])
        return float(found.y[0, -1]) / t, float(found.y[1, -1])

    return flow


def closed_flow(omega: Fraction, clearance: Fraction, origin: Any, context: Any) -> Flow:
    """The flow of x'' + x = cos(omega t) in an mpmath context, launch times counted from `origin`."""
    w, c = context.mpf(omega.numerator) / omega.denominator, context.mpf(clearance.numerator) / clearance.denominator
    gain = 1 / (1 - w * w)

    def flow(s: Any, v: Any, t: Any) -> tuple[Any, Any]:
        start = origin + s
        alpha, beta = c - gain * context.cos(w * start), v + gain * w * context.sin(w * start)
        x = gain * context.cos(w * (start + t)) + alpha * context.cos(t) + beta * context.sin(t)
        slope = -gain * w * context.sin(w * (start + t)) - alpha * context.sin(t) + beta * context.cos(t)
        return (x - c) / t, slope

    return flow


def return_time(flow: Flow, s: Any, v: Any, guess: Any, accuracy: Any = None) -> tuple[Any, Any]:
    """(t, x') at the zero of y near a guess, by Newton's method; dy/dt = (x' - y)/t.

    Raises
    ------
    ArithmeticError : no convergence.
    """
    t, target, last = guess, SETTINGS.newton if accuracy is None else accuracy, float("inf")
    for _ in range(SETTINGS.turns):
        y, slope = flow(s, v, t)
        step = y * t / (slope - y)
        t = t - step
        size = abs(step / t)
        if size < target or (accuracy is None and last <= size < SETTINGS.stalled):
            return t, flow(s, v, t)[1]
        last = size
    raise ArithmeticError(f"no impact found near t = {guess} from sigma = {s}, v = {v}")


@dataclass(frozen=True)
class SlopeCase:
    """A slope of a stable manifold at Pi_0 found on true orbits; a and r at its foot."""

    name: str
    a: float
    r: float
    found: float


def _chatter_sum(flow: Flow, acceleration_at: Callable[[float], float], s: float, v: float, r: float) -> float:
    """tau_inf - s: flights one after the other until the rest, 2v/(|a|(1-r)) at the end, is below rounding."""
    start = s
    while v > 1e-12:
        t, slope = return_time(flow, s, v, -2 * v / acceleration_at(s))
        s, v = s + t, -r * slope
    return s - start - 2 * v / (acceleration_at(s) * (1 - r))


def _regular(model: Oscillator, tau: float) -> tuple[Flow, Callable[[float], float], float]:
    at_rest = function_of(acceleration(model), ("t",), DOUBLES)
    return scipy_flow(model, tau), lambda s: float(at_rest(tau + s)), as_float(model.restitution)


@lru_cache(maxsize=1)
def chatter_slopes() -> tuple[SlopeCase, ...]:
    """Slopes v/(tau - tau_inf) of true chatter sequences, extrapolated to v = 0 over the regular point tau = 1.2."""
    cases = []
    for name, model in MODELS.items():
        flow, a, r = _regular(model, 1.2)
        slopes = [-v / _chatter_sum(flow, a, 0.0, v, r) for v in (4e-3, 2e-3, 1e-3)]
        first = [2 * slopes[1] - slopes[0], 2 * slopes[2] - slopes[1]]
        cases.append(SlopeCase(name, a(0.0), r, (4 * first[1] - first[0]) / 3))
    return tuple(cases)


@lru_cache(maxsize=1)
def completion_orders() -> tuple[float, ...]:
    """Order in v of tau_inf minus its smooth expansion to second order in v, on true chatter sequences.

    With w = v/a: tau_inf = tau - 2w/(1-r) - (2/3) w^2 (2a'/a + f_v)/(1-r)^2 + O(v^3).
    """
    orders = []
    for model in MODELS.values():
        flow, a, r = _regular(model, 1.2)
        slope = (a(1e-5) - a(-1e-5)) / 2e-5
        damping = -float(force_jet(model, 0, 2, DOUBLES).get((0, 1), 0.0))
        misses = []
        for v in (8e-3, 4e-3):
            w = v / a(0.0)
            series = -2 * w / (1 - r) - 2 / 3 * w**2 * (2 * slope / a(0.0) - damping) / (1 - r) ** 2
            misses.append(abs(_chatter_sum(flow, a, 0.0, v, r) - series))
        orders.append(float(np.log2(misses[0] / misses[1])))
    return tuple(orders)


@dataclass(frozen=True)
class GammaCase:
    """The leading coefficient of gamma at a contact point, found on true orbits.

    Attributes
    ----------
    name : model, contact and flow. expected, multiplier : by the theory. found, ratio (of sigma) : on true orbits.
    """

    name: str
    j: int
    expected: float
    found: float
    multiplier: float
    ratio: float

    @property
    def error(self) -> float:
        """Relative error of the coefficient found."""
        return abs(self.found / self.expected - 1)

    def line(self) -> str:
        """One line for a table."""
        return f"{self.name}: {self.found:.12g} (theory {self.expected:.12g})"


def backwards(
    flow: Flow, r: Any, s: Any, v: Any, rate: float, stop: float, accuracy: Any = None
) -> list[tuple[Any, Any]]:
    """Points (sigma, v) of the orbit before (s, v), until |sigma| > stop.

    The flight before (s, v) is run in negative time from impact velocity -v/r; `rate` is the guess of sigma'/sigma.
    """
    orbit = [(s, v)]
    while abs(s) < stop:
        t, slope = return_time(flow, s, -v / r, s * (1 / rate - 1), accuracy)
        s, v = s + t, slope
        orbit.append((s, v))
    return orbit


def extrapolated(points: list[tuple[Any, Any]]) -> Any:
    """The value at sigma = 0 of the polynomial through (sigma, value) pairs."""
    total = 0
    for n, (s, value) in enumerate(points):
        weight = 1
        for m, (other, _) in enumerate(points):
            if m != n:
                weight = weight * other / (other - s)
        total = total + weight * value
    return total


def lambda_of(r: float, j: int) -> float:
    """The root in (0, 1) of r = lambda^(j+1) P_j/Q_j, by bisection: numbers only, for a guess and a comparison."""

    def restitution(rate: float) -> float:
        above = sum((j + 1 - i) * rate**i for i in range(j + 1))
        return rate ** (j + 1) * above / sum((i + 1) * rate**i for i in range(j + 1))

    return float(halved(lambda rate: restitution(rate) < r, 0.0, 1.0)[0])


def gamma_case(name: str, model: Oscillator, a_j: float, j: int, flow: Flow, start: Any, accuracy: Any) -> GammaCase:
    """Follow G backwards from a point beside gamma, and read off the leading coefficient."""
    r = as_fraction(model.restitution)
    if r is None:
        raise ArithmeticError("a rational restitution is needed here")
    rate = lambda_of(float(r), j)
    p = sum((j + 1 - i) * rate**i for i in range(j + 1))
    expected = a_j * (1 - rate) * p / ((j + 1) * (j + 2))
    one = start / start
    orbit = backwards(
        flow,
        one * r.numerator / r.denominator,
        -start,
        abs(start) ** (j + 1) * 0.9 * abs(expected),
        rate,
        3e-2,
        accuracy,
    )
    tail = orbit[-5:]
    limit = float(extrapolated([(s, v / s ** (j + 1)) for s, v in tail]))
    ratio = float(extrapolated([(before[0], after[0] / before[0]) for after, before in pairwise(tail)]))
    return GammaCase(name, j, expected, limit, rate, ratio)


@lru_cache(maxsize=4)
def gamma_cases(j: int) -> tuple[GammaCase, ...]:
    """gamma at a tangency (j = 1) or at each model's own swan (j = 2), on DOP853 and, linear, with 40 digits."""
    cases = []
    where = "tangency" if j == 1 else "swan"
    for name, model in MODELS.items():
        at, tau = contact_model(model, j)
        a_j = float(acceleration_jet(at, tau, j, DOUBLES)[j])
        cases.append(
            gamma_case(f"{name}, {where}, DOP853", at, a_j, j, scipy_flow(at, tau), SETTINGS.start[j - 1], None)
        )
    context, origin, clearance = many_digits(j)
    flow = closed_flow(Fraction(2), clearance, origin, context)
    a_j = 2 * sqrt(1 - 0.09) if j == 1 else -2.0
    start = context.mpf(10) ** -25
    cases.append(
        gamma_case(
            f"linear, {where}, closed form in 40 digits and more", LINEAR, a_j, j, flow, start, context.mpf(10) ** -40
        )
    )
    return tuple(cases)


def resting_times(model: Oscillator, tau: Any, v: Any, impacts: int, least: float, after: float = -inf) -> Array:
    """Times at which chatter from states comes to rest, later than a time.

    Parameters
    ----------
    impacts : flown at most. least : a velocity from which on the flights left are summed up.
    """
    tau, v = np.array(tau, dtype=float), np.array(v, dtype=float)
    flying = np.arange(tau.size)
    for _ in range(impacts):
        step = impact_map(model, tau[flying], v[flying])
        tau[flying], v[flying] = step.tau, step.v
        flying = np.flatnonzero((v > least) | (tau < after))
        if not flying.size:
            break
    return np.asarray(tau - 2 * v / (wall_acceleration.acceleration(model, tau) * (1 - as_float(model.restitution))))


def many_digits(j: int) -> tuple[Any, Any, Fraction]:
    """(mpmath context, tau_*, clearance) of the linear model at a regular point, its tangency or its swan."""
    from mpmath.ctx_mp import MPContext

    context = MPContext()
    context.dps = SETTINGS.digits
    if j == 0:
        return context, context.mpf(6) / 5, Fraction(3, 10)
    if j == 1:
        return context, context.pi - context.acos(context.mpf(3) / 10) / 2, Fraction(3, 10)
    return context, context.mpf(0), Fraction(1)


def contact_model(model: ImpactOscillator, j: int) -> tuple[ImpactOscillator, float]:
    """The model at its first tangency with a' > 0, or at its own negative swan."""
    if j == 1:
        return model, next(point.tau for point in tangency_points(model) if point.kind == "gamma")
    swans = swan_points_over_clearance(model, (Fraction(-2), Fraction(2)))
    swan = next(point for point in swans if point.kind == "negative")
    return model.replace(clearance=swan.clearance), swan.tau
