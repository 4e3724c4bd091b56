"""The output of a command: text, tables, JSON or a picture; a file appears only when complete."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click
from click.core import ParameterSource

from singimpact import cache
from singimpact.inputs import refuse, require
from singimpact.result import as_json
from singimpact.status import Status
from singimpact.store import cache_folder, require_writable, write_text, written

Function = TypeVar("Function", bound=Callable[..., Any])


def output_options(function: Function) -> Function:
    """The options ``--json`` and ``-o`` of a command that gives text."""
    told = "Write to this file instead of standard output."
    function = click.option("-o", "--output", metavar="FILE", callback=writable, help=told)(function)
    return click.option("--json", "as_json", is_flag=True, help="Print JSON.")(function)


def page_format(more: str = "") -> Callable[[Function], Function]:
    """The option ``--format`` of a command that also writes a page of the documentation."""
    kinds, told = click.Choice(["text", "markdown", "page"]), f"`page` writes the page of the documentation{more}."
    return click.option("--format", "form", type=kinds, default="text", show_default=True, help=told)


def whole_option(
    name: str, least: int, most: int | None, told: str, default: int | None = None
) -> Callable[[Function], Function]:
    """An option that is a whole number from `least` to `most`."""
    kind = click.IntRange(least, most)
    return click.option(name, type=kind, default=default, show_default=default is not None, help=told)


def choice_option(
    name: str, kinds: Sequence[str], told: str, default: str | None = None
) -> Callable[[Function], Function]:
    """An option that is one of some words."""
    kind = click.Choice(kinds)
    return click.option(name, type=kind, default=default, show_default=default is not None, help=told)


def picture_option(
    told: str = "The picture: .png, .pdf or .svg.", required: bool = False
) -> Callable[[Function], Function]:
    """The option ``-o`` of a command that draws."""
    return click.option("-o", "--output", metavar="FILE.png", required=required, callback=_drawable, help=told)


def csv_option(columns_: str) -> Callable[[Function], Function]:
    """The option ``--csv`` of a command that follows curves."""
    told = f"Write one line for each point: {columns_}"
    return click.option("--csv", metavar="FILE.csv", callback=writable, help=told)


def state_options(function: Function) -> Function:
    """The options ``--tau`` and ``--v``."""
    function = click.option("--v", metavar="NUMBER", required=True, help="Launch velocity.")(function)
    return click.option("--tau", metavar="NUMBER", required=True, help="Launch phase.")(function)


def writable(ctx: click.Context, option: click.Parameter, path: str | None) -> str | None:  # noqa: ARG001
    """Check the output path before the computation, not after it."""
    if path is not None:
        require_writable(path)
    return path


def _drawable(ctx: click.Context, option: click.Parameter, path: str | None) -> str | None:
    if path is not None:
        suffix_of(path)
    return writable(ctx, option, path)


def refuse_given(names: Sequence[str], accepted: str) -> None:
    """Refuse options of the running command that nothing would read."""
    context = click.get_current_context()
    for name in names:
        if context.get_parameter_source(name) == ParameterSource.COMMANDLINE:
            raise refuse(f"--{name}", context.params[name], accepted)


def emit(text: str, output: str | None) -> None:
    """Print a text, or write it to the given file."""
    if output is None:
        click.echo(text)
    else:
        write_text(output, text.rstrip("\n") + "\n")


def give(data: object, text: str, as_json: bool, output: str | None = None) -> None:
    """Print data as JSON where ``--json`` asks for it and a text otherwise, or write it to the given file."""
    emit(as_json_text(data) if as_json else text, output)


def as_json_text(data: object) -> str:
    """Valid JSON: nan and inf become null, and the status beside them tells them apart.

    Examples
    --------
    >>> print(as_json_text({"flight_time": float("inf")}))
    {
      "flight_time": null
    }
    """
    return json.dumps(as_json(data), indent=2, allow_nan=False)


def number_text(value: Any, digits: int | None) -> Any:
    """A double, or the text of as many digits as were asked for."""
    if digits is None:
        return float(value)
    from mpmath import nstr

    return nstr(value, digits, strip_zeros=False)


def lines_of(rows: Mapping[str, Any], status: Status, plain: tuple[Status, ...] = ()) -> list[str]:
    """Names and values below one another, and last the status, with its sentence where it is not among `plain`.

    Examples
    --------
    >>> lines_of({"tau": 0.5, "impacts": 3}, Status.hit, (Status.hit,))
    ['tau      0.5', 'impacts  3', 'status   hit']
    """
    width = max(map(len, [*rows, "status"]))
    word = status.name if status in plain else f"{status.name}: {status.sentence}"
    return [f"{name:{width}}  {value}" for name, value in [*rows.items(), ("status", word)]]


# Rows of cells as aligned text or as a Markdown table.


def columns(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Left-aligned columns two spaces apart, no trailing blanks.

    Examples
    --------
    >>> print(columns(["tau", "v"], [["0.5", "0.125"], ["10", "1"]]))
    tau  v
    0.5  0.125
    10   1
    """
    table = [list(header), *map(list, rows)]
    widths = [max(len(row[i]) for row in table) for i in range(len(header))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in table
    )


def markdown(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Rows of cells as a table of Markdown.

    Examples
    --------
    >>> print(markdown(["tau", "v"], [["0.5", "0.125"]]))
    | tau | v |
    |---|---|
    | 0.5 | 0.125 |
    """
    lines = [list(header), *map(list, rows)]
    text = ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]
    return "\n".join([text[0], "|" + "---|" * len(header), *text[1:]])


# Pictures as files: the suffix gives the format.

PICTURES = (".png", ".pdf", ".svg")


def suffix_of(output: str) -> str:
    """The ending of a picture's name.

    Raises
    ------
    InputError : not .png, .pdf or .svg.
    """
    suffix = Path(output).suffix.lower()
    require(suffix in PICTURES, "output", output, "a file name ending in .png, .pdf or .svg")
    return suffix


def save(figure: Any, output: str | Path, dpi: int = 150) -> None:
    """Write a figure, without a date, so that the same picture gives the same file."""
    kind = suffix_of(str(output))[1:]
    import matplotlib

    dated = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(kind)
    # letters of a PDF as TrueType outlines: printers refuse matplotlib's own Type 3
    with written(output) as draft, matplotlib.rc_context({"svg.hashsalt": "singimpact", "pdf.fonttype": 42}):
        figure.savefig(draft, format=kind, dpi=dpi, metadata=dated)


def save_once(
    request: tuple[object, ...], output: str | Path, make: Callable[[], tuple[Any, Any]], dpi: int = 150
) -> Any:
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


def kept_at(asked: tuple[object, ...], libraries: tuple[str, ...]) -> Path:
    """Where the cache keeps what was drawn: under what was asked, the package, and the libraries that draw."""
    return cache_folder() / "pictures" / f"{cache.key_of(asked, ('numpy', *libraries))}.picture"
