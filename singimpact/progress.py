"""A progress line on a terminal or in a notebook; none if standard error is neither."""

import os
import sys
import time
from types import TracebackType
from typing import Any

from singimpact.notebook import CellLine, in_notebook

DELAY = 1.0  # s of work before the line appears; the import of rich takes 0.1 s


def watched() -> bool:
    """Whether standard error is a terminal, or the process runs a notebook."""
    return in_notebook() or (sys.stderr.isatty() and os.environ.get("TERM") != "dumb")


class ProgressLine:
    """Shows ``done/total text`` on standard error, or under the cell of a notebook, until the work ends.

    Parameters
    ----------
    delay : float, seconds of work before the line appears.

    Examples
    --------
    >>> with ProgressLine() as line:
    ...     line.show(1, 2, "first")
    """

    def __init__(self, delay: float = DELAY) -> None:
        self._after = time.monotonic() + delay
        self._watched = watched()
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> "ProgressLine":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._bar is not None:
            self._bar.stop()

    def show(self, done: int, total: int | None, text: str) -> None:
        """Show the number of finished items and a text; total is None if it is unknown."""
        if not self._watched or (self._bar is None and time.monotonic() < self._after):
            return
        if self._bar is None:
            self._bar = _bar()
            self._task = self._bar.add_task(text, total=total)
            self._bar.start()
        self._bar.update(self._task, completed=done, total=total, description=text)


def _bar() -> Any:
    if in_notebook():
        return CellLine()
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
    from rich.table import Column

    return Progress(
        MofNCompleteColumn(),
        BarColumn(bar_width=20),
        TimeElapsedColumn(),
        TextColumn("{task.description}", markup=False, table_column=Column(no_wrap=True, ratio=1)),
        console=Console(stderr=True),
        transient=True,
        expand=True,
    )
