"""Waiting, in a new cache folder, until flights are no longer interpreted.

What the wait costs a user is timed by `bench start`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import lru_cache

from singimpact.bench.drawn import Draws, States

TRIED = 64  # states, or impacts, of a try
INTERPRETED = 20e-6  # CPU seconds of one: 50 us and more when it is interpreted, 0.5 to 5 us when it is compiled
PAUSE = 0.3  # seconds between two tries, in which the process that compiles has the machine


def _map(states: States) -> None:
    states.osc.impact_map(states.tau, states.v)


def _orbit(states: States) -> None:
    states.osc.orbit(float(states.tau[0]), float(states.v[0]), TRIED)


def _iterate(states: States) -> None:
    states.osc.iterate(states.tau, states.v, 1)


WORKS: dict[str, Callable[[States], None]] = {"map": _map, "orbit": _orbit, "iterate": _iterate}


def compiled(works: Sequence[str], wait: float) -> list[str]:
    """Notes about work, keys of `WORKS`, that is still interpreted so many seconds after a first wait."""
    return [note for family in ("linear", "duffing") for work in works for note in _waited(family, work, wait)]


@lru_cache(maxsize=1)
def _begun() -> float:
    return time.monotonic()


@lru_cache(maxsize=16)
def _waited(family: str, work: str, wait: float) -> tuple[str, ...]:
    draw, begun = Draws(family, "generic", TRIED, 0.9), _begun()
    WORKS[work](draw())  # loads modules, and lays out tables
    while True:
        states = draw()
        start = time.thread_time()
        WORKS[work](states)
        if time.thread_time() - start < INTERPRETED * TRIED:
            return ()
        if time.monotonic() - begun > wait:
            return (f"{family}, {work}: still interpreted {wait:g} s after compiling began.",)
        time.sleep(PAUSE)
