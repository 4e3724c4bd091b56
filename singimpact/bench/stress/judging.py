"""A trial: doubles against 60 digits. The unit of an error is the effect of one rounding error of the given state.

    units = |found - true| / (epsilon (|true| + sum |d true/d input| |input|))

The right status is 0 units, a wrong one inf.  Nothing is forgiven besides: no least error is always allowed.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import mpmath

from singimpact.algebra.numbers import EPSILON

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
