"""One-line refusals: every bad input ends in a sentence that names it, its value and what would be accepted."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from numbers import Integral

LONGEST = 1500  # characters of a refusal


class InputError(ValueError):
    """The caller's mistake, told in one line, whatever was put into it.

    Examples
    --------
    >>> len(str(InputError("1" * 5000 + " is not accepted")))
    1500
    """

    def __init__(self, sentence: str) -> None:
        text = " ".join(sentence.split())
        super().__init__(text if len(text) <= LONGEST else text[: LONGEST - 3] + "...")


class Unfinished(RuntimeError):
    """Work that ended too early through no mistake in what was given, told in one line."""


def refuse(name: str, value: object, accepted: str) -> InputError:
    """The error for an input that cannot be used; the caller raises it.

    Examples
    --------
    >>> print(refuse("restitution", 1.5, "a number in (0, 1]"))
    restitution = 1.5 is not accepted: give a number in (0, 1]
    """
    return InputError(f"{name} = {shown(value)} is not accepted: give {accepted}")


def whole(name: str, value: object, least: int, most: int) -> int:
    """A whole number from least to most, or a refusal.

    Examples
    --------
    >>> whole("impacts", 3, 1, 10)
    3
    """
    if isinstance(value, bool) or not isinstance(value, Integral) or not least <= int(value) <= most:
        raise refuse(name, value, f"a whole number from {least} to {most}")
    return int(value)


def shown(value: object, limit: int = 60) -> str:
    """A value as one short line, whatever its size."""
    text = value[: limit + 1] if isinstance(value, str) else _plain(value)
    text = repr(text) if isinstance(value, str) else text
    text = " ".join(text.split())
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _plain(value: object) -> str:
    size = getattr(value, "size", None)
    if isinstance(size, int) and size > 8:
        return f"an array of shape {getattr(value, 'shape', '?')}"
    return str(value)


def nearest(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """The known names that look most like the one given.

    Examples
    --------
    >>> nearest("clearence", ["clearance", "restitution"])
    ['clearance']
    """
    return difflib.get_close_matches(name[:200], list(known), n=count, cutoff=0.4)


def unknown(kind: str, name: str, known: Iterable[str]) -> InputError:
    """The error for a name that does not exist, with the nearest names that do."""
    names = list(known)
    near = nearest(name, names) or sorted(names)[:8]
    return InputError(f"unknown {kind} {shown(name)}: the nearest known are {', '.join(near) or 'none'}")
