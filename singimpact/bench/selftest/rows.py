"""The table of a self-test: a row for each comparison, with the states that disagree as they are typed.

Random states of a model, in its own units of time and velocity, and their flights.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from functools import wraps
from math import isfinite, isnan, pi, sqrt
from time import process_time
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import DOUBLES, Array, as_float, derivative, evaluate
from singimpact.bench.truth.plain_orbits import PlainOrbits, plain_orbits
from singimpact.flights.results import Step
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.notebook import table
from singimpact.oscillator.wall_acceleration import acceleration

HEADER = ("compared", "tried", "agree", "undecided", "wrong", "worst", "note")
NOTE = (
    "worst: largest difference in units of what is allowed (1 is the limit). undecided: the status is unresolved, the"
    " independent computation does not settle, rounding explains any difference, or the row's CPU time was used up."
)


@dataclass(frozen=True)
class RowSettings:
    """Settings of a row: what it stores, and its time.

    Parameters
    ----------
    shown : wrong states of a row that are written out.
    seconds : CPU time, counted from the end of the first state, after which a row starts no further one; those left are
        undecided. The first state includes what is compiled, 10 s for a new model. Twelve rows then end within
        about two minutes for any model.
    """

    shown: int = 3
    seconds: float = 10.0


ROWS = RowSettings()


@dataclass(frozen=True)
class Row:
    """One comparison.

    Parameters
    ----------
    compared : with what. tried, agree, undecided, wrong : states, or points.
    worst : largest difference in units of what is allowed, among those that agree or are wrong; nan for none.
    note : why nothing was tried, or why states are undecided.
    wrong_states : calls that repeat some of the wrong ones, with both values.
    """

    compared: str
    tried: int = 0
    agree: int = 0
    undecided: int = 0
    wrong: int = 0
    worst: float = float("nan")
    note: str = ""
    wrong_states: tuple[str, ...] = ()

    def cells(self) -> list[str]:
        """The row as texts."""
        counts = [str(count) for count in (self.tried, self.agree, self.undecided, self.wrong)]
        return [self.compared, *counts, "-" if isnan(self.worst) else f"{self.worst:.2g}", self.note]


@dataclass
class Tally:
    """Counts of a row while it is filled.

    Examples
    --------
    >>> tally = Tally("a row")
    >>> tally.judge(0.5, "fine")
    >>> tally.judge(float("nan"), "a state")
    >>> tally.leave("not settled")
    >>> tally.row().cells()
    ['a row', '3', '1', '1', '1', 'inf', 'not settled: 1']
    """

    compared: str
    begun: float = field(default_factory=process_time)
    agree: int = 0
    worst: float = float("nan")
    wrong: list[str] = field(default_factory=list)
    causes: dict[str, int] = field(default_factory=dict)

    @property
    def late(self) -> bool:
        """Whether the row has used up its CPU time."""
        return process_time() - self.begun > ROWS.seconds

    def restart(self) -> None:
        """Count CPU time from now on: what was compiled before is no work of a state."""
        self.begun = process_time()

    def judge(self, ratio: float, state: str) -> None:
        """Count a difference in units of what is allowed; nan is wrong."""
        if not self.agree and not self.wrong and not self.causes:
            self.restart()
        ratio = float("inf") if isnan(ratio) else ratio
        self.worst = ratio if isnan(self.worst) else max(self.worst, ratio)
        if ratio <= 1:
            self.agree += 1
        else:
            self.wrong.append(state)

    def leave(self, cause: str, count: int = 1) -> None:
        """Count states as undecided."""
        if count:
            self.causes[cause] = self.causes.get(cause, 0) + count

    def in_time(self, places: Sequence[int]) -> Iterator[int]:
        """Places one after the other until the CPU time is used up; those that are left are undecided."""
        for done, place in enumerate(places):
            if self.late:
                self.leave("CPU time used up", len(places) - done)
                return
            yield place

    def row(self) -> Row:
        """The row."""
        undecided = sum(self.causes.values())
        note = ", ".join(f"{cause}: {count}" for cause, count in self.causes.items())
        tried = self.agree + len(self.wrong) + undecided
        return Row(
            self.compared,
            tried,
            self.agree,
            undecided,
            len(self.wrong),
            self.worst,
            note,
            tuple(self.wrong[: ROWS.shown]),
        )


@dataclass(frozen=True)
class SelfTest:
    """The result of a self-test.

    Parameters
    ----------
    model : the model as text. rows : one for each comparison. seconds : CPU time.
    """

    model: str
    rows: tuple[Row, ...]
    seconds: float

    @property
    def wrong(self) -> int:
        """The number of states or points that are wrong; 0 where none is."""
        return sum(row.wrong for row in self.rows)

    @property
    def undecided(self) -> int:
        """The number of states or points that were not decided."""
        return sum(row.undecided for row in self.rows)

    def as_data(self) -> dict[str, Any]:
        """The result as plain data."""
        return {
            "wrong": self.wrong,
            "undecided": self.undecided,
            "seconds": self.seconds,
            "rows": [asdict(row) for row in self.rows],
        }

    def __str__(self) -> str:
        lines = [
            self.model,
            *_aligned([list(HEADER), *(row.cells() for row in self.rows)]),
            NOTE,
            *self._wrong_states(),
        ]
        lines.append(f"{self.wrong} wrong, {self.undecided} undecided, {self.seconds:.0f} s of CPU time")
        return "\n".join(lines)

    def _wrong_states(self) -> list[str]:
        return [f"wrong, {row.compared}: {state}" for row in self.rows for state in row.wrong_states]

    def _repr_html_(self) -> str:
        caption = f"{self.wrong} wrong, {self.undecided} undecided"
        listed = self._wrong_states()
        below = table(["wrong states"], [[text] for text in listed]) if listed else ""
        return table(HEADER, [row.cells() for row in self.rows], caption) + below


def _aligned(lines: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]


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
