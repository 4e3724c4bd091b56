"""The number of flights of a piece of work, which a picture reports and tests hold."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass


@dataclass
class Count:
    """Flights computed since counting began."""

    flights: int = 0


_OPEN: ContextVar[tuple[Count, ...]] = ContextVar("open counts", default=())


@contextmanager
def counted() -> Iterator[Count]:
    """Counts the flights of a block; blocks may stand inside one another.

    Examples
    --------
    >>> from singimpact.flights.impact_map import impact_map
    >>> from singimpact.oscillator.model import Oscillator
    >>> with counted() as count:
    ...     _ = impact_map(Oscillator("0", "-2", 0, 1), [0, 1], 1)
    >>> count.flights
    2
    """
    count = Count()
    token = _OPEN.set((*_OPEN.get(), count))
    try:
        yield count
    finally:
        _OPEN.reset(token)


def add(flights: int) -> None:
    """Flights that were computed just now."""
    for count in _OPEN.get():
        count.flights += flights
