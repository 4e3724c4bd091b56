"""The table of a self-test: a row for each comparison, with the states that disagree as they are typed."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from math import isnan
from time import process_time
from typing import Any

from singimpact.notebook import table

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
