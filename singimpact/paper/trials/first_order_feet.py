"""The foot X of an unfolded negative swan of five oscillators, at two half distances H of its tangency points."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from math import log

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.contact.contact import force_jet
from singimpact.contact.swans import swan_points_over_clearance
from singimpact.dynamics.chatter import chatter_limit
from singimpact.dynamics.orbit import orbit
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.impact_oscillator import universal
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.paper.trials.true_orbits import System, resting_times

RATES = ("3/10", "1/2", "4/5")
SIZES = (0.004, 0.002)  # half distances H tried, to leading order in c_0 - c
REST = 1e-7  # in H: an orbit from rest so far behind A has the same foot to its square, and A itself is rounded


@lru_cache(maxsize=8)
def limit_of(r: str, sigma: float = -1.0, v: float = 0.0) -> float:
    """Where chatter from (sigma, v) comes to rest in the negative swan; for A itself this is X."""
    return float(resting_times(universal(-1, r), [sigma], [v], 2000, 1e-14)[0])


Model = System  # without its clearance
MODELS = (
    Model("x'' + x = cos 2t + sin(3t)/5", "x", "cos(2*t) + 0.2*sin(3*t)"),
    Model("x'' + x'/2 + x = cos 2t", "x + 0.5*xdot", "cos(2*t)"),
    Model("x'' + 3x'/10 + x + 2x^3/5 = cos 2t", "x + 0.3*xdot + 0.4*x**3", "cos(2*t)"),
    Model("x'' - 2(1 - x^2)x'/5 + x = (13/10) cos 2.8t", "x - 0.4*(1 - x**2)*xdot", "1.3*cos(2.8*t)"),
    Model("x'' + x'/5 + x^3 = cos 2t + cos(4t + 1)/5", "x**3 + 0.2*xdot", "cos(2*t) + 0.2*cos(4*t + 1)"),
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
    point = next(each for each in swan_points_over_clearance(osc) if each.kind == "negative")
    c, tau = float(point.clearance), float(point.tau)
    at = model.over(repr(c), "1/2")
    second, third = (float(acceleration(at, np.array([tau]), order=n)[0]) for n in (2, 3))
    damping = float(force_jet(at, 0, 2, DOUBLES).get((0, 1), 0.0))
    return c, tau, abs(second), damping + 2 * third / (3 * second)


@cache
def measured(model: Model, rate: str, tried: tuple[float, ...] = SIZES) -> Feet:
    """X_H - X at each H; times are taken from the middle of A and B, in units of H."""
    c, tau, bend, chi = _swan(model)
    sizes, offsets, limit = [], [], limit_of(rate)
    for size in tried:
        osc = model.over(repr(c - bend * size**2 / 2), rate)
        near = swan_configuration(osc, near=tau)
        half = (near.B - near.A) / 2
        rest = float(chatter_limit(osc, near.A + REST * half, 0).tau)
        sizes.append(half)
        offsets.append((rest - (near.A + near.B) / 2) / half - limit)
    return Feet(chi, limit, tuple(sizes), tuple(offsets))


# The orbit that is born at a negative swan with a_c < 0 elsewhere: released at A, it hops, chatters and rests.

BIRTH_RATES = ("3/10", "4/5")
DEPTHS = (4, 5)  # k: the clearance is c_0 - 10^-k
FINE = 4001  # times at which the height of a hop is sampled
FROM = ((0.3, 0.0), (0.5, 0.0), (0.3, 0.02), (0.6, 0.01))  # (phase in periods, v) of starts that end in the same orbit


# Oscillators whose a_c is largest at t = 0 modulo its period, where it is 0 at the clearance 1.
LIFTS = (
    Model("x'' + x = cos 2t", "x", "cos(2*t)"),
    Model("x'' + x'/2 + x = cos 2t", "x + 0.5*xdot", "cos(2*t)"),
    Model("x'' + x'/10 + x + 3x^3/10 = (13/10) cos 2t", "x + 0.1*xdot + 0.3*x**3", "1.3*cos(2*t)"),
)


@dataclass(frozen=True)
class Hop:
    """The hop of the orbit, beside its law.

    Attributes
    ----------
    half : H, half the time between A and B. first, speed, top, rest : time of the first hit after the release in units
        of H, its speed in units of |a''| H^3, the largest height in units of |a''| H^4, the time of rest in units of H.
    period : the largest difference of the time between two releases and the period. impacts : of a turn, summed up
        chatter counts as one. merged : whether other starts are released at the same phase.
    """

    half: float
    first: float
    speed: float
    top: float
    rest: float
    period: float
    impacts: int
    merged: bool


def clearance(depth: int) -> str:
    """1 - 10^-depth as a decimal."""
    return "0." + "9" * depth


@cache
def hop(lift: Model, rate: str, depth: int) -> Hop:
    """The orbit from rest between two swans, over three turns."""
    osc = lift.over(clearance(depth), rate)
    assert osc.period is not None
    period = as_float(osc.period)
    run = orbit(osc, FROM[0][0] * period, FROM[0][1], 400)
    releases = np.flatnonzero(run.kind == "release")
    start = int(releases[0])
    A = float(run.tau[start])
    half = (round(A / period) * period) - A  # a_c is even about its maximum
    bend = abs(float(acceleration(osc, np.array([A + half]), order=2)[0]))
    hits = run.tau[start + 1 :]
    v = float(run.v[start + 1])
    completed = float(run.tau[start + 1 :][run.kind[start + 1 :] == "complete"][0])
    top = float(np.max(run.sample(np.linspace(A, float(hits[0]), FINE)).x)) - as_float(osc.clearance)
    runs = [orbit(osc, share * period, speed, 400) for share, speed in FROM]
    return Hop(
        half=half,
        first=(float(hits[0]) - A) / half,
        speed=v / as_float(osc.slope_at_rest()) / (bend * half**3),
        top=top / (bend * half**4),
        rest=(completed - A) / half,
        period=float(np.max(np.abs(np.diff(run.tau[releases]) - period))),
        impacts=int(releases[1] - releases[0] - 2),
        merged=bool(np.ptp([float(other.tau[other.kind == "release"][0]) % period for other in runs]) < 1e-12),
    )
