"""A result as one line of words and numbers: fields by name, statuses by theirs, without the types of numpy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from singimpact.status import Cause, Status

MOST_NUMBERS = 6
"""Numbers of an array that are shown; of a longer one its shape."""
KINDS: dict[str, type[Status] | type[Cause]] = {"status": Status, "cause": Cause}


def in_words(record: Any) -> str:
    """The line that a result prints: the `__repr__` of its class.

    Parameters
    ----------
    record : a dataclass or a named tuple. What is empty is left out, and so is the cause of what is decided.

    Examples
    --------
    >>> from collections import namedtuple
    >>> Hit = namedtuple("Hit", "tau v status notes")
    >>> print(in_words(Hit(np.float64(0.5), np.array([1.0, 2.5]), np.int8(0), None)))
    Hit(tau=0.5, v=[1.0, 2.5], status=hit)
    """
    names = getattr(record, "_fields", None)
    if names is None:
        names = [name for name, field in record.__dataclass_fields__.items() if field.repr]
    shown = {name: value_in_words(getattr(record, name), KINDS.get(name)) for name in names}
    if not np.any(getattr(record, "cause", 0)):
        shown.pop("cause", None)
    return f"{type(record).__name__}({', '.join(f'{name}={text}' for name, text in shown.items() if text)})"


def value_in_words(value: Any, kind: type[Status] | type[Cause] | None = None) -> str:
    """One value without the type that holds it; "" of nothing.

    Parameters
    ----------
    kind : of a status or a cause, whose numbers are shown as names.

    Examples
    --------
    >>> value_in_words(np.float64(0.1)), value_in_words(np.zeros((2, 40))), value_in_words({})
    ('0.1', 'array of shape (2, 40)', '')
    >>> value_in_words(np.array([0, 0, 3], dtype=np.int8), Status)
    '2 hit, 1 no_return'
    """
    if value is None or (isinstance(value, Mapping | tuple | list) and not value):
        return ""
    if kind is not None:
        if not np.ndim(value):
            return kind(int(value)).name
        pairs = zip(*np.unique(np.asarray(value), return_counts=True), strict=True)
        return ", ".join(f"{count} {kind(int(code)).name}" for code, count in pairs)
    if isinstance(value, np.ndarray) and value.shape:
        return str(value.tolist()) if value.size <= MOST_NUMBERS else f"array of shape {value.shape}"
    if isinstance(value, np.generic | np.ndarray):
        value = value.item()
    return repr(value) if isinstance(value, str) else str(value)
