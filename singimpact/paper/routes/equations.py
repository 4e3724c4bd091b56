"""Equations that remember what they were derived from.

A function marked `@equation(label)` derives one displayed equation of the theory.  Its result is computed once, and
every marked function that it called is remembered: `derived_from` answers from what ran, not from a list.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

_open: ContextVar[set[str] | None] = ContextVar("_open", default=None)
_used: dict[str, frozenset[str]] = {}


def equation(label: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Mark a function as the derivation of the equation `label`."""

    def mark(function: Callable[P, R]) -> Callable[P, R]:
        results: dict[Any, tuple[R, frozenset[str]]] = {}

        @wraps(function)
        def derive(*args: P.args, **kwargs: P.kwargs) -> R:
            key = (args, tuple(sorted(kwargs.items())))
            if key not in results:
                used: set[str] = set()
                token = _open.set(used)
                try:
                    value = function(*args, **kwargs)
                finally:
                    _open.reset(token)
                results[key] = (value, frozenset(used))
                _used[label] = _used.get(label, frozenset()) | used
            outer = _open.get()
            if outer is not None:
                outer.add(label)
            return results[key][0]

        derive.label = label  # type: ignore[attr-defined]
        return derive

    return mark


def derived_from(label: str) -> frozenset[str]:
    """Labels of the equations that the derivation of `label` called directly, once it has run."""
    return _used.get(label, frozenset())


def watched(function: Callable[[], R]) -> tuple[R, frozenset[str]]:
    """The value of a call and the labels of the equations it used directly.

    Examples
    --------
    >>> one = equation("e:one")(lambda: 1)
    >>> watched(lambda: one() + 1) == (2, frozenset({"e:one"}))
    True
    """
    used: set[str] = set()
    token = _open.set(used)
    try:
        value = function()
    finally:
        _open.reset(token)
    return value, frozenset(used)
