"""Chatter limits, thresholds and grown curves; the reference values are those of `digits=`, by ball arithmetic."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from singimpact.bench.measuring import condition
from singimpact.bench.stress.judging import DIGITS, Function, Trial, powers
from singimpact.bench.stress.launches import Launch
from singimpact.dynamics.invariant_arcs import grown_gamma, stable_manifold
from singimpact.dynamics.threshold import threshold
from singimpact.impact_oscillator import linear
from singimpact.status import Status
from singimpact.surface.curve import Window

FEW = 5  # each reference value takes 0.1 s or more
START = Launch("linear", tau=0.9, v=0.005)
GAMMA, END = Launch("linear", tau=0.9, restitution=0.5), 1.5 * np.pi / 2.8
NEAR: dict[str, tuple[float, Callable[[Launch, float], Launch]]] = {
    "v -> 0": (14, lambda at, off: replace(at, v=off)),
    "omega -> 1": (12, lambda at, off: replace(at, omega=1 + off, tau=2.5)),
    "r -> 0": (12, lambda at, off: replace(at, restitution=off)),
    "r -> 1": (2, lambda at, off: replace(at, restitution=1 - off, v=0.01 * off)),
    "a -> 0": (4, lambda at, off: replace(at, tau=0.5609986881410345 + off, v=off**2 / 20)),
    "a' -> 0": (4, lambda at, off: replace(at, clearance=1 - off, tau=1.2 * off**0.5, v=off**1.5 / 50)),
    "huge tau": (12, lambda at, off: replace(at, tau=0.9 + 1 / off, v=1e-6)),
}


def _states(place: str, points: int) -> Iterator[Launch]:
    last, moved = NEAR[place]
    for off in powers(min(points, FEW), last):
        yield moved(START, off)


def _chatter_limit(place: str, points: int) -> Iterator[Trial]:
    """tau_inf; the state and every phase until then are rounded relative to tau_inf itself."""
    for at in _states(place, points):
        found, true = at.model.chatter_limit(at.tau, at.v), at.model.chatter_limit(at.tau, at.v, digits=DIGITS)
        status = int(found.status), int(true.status)
        if status[0] != status[1] or true.status != Status.complete:
            yield Trial(str(at), status=status)
            continue
        kappa = condition(partial(_end, at), at.tau, at.v, 1e-4)
        yield Trial(str(at), [float(found.tau)], [true.tau], [(kappa - 1) * abs(true.tau)], status)


def _end(at: Launch, tau: float, v: float) -> float:
    return float(at.model.chatter_limit(tau, v).tau)


def _on_gamma(at: Launch, tau: float, _: float) -> float:
    return float(threshold(at.model, tau).v)


ALONG_GAMMA: dict[str, tuple[float, Callable[[Launch, float], Launch]]] = {
    "omega -> 1": NEAR["omega -> 1"],
    "r -> 0": (3, lambda at, off: replace(at, restitution=off)),
    "r -> 1": (1.2, lambda at, off: replace(at, restitution=1 - off, tau=1.6)),
    "a -> 0": (4, lambda at, off: replace(at, tau=END - off)),
}


def _threshold(place: str, points: int) -> Iterator[Trial]:
    last, near = ALONG_GAMMA[place]
    for off in powers(min(points, 3), last):
        slow = near(GAMMA, off)
        found, true = threshold(slow.model, slow.tau), threshold(slow.model, slow.tau, digits=20)
        status = int(found.status), int(true.status)
        kappa = condition(partial(_on_gamma, slow), slow.tau, 1.0, 1e-7)
        yield Trial(str(slow), [float(found.v)], [true.v], [(kappa - 1) * true.v], status)


RATES = {"r -> 0": 1e-3, "r -> 1": 0.9}  # of curves, which cost many flights


def _gamma_grown(name: str, points: int) -> Iterator[Trial]:
    """Vertices beside the threshold over the same phase."""
    rate = RATES.get(name, 0.5)
    osc = linear("2.8", 0, rate)
    points_of = np.vstack([curve.points for curve in grown_gamma(osc, Window((0.6, 2.0), (0.0, 1.0)))])
    far = END - points_of[:, 0]
    for off in powers(min(points, 2), 3 if name == "a -> 0" else 1, 0.3):
        tau, v = points_of[int(np.argmin(np.abs(far - off) + (far < off / 2)))].tolist()
        true = threshold(osc, tau, digits=20)
        kappa = condition(lambda at, _: float(threshold(osc, at).v), tau, 1.0, 1e-7)
        yield Trial(f"r = {rate}, tau = {tau!r}", [v], [true.v], [(kappa - 1) * true.v])


def _stable_manifold(name: str, points: int) -> Iterator[Trial]:
    """Chatter from a vertex ends at the foot, within the error that the condition number allows."""
    rate, foot = RATES.get(name, 0.5), END - 1e-3 if name == "a -> 0" else 1.0
    osc = linear("2.8", 0, rate)
    vertices = np.vstack([curve.points for curve in stable_manifold(osc, Window((0.2, 1.5), (0.0, 1.0)), foot)])
    for index in np.linspace(2, len(vertices) - 2, min(points, 6)).astype(int).tolist():
        tau, v = vertices[index].tolist()
        if not v > 0:
            continue
        end = osc.chatter_limit(tau, v, digits=DIGITS)
        if end.status != Status.complete:
            continue
        kappa = condition(lambda at, speed: float(osc.chatter_limit(at, speed).tau), tau, v)
        yield Trial(f"r = {rate}, tau = {tau!r}, v = {v!r}", [float(end.tau)], [foot], [kappa - 1])


def _function(name: str, judge: Callable[..., Iterator[Trial]], places: tuple[str, ...], left_out: str) -> Function:
    return Function(name, {place: partial(judge, place) for place in places}, "digits=, in balls", left_out)


FUNCTIONS = (
    _function("chatter_limit", _chatter_limit, tuple(NEAR), "flights get short: P, Z and long flights are no chatter"),
    _function(
        "threshold",
        _threshold,
        tuple(ALONG_GAMMA),
        "v is the answer; r up to 0.94, beyond which its enclosure takes minutes",
    ),
    _function("gamma grown", _gamma_grown, ("a -> 0", *RATES), "v is the answer; the curve has no flights of its own"),
    _function("stable manifold", _stable_manifold, ("v -> 0", "a -> 0", *RATES), "a curve over one foot"),
)
