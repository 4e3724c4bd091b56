"""Random states of a model, in its own units of time and velocity, and their flights."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import wraps
from math import isfinite, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array, as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.bench.selftest.rows import Row, Tally
from singimpact.bench.truth.plain_orbits import PlainOrbits, plain_orbits
from singimpact.flights.results import Step
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.oscillator.wall_acceleration import acceleration


@dataclass(frozen=True)
class DrawSettings:
    """Where states are drawn.

    Parameters
    ----------
    window : phases of a model without a period.
    fast : largest velocity in units of max |a_c| over the frequency of the model.
    decades : of the velocities below it; half of them lie in the top `usual` ones, where flights are long.
    usual : see there.
    horizon : of every flight, in units of 1 over the frequency of the model: about ten turns.
    together : states flown by one call, after which the CPU time is looked at.
    """

    window: tuple[float, float] = (-10.0, 10.0)
    fast: float = 3.0
    decades: float = 10.0
    usual: float = 2.0
    horizon: float = 60.0
    together: int = 25


DRAW = DrawSettings()


class Scales(NamedTuple):
    """The model's window of phases, largest velocity, fastest rate, horizon, and its period or None.

    The frequency of a model is the larger of 2 pi/period and sqrt|df/dx| at rest on the obstacle; its fastest rate is
    |df/dx'| there where that is larger still.
    """

    low: float
    high: float
    fast: float
    rate: float
    horizon: float
    period: float | None


LEAST = 1e-300  # allowed of a velocity that is 0, with restitution 0


class Flown(NamedTuple):
    """Launches of a model with the impacts that `osc.impact_map` gives. left : drawn and not flown, out of time."""

    osc: ImpactOscillator
    scales: Scales
    tau: Array
    v: Array
    step: Step
    left: int

    @property
    def plain(self) -> PlainOrbits:
        """The model in `bench.truth.plain_orbits`; an algebraic number that is given as a root is not comparable."""
        units = self.scales
        try:
            return plain_orbits(self.osc, units.rate, units.horizon, units.fast)
        except TypeError as reason:
            raise NotComparable(reason) from reason

    def call(self, at: int, name: str = "impact_map") -> str:
        """A state as it is typed."""
        return f"osc.{name}({float(self.tau[at])!r}, {float(self.v[at])!r}, horizon={self.scales.horizon:.6g})"


class NotComparable(Exception):
    """A row does not apply to a model, for the reason given."""


def compared(
    name: str, nothing: str = "no flight that was drawn returns"
) -> Callable[[Callable[[Flown, Tally], None]], Callable[[Flown], Row]]:
    """A row of the table, from a function that judges states in a tally.

    Parameters
    ----------
    name : of the row. nothing : the note where there is no state to judge.
    """

    def row_of(judge: Callable[[Flown, Tally], None]) -> Callable[[Flown], Row]:
        @wraps(judge)
        def row(flown: Flown) -> Row:
            tally = Tally(name)
            try:
                judge(flown, tally)
            except NotComparable as reason:
                return Row(name, note=f"does not apply: {reason}")
            result = tally.row()
            return result if result.tried else replace(result, note=nothing)

        return row

    return row_of


def scales(osc: ImpactOscillator) -> Scales:
    """Units of a model, from its period and the linear part of f at rest on the obstacle.

    Examples
    --------
    >>> scales(ImpactOscillator("4*x", "cos(t)", 0, "1/2")).rate
    2.0
    """
    period = None if osc.period is None else as_float(osc.period)
    stiffness, damping = (_at_rest(osc, name) for name in ("x", "xdot"))
    frequency = max(sqrt(abs(stiffness)), 2 * pi / period if period else 0.0) or abs(damping) or 1.0
    low, high = (0.0, period) if period else DRAW.window
    with np.errstate(all="ignore"):
        sizes = np.abs(acceleration(osc, np.linspace(low, high, 513)))
    largest = float(np.max(sizes[np.isfinite(sizes)], initial=0.0))
    fast = DRAW.fast * (largest or frequency) / frequency
    return Scales(low, high, fast, max(frequency, abs(damping)), DRAW.horizon / frequency, period)


def _at_rest(osc: ImpactOscillator, name: str) -> float:
    """df/dx or df/dx' at rest on the obstacle; 0 where it is not finite."""
    try:
        value = evaluate(derivative(osc.force(), name), {"x": as_float(osc.clearance), "xdot": 0.0, "t": 0.0}, DOUBLES)
    except (ArithmeticError, ValueError):
        return 0.0
    return float(value) if isfinite(value) else 0.0


def flown(osc: ImpactOscillator, states: int, seed: int) -> Flown:
    """Random states with their impacts."""
    units, rng = scales(osc), np.random.default_rng(seed)
    tau = rng.uniform(units.low, units.high, states)
    decades = np.where(rng.uniform(size=states) < 0.5, DRAW.usual, DRAW.decades) * rng.uniform(size=states)
    v = units.fast * 10.0**-decades
    tally = Tally("flights")
    parts: list[Step] = []
    for begin in range(0, states, DRAW.together):
        if tally.late and parts:
            break
        chosen = slice(begin, begin + DRAW.together)
        parts.append(osc.impact_map(tau[chosen], v[chosen], horizon=units.horizon))
    count = min(len(parts) * DRAW.together, states)
    return Flown(osc, units, tau[:count], v[:count], _joined(parts), states - count)


def _joined(parts: list[Step]) -> Step:
    # notes and what is certified are no arrays, and no row reads them
    names = [field.name for field in fields(Step) if field.name not in ("notes", "certified")]
    columns: dict[str, Any] = {
        name: np.concatenate([np.broadcast_to(getattr(part, name), np.shape(part.status)) for part in parts])
        for name in names
    }
    return Step(**columns)
