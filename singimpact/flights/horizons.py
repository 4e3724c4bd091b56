"""The flight time after which a flight is given up: given by the caller, or long beside the motion of the model."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array, as_float, constant, sign_of
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.kernels.hits import UNIT as EPSILON
from singimpact.flights.limits import LIMITS
from singimpact.flights.model_numbers import fastest_rate, fastest_rates, has_table, recurrence_of, valued
from singimpact.inputs import refuse, require
from singimpact.oscillator.linear import LinearForm, form_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, period_over


@dataclass(frozen=True)
class HorizonSettings:
    """Multiples of the characteristic times in a default horizon; a flight usually lasts less than one."""

    # periods of a forcing that is slow beside the free motion: an adiabatic flight ends within one
    slow_periods: float = 2.0
    # half turns of the free motion of a linear model: where the forcing is fast, a flight is one of them
    half_turns: float = 64.0
    # the same of other models, whose Taylor steps cost twenty times as much
    nonlinear_half_turns: float = 4.0
    # amplitudes of free motions whose half turns are estimated, in units of max(1, |c|)
    amplitudes: tuple[float, ...] = (0.3, 1.0, 3.0)
    # times the return time 2 v/|mean force| of a constant force
    returns: float = 4.0
    # samples of one period of the forcing for its mean
    samples: int = 256
    # a mean force, or a pull back, below this part of the largest force is taken as zero
    least_mean: float = 1e-12


SETTINGS = HorizonSettings()


@dataclass(frozen=True)
class Allowance:
    """When a flight is given up, and how accurate it is.

    Parameters
    ----------
    horizon, reach : a flight with launch velocity v is given up after the time max(horizon, reach v).
        Of many models they are arrays.
    epsilon : relative error of a Taylor step. steps : Taylor steps.
    """

    horizon: Any
    epsilon: float = EPSILON
    steps: int = LIMITS.steps
    reach: Any = 0.0

    def until(self, v: Any) -> Any:
        """The flight time at which flights with launch velocities v are given up."""
        return np.maximum(self.horizon, self.reach * v)


def horizon_of(osc: Oscillator, horizon: Any) -> float:
    """The time at which a flight is given up; `reach_of` may defer that of a fast launch.

    Examples
    --------
    >>> horizon_of(Oscillator("x", "cos(t)", 0, 1), "3/2"), round(horizon_of(Oscillator("x", "cos(t)", 0, 1), None))
    (1.5, 6283)
    """
    if horizon is not None:
        tree = constant("horizon", horizon)
        require(sign_of(tree) > 0, "horizon", horizon, "a positive time")
        longest = LIMITS.longest_radians / fastest_rate(osc)
        if as_float(tree) > longest:
            raise refuse("horizon", horizon, f"at most {longest:.3g}, 1e7 radians of the model's fastest motion")
        return as_float(tree)
    return _usual(osc)[0]


def steps_of(osc: Oscillator) -> int:
    """The Taylor steps after which a flight is given up by default; fewer of a long f or g, whose steps take longer.

    Examples
    --------
    >>> steps_of(Oscillator("x**3", "cos(t)", 0, 1))
    16000
    """
    if has_table(osc):
        return LIMITS.steps
    return min(LIMITS.steps, int(LIMITS.steps_by_price / recurrence_of(osc).price))


def reach_of(osc: Oscillator) -> float:
    """The default horizon of a launch with velocity v is at least this times v: the mean force is slow to turn it back.

    Examples
    --------
    >>> reach_of(Oscillator("0", "cos(2*t) - 1/2000", 0, 1))
    16000.0
    """
    return _usual(osc)[1]


@lru_cache(maxsize=256)
def _usual(osc: Oscillator) -> tuple[float, float]:
    horizon, reach = usual(osc)
    return float(horizon), float(reach)


def usual(osc: Oscillator, over: Mapping[str, Array] = MappingProxyType({})) -> tuple[Array, Array]:
    """The default horizon of flights, and the time for which a launch is followed a unit of its velocity.

    Parameters
    ----------
    over : numbers of the model as arrays of shape (n, 1), which the results then have; without it they are numbers.
    """
    names = frozenset(over)
    form = form_of(osc.force(names), osc.forcing(names))
    tree, fast = period_over(osc, names), fastest_rates(osc, over)
    clearance = over.get(CLEARANCE, as_float(osc.clearance))
    if tree is None:
        period, least, longest = None, LIMITS.horizon_time, np.inf
    else:
        period = np.abs(valued(tree, over))
        least = np.minimum(LIMITS.horizon_periods * period, LIMITS.horizon_radians / fast)
        longest = LIMITS.longest_radians / fast
    if form is None:
        time, reach = _of_nonlinear(osc, over, period, clearance)
    else:
        time, reach = _of_linear(form, over, period, clearance)
    return np.maximum(least, np.minimum(np.maximum(least, time), longest)), reach


def _of_linear(form: LinearForm, over: Mapping[str, Array], period: Any, clearance: Any) -> tuple[Array, Array]:
    """The longest of the times that a horizon holds, and the reach."""
    k, d, steady = (valued(tree, over) for tree in (form.stiffness, form.damping, form.constant))
    waves = [[valued(tree, over) for tree in (wave.cosine, wave.sine, wave.rate)] for wave in form.harmonics]
    least = 0.0 if period is None else SETTINGS.slow_periods * period
    with np.errstate(all="ignore"):
        force, speed = 0.0 * k, 0.0 * k
        for cosine, sine, rate in waves:
            force, speed = force + np.hypot(cosine, sine), speed + np.hypot(cosine, sine) / np.abs(rate)
        back, reach = _turned_back(steady - k * clearance, force, speed)
        half_turns = SETTINGS.half_turns * (np.pi / np.abs(k) ** 0.5 + np.abs(d) / np.abs(k))
        return np.maximum(least, np.where(k == 0, back, half_turns)), np.where(k == 0, reach, 0.0)


def _of_nonlinear(osc: Oscillator, over: Mapping[str, Array], period: Any, clearance: Any) -> tuple[Array, Array]:
    """Horizons from the force at rest and the mean of the forcing, in doubles: estimates are enough."""
    phases = (2 * np.pi if period is None else period) * np.arange(SETTINGS.samples) / SETTINGS.samples
    amplitudes = np.array(SETTINGS.amplitudes) * np.maximum(1.0, np.abs(clearance))
    above = clearance + np.concatenate([0.0 * amplitudes[..., :1], amplitudes], axis=-1)
    forcing = osc.forcing(frozenset(over))
    with np.errstate(all="ignore"):
        moving = evaluate(forcing, {**over, "t": phases}, DOUBLES)
        if osc.parametric:
            at_rest = {"x": clearance, "xdot": 0.0, "t": phases}
            moving = moving - evaluate(osc.force(frozenset(over)), {**over, **at_rest}, DOUBLES)
        moving = moving + 0 * phases
        force = _mean_force(osc, over, above, phases)
        average = 0.0 if period is None else moving.mean(axis=-1, keepdims=True)
        pull = force[..., 1:] - average
        # a difference of rounding errors is no weak spring: it would make a horizon of 1e8
        back = pull > SETTINGS.least_mean * (np.abs(force).max(axis=-1, keepdims=True) + np.abs(average))
        half_turns = np.where(back, np.pi / np.sqrt(pull / amplitudes), 0.0)
        times = SETTINGS.nonlinear_half_turns * np.where(np.isfinite(half_turns), half_turns, 0.0)
        time, start = times.max(axis=-1, keepdims=True), force[..., :1]
        if over == {}:
            time, start, average = time[0], start[0], np.ravel(average)[0]
        if period is None:
            return time, 0.0 * time
        swing = np.abs(moving - average).max(axis=-1, keepdims=over != {})
        longer, reach = _turned_back(average - start, swing, swing * period / (2 * np.pi))
        certain = np.isfinite(swing) & np.isfinite(start)
        return np.maximum(time, np.where(certain, longer, 0.0)), np.where(certain, reach, 0.0)


def _mean_force(osc: Oscillator, over: Mapping[str, Array], above: Array, phases: Array) -> Array:
    """f(x, 0) at some places; its mean over a period, less that at the wall, where t occurs in f."""
    force = osc.force(frozenset(over))
    if not osc.parametric:
        return np.asarray(evaluate(force, {**over, "x": above, "xdot": 0 * above}, DOUBLES) + 0 * above)
    letters = {name: value[..., None] for name, value in over.items()}
    state = {**letters, "x": above[..., None], "xdot": 0.0, "t": phases[..., None, :]}
    means = (evaluate(force, state, DOUBLES) + 0.0 * (above[..., None] + phases[..., None, :])).mean(axis=-1)
    return np.asarray(means - means[..., :1])


def _turned_back(mean: Any, force: Any, speed: Any) -> tuple[Array, Array]:
    """The time and the reach of flights that a mean force turns back to the wall; zeros where it does not.

    Parameters
    ----------
    force, speed : sizes of what oscillates about the mean, and of the velocity that it gives to the mass.
    """
    with np.errstate(all="ignore"):
        reach = np.where(mean < -SETTINGS.least_mean * force, 2 * SETTINGS.returns / -mean, 0.0)
    return reach * speed, reach
