"""Numbers on the impact surface of two models: gradients, points of H and Z, jumps, crossings after the first hit."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from singimpact.algebra.derivations import motion
from singimpact.algebra.numbers import as_float
from singimpact.algebra.solving import halved, secant
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.trials import true_orbits

SEED = 20071
STEP = 1e-5  # of central differences: truncation and rounding are both near 1e-10


def models() -> list[tuple[str, ImpactOscillator]]:
    """The two models of `true_orbits`, with methods."""
    return [(name, ImpactOscillator(**model.to_dict())) for name, model in true_orbits.MODELS.items()]


def path(model: Any, tau: float, x: float, v: float, times: Any) -> Any:
    """(x, x-dot) of a free flight at increasing or decreasing times after tau, by DOP853; shape (2, len(times))."""
    force, forcing = true_orbits.force_and_forcing(model)

    def field(time: float, state: Any) -> list[float]:
        return [state[1], float(forcing(tau + time) - force(state[0], state[1]))]

    steps = np.atleast_1d(np.asarray(times, dtype=float))
    found = solve_ivp(field, (0.0, steps[-1]), [x, v], method="DOP853", t_eval=steps, rtol=1e-13, atol=1e-14)
    return found.y


def flow(model: Any) -> Any:
    """(tau, x, v, t) -> (x, x-dot) after t."""
    return lambda tau, x, v, t: path(model, tau, x, v, t)[:, -1]


def clearance(model: Any) -> float:
    """c as a double."""
    return as_float(model.clearance)


@dataclass(frozen=True)
class Gradient:
    """The gradient of x_c at a point of V_c: its size, and how well x_tau = x-dot - v x_c - A x_v holds."""

    name: str
    gradient: float
    identity_error: float


def _gradient(name: str, model: Any, tau: float, v: float, t: float) -> Gradient:
    at = flow(model)
    c = clearance(model)

    def slope(d_tau: float, d_x: float, d_v: float) -> float:
        ahead = at(tau + d_tau, c + d_x, v + d_v, t)[0]
        behind = at(tau - d_tau, c - d_x, v - d_v, t)[0]
        return float(ahead - behind) / (2 * STEP)

    x_tau, x_x, x_v = slope(STEP, 0, 0), slope(0, STEP, 0), slope(0, 0, STEP)
    speed = float(at(tau, c, v, t)[1])
    push = (float(at(tau, c, v, STEP)[1]) - float(at(tau, c, v, -STEP)[1])) / (2 * STEP)
    error = abs(x_tau - (speed - v * x_x - push * x_v)) / (1 + abs(x_x) + abs(x_v))
    return Gradient(name, float(np.linalg.norm([x_tau, x_v, speed])), error)


@lru_cache(maxsize=1)
def gradients() -> tuple[Gradient, ...]:
    """At first hits from random states of two models."""
    rng = np.random.default_rng(SEED)
    found = []
    for name, model in models():
        for tau, v in zip(rng.uniform(0, 3, 6), rng.uniform(0.2, 1.5, 6), strict=True):
            step = model.first_hit(tau, v)
            found.append(_gradient(name, model, float(tau), float(v), float(step.flight_time)))
    return tuple(found)


@dataclass(frozen=True)
class ZeroSetPoint:
    """A point of Z found from rest: second derivative of v along the sheet after the involution, found and expected."""

    second: float
    expected: float


@lru_cache(maxsize=1)
def zero_set_points() -> tuple[ZeroSetPoint, ...]:
    """From rest at times with a > 0: at landing (tau', w) reversed, the sheet has v_tt = -a(tau)/(t dy/dv)."""
    places = [(model, tau) for _, model in models() for tau in (0.1, 2.9) if model.acceleration(tau) > 0]
    return tuple(_zero_set_point(model, tau) for model, tau in places)


def _zero_set_point(model: Any, tau: float, h: float = 1e-2) -> ZeroSetPoint:
    at, c = flow(model), clearance(model)
    t = float(model.first_hit(tau, 0.0).flight_time)
    w = float(at(tau, c, 0.0, t)[1])
    values = [_launch(at, c, tau + t, w, -t + n * h) for n in (-2, -1, 0, 1, 2)]
    second = float(np.dot([-1, 16, -30, 16, -1], values)) / (12 * h * h)
    rate = (float(at(tau + t, c, w + STEP, -t)[0]) - float(at(tau + t, c, w - STEP, -t)[0])) / (2 * STEP)
    return ZeroSetPoint(second, -float(model.acceleration(tau)) / rate)


def _launch(at: Any, c: float, tau: float, v: float, time: float) -> float:
    """The launch velocity near v of a flight that is back after `time`."""
    return float(secant(lambda speed: float(at(tau, c, speed, time)[0]) - c, v, v + 1e-6, 30, 1e-15))


@dataclass(frozen=True)
class TouchingFlight:
    """A flight from rest with a = 0 at s = 0: a, a' there, x-dot and v_(sigma t) where it is back."""

    acceleration: Any
    slope: Any
    velocity: Any
    mixed: Any


PATH = sympy.Symbol("s")


@lru_cache(maxsize=8)
def touching_flight(x: Any = PATH**3 * (1 - PATH) ** 2) -> TouchingFlight:
    """The derivatives that a cusp of phi would need at the first return of the flight x(s) from rest, exactly."""
    s, e = PATH, sympy.Symbol("e")
    back = min(root for root in sympy.Poly(x, s).real_roots() if root > 0)
    forcing = sympy.Poly(sympy.expand(sympy.diff(x, s, 2)), s)
    twice = sum(value * s ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in forcing.terms())  # X'' = forcing
    # launch at s, back at e: v(s, e) = X'(s) - (X(e) - X(s))/(e - s); at the landing the other way round
    launch = sympy.cancel(sympy.diff(twice, s) - (twice.subs(s, e) - twice) / (e - s))
    after = launch.subs({s: e, e: s}, simultaneous=True)  # velocity at the landing, phi = (e, after)
    at = {s: 0, e: back}
    return TouchingFlight(
        acceleration=forcing.eval(0),
        slope=sympy.diff(forcing.as_expr(), s).subs(s, 0),
        velocity=after.subs(at),
        mixed=sympy.diff(after, s, e).subs(at),
    )


def exact_sheet(height: Any) -> tuple[Any, Any]:
    """(v_c, x-dot) of a polynomial motion x = height(v, t) launched at 0 from c = 0; the certificate is left.

    Examples
    --------
    >>> from singimpact.paper.routes.implicit import t, v
    >>> exact_sheet(v * t + t**2 / 2)
    (-t/2, t/2)
    """
    from singimpact.paper.routes.implicit import sigma, t, v

    forcing = sympy.Poly(sympy.diff(height, t, 2), t)
    launch = sympy.expand(-sympy.cancel((height - v * t) / t))
    landing = sympy.expand(sympy.diff(height, t).subs(v, launch))
    jets = [forcing.nth(n) for n in range(forcing.degree() + 1)]
    # at other launch times the motion has the same acceleration, counted from there
    moved = sum(
        jet * ((sigma + t) ** (n + 2) - sigma ** (n + 2) - (n + 2) * sigma ** (n + 1) * t) / ((n + 1) * (n + 2))
        for n, jet in enumerate(jets)
    )
    whole = sympy.expand(v * t + moved)
    motion((sigma, v, t), whole, jets, {}, launch=sympy.expand(-sympy.cancel(moved / t)))
    return launch, landing


@dataclass(frozen=True)
class PressedPoint:
    """A state of rest with a < 0 and c > 0: where the free flight goes."""

    clearance: float
    acceleration: float
    height: float
    above_zero: bool
    below_c: bool


@lru_cache(maxsize=1)
def pressed_point() -> PressedPoint:
    """The linear model at tau = 1.2."""
    _, model = models()[0]
    c, a = clearance(model), float(model.acceleration(1.2))
    heights = [float(flow(model)(1.2, c, 0.0, t)[0]) for t in (0.01, 0.005, 0.001)]
    return PressedPoint(c, a, heights[0], min(heights) > 0, max(heights) < c)


@dataclass(frozen=True)
class Jumps:
    """Jumps of the first-hit map on lines of states: how many, on how many lines, the worst |x-dot| at the touch."""

    count: int
    lines: int
    worst: float


@lru_cache(maxsize=1)
def jumps_are_grazes() -> Jumps:
    """Bisect every jump of the flight time along lines tau = const, and look at the impact velocity beside it."""
    count, lines, worst = 0, 0, 0.0
    for _, model in models():
        for tau in np.linspace(0.2, 3.0, 12):
            lines += 1
            for low, high in _jumps(model, float(tau)):
                count += 1
                worst = max(worst, _touch(model, float(tau), low, high))
    return Jumps(count, lines, worst)


def _jumps(model: Any, tau: float, coarse: int = 151, fine: int = 10, least: float = 0.3) -> list[tuple[float, float]]:
    """Neighbours between which the flight time jumps, of coarse * fine velocities: looked for where it changes much."""
    v = np.linspace(0.05, 2.5, coarse)
    times = np.asarray(model.impact_map(tau, v).flight_time)
    jumps = []
    for at in np.flatnonzero(np.abs(np.diff(times)) > least):
        between = np.linspace(v[at], v[at + 1], fine + 1)
        times_between = np.asarray(model.impact_map(tau, between).flight_time)
        places = np.flatnonzero(np.abs(np.diff(times_between)) > least)
        jumps += [(float(between[index]), float(between[index + 1])) for index in places]
    return jumps


def _touch(model: Any, tau: float, low: float, high: float) -> float:
    """The smaller |x-dot| at the first hit on the two sides of a jump, after bisection to 1e-13."""
    start = float(model.first_hit(tau, low).flight_time)
    ends = halved(lambda v: abs(float(model.first_hit(tau, v).flight_time) - start) <= 0.1, low, high, 1e-13)
    return float(min(abs(float(model.first_hit(tau, v).velocity)) for v in ends))


@dataclass(frozen=True)
class Images:
    """The number of points that were mapped, and the worst deviation."""

    count: int
    worst: float


@lru_cache(maxsize=1)
def horizon_images() -> Images:
    """Flights run backwards from rest to an earlier crossing: launched there they touch c at rest (points of H)."""
    misses = [_touching(model, float(tau)) for _, model in models() for tau in np.linspace(0, 3.5, 25)]
    found = [miss for miss in misses if miss is not None]
    return Images(len(found), max(found))


def _touching(model: Any, tau: float) -> float | None:
    """|x-dot| at (tau, c) of the flight from the last crossing before tau of the orbit that rests there."""
    at, c = flow(model), clearance(model)
    times = np.linspace(0.05, 6, 200)
    flown = path(model, tau, c, 0.0, -times)
    sign = _crossings(flown[0] - c)
    if not len(sign):
        return None
    (x, xdot), begun = flown[:, sign[0]], times[sign[0]]  # the rest of the way is one step of DOP853
    t = brentq(
        lambda u: float(at(tau - begun, x, xdot, begun - u)[0]) - c if u > begun else x - c,
        begun,
        times[sign[0] + 1],
        xtol=1e-13,
    )
    v = float(at(tau - begun, x, xdot, begun - t)[1])
    return abs(float(at(tau - t, c, v, t)[1]))


def _crossings(heights: Any) -> Any:
    """Indices before which the sign changes."""
    return np.flatnonzero(np.sign(heights[1:]) != np.sign(heights[:-1]))


@lru_cache(maxsize=1)
def common_orbits() -> Images:
    """From p(z) and from phi(z) one reaches the same state at a third time."""
    rng = np.random.default_rng(SEED)
    count, worst = 0, 0.0
    for _, model in models():
        at, c = flow(model), clearance(model)
        for tau, v in zip(rng.uniform(0, 3, 8), rng.uniform(0.2, 1.5, 8), strict=True):
            hit = model.first_hit(tau, v)
            t, w = float(hit.flight_time), float(hit.velocity)
            one, two = at(tau, c, v, t + 0.7), at(tau + t, c, w, 0.7)
            count += 1
            worst = max(worst, abs(float(one[0]) - float(two[0])), abs(float(one[1]) - float(two[1])))
    return Images(count, worst)


@dataclass(frozen=True)
class Semiconjugacy:
    """G o p against R o phi at first hits (worst difference) and at later crossings (least difference)."""

    name: str
    visible: int
    worst: float
    least_miss: float
    tau: float
    v: float
    first: float
    later: float


@lru_cache(maxsize=1)
def semiconjugacy() -> Semiconjugacy:
    """First hits by the impact map; crossings of the free flight, by DOP853, are points of V' too."""
    visible, worst, misses, example = 0, 0.0, [], ("", 0.0, 0.0, 0.0, 0.0)
    for name, model in models():
        at, c, r = flow(model), clearance(model), as_float(model.restitution)
        for tau, v in ((0.4, 0.6), (2.9, 0.5), (1.5, 0.3)):
            step = model.impact_map(tau, v)
            t = float(step.flight_time)
            image = (tau + t, -r * float(at(tau, c, v, t)[1]))
            visible += 1
            worst = max(worst, abs(image[0] - float(step.tau)), abs(image[1] - float(step.v)))
            times = np.linspace(t + 0.05, t + 6, 300)
            sign = _crossings(path(model, tau, c, v, times)[0] - c)
            if len(sign):
                misses.append(float(times[sign[0]]) - t)
                example = (name, tau, v, t, float(times[sign[0]]))
    return Semiconjugacy(example[0], visible, worst, min(misses, default=0.0), *example[1:])
