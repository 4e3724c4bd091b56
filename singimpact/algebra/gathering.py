"""The open collection of certificates, which a derivation hands its own to, also when its value comes from a cache.

Nothing here makes a certificate (`certificates`, `derivations`), and nothing in this room checks one: the claims hand
what was gathered to the second program, which shares no code with the makers.
"""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")
Certificate = dict[str, Any]
_OPEN: ContextVar[list[Certificate] | None] = ContextVar("certificates", default=None)


@contextmanager
def collected() -> Iterator[list[Certificate]]:
    """A list that gathers every certificate left while it is open, each once; none of them is checked yet."""
    found: list[Certificate] = []
    token = _OPEN.set(found)
    try:
        yield found
    finally:
        _OPEN.reset(token)


def gathering() -> bool:
    """Whether a collection is open: without one a derivation need not make its certificate."""
    return _OPEN.get() is not None


def left_behind(certificate: Certificate) -> None:
    """A certificate joins the open collection, unchecked."""
    collection = _OPEN.get()
    if collection is not None and certificate not in collection:
        collection.append(certificate)


class Remembered:
    """The results of a derivation, each with the certificates that were left while it ran.

    A result found while no collection was open has none; it is derived again when one is.
    """

    def __init__(self) -> None:
        self._results: dict[Hashable, tuple[Any, tuple[Certificate, ...] | None]] = {}

    def clear(self) -> None:
        """Forget all results."""
        self._results.clear()

    def result(self, key: Hashable, derive: Callable[[], R]) -> R:
        """The result for a key, derived when it is not known; its certificates join the open collection."""
        stored = self._results.get(key)
        if stored is None or (gathering() and stored[1] is None):
            if gathering():
                with collected() as proofs:
                    value = derive()
                stored = value, tuple(proofs)
            else:
                stored = derive(), None
            self._results[key] = stored
        collection = _OPEN.get()
        if collection is not None:  # certificates that were left before join it, each once
            collection += [proof for proof in stored[1] or () if proof not in collection]
        return stored[0]


def remembered(function: Callable[P, R]) -> Callable[P, R]:
    """A derivation whose results are kept, and leave their certificates each time that they are used.

    Examples
    --------
    >>> form = {"kind": "definite", "variables": ["x", "y"], "form": ["1", "0", "1"], "sign": 1}
    >>> derive = remembered(lambda: left_behind(form))
    >>> derive()
    >>> for _ in range(2):
    ...     with collected() as found:
    ...         derive()
    ...     print(len(found))
    1
    1
    """
    results = Remembered()

    @wraps(function)
    def derive(*args: P.args, **kwargs: P.kwargs) -> R:
        return results.result((args, tuple(sorted(kwargs.items()))), lambda: function(*args, **kwargs))

    return derive
