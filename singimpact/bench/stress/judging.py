"""A trial: doubles against 60 digits. The unit of an error is the effect of one rounding error of the given state.

    units = |found - true| / (epsilon (|true| + sum |d true/d input| |input|))

The right status is 0 units, a wrong one inf.  Nothing is forgiven besides: no least error is always allowed.

Launches that approach the singular points of a flight, for linear, cubic and steep oscillators.

Places: v -> 0 pressed and free, short flights, near resonance, r -> 0 and 1, next to zeros of a and of a', next to the
outline P (flights that graze) and to Z (launches that nearly rest), late phases, many periods without impact, forces
that vary within 1/K of a state, K towards 1e4; two walls from 1e-12 to 1e6 apart, and grazes of the other one.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import acos, inf, log2, pi
from typing import Any

import flint
import mpmath

from singimpact.algebra import EPSILON, balls_at
from singimpact.bench.truth.first_hit import Above, Cubic, Linear, first_hit
from singimpact.impact_oscillator import ImpactOscillator, linear

DIGITS = 60
STEP = 25  # differences of 60-digit numbers over 10^-STEP are right to 25 digits


@dataclass(frozen=True)
class Limits:
    """failure : units above which a function fails: a few operations do not round that much.
    spare : decimal digits beside the 60, for what cancels in a truth.
    """

    failure: float = 100.0
    spare: int = 20


LIMITS = Limits()


@dataclass(frozen=True)
class Trial:
    """The value of a function at a state, and the reference value.

    Parameters
    ----------
    state : as text. found, truth : numbers; a truth may be a ball. moved : sum |d true/d input| |input|, a number each.
    status : given and true; they must agree.
    """

    state: str
    found: Sequence[Any] = ()
    truth: Sequence[Any] = ()
    moved: Sequence[Any] = ()
    status: tuple[int, int] = (0, 0)

    @property
    def units(self) -> float:
        """The largest error of its numbers.

        Examples
        --------
        >>> Trial("v = 1", [1 + 2.0**-51], ["1"], [1.0]).units
        1.0
        >>> Trial("v = 0", status=(5, 2)).units
        inf
        """
        if self.status[0] != self.status[1]:
            return inf
        parts = zip(self.found, self.truth, self.moved, strict=True)
        return max((_units(*number) for number in parts), default=0.0)


def _units(found: Any, truth: Any, moved: Any) -> float:
    with mpmath.workdps(DIGITS + LIMITS.spare):
        value, error = number(truth), abs(mpmath.mpf(found) - number(truth))
        allowed = (abs(value) + number(moved)) * mpmath.mpf(EPSILON)
        if not error:
            return 0.0
        return float(error / allowed) if allowed > 0 and mpmath.isfinite(error) else inf


def number(value: Any) -> Any:
    """A ball's middle, a certified value or text as an mpmath number at the working precision."""
    if hasattr(value, "mid"):
        mantissa, exponent = value.mid().man_exp()
        return mpmath.mpf(int(mantissa)) * mpmath.power(2, int(exponent))
    if hasattr(value, "numerator") and not isinstance(value, int | float):
        return mpmath.mpf(int(value.numerator)) / int(value.denominator)
    return mpmath.mpf(value)


def moved(function: Callable[..., Any], inputs: Sequence[Any]) -> tuple[Any, Any]:
    """Values of a function of 60 digits, and sum |d value/d input| |input| by differences, a number for each value.

    Parameters
    ----------
    function : of as many numbers as there are inputs -> list of numbers.

    Examples
    --------
    >>> values, rounding = moved(lambda x: [x**3], [2.0])
    >>> float(values[0]), round(float(rounding[0]), 12)
    (8.0, 24.0)
    """
    with mpmath.workdps(DIGITS + LIMITS.spare):
        exact = [number(value) for value in inputs]
        values = function(*exact)
        total = [mpmath.mpf(0) for _ in values]
        for index, size in enumerate(exact):
            if not size:
                continue
            change = abs(size) * mpmath.mpf(10) ** -STEP
            other = function(*exact[:index], exact[index] + change, *exact[index + 1 :])
            total = [
                so_far + abs((new - old) / change * size) for so_far, new, old in zip(total, other, values, strict=True)
            ]
        return values, total


