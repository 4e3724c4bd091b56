"""The impact map of the package near a tangency with a' > 0: jumps, sides of gamma, eigenvalues, lift-off."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np
import sympy

from singimpact.algebra.solving import halved
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.true_sheet import Place, foliated, swans, tangencies
from singimpact.status import Status
from singimpact.theory.multipliers import eigenvalues_on_gamma, lambda_


@dataclass(frozen=True)
class JumpCase:
    """Jumps of the flight time on lines sigma = const: how many on each, v/(a' sigma^2) there as sigma -> 0."""

    name: str
    side: int
    count: int
    coefficient: float


@lru_cache(maxsize=1)
def jumps() -> tuple[JumpCase, ...]:
    """Jumps of F near the tangency: the flight time changes by more than |sigma| between neighbours of a grid in v."""
    return tuple(_jumps_on(place, side) for place in tangencies() for side in (-1, 1))


def _jumps_on(point: Place, side: int) -> JumpCase:
    scaled = np.linspace(0.02, 1.2, 400)
    counts, jumps = [], []
    for size in (0.02, 0.01, 0.005):
        unit = point.jets()["a_d1"] * size**2
        tau = point.tau + side * size
        at = np.flatnonzero(np.abs(np.diff(_flight_times(point, tau, scaled * unit))) > size)
        counts.append(len(at))
        if len(at) == 1:
            jumps.append((size, _bisected(point, tau, scaled[at[0]] * unit, scaled[at[0] + 1] * unit, size) / unit))
    coefficient = float(true_orbits.extrapolated(jumps)) if jumps else float("nan")
    return JumpCase(point.name, side, max(counts), coefficient)


def _flight_times(place: Place, tau: float, v: Any) -> Any:
    step = place.model.impact_map(tau, v)
    if not np.all(np.isin(step.status, (Status.hit, Status.graze))):
        raise ArithmeticError(f"a flight near the tangency of {place.name} has status {np.unique(step.status)}")
    return np.asarray(step.flight_time)


def _bisected(place: Place, tau: float, low: float, high: float, size: float) -> float:
    """The v of the jump between two values on its two sides, to a part in 1e9."""
    start = float(_flight_times(place, tau, low))
    low, high = halved(lambda v: abs(float(_flight_times(place, tau, v)) - start) <= size, low, high, 1e-9)
    return (low + high) / 2


@dataclass(frozen=True)
class SideCase:
    """The behaviour below and above gamma: "chatter", "lost" or "undecided", after how many impacts at the most."""

    name: str
    below: str
    above: str
    impacts: int

    def line(self) -> str:
        """One line for a table."""
        return f"below: {self.below}, above: {self.above}, at most {self.impacts} impacts"


@lru_cache(maxsize=1)
def sides() -> tuple[SideCase, ...]:
    """Orbits launched at sigma = -0.02 a tenth below and above gamma, and at half and nearly at P_*."""
    cases = []
    for place in tangencies():
        below = [_fate(place, factor) for factor in (0.3, 0.9)]
        above = [_fate(place, factor) for factor in (1.1, 1.3)]
        cases.append(SideCase(place.name, _common(below), _common(above), max(count for _, count in below + above)))
    return tuple(cases)


def _common(fates: list[tuple[str, int]]) -> str:
    names = {name for name, _ in fates}
    return names.pop() if len(names) == 1 else "undecided"


def _fate(point: Place, factor: float, impacts: int = 400) -> tuple[str, int]:
    """Follow impacts until the speed has died out before tau_*, or a flight leaves the neighbourhood of tau_*."""
    start = 0.02
    tau, v = point.tau - start, factor * point.coefficient * start**2
    first = v
    for count in range(impacts):
        step = point.model.impact_map(tau, v)
        if float(step.flight_time) > 10 * start:
            return "lost", count
        tau, v = float(step.tau), float(step.v)
        if v < 1e-9 * first and tau < point.tau:
            return "chatter", count
    return "undecided", impacts


def leaves_gamma() -> tuple[str, bool]:
    """The factor by which an orbit started beside gamma (v off by 1e-3) has left it once sigma has shrunk 30-fold."""
    growth = []
    for point in tangencies():
        (sigma, v), offset = _on_gamma(point)[-1], 1e-3
        tau, speed, along = point.tau + sigma, v * (1 - offset), point.coefficient
        while abs(tau - point.tau) > abs(sigma) / 30:
            step = point.model.impact_map(tau, speed)
            tau, speed = float(step.tau), float(step.v)
        growth.append(abs(speed / (along * (tau - point.tau) ** 2) - 1) / offset)
    name = f"true orbits beside gamma leave it on both models (v/gamma off by 1e-3 grows {min(growth):.3g}-fold)"
    return name, min(growth) > 10


def _on_gamma(place: Place) -> list[tuple[float, float]]:
    """Points of gamma up to sigma = -0.02, found by following G backwards."""
    flow = true_orbits.scipy_flow(place.model, place.tau)
    start = true_orbits.SETTINGS.start[0]
    return true_orbits.backwards(flow, place.r, -start, place.coefficient * start**2, place.multiplier, 0.02)


@dataclass(frozen=True)
class EigenvalueCase:
    """The larger eigenvalue of DG at points of gamma, extrapolated to w_*."""

    name: str
    r: float
    found: float


@lru_cache(maxsize=1)
def eigenvalues() -> tuple[EigenvalueCase, ...]:
    """From differences of the impact map at points of gamma on both models."""
    return tuple(EigenvalueCase(point.name, point.r, _limiting_eigenvalue(point)) for point in tangencies())


def _limiting_eigenvalue(point: Place) -> float:
    def image(sigma: float, v: float) -> tuple[float, float]:
        step = point.model.impact_map(point.tau + sigma, v)
        return float(step.tau), float(step.v)

    return _extrapolated_eigenvalue(image, _on_gamma(point)[-4:], 1e-5)


def _extrapolated_eigenvalue(image: Callable[[Any, Any], Any], points: list[tuple[Any, Any]], step: Any) -> float:
    """The larger eigenvalue of a map at points, by central differences in proportion to sigma and v, at sigma = 0."""
    values = []
    for sigma, v in points:
        columns = []
        for d_sigma, d_v in ((step * abs(sigma), 0), (0, step * v)):
            ends = image(sigma + d_sigma, v + d_v), image(sigma - d_sigma, v - d_v)
            columns.append([(ahead - behind) / (2 * (d_sigma + d_v)) for ahead, behind in zip(*ends, strict=True)])
        (a, c), (b, d) = columns
        values.append((sigma, (a + d + ((a - d) ** 2 + 4 * b * c) ** 0.5) / 2))
    return float(true_orbits.extrapolated(values))


LIFT_OFF = {
    "x'' + x = sin 2t": ("x", "sin(2*t)"),
    "damped Duffing, sin 1.7t": ("x + 0.1*xdot + 0.3*x**3", "sin(1.7*t)"),
}


@lru_cache(maxsize=1)
def lift_off() -> tuple[tuple[str, float], ...]:
    """(model, flight time) of the first hit from (tau_*, 0), on models for which tau_* = 0 is a double exactly."""
    models = {name: ImpactOscillator(f, g, 0, "0.5") for name, (f, g) in LIFT_OFF.items()}
    return tuple((name, float(model.impact_map(0.0, 0.0).flight_time)) for name, model in models.items())


# Orbits near a negative swan on two models: the cube root in F, the eigenvalue on gamma, where orbits come to rest.


@lru_cache(maxsize=1)
def cube_root() -> float:
    """d log t/d log v of the flight time on sigma = 0, from v = 1e-9 to 1e-12, at the swan of x'' + x = cos 2t."""
    step = linear(2, 1, "1/2").impact_map(0.0, [1e-9, 1e-12])
    return float(np.log(step.flight_time[0] / step.flight_time[1]) / np.log(1e3))


@lru_cache(maxsize=1)
def eigenvalue() -> tuple[float, float]:
    """The larger eigenvalue of DG on gamma at the swan of the linear model: of the homogeneous one, and on true orbits.

    The second is extrapolated from differences of the closed form at points of gamma in many digits.
    """
    context, origin, clearance = true_orbits.many_digits(2)
    flow = true_orbits.closed_flow(Fraction(2), clearance, origin, context)
    r, rate = context.mpf(1) / 2, true_orbits.lambda_of(0.5, 2)
    start = context.mpf(10) ** -25
    target = context.mpf(10) ** -40
    orbit = true_orbits.backwards(flow, r, -start, start**3 * 0.2, rate, 3e-2, target)

    def image(s: Any, v: Any) -> tuple[Any, Any]:
        t, slope = true_orbits.return_time(flow, s, v, s * (rate - 1), target)
        return s + t, -r * slope

    expected = float(eigenvalues_on_gamma(2)[0].subs(lambda_, sympy.Float(rate, 30)))
    return expected, _extrapolated_eigenvalue(image, orbit[-5:], context.mpf(10) ** -12)


def fates() -> tuple[str, bool]:
    """From sigma in {-0.05, 0.02} and v at 0.2 to 5 times the height of gamma at |sigma|, at both models' swans."""
    count, lost, largest = 0, 0, -np.inf
    for point in swans():
        model, contact = point.model, point.tau
        height = abs(float(model.acceleration(contact, order=2))) * 0.05**3 / 12
        for sigma in (-0.05, 0.02):
            tau, v = np.full(6, contact + sigma), height * np.array([0.2, 0.5, 0.8, 1.3, 2.0, 5.0])
            for _ in range(300):
                step = model.impact_map(tau, v)
                lost += int(np.count_nonzero(np.asarray(step.flight_time) > 1.0))
                tau, v = np.asarray(step.tau), np.asarray(step.v)
            count += len(v)
            largest = max(largest, float(np.max(model.acceleration(tau))))
            lost += int(np.count_nonzero(v > 1e-8 * height))
    name = (
        f"{count} true orbits from states near w_*, below and above gamma on two models, all come to rest at "
        f"points with a < 0 (largest a there {float(largest):.1e})"
    )
    return name, largest < 0 and lost == 0


# Orbits near a tangency with a' < 0 on two models: no jumps, chatter, and leaves followed backwards.


def no_jumps() -> tuple[str, bool]:
    """Neighbouring flight times on a grid with |sigma| <= 0.05 and v up to 4 |k| sigma^2 at its corner."""
    states, largest = 0, 0.0
    for point in foliated():
        sigma = np.linspace(-0.05, 0.05, 81)
        v = np.linspace(0, 4 * abs(point.jets()["k"]) * 0.05**2, 61)[1:]
        times = np.asarray(point.model.impact_map((point.tau + sigma)[:, None], v[None, :]).flight_time)
        states += times.size
        largest = max(largest, float(np.abs(np.diff(times, axis=0)).max()), float(np.abs(np.diff(times, axis=1)).max()))
    name = f"no jump of F among {states} neighbouring states on two models, largest step {largest:.1e}"
    return name, largest < 0.05


def chatter() -> tuple[str, bool]:
    """Arcs p(t = l sigma), 0 < sigma <= 0.05, for l = 0.1, 0.5, 2, followed together: the largest v over them falls."""
    count, last, factor = 40, 0.0, 0.0
    for point in foliated():
        for ell in (0.1, 0.5, 2.0):
            sigma = np.linspace(0.002, 0.05, 25)
            tau, v = point.tau + sigma, -point.jets()["k"] * (3 * ell + ell**2) * sigma**2
            start, sizes = v.max(), []
            for _ in range(count):
                step = point.model.impact_map(tau, v)
                tau, v = np.asarray(step.tau), np.asarray(step.v)
                sizes.append(float(v.max()))
            last = max(last, sizes[-1] / start)
            factor = max(factor, sizes[-1] / sizes[-2])
    name = (
        f"the largest v over arcs t = l sigma of true orbits falls below {last:.0e} of its start after "
        f"{count} impacts on two models, by a factor of at most {factor:.3f} an impact in the end"
    )
    return name, last < 1e-6 and factor < 1


@dataclass(frozen=True)
class Leaf:
    """A leaf from its foot tau_* + foot on Pi_0 backwards to tau_* + end on Pi_0."""

    name: str
    foot: float
    end: float


@lru_cache(maxsize=1)
def leaves() -> tuple[Leaf, ...]:
    """Launch from rest at tau_* + end, end < 0, where a > 0; chatter comes to rest at the foot of the leaf."""
    ends, cases = np.array([-0.04, -0.02, -0.01]), []
    for point in foliated():
        feet = true_orbits.resting_times(point.model, point.tau + ends, np.zeros(3), 400, 1e-13) - point.tau
        cases += [Leaf(point.name, *pair) for pair in zip(feet.tolist(), ends.tolist(), strict=True)]
    return tuple(cases)
