"""Pictures as files: the format is read from the ending, the file is whole or absent."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from singimpact.inputs import refuse
from singimpact.store import written

PICTURES = (".png", ".pdf", ".svg")


def suffix_of(output: str) -> str:
    """The ending of a picture's name.

    Raises
    ------
    InputError : not .png, .pdf or .svg.
    """
    found = Path(output).suffix.lower()
    if found not in PICTURES:
        raise refuse("output", output, "a file name ending in .png, .pdf or .svg")
    return found


def save(figure: Any, output: str | Path, dpi: int = 150) -> None:
    """Write a figure; without a date, so that the same picture is the same file."""
    kind = suffix_of(str(output))[1:]
    import matplotlib

    dated = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(kind)
    with written(output) as draft, matplotlib.rc_context({"svg.hashsalt": "singimpact"}):
        figure.savefig(draft, format=kind, dpi=dpi, metadata=dated)


def blank_axes() -> Any:
    """Axes of a figure that no window shows, of the size of a picture of branches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(7.2, 4.8), dpi=150, layout="constrained").add_subplot()
