"""The output of a command: text or JSON, on standard output or in a file, which appears only when complete."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import click

from singimpact.result import as_json
from singimpact.status import Status
from singimpact.store import require_writable, write_text

Function = TypeVar("Function", bound=Callable[..., Any])


def output_options(function: Function) -> Function:
    """The options ``--json`` and ``-o`` of a command that gives text."""
    function = click.option(
        "-o", "--output", metavar="FILE", callback=_checked, help="Write to this file instead of standard output."
    )(function)
    return click.option("--json", "as_json", is_flag=True, help="Print JSON.")(function)


def _checked(ctx: click.Context, option: click.Parameter, path: str | None) -> str | None:  # noqa: ARG001
    """Check the output path before the computation, not after it."""
    if path is not None:
        require_writable(path)
    return path


def emit(text: str, output: str | None) -> None:
    """Print a text, or write it to the given file."""
    if output is None:
        click.echo(text)
    else:
        write_text(output, text.rstrip("\n") + "\n")


def as_json_text(data: Any) -> str:
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