Sweep = Callable[[int], Iterator[Trial]]  # a function of the number of points: trials that approach a singular point
Judge = Callable[[str, int], Iterator[Trial]]  # of a place and the number of points: the trials of a function there


@dataclass(frozen=True)
class Function:
    """A public function and its sweeps.

    Parameters
    ----------
    name : as the table shows it. sweeps : place -> sweep. route : where the 60 digits come from.
    left_out : why the other places do not apply.
    """

    name: str
    sweeps: dict[str, Sweep]
    route: str
    left_out: str


@dataclass(frozen=True)
class Cell:
    """The worst trial of a function near a singular point. failed : over the limit, or no trial was run."""

    function: str
    place: str
    trials: int
    units: float
    state: str

    @property
    def failed(self) -> bool:
        """Whether it is over the limit."""
        return not (self.trials and self.units <= LIMITS.failure)


def worst(function: str, name: str, sweep: Sweep, points: int) -> Cell:
    """The cell of a sweep.

    Examples
    --------
    >>> worst("f", "v", lambda points: iter([Trial(str(n), [n], [n], [0]) for n in range(points)]), 3)
    Cell(function='f', place='v', trials=3, units=0.0, state='0')
    """
    trials = list(sweep(points))
    judged = [(trial.units, trial.state) for trial in trials]
    units, state = max(judged, key=lambda pair: pair[0], default=(inf, "no trial"))
    return Cell(function, name, len(trials), units, state)


def powers(points: int, last: float, first: float = 1.0) -> list[float]:
    """10^-first to 10^-last in equal ratios: the distances of a sequence from its singular point.

    Examples
    --------
    >>> powers(3, 3)
    [0.1, 0.01, 0.001]
    """
    return [float(f"{10.0 ** -(first + (last - first) * n / max(points - 1, 1)):.3g}") for n in range(points)]


CUBIC = "x + xdot/10 + 3*x**3/10"
BITS = 320
HORIZON = {
    "linear": 20000.0,
    "cubic": 60.0,
}  # a flight that does not return is slow in 60 digits; the cubic model is damped


@dataclass(frozen=True)
class Launch:
    """A model and a state, all exact doubles; with a second wall at `upper` the state is at the wall 0 or 1."""

    family: str
    omega: float = 2.8
    clearance: float = 0.0
    restitution: float = 0.8
    tau: float = 0.9
    v: float = 0.5
    upper: float | None = None
    wall: int = 0
    upper_restitution: float | None = None

    @property
    def model(self) -> ImpactOscillator:
        """The oscillator; without an `upper_restitution` both walls have one."""
        if self.family == "linear":
            osc = linear(self.omega, self.clearance, self.restitution)
        else:
            osc = ImpactOscillator(CUBIC, "cos(omega*t)", self.clearance, self.restitution, {"omega": self.omega})
        return osc if self.upper is None else osc.replace(upper=self.upper, upper_restitution=self.upper_restitution)

    def motion(self, tau: Any, v: Any, sign: int = 1) -> Linear | Cubic:
        """The flight from another state, in balls, up from its wall; sign -1: backwards."""
        place, push = (-self.upper, -1) if self.wall and self.upper is not None else (self.clearance, 1)
        if self.family == "linear":
            return Linear(self.omega, place, tau, v, push)
        return Cubic(self.omega, place, tau, v, sign, push)

    @property
    def gap(self) -> Any:
        """The distance of both walls, a ball; None of one wall."""
        return None if self.upper is None else flint.arb(self.upper) - flint.arb(self.clearance)

    def before_touch(self, time: float) -> tuple[Any, Any] | None:
        """Flight time and velocity back from a touch of this wall; None where no flight touches it."""
        with balls_at(BITS):
            motion = self.motion(-time, 0.0, -1)
            if not motion.at(0)[2] > 1e-3:
                return None
            return first_hit(motion if self.upper is None else Above(motion, self.gap), 0.0, 60.0)

    @property
    def horizon(self) -> float:
        """The time after which a flight is given up."""
        return HORIZON[self.family]

    @property
    def bits(self) -> int:
        """Precision of the balls in bits; small v need more."""
        return BITS + (int(4 * max(-log2(self.v), 0)) if self.v else 0)

    def __str__(self) -> str:
        walls = ("clearance",) if self.upper is None else ("clearance", "upper", "wall")
        names = ("omega", *walls, "restitution", "tau", "v")
        return f"{self.family}, " + ", ".join(f"{name} = {getattr(self, name)!r}" for name in names)


