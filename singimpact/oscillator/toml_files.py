"""Model files: TOML with the fields of an `Oscillator`."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from singimpact.inputs import InputError, shown, unknown
from singimpact.store import read_bounded

FIELDS = ("f", "g", "clearance", "restitution", "parameters", "period")
REQUIRED = ("f", "g", "clearance", "restitution")


def fields_of(text: str, source: str = "model file") -> dict[str, Any]:
    """The fields in a TOML text; numbers keep the decimals that are written.

    Raises
    ------
    InputError : not TOML, an unknown key (the nearest known one is named), a field missing.

    Examples
    --------
    >>> fields_of('f = "x"\\ng = "cos(2*t)"\\nclearance = 0.3\\nrestitution = 0.5')
    {'f': 'x', 'g': 'cos(2*t)', 'clearance': '0.3', 'restitution': '0.5'}
    """
    try:
        fields = tomllib.loads(text, parse_float=str)
    except (ValueError, RecursionError) as error:  # an integer of 5000 digits is a plain ValueError
        raise InputError(f"{source} is not TOML: {' '.join(str(error).split())}") from None
    for key in fields:
        if key not in FIELDS:
            raise unknown(f"key in {source}:", key, FIELDS)
    for key in REQUIRED:
        if key not in fields:
            raise InputError(f"{source} has no {key}: a model needs {', '.join(REQUIRED)}")
    return fields


def read_fields(path: str | Path) -> dict[str, Any]:
    """The fields of a model file."""
    raw = read_bounded(path, "model file")
    try:
        return fields_of(raw.decode("utf-8"), f"model file {shown(str(path))}")
    except UnicodeDecodeError:
        raise InputError(f"model file {shown(str(path))} is not UTF-8 text") from None


def to_toml(fields: dict[str, Any]) -> str:
    """The TOML text of a model's fields (`Oscillator.to_dict`)."""
    lines = [f'{key} = "{value}"' for key, value in fields.items() if key != "parameters"]
    if "parameters" in fields:
        lines += ["", "[parameters]", *(f'{name} = "{value}"' for name, value in fields["parameters"].items())]
    return "\n".join(lines) + "\n"
