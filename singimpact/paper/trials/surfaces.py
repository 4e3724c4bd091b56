"""Numbers on the impact surface of two models: points of H, crossings after the first hit; exact motions."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from singimpact.algebra import Array, as_float, motion
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.oscillator.model import Oscillator
from singimpact.paper.trials import true_orbits

Tried = tuple[str, bool]  # what was found on true orbits, in words, and whether it is as it should be


def path(model: Oscillator, tau: float, x: float, v: float, times: ArrayLike) -> Array:
    """(x, x-dot) of a free flight at increasing or decreasing times after tau, by DOP853; shape (2, len(times))."""
    force, forcing = true_orbits.force_and_forcing(model)

    def field(time: float, state: Array) -> list[float]:
        return [state[1], float(forcing(tau + time) - force(state[0], state[1]))]

    steps = np.atleast_1d(np.asarray(times, dtype=float))
    return np.asarray(
        solve_ivp(field, (0.0, steps[-1]), [x, v], method="DOP853", t_eval=steps, rtol=1e-13, atol=1e-14).y
    )


def flow(model: Oscillator) -> Callable[[float, float, float, float], Array]:
    """(tau, x, v, t) -> (x, x-dot) after t."""
    return lambda tau, x, v, t: path(model, tau, x, v, t)[:, -1]


def clearance(model: Oscillator) -> float:
    """c as a double."""
    return as_float(model.clearance)


@dataclass(frozen=True)
class TouchingFlight:
    """A flight from rest with a = 0 at s = 0: a, a' there, x-dot and v_(sigma t) where it is back."""

    acceleration: Any
    slope: Any
    velocity: Any
    mixed: Any


PATH = sympy.Symbol("s")


@lru_cache(maxsize=8)
def touching_flight(x: sympy.Expr = PATH**3 * (1 - PATH) ** 2) -> TouchingFlight:
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


def exact_sheet(height: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
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
    motion((sigma, v, t), sympy.expand(v * t + moved), jets, {}, launch=sympy.expand(-sympy.cancel(moved / t)))
    return launch, landing


@lru_cache(maxsize=1)
def pressed_point() -> tuple[Tried, dict[str, str]]:
    """A state of rest of the linear model with a < 0 and c > 0: where the free flight goes, and its numbers."""
    model = true_orbits.LINEAR
    c, a = clearance(model), float(model.acceleration(1.2))
    heights = [float(flow(model)(1.2, c, 0.0, t)[0]) for t in (0.01, 0.005, 0.001)]
    name = (
        f"at a point with a = {a:.3g} < 0 and c = {c:.3g} the free flight has x_c > 0 and "
        "x_c < c for small t: the mass cannot follow it"
    )
    numbers = {"c": f"{c:.3g}", "a": f"{a:.6g}", "x_c at t = 0.01": f"{heights[0]:.9f}"}
    return (name, min(heights) > 0 and max(heights) < c), numbers


@lru_cache(maxsize=1)
def horizon_images() -> Tried:
    """Flights run backwards from rest to an earlier crossing: launched there they touch c at rest (points of H)."""
    touches = [_touching(model, float(tau)) for model in true_orbits.MODELS.values() for tau in np.linspace(0, 3.5, 25)]
    misses = [miss for miss in touches if miss is not None]
    name = f"phi takes {len(misses)} points of H on two models to |v| <= {max(misses):.0e}"
    return name, max(misses) < 1e-9


def _touching(model: ImpactOscillator, tau: float) -> float | None:
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


def _crossings(heights: Array) -> Array:
    return np.flatnonzero(np.sign(heights[1:]) != np.sign(heights[:-1]))


@lru_cache(maxsize=1)
def semiconjugacy() -> tuple[Tried, dict[str, str]]:
    """G o p against R o phi at first hits by the impact map, at later crossings by DOP853; a later one in numbers."""
    visible, worst, misses, example = 0, 0.0, [], dict[str, str]()
    for name, model in true_orbits.MODELS.items():
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
                example = {
                    "model": name,
                    "tau": f"{tau:.6f}",
                    "v": f"{v:.6f}",
                    "t of a later crossing": f"{float(times[sign[0]]):.6f}",
                    "first hit": f"{t:.6f}",
                }
    name = f"at {visible} first hits of two models G(p(z)) = R(phi(z)) to {worst:.0e}, at later crossings not"
    return (name, worst < 1e-9 and min(misses, default=0.0) > 1e-3), example