@dataclass(frozen=True)
class SteepLaunch(Launch):
    """A state of a model with a layer of a steepness; force and forcing are its texts, of period 2 pi."""

    force: str = "x"
    forcing: str = "cos(t)"
    steepness: float = 0.0

    @property
    def model(self) -> ImpactOscillator:
        """The oscillator."""
        return ImpactOscillator(self.force, self.forcing, self.clearance, self.restitution)

    @property
    def horizon(self) -> float:
        """The time after which a flight is given up."""
        return HORIZON["cubic"]

    def __str__(self) -> str:
        return f"f = {self.force}, g = {self.forcing}, tau = {self.tau!r}, v = {self.v!r}"


Launches = Callable[[str, int], Iterator[Launch]]


def _small_v(family: str, points: int) -> Iterator[Launch]:
    for v in powers(points, 13):
        yield Launch(family, tau=0.9, v=v)
        yield Launch(family, tau=0.1, v=v)
    yield Launch(family, tau=0.9, v=1e-300)


def _tangent(family: str, points: int) -> Iterator[Launch]:
    place = acos(0.3 if family == "linear" else 0.3 + 0.3 * 0.3**3) / 2.8
    for off in powers(points, 15):
        for tau in (place - off, place + off, -place - off, -place + off):
            yield Launch(family, clearance=0.3, tau=tau, v=1e-3)
            yield Launch(family, clearance=0.3, tau=tau, v=0.0)


def _swan(family: str, points: int) -> Iterator[Launch]:
    level = 1.0 if family == "linear" else 0.8  # 0.8 + 0.3 0.8^3 = 0.9536 at cos(omega tau)
    place = 0.0 if family == "linear" else acos(0.8 + 0.3 * 0.8**3) / 2.8
    for off in powers(points, 12):
        for side in (1, -1):
            yield Launch(family, clearance=level - side * off, tau=place + off, v=1e-3)
            yield Launch(family, clearance=level - off, tau=place - side * off**0.5, v=off)


def _grazing(family: str, points: int) -> Iterator[Launch]:
    """A backward flight from a state next to a graze."""
    for touch in (0.1, 1.0):
        yield from _beside(Launch(family, clearance=-0.4), touch, points)


def _beside(at: Launch, touch: float, points: int) -> Iterator[Launch]:
    """Launches at the lower wall beside the one whose flight grazes at a time, where a flight back from there hits."""
    hit = at.before_touch(touch)
    if hit is None:
        return
    for off in powers(points, 13):
        for side in (1, -1):
            yield replace(at, wall=0, tau=touch - float(hit[0]), v=-float(hit[1]) * (1 + side * off))


def _between(family: str, points: int) -> Iterator[Launch]:
    """Launches that reach the other wall, just so and not; slow ones; backward flights from states beside a graze."""
    for gap in powers(points, 12, -6 if family == "linear" else -1):
        for share in (0.3, 1.0, 3.0):
            yield Launch(family, v=share * max(gap, (2 * gap) ** 0.5), upper=gap)
    for v in powers(points, 150):
        yield Launch(family, v=v, upper=0.5)
    for touch in (0.8, 1.3):
        yield from _beside(Launch(family, clearance=-0.4, upper=0.6, wall=1), touch, points)


