"""Equations that remember what they were derived from.

A function marked `@equation(label)` derives one displayed equation of the theory.  Its result is computed once, and
every marked function that it called is remembered: `derived_from` answers from what ran, not from a list.  So are the
certificates of its steps, which join the collection that is open each time that the result is used.
"""

from collections.abc import Callable
from contextvars import ContextVar
from functools import wraps
from typing import ParamSpec, TypeVar

from singimpact.algebra.gathering import Remembered

P = ParamSpec("P")
R = TypeVar("R")

_open: ContextVar[set[str] | None] = ContextVar("_open", default=None)
_used: dict[str, frozenset[str]] = {}


def equation(label: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Mark a function as the derivation of the equation `label`."""

    def mark(function: Callable[P, R]) -> Callable[P, R]:
        results = Remembered()

        @wraps(function)
        def derive(*args: P.args, **kwargs: P.kwargs) -> R:
            def derived() -> R:
                value, used = watched(lambda: function(*args, **kwargs))
                _used[label] = _used.get(label, frozenset()) | used
                return value

            value = results.result((args, tuple(sorted(kwargs.items()))), derived)
            outer = _open.get()
            if outer is not None:
                outer.add(label)
            return value

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
