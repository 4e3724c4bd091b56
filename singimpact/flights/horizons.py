"""The flight time after which a flight is given up: given by the caller, or long beside the motion of the model."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array, as_float, constant, sign_of
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.kernels.hits import UNIT as EPSILON
from singimpact.flights.limits import LIMITS
from singimpact.flights.model_numbers import fastest_rate, has_table, recurrence_of
from singimpact.inputs import refuse
from singimpact.oscillator.linear import LinearForm, at_rest, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import at_wall


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
    epsilon : relative error of a Taylor step. steps : Taylor steps.
    """

    horizon: float
    epsilon: float = EPSILON
    steps: int = LIMITS.steps
    reach: float = 0.0

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
        if sign_of(tree) <= 0:
            raise refuse("horizon", horizon, "a positive time")
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
    form, fast = linear_form(osc), fastest_rate(osc)
    if osc.period is None:
        least, longest = LIMITS.horizon_time, np.inf
    else:
        period = as_float(osc.period)
        least = min(LIMITS.horizon_periods * period, LIMITS.horizon_radians / fast)
        longest = LIMITS.longest_radians / fast
    times, reach = _of_nonlinear(osc) if form is None else _of_linear(osc, form)
    return max(least, min(max([least, *times]), longest)), reach


def _of_linear(osc: Oscillator, form: LinearForm) -> tuple[list[float], float]:
    """Times that a horizon holds, and the reach."""
    k, d, mean = as_float(form.stiffness), abs(as_float(form.damping)), as_float(at_rest(form, osc.clearance))
    times = [] if osc.period is None else [SETTINGS.slow_periods * as_float(osc.period)]
    if k:
        times.append(SETTINGS.half_turns * (np.pi / abs(k) ** 0.5 + d / abs(k)))
        return times, 0.0
    sizes = [(np.hypot(as_float(wave.cosine), as_float(wave.sine)), as_float(wave.rate)) for wave in form.harmonics]
    return _turned_back(times, mean, sum(size for size, _ in sizes), sum(size / abs(rate) for size, rate in sizes))


def _of_nonlinear(osc: Oscillator) -> tuple[list[float], float]:
    """Horizons from the force at rest and the mean of the forcing, in doubles: estimates are enough."""
    period = 2 * np.pi if osc.period is None else as_float(osc.period)
    phases = period * np.arange(SETTINGS.samples) / SETTINGS.samples
    clearance = as_float(osc.clearance)
    amplitudes = np.array(SETTINGS.amplitudes) * max(1.0, abs(clearance))
    with np.errstate(all="ignore"):
        moving = at_wall(osc).moving if osc.parametric else osc.forcing()
        forcing = evaluate(moving, {"t": phases}, DOUBLES) + 0 * phases
        above = clearance + np.concatenate([[0.0], amplitudes])
        force = _mean_force(osc, above, phases)
        average = 0.0 if osc.period is None else float(forcing.mean())
        pull = force[1:] - average
        # a difference of rounding errors is no weak spring: it would make a horizon of 1e8
        back = pull > SETTINGS.least_mean * (np.abs(force).max() + abs(average))
        half_turns = np.pi / np.sqrt(pull[back] / amplitudes[back])
    times = (SETTINGS.nonlinear_half_turns * half_turns[np.isfinite(half_turns)]).tolist()
    if osc.period is None or not np.isfinite(forcing).all() or not np.isfinite(force[0]):
        return times, 0.0
    swing = float(np.abs(forcing - average).max())
    return _turned_back(times, average - float(force[0]), swing, swing * period / (2 * np.pi))


def _mean_force(osc: Oscillator, above: Array, phases: Array) -> Array:
    """f(x, 0) at some places; its mean over a period, less that at the wall, where t occurs in f."""
    if not osc.parametric:
        return np.asarray(evaluate(osc.force(), {"x": above, "xdot": 0 * above}, DOUBLES) + 0 * above)
    state = {"x": above[:, None], "xdot": 0.0, "t": phases}
    means = (evaluate(osc.force(), state, DOUBLES) + np.zeros((above.size, phases.size))).mean(axis=1)
    return np.asarray(means - means[0])


def _turned_back(times: list[float], mean: float, force: float, speed: float) -> tuple[list[float], float]:
    """Horizons with the return times of a mean force that presses the mass to the wall.

    Parameters
    ----------
    force, speed : sizes of what oscillates about the mean, and of the velocity that it gives to the mass.
    """
    if not mean < -SETTINGS.least_mean * force:
        return times, 0.0
    reach = 2 * SETTINGS.returns / -mean
    return [*times, reach * speed], reach