def _long(family: str, points: int) -> Iterator[Launch]:
    for n, off in enumerate(powers(points, 12, 2)):
        omega, deep = (1 + off, 3.0 + 5 * n) if family == "linear" else (1 + off, 0.7 + 0.8 * n / points)
        yield Launch(family, omega, -deep, tau=2 * pi * 0.3, v=0.7)
        yield Launch(family, 2 - omega, -deep, tau=0.1, v=0.2)


def _steep(family: str, points: int) -> Iterator[Launch]:
    """Friction, a stop, a bump and a pulse that are crossed, of the steepness K.

    The pulse is written without cos(t) - 1, whose rounding alone would move it by K^2 epsilon.
    """
    for off in powers(max(points // 3, 2), 4) if family == "linear" else ():
        K = round(1 / off)
        for force, forcing, tau in (
            (f"x + tanh({K}*xdot)/10", "cos(t)", 0.3),
            (f"x + 5*(1 + tanh({K}*(x - 1/2)))", "cos(t)", 0.3),
            (f"x + 5*exp(-{K}**2*(x - 1/2)**2)", "cos(t)", 0.3),
            ("x", f"10*exp(-2*{K}**2*sin(t/2)**2) - 1/5", 4.5),
        ):
            yield SteepLaunch(force, 1.0, tau=tau, v=2.0, force=force, forcing=forcing, steepness=float(K))


def _parametric(family: str, points: int) -> Iterator[Launch]:
    """Slow launches with t in f, a modulation that vanishes, and slow launches of a model without t."""
    for off in powers(max(points // 3, 2), 12) if family == "linear" else ():
        for force, forcing, tau, v in (
            ("(1 + cos(2*t)/3)*x + xdot*(1 + sin(t))/10", "cos(t) - 1/5", 2.5, off),
            (f"(1 + {off!r}*cos(2*t))*x + x**3/5", "cos(t)", 0.3, 1.0),
            ("x - (1 - x**2)*xdot", "-1/5", 0.0, off),
        ):
            yield SteepLaunch(force, 1.0, tau=tau, v=v, force=force, forcing=forcing, steepness=1.0)


PLACES: dict[str, Launches] = {
    "v -> 0": _small_v,
    "t -> 0": lambda family, points: (Launch(family, clearance=30.0, v=v) for v in powers(points, 16, 0)),
    "omega -> 1": lambda family, points: (
        Launch(family, omega, -0.5, tau=0.3) for off in (0.0, *powers(points, 15)) for omega in {1 + off, 1 - off}
    ),
    "r -> 0": lambda family, points: (Launch(family, restitution=r) for r in powers(points, 15)),
    "r -> 1": lambda family, points: (Launch(family, restitution=1 - off) for off in powers(points, 15)),
    "a -> 0": _tangent,
    "a' -> 0": _swan,
    "next to P": _grazing,
    # launches with a > 0 whose velocity runs to 0: the flight is long, Z is where it left at rest
    "next to Z": lambda family, points: (
        Launch(family, clearance=clearance, tau=tau, v=v)
        for v in (0.0, *powers(points, 16))
        for clearance, tau in ((-0.4, 0.2), (0.2, 0.4))
    ),
    "huge tau": lambda family, points: (
        Launch(family, tau=tau) for size in powers(points, 15) for tau in (0.9 + 1 / size, -1 / size)
    ),
    "long flights": _long,
    "steep layers": _steep,
    "t in f": _parametric,
    "two walls": _between,
}


def both(place: str, points: int) -> Iterator[Launch]:
    """Launches of linear or steep oscillators, then a third as many of the cubic one, whose truth takes fifty times
    longer.
    """
    yield from PLACES[place]("linear", points)
    yield from PLACES[place]("cubic", max(points // 3, 2))
