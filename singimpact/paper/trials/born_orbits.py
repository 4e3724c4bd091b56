"""The orbit that is born at a negative swan with a_c < 0 elsewhere: released at A, it hops, chatters and rests."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.dynamics.orbit import Orbit, orbit
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration

RATES = ("3/10", "4/5")
DEPTHS = (4, 5)  # k: the clearance is c_0 - 10^-k
FINE = 4001  # times at which the height of a hop is sampled
FROM = ((0.3, 0.0), (0.5, 0.0), (0.3, 0.02), (0.6, 0.01))  # (phase in periods, v) of starts that end in the same orbit


class Lift(NamedTuple):
    """An oscillator whose a_c is largest at t = 0 modulo its period, where it is 0 at the clearance 1."""

    name: str
    f: str
    g: str


LIFTS = (
    Lift("x'' + x = cos 2t", "x", "cos(2*t)"),
    Lift("x'' + x'/2 + x = cos 2t", "x + 0.5*xdot", "cos(2*t)"),
    Lift("x'' + x'/10 + x + 3x^3/10 = (13/10) cos 2t", "x + 0.1*xdot + 0.3*x**3", "1.3*cos(2*t)"),
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
def hop(lift: Lift, rate: str, depth: int) -> Hop:
    """The orbit from rest between two swans, over three turns."""
    osc = Oscillator(lift.f, lift.g, clearance(depth), rate)
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
    path = run.sample(np.linspace(A, float(hits[0]), FINE))
    top = float(np.max(path.x)) - as_float(osc.clearance)
    others = [_release(orbit(osc, share * period, speed, 400), period) for share, speed in FROM]
    return Hop(
        half=half,
        first=(float(hits[0]) - A) / half,
        speed=v / as_float(osc.slope_at_rest()) / (bend * half**3),
        top=top / (bend * half**4),
        rest=(completed - A) / half,
        period=float(np.max(np.abs(np.diff(run.tau[releases]) - period))),
        impacts=int(releases[1] - releases[0] - 2),
        merged=bool(np.ptp(others) < 1e-12),
    )


def _release(run: Orbit, period: float) -> float:
    """The phase of the first release."""
    return float(run.tau[run.kind == "release"][0]) % period
