"""The foot X of an unfolded negative swan of five oscillators, at two half distances H of its tangency points."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from math import log

import numpy as np

import singimpact as si
from singimpact.dynamics import swan_configuration
from singimpact.oscillator import acceleration
from singimpact.paper import System, resting_times

RATES = ("3/10", "1/2", "4/5")
SIZES = (0.004, 0.002)  # half distances H tried, to leading order in c_0 - c
REST = 1e-7  # in H: an orbit from rest so far behind A has the same foot to its square, and A itself is rounded


@lru_cache(maxsize=8)
def limit_of(r: str, sigma: float = -1.0, v: float = 0.0) -> float:
    """Where chatter from (sigma, v) comes to rest in the negative swan; for A itself this is X."""
    return float(resting_times(si.universal(-1, r), [sigma], [v], 2000, 1e-14)[0])


Model = System  # without its clearance
MODELS = (
    Model("x'' + x = cos 2t + sin(3t)/5", "x", "cos(2*t) + 0.2*sin(3*t)"),
    Model("x'' + x'/2 + x = cos 2t", "x + 0.5*xdot", "cos(2*t)"),
    Model("x'' + 3x'/10 + x + 2x^3/5 = cos 2t", "x + 0.3*xdot + 0.4*x**3", "cos(2*t)"),
    Model("x'' - 2(1 - x^2)x'/5 + x = (13/10) cos 2.8t", "x - 0.4*(1 - x**2)*xdot", "1.3*cos(2.8*t)"),
    Model("x'' + x'/5 + x^3 = cos 2t + cos(4t + 1)/5", "x**3 + 0.2*xdot", "cos(2*t) + 0.2*cos(4*t + 1)"),
)


# f_v(c, 0) of each
FRICTION = dict(
    zip(MODELS, (lambda _: 0.0, lambda _: 0.5, lambda _: 0.3, lambda c: -0.4 * (1 - c**2), lambda _: 0.2), strict=True)
)


@dataclass(frozen=True)
class Feet:
    """Measurements of the foot for one model and r.

    Attributes
    ----------
    chi : f_v + 2 a'''/(3 a'') at the swan point. limit : X of the universal model. sizes : H. offsets : X_H - X.
    """

    chi: float
    limit: float
    sizes: tuple[float, ...]
    offsets: tuple[float, ...]

    def order(self, errors: Sequence[float]) -> float:
        """The order of errors in H."""
        return log(abs(errors[0] / errors[1])) / log(self.sizes[0] / self.sizes[1])


@cache
def _swan(model: Model) -> tuple[float, float, float, float]:
    """(c_0, tau_*, |a''|, chi) of its first negative swan point."""
    osc = model.over("0", "1/2")
    point = next(each for each in si.swan_points(osc.f, osc.g) if str(each.kind) == "negative")
    c, tau = float(point.clearance), float(point.tau)
    at = model.over(repr(c), "1/2")
    second, third = (float(acceleration(at, np.array([tau]), order=n)[0]) for n in (2, 3))
    return c, tau, abs(second), FRICTION[model](c) + 2 * third / (3 * second)


@cache
def measured(model: Model, rate: str, tried: tuple[float, ...] = SIZES) -> Feet:
    """X_H - X at each H; times are taken from the middle of A and B, in units of H."""
    c, tau, bend, chi = _swan(model)
    sizes, offsets, limit = [], [], limit_of(rate)
    for size in tried:
        osc = model.over(repr(c - bend * size**2 / 2), rate)
        near = swan_configuration(osc, near=tau)
        half = (near.B - near.A) / 2
        rest = float(si.chatter_limit(osc, near.A + REST * half, 0).tau)
        sizes.append(half)
        offsets.append((rest - (near.A + near.B) / 2) / half - limit)
    return Feet(chi, limit, tuple(sizes), tuple(offsets))
