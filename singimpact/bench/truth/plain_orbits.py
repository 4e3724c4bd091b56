"""Impacts, chatter, rest and lift-off of any model by fixed steps: what orbits of the package are compared with.

First hits are those of `graded_steps`, of the acceleration as a plain compiled function; the layers of a model are not
known here, so the steps are graded by the rate of the motion alone.

Shared with the package: f, g and rho as expression trees, and the period. Not shared: their evaluation, flights, laws
of rebound, sums of chatter, zeros of a_c.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import copysign, inf, isfinite, nan
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from singimpact.algebra import Array, Expression, as_float, evaluate, names_in, subtract
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import EVERYWHERE, HIT, MISS, UNDECIDED, Motion
from singimpact.oscillator.model import Oscillator

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "atan", "tanh", "log1p")


@lru_cache(maxsize=8)
def motion(osc: Oscillator, rate: float, above: bool = False) -> Motion:
    """The model as `graded_steps.first_hit` flies it.

    Parameters
    ----------
    rate : 1/time; a step is at most fineness/rate. above : from the upper wall, in -x.

    Raises
    ------
    TypeError : f or g holds an algebraic number that is given as a root.

    Examples
    --------
    >>> falling = motion(Oscillator("0", "-2", 0, "1/2"), 1.0)
    >>> round(graded_steps.first_hit(falling, 0.0, 3.0, 30.0).flight_time, 12)
    3.0
    """
    gap = inf if osc.upper is None else as_float(subtract(osc.upper, osc.clearance))
    wall = -as_float(osc.upper) if above and osc.upper is not None else as_float(osc.clearance)
    layers = np.array([[EVERYWHERE, 0.0, 1 / rate, 0.0, 0.0]])
    acceleration = python_function("acceleration", text(osc, above))
    return Motion(graded_steps.compiled(acceleration), np.zeros(1), layers, wall, gap)


def text(osc: Oscillator, above: bool = False) -> str:
    """The source of g - f in doubles; or with `above` that of (-x)''.

    Examples
    --------
    >>> print(text(Oscillator("x/2", "1", 0, "1/2")), end="")
    def acceleration(t, x, xdot, p):
        return 1.0 - ((0.5) * (x))
    """
    f, g = source(osc.force()), source(osc.forcing())
    # from the upper wall x and x' change their signs, and so does the acceleration
    turned, result = ("    x, xdot = -x, -xdot\n", f"{f} - ({g})") if above else ("", f"{g} - ({f})")
    return f"def acceleration(t, x, xdot, p):\n{turned}    return {result}\n"


def rebound(osc: Oscillator) -> Callable[[float], float]:
    """rho of the lower wall as a plain Python function of the velocity before the impact.

    Examples
    --------
    >>> rebound(Oscillator("x", "cos(t)", 0, "-v/2"))(-0.75)
    0.375
    """
    return python_function("rho", f"def rho(v):\n    return {source(osc.rho())}\n")


def python_function(name: str, text: str) -> Callable[..., float]:
    """The function that a Python text defines; the names of `FUNCTIONS` in it are those of `math`."""
    space: dict[str, Any] = {function: getattr(math, function) for function in FUNCTIONS}
    exec(compile(text, f"<{name}>", "exec"), space)
    return space[name]  # type: ignore[no-any-return]


def source(tree: Expression) -> str:
    """The Python text of an expression in doubles, with the functions of `math`.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> source(parse("x**(-1/2) + tanh(2*x)/3", ["x"]))
    '(x) ** -0.5 + (0.3333333333333333) * (tanh((2.0) * (x)))'
    """
    written: str = evaluate(tree, {name: _Text(name) for name in names_in(tree)}, _Texts()).text
    return written


@dataclass(frozen=True)
class _Text:
    """A sum as Python text; its terms need no brackets."""

    text: str

    def __add__(self, other: "_Text") -> "_Text":
        return _Text(f"{self.text} + {other.text}")

    def __mul__(self, other: "_Text") -> "_Text":
        return _Text(f"({self.text}) * ({other.text})")


class _Texts:
    """The ring of such texts."""

    def rational(self, value: Fraction) -> _Text:
        return _Text(repr(float(value)))

    def pi(self) -> _Text:
        return _Text(repr(math.pi))

    def power(self, base: _Text, exponent: Fraction) -> _Text:
        return _Text(f"({base.text}) ** {exponent if exponent.denominator == 1 else float(exponent)}")

    def call(self, function: str, argument: _Text) -> _Text:
        return _Text(f"{function}({argument.text})")

    def root(self, tree: Expression) -> _Text:
        raise TypeError(f"the root {tree} has no text in doubles")


# Orbits of such flights.


@dataclass(frozen=True)
class PlainOrbitSettings:
    """Settings of the orbits by fixed steps."""

    # of the first of the flights that must agree; at 0.2 the velocities of a friction of steepness 50 are off by 2e-10
    first: float = 0.1
    # of a flight that is flown once: 1e-13 from two that agree, for 600 states of three smooth models
    quick: float = 0.2
    # intervals of a period between which the sign of a_c is looked at
    grid: int = 4096
    # a chatter is summed up where the last correction is below this part of its length
    summed: float = 1e-10
    # v/fast at which the slope of rho at rest is taken
    slow: float = 1e-9
    # steps of a central difference of flights: of v relative, of tau in units of 1/rate
    step: float = 2e-3
    # of neighbours whose flights say how a launch error grows: relative, and in units of 1/rate
    beside: float = 1e-10
    # relative tolerance of a flight from rest
    rest: float = 1e-12


SETTINGS = PlainOrbitSettings()


class Impact(NamedTuple):
    """The end of a flight: HIT, MISS or UNDECIDED, flight time, velocity there, velocity after."""

    status: int
    time: float
    velocity: float
    v: float


class Chatter(NamedTuple):
    """`status` "complete", "lifts off" or "open"; time from start to end, its error, impacts flown, the last v."""

    status: str
    time: float
    error: float
    impacts: int
    v: float = 0.0


@dataclass(frozen=True, eq=False)
class PlainOrbits:
    """Orbits of one model.

    Parameters
    ----------
    motion : the model as `graded_steps` flies it. rho : velocity after an impact.
    slope : -rho'(0); nan where rho is not smooth at rest, or loses nothing there. period : of g, or nan.
    rate : fastest rate of the model. horizon : of a flight. above : those of a second wall, in -x.

    With two walls velocities are those of x: states of the upper wall have v < 0, or -0.0.
    """

    motion: Motion
    rho: Callable[[float], float]
    slope: float
    period: float
    rate: float
    horizon: float
    above: "PlainOrbits | None" = None

    def at(self, v: float) -> "PlainOrbits":
        """The orbits of the wall of a state, in whose coordinates it is the lower one."""
        return self.above if self.above is not None and copysign(1.0, v) < 0 else self

    def push(self, tau: float) -> float:
        """a_c(tau)."""
        return float(self.motion.acceleration(tau, self.motion.clearance, 0.0, self.motion.parameters))

    def pushes(self, tau: Array) -> Array:
        """a_c at times."""
        return np.array([self.push(t) for t in tau.tolist()])

    def rebound(self, velocity: float) -> float:
        """rho(velocity); nan where it is no velocity away from the obstacle."""
        if velocity == 0:
            return 0.0
        if velocity > 0:
            return nan if self.above is None else -self.above.rebound(-velocity)
        try:
            v = self.rho(velocity)
        except (ArithmeticError, ValueError):
            return nan
        return float(v) if isinstance(v, int | float) and (0 < v < inf or (v == 0 and self.plastic)) else nan

    @property
    def plastic(self) -> bool:
        """Whether impacts leave no velocity."""
        return self.slope == 0

    def goes_on(self, hit: Impact) -> bool:
        """Whether a flight ended in an impact with a velocity after it."""
        return hit.status == HIT and (abs(hit.v) > 0 or self.plastic)

    def fly(self, tau: float, v: float, quick: bool, horizon: float | None = None) -> Impact:
        """The first impact; of a mass at rest where a_c lifts it."""
        if v or not self.plastic:
            return self.quick_impact(tau, v, horizon) if quick else self.impact(tau, v, horizon)
        return self.lifted(tau, horizon) if self.push(tau) > 0 else Impact(UNDECIDED, nan, nan, nan)

    def impact(self, tau: float, v: float, horizon: float | None = None) -> Impact:
        """The first impact of a flight, alike at two finenesses."""
        until = self.horizon if horizon is None else horizon
        hit = graded_steps.first_hit(self.at(v).motion, tau, abs(v), until, SETTINGS.first)
        return self._ended(v, hit.status, hit.flight_time, hit.velocity)

    def quick_impact(self, tau: float, v: float, horizon: float | None = None) -> Impact:
        """The first impact of a flight at one fineness."""
        until = self.horizon if horizon is None else horizon
        return self._ended(v, *self.at(v).motion.flown(tau, abs(v), until, SETTINGS.quick)[:3])

    def _ended(self, v: float, status: int, time: float, velocity: float) -> Impact:
        """The end of a flight of the wall of v, whose velocity there is > 0 at the other wall."""
        if self.above is None:
            return Impact(status, time, velocity, self.rebound(min(velocity, 0.0)))
        velocity *= copysign(1.0, v)
        return Impact(status, time, velocity, self.rebound(velocity) if status == HIT else nan)

    def impacts(self, tau: float, v: float, count: int, quick: bool = False) -> tuple[float, float] | None:
        """Time and velocity after so many impacts; None where a flight does not return.

        Parameters
        ----------
        quick : each flown at one fineness alone.
        """
        since = 0.0
        for _ in range(count):
            hit = self.fly(tau + since, v, quick)
            if not self.goes_on(hit):
                return None
            since, v = since + hit.time, hit.v
        return since, v

    def spread(self, tau: float, v: float, count: int = 1) -> tuple[float, float]:
        """By how much rounding of a launch moves time and velocity after impacts: differences of neighbours, scaled.

        The launch is off by 1e-12 of v, and by 1e-12/rate and a rounding of tau.
        """
        h, centre = SETTINGS.beside, self.impacts(tau, v, count, True)
        sides = [
            self.impacts(tau + i * h / self.rate, v * (1 + j * h), count, True)
            for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))
        ]
        if centre is None or None in sides:
            return inf, inf
        away = np.max(np.abs(np.array(sides, dtype=float) - centre), axis=0)
        scale = 1e-2 + 2.0**-52 * abs(tau) * self.rate / h
        return float(away[0] * scale), float(away[1] * scale)

    def chatter(self, tau: float, v: float, most: int) -> Chatter:
        """Where infinitely many impacts end: flown ones and 2 v/(|a_c| (1 - r)) for the others.

        Notes
        -----
        What this sum E_n after n impacts leaves out is C v_n^2 + ..., so E_n + (E_n - E_(n-1)) r^2/(1 - r^2) is used,
        and the correction is its error.
        """
        since, before = 0.0, nan
        if self.plastic:
            time = self.impact(tau, v).time if v else 0.0
            status = "complete" if self.push(tau + time) < 0 else "lifts off"
            return Chatter(status if isfinite(time) else "open", time, 1e-11 * time, 1)
        if not (self.slope < 1 or (self.above is not None and self.above.slope < 1)):
            return Chatter("open", nan, inf, 0)
        for count in range(most + 1):
            here = self.at(v)
            a, r = here.push(tau + since), here.slope
            if a >= 0 and count:
                return Chatter("lifts off", since, graded_steps.FINENESS.most * since, count)
            total = since + 2 * abs(v) / (-a * (1 - r)) if a < 0 and r < 1 else nan
            correction = (total - before) * r * r / (1 - r * r)
            if abs(correction) <= SETTINGS.summed * total:
                return Chatter("complete", total + correction, abs(correction) + 1e-11 * total, count, v)
            hit = self.impact(tau + since, v)
            if hit.status != HIT or not abs(hit.v) > 0:
                break
            before = total if hit.v * v > 0 else nan
            since, v = since + hit.time, hit.v
        return Chatter("open", nan, inf, most)

    def difference_quotients(self, tau: float, v: float) -> tuple[Array, Array] | None:
        """D G and its error by central differences of flights; None where a flight does not return or is not decided.

        Notes
        -----
        Two steps h and h/2 give (4 D_(h/2) - D_h)/3; the error is a tenth of their difference, and of the flights.
        """
        columns, errors = [], []
        for by_tau in (1.0, 0.0):
            quotients = []
            for factor in (1.0, 0.5):
                h = SETTINGS.step * factor * (1 / self.rate if by_tau else v)
                ends = [self.impact(tau + s * h * by_tau, v + s * h * (1 - by_tau)) for s in (-1, 1)]
                if any(end.status != HIT or not isfinite(end.v) for end in ends):
                    return None
                less, more = ends
                if less.v * more.v < 0:  # at different walls
                    return None
                change = np.array([more.time - less.time, abs(more.v) - abs(less.v)])
                quotients.append(np.array([by_tau, 0.0]) + change / (2 * h))
                noise = 1e-11 * np.array([more.time, abs(more.v)]) / h
            columns.append((4 * quotients[1] - quotients[0]) / 3)
            errors.append(np.abs(quotients[1] - quotients[0]) / 10 + noise)
        return np.stack(columns, axis=1), np.stack(errors, axis=1)

    @cached_property
    def grid(self) -> tuple[Array, Array]:
        """Times of one period, shifted by a part of an interval, and a_c there."""
        times = (np.arange(SETTINGS.grid) + 0.4142) * self.period / SETTINGS.grid
        return times, self.pushes(times)

    @cached_property
    def lift_offs(self) -> tuple[float, ...]:
        """Phases in one period at which a_c becomes positive, by bisection."""
        times, a = self.grid
        ends = np.append(times[1:], times[0] + self.period)
        rising = np.flatnonzero((a < 0) & (np.roll(a, -1) >= 0))
        return tuple(sorted(self._zero(times[at], ends[at]) % self.period for at in rising.tolist()))

    def _zero(self, low: float, high: float) -> float:
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (middle, high) if self.push(middle) < 0 else (low, middle)
        return high

    def next_lift_off(self, tau: float) -> int:
        """The place in `lift_offs` of the first after a time; -1 where there is none."""
        if not self.lift_offs:
            return -1
        return int(np.searchsorted(np.array(self.lift_offs), tau % self.period)) % len(self.lift_offs)

    def lifted(self, tau: float, horizon: float | None = None, v: float = 0.0) -> Impact:
        """The first impact of a mass that lifts off from rest, by scipy's DOP853 with dense output; v is +-0.0."""
        model = self.at(v).motion
        p, c = model.parameters, model.clearance

        def slopes(s: float, y: Array) -> list[float]:
            return [y[1], model.acceleration(tau + s, c + y[0], y[1], p)]

        def height(_s: float, y: Array) -> float:
            return float(y[0])

        def depth(_s: float, y: Array) -> float:
            return float(y[0]) - model.gap

        height.terminal, height.direction = True, -1.0  # type: ignore[attr-defined]
        depth.terminal = True  # type: ignore[attr-defined]
        events = (height,) if self.above is None else (height, depth)
        until = self.horizon if horizon is None else horizon
        try:
            # x - c begins as s^3, below any absolute tolerance: steps are short there
            flight = solve_ivp(
                slopes,
                (0.0, until),
                [0.0, 0.0],
                "DOP853",
                events=events,
                rtol=SETTINGS.rest,
                atol=1e-15,
                max_step=0.2 / self.rate,
            )
        except (ArithmeticError, ValueError):
            return Impact(UNDECIDED, nan, nan, nan)
        if flight.status != 1:
            return Impact(MISS if flight.status == 0 else UNDECIDED, inf, 0.0, nan)
        return self._ended(v, HIT, float(flight.t[-1]), float(flight.y[1, -1]))


