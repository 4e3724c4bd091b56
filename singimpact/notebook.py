"""Results in a notebook: tables as HTML, and a line of progress that is rewritten in its cell."""

import sys
from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from io import BytesIO
from typing import Any

from singimpact.handed_on import public
from singimpact.inputs import InputError

MOST_ROWS = 20


def in_notebook() -> bool:
    """Whether this process answers the cells of a notebook; nothing is imported to find out."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None and hasattr(ipython, "get_ipython") else None
    return type(shell).__name__ == "ZMQInteractiveShell"


def table(header: Sequence[str], rows: Sequence[Sequence[Any]], caption: str = "", most: int = MOST_ROWS) -> str:
    """An HTML table of texts; formulas between dollar signs are set by the notebook.

    Parameters
    ----------
    header : names of the columns. rows : of as many cells; caption : a line above it.
    most : rows shown; those beyond are counted.

    Examples
    --------
    >>> table(["a", "b"], [["1", "x < y"]])
    '<table><tr><th>a</th><th>b</th></tr><tr><td>1</td><td>x &lt; y</td></tr></table>'
    """
    shown = [_row("td", row) for row in rows[:most]]
    if len(rows) > most:
        shown.append(f'<tr><td colspan="{len(header)}">and {len(rows) - most} more</td></tr>')
    above = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{above}{_row('th', header) if header else ''}{''.join(shown)}</table>"


def box(thing: object, more: str) -> str:
    """A result in a notebook: its words, its model, a small picture where `si.plot` draws one, and what is folded up.

    Parameters
    ----------
    more : HTML that a click opens.
    """
    latex = getattr(getattr(thing, "oscillator", getattr(thing, "model", None)), "_repr_latex_", None)
    equation = f"<div>{latex()}</div>" if latex else ""
    where = f"<small>help: <code>help({type(thing).__module__}.{type(thing).__qualname__})</code></small>"
    folded = f"<details><summary>numbers</summary>{more}</details>"
    return f"<div><pre>{escape(str(thing))}</pre>{equation}{_picture(thing)}{folded}{where}</div>"


def _picture(thing: object) -> str:
    """The thing as `si.plot` draws it, small; "" where it draws nothing."""
    import numpy as np

    try:
        figure = np.ravel(public("plot")(thing))[0].figure
    except InputError:
        return ""
    from matplotlib import pyplot

    stream = BytesIO()
    figure.savefig(stream, format="png", dpi=60)
    pyplot.close(figure)  # or the notebook shows it again
    return f'<img alt="picture" src="data:image/png;base64,{b64encode(stream.getvalue()).decode()}">'


def _row(cell: str, texts: Iterable[Any]) -> str:
    return f"<tr>{''.join(f'<{cell}>{escape(str(text))}</{cell}>' for text in texts)}</tr>"


class CellLine:
    """A line of progress in the output of a cell; it takes what a bar of rich takes."""

    def __init__(self) -> None:
        from IPython.display import HTML, display

        self._html: Any = HTML
        self._handle: Any = display(HTML(""), display_id=True)

    def add_task(self, description: str, total: int | None) -> tuple[str, int | None]:
        """Begin a line for a count."""
        return description, total

    def start(self) -> None:
        """Nothing to start: the line is there."""

    def update(self, _: Any, completed: int, total: int | None, description: str) -> None:
        """Rewrite the line."""
        bar = "" if total is None else f'<progress value="{completed}" max="{total}"></progress>'
        told = completed if total is None else f"{completed}/{total}"
        self._handle.update(self._html(f"{bar} {told} {escape(description)}"))

    def stop(self) -> None:
        """The line goes when the work ends."""
        self._handle.update(self._html(""))
