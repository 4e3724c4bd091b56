"""Orbits: impact after impact, rest on the obstacle and complete chatter in between."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from singimpact.dynamics.chatter import summed
from singimpact.dynamics.rest import release
from singimpact.flights.impact_map import impact_map
from singimpact.flights.states import States
from singimpact.inputs import InputError, whole
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

EPSILON = 2.0**-52


@dataclass(frozen=True, eq=False)
class Orbit:
    """The states of an orbit just after its events.

    Parameters
    ----------
    oscillator : the model.
    tau, v : time of every event and velocity just after it; the first entry is the given state.
    kind : of every event: `start`, `impact`, `graze`, `complete` (infinitely many impacts end there: the time is a sum
        of what was too short to fly), `release` (the mass at rest lifts off).
    phases : (kind, tau_start, tau_end), in order: `flight`, `chatter` (summed up), `sticking`; the last one may be
        `no_return`, `sticking` (tau_end inf) or `unresolved` (tau_end nan).
    """

    oscillator: Oscillator
    tau: np.ndarray[Any, Any]
    v: np.ndarray[Any, Any]
    kind: np.ndarray[Any, Any]
    phases: list[tuple[str, float, float]]


@dataclass
class _Record:
    events: list[tuple[float, float, str]]
    phases: list[tuple[str, float, float]] = field(default_factory=list)

    def go(self, phase: str, tau: float, v: float, kind: str) -> None:
        self.phases.append((phase, self.events[-1][0], tau))
        self.events.append((tau, v, kind))

    def end(self, phase: str, tau: float) -> None:
        self.phases.append((phase, self.events[-1][0], tau))


def orbit(osc: Oscillator, tau: Any, v: Any, impacts: int = 200, *, horizon: Any = None) -> Orbit:
    """The orbit of a state through at most `impacts` flights.

    Parameters
    ----------
    osc : the model. tau, v : the state, v >= 0.
    impacts : how many flights are flown; chatter that is summed up costs none.
    horizon : flight time at which a flight is given up; None for the package default.

    Returns
    -------
    Orbit : it is shorter when the mass does not return, rests for ever, or meets a graze that doubles cannot decide.

    Examples
    --------
    >>> found = orbit(Oscillator("0", "-2", 0, "1/2"), 0, 1)
    >>> found.kind.tolist(), found.tau.tolist(), found.phases[-1]
    (['start', 'complete'], [0.0, 2.0], ('sticking', 2.0, inf))
    """
    states = States.read(tau, v)
    if states.shape:
        raise InputError(f"tau and v have shape {states.shape}: an orbit starts from one state, give two numbers")
    record = _Record([(float(states.tau[0]), float(states.v[0]), "start")])
    given: tuple[Any, Any] | None = (tau, v)
    for _ in range(whole("impacts", impacts, 0, 10**7)):
        if not _advance(osc, record, given, horizon):
            break
        given = None
    times, velocities, kinds = zip(*record.events, strict=True)
    return Orbit(osc, np.array(times), np.array(velocities), np.array(kinds), record.phases)


def _advance(osc: Oscillator, record: _Record, given: tuple[Any, Any] | None, horizon: Any) -> bool:
    """One flight with the rest or the end of chatter before it; False: the orbit ends here."""
    tau, v, _ = record.events[-1]
    if v > 0:
        begun = record.events[0][0]
        left = summed(osc, tau, v, EPSILON * max(abs(tau), tau - begun))
        if left is not None:
            record.go("chatter", tau + left, 0.0, "complete")
            return _rested(osc, record)
    step = impact_map(osc, *(given or (tau, v)), horizon=horizon)
    match step.status:
        case Status.hit | Status.graze:
            record.go("flight", float(step.tau), float(step.v), Status(int(step.status)).name.replace("hit", "impact"))
            return True
        case Status.sticks:
            return _rested(osc, record)
        case Status.no_return | Status.escaped:
            record.end("no_return", np.inf)
        case _:
            record.end("unresolved", np.nan)
    return False


def _rested(osc: Oscillator, record: _Record) -> bool:
    tau = record.events[-1][0]
    lifted = release(osc, tau)
    if not np.isfinite(lifted):
        record.end("sticking" if np.isinf(lifted) else "unresolved", lifted)
        return False
    record.go("sticking", lifted, 0.0, "release")
    return True