@lru_cache(maxsize=8)
def plain_orbits(osc: Oscillator, rate: float, horizon: float, fast: float, above: bool = False) -> PlainOrbits:
    """The orbits of a model.

    Parameters
    ----------
    rate, horizon : see `PlainOrbits`. fast : largest velocity of interest. above : those of its upper wall, in -x.

    Raises
    ------
    TypeError : f, g or rho holds an algebraic number that is given as a root.

    Examples
    --------
    >>> ball = plain_orbits(Oscillator("0", "-2", 0, "1/2"), 1.0, 30.0, 1.0)
    >>> end = ball.chatter(0.0, 1.0, 100)
    >>> end.status, round(end.time, 12), round(ball.impact(0.0, 3.0).v, 12)
    ('complete', 2.0, 1.5)
    """
    rho = rebound(osc.mirrored if above else osc)
    slopes = [rho(-slow) / slow for slow in (SETTINGS.slow * fast, 1e-3 * SETTINGS.slow * fast)]
    smooth = abs(slopes[1] - slopes[0]) <= 1e-6 * slopes[0] and slopes[0] < 1 - 1e-6
    second = plain_orbits(osc, rate, horizon, fast, True) if osc.upper is not None and not above else None
    slope, period = slopes[1] if smooth else nan, as_float(osc.period)
    return PlainOrbits(motion(osc, rate, above), rho, slope, period, rate, horizon, second)
