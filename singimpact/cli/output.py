"""The output of a command: text or JSON, on standard output or in a file, which appears only when complete."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any, TypeVar

import click

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
    return json.dumps(_plain(data), indent=2, allow_nan=False)


def _plain(data: Any) -> Any:
    if isinstance(data, dict):
        return {str(key): _plain(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(item) for item in data]
    if isinstance(data, float):
        return float(data) if math.isfinite(data) else None
    if data is None or isinstance(data, bool | int | str):
        return data
    return _plain(data.item()) if hasattr(data, "item") else str(data)
