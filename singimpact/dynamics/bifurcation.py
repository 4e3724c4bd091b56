"""Where orbits settle as a number of the model moves: the last impacts of one long orbit for each value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.case_pools import ThreadPool
from singimpact.cases import sweep
from singimpact.dynamics.orbit import orbit
from singimpact.inputs import refuse, unknown
from singimpact.oscillator.model import Oscillator
from singimpact.store import write_table
from singimpact.surface.curve import window_ends

Array = np.ndarray[Any, Any]
FEW = 200_000
"""Impacts in all, below which no processes are started: about five seconds."""


@dataclass(frozen=True)
class Bifurcation:
    """Events of settled orbits.

    Attributes
    ----------
    over : the number that moves. values : of it. events : shape (values, kept, 3): phase, v, 1 where chatter ended; nan
        where an orbit had fewer.
    """

    over: str
    values: Array
    events: Array

    def __repr__(self) -> str:
        count, kept = self.events.shape[:2]
        low, high = self.values[[0, -1]].tolist()
        return f"Bifurcation(over {self.over}: {count} values from {low:.6g} to {high:.6g}, {kept} events of each)"

    def to_csv(self, path: Any) -> None:
        """Write value, phase, v and whether chatter ended there, a line an event."""
        phase, v, ended = self.events.reshape(-1, 3).T
        there = np.isfinite(phase)
        values = np.repeat(self.values, self.events.shape[1])[there]
        write_table(path, {self.over: values.tolist(), "phase": phase[there].tolist(), "v": v[there].tolist(),
                           "chatter_ended": ended[there].astype(int).tolist()})  # fmt: skip


def bifurcation(
    model: Oscillator, over: str, between: Any, points: int = 300, start: Any = (0, "0.1"), impacts: int = 200,
    kept: int = 60, **sweeping: Any,
) -> Bifurcation:  # fmt: skip
    """The last events of an orbit for evenly spaced values of a number of the model.

    Parameters
    ----------
    over : clearance, restitution or a parameter. between : its ends. points : values. start : the state (tau, v).
    impacts : flown for each value. kept : events of the end that are shown. sweeping : `executor` and `output` of
        `sweep`; without an executor a few values are flown here, which takes less time than to start processes.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     model = Oscillator("x", "cos(2*t)", 0, "1/2")
    ...     found = bifurcation(model, "clearance", ("0.2", "0.3"), 2, impacts=60, kept=4, executor=pool)
    >>> found.events.shape, bool(abs(found.events[0, 0] - found.events[0, 3]).max() < 1e-6)
    ((2, 4, 3), True)
    """
    if not isinstance(model, Oscillator):
        raise refuse("model", model, "an ImpactOscillator")
    if over not in ("clearance", "restitution", *model.parameters):
        raise unknown("number of the model", str(over), ["clearance", "restitution", *model.parameters])
    if model.period is None:
        raise refuse("model", model, "one with a period: phases are shown")
    for name, value, least in (("points", points, 2), ("impacts", impacts, 1), ("kept", kept, 1)):
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise refuse(name, value, f"a whole number from {least}")
    low, high = window_ends(over, between)
    values = np.linspace(low, high, points)
    ask = partial(settled, dict(model.to_dict()), over, tuple(map(str, start)), impacts, kept)
    few = sweeping.get("executor") is None and points * impacts <= FEW
    with ThreadPool(1) if few else nullcontext(sweeping.get("executor")) as pool:
        events = sweep(ask, values.tolist(), **(sweeping | {"executor": pool}))
    return Bifurcation(over, values, np.array(events))


def settled(
    fields: Mapping[str, Any], over: str, start: tuple[str, ...], impacts: int, kept: int, value: float
) -> Array:
    """The last events of one orbit; a function of this module, so that another process can be sent it."""
    model = Oscillator(**fields).replace(**{over: value})
    assert model.period is not None
    flown = list(_events(model, start[0], start[1], impacts))
    last = flown[max(impacts - kept, 0) :][-kept:] or flown[-1:]  # one that has come to rest for ever shows only that
    events = np.array(last).reshape(-1, 3)
    events[:, 0] = np.mod(events[:, 0], as_float(model.period))
    return np.vstack([events, np.full((kept - len(events), 3), np.nan)])


def _events(model: Oscillator, tau: Any, v: Any, impacts: int) -> Iterator[tuple[float, float, float]]:
    """Impacts, grazes and ends of chatter (1 in the last column) of an orbit."""
    found = orbit(model, tau, v, impacts)
    shown = np.isin(found.kind, ("impact", "graze", "complete"))
    yield from zip(found.tau[shown], found.v[shown], 1.0 * (found.kind[shown] == "complete"), strict=True)
