"""Pictures as files: the suffix gives the format, and the file appears only when complete."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.inputs import refuse
from singimpact.store import cache_folder, written

PICTURES = (".png", ".pdf", ".svg")


def suffix_of(output: str) -> str:
    """The ending of a picture's name.

    Raises
    ------
    InputError : not .png, .pdf or .svg.
    """
    suffix = Path(output).suffix.lower()
    if suffix not in PICTURES:
        raise refuse("output", output, "a file name ending in .png, .pdf or .svg")
    return suffix


def save(figure: Any, output: str | Path, dpi: int = 150) -> None:
    """Write a figure, without a date, so that the same picture gives the same file."""
    kind = suffix_of(str(output))[1:]
    import matplotlib

    dated = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(kind)
    # letters of a PDF as TrueType outlines: printers refuse matplotlib's own Type 3
    with written(output) as draft, matplotlib.rc_context({"svg.hashsalt": "singimpact", "pdf.fonttype": 42}):
        figure.savefig(draft, format=kind, dpi=dpi, metadata=dated)


def save_once(request: tuple[Any, ...], output: str | Path, make: Callable[[], tuple[Any, Any]], dpi: int = 150) -> Any:
    """Write a picture, from the cache if it was drawn before, and return the text that is printed with it.

    Parameters
    ----------
    request : all that the picture depends on beside the package, as texts and numbers.
    make : gives a matplotlib figure and what is to be said of it, which JSON holds.
    """
    stored = kept_at((*request, suffix_of(str(output)), dpi), ("matplotlib", "contourpy"))
    content = cache.recall(stored)
    if content is None:
        figure, values = make()
        save(figure, output, dpi)
        cache.keep(stored, json.dumps(values).encode() + b"\n" + Path(output).read_bytes())
        return json.loads(json.dumps(values))
    values, _, picture = content.partition(b"\n")
    with written(output) as draft:
        draft.write_bytes(picture)
    return json.loads(values)


def kept_at(asked: tuple[Any, ...], libraries: tuple[str, ...]) -> Path:
    """Where the cache keeps what was drawn: under what was asked, the package, and the libraries that draw."""
    return cache_folder() / "pictures" / f"{cache.key_of(asked, ('numpy', *libraries))}.picture"


def blank_axes() -> Any:
    """Axes of a figure that no window shows, of the size of a picture of branches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(7.2, 4.8), dpi=150, layout="constrained").add_subplot()
