"""Orbits: impact after impact, rest on the obstacle and complete chatter in between."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.dynamics.chatter import ENDING, summed
from singimpact.dynamics.release import release
from singimpact.flights.impact_map import impact_map
from singimpact.flights.orbits import orbit_segment
from singimpact.flights.states import States
from singimpact.inputs import InputError, whole
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

EPSILON = 2.0**-52
Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class OrbitSettings:
    """How an orbit is flown."""

    # impacts of one call into compiled code
    block: int = 4096
    # impacts flown at most before the sum of a short chatter is tried again
    more: int = 64


SETTINGS = OrbitSettings()


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
    run = _Run(osc, states, horizon)
    most = whole("impacts", impacts, 0, 10**7)
    while run.flown < most and not run.over:
        run.advance(most - run.flown)
    times, velocities = np.concatenate(run.times), np.concatenate(run.velocities)
    return Orbit(osc, times, velocities, np.concatenate(run.kinds), run.phases)


class _Run:
    """An orbit that is being flown: its events in blocks, its phases."""

    def __init__(self, osc: Oscillator, states: States, horizon: Any) -> None:
        self.osc, self.horizon, self.given = osc, horizon, states.given(0)
        self.tau, self.v = float(states.tau[0]), float(states.v[0])
        self.begun, self.flown, self.over = self.tau, 0, False
        self.times, self.velocities = [np.array([self.tau])], [np.array([self.v])]
        self.kinds: list[Array] = [np.array(["start"], dtype="U8")]
        self.phases: list[tuple[str, float, float]] = []
        # whether the chatter left is short, and how many impacts are flown before its sum is tried again
        self.short, self.more = False, 1

    def advance(self, most: int) -> None:
        """At least one flight, or the end of a chatter."""
        if self.v > 0 and self.horizon is None:
            if self.short and self._summed():
                return
            count = min(most, self.more if self.short else SETTINGS.block)
            found = orbit_segment(self.osc, self.tau, self.v, count, 0.0 if self.short else ENDING.near)
            self._impacts(found.tau, found.v)
            self.more = min(2 * self.more, SETTINGS.more) if self.short else self.more
            self.short = found.short
            if not found.status:
                return
            if self.flown == most:
                return
        self._mapped()

    def _impacts(self, times: Array, velocities: Array) -> None:
        starts = [self.tau, *times.tolist()]
        self.phases += [("flight", begin, end) for begin, end in pairwise(starts)]
        if times.size:
            self._event(times, velocities, "impact")
            self.flown += times.size

    def _event(self, times: Array, velocities: Array, kind: str) -> None:
        self.times.append(times)
        self.velocities.append(velocities)
        self.kinds.append(np.full(times.size, kind, dtype="U8"))
        self.tau, self.v = float(times[-1]), float(velocities[-1])

    def _go(self, phase: str, tau: float, v: float, kind: str) -> None:
        self.phases.append((phase, self.tau, tau))
        self._event(np.array([tau]), np.array([v]), kind)

    def _end(self, phase: str, tau: float) -> None:
        self.phases.append((phase, self.tau, tau))
        self.over = True

    def _summed(self) -> bool:
        """Whether the chatter left is summed up, which counts as one flight."""
        left = summed(self.osc, self.tau, self.v, EPSILON * max(abs(self.tau), self.tau - self.begun))
        if left is None:
            return False
        self._go("chatter", self.tau + left, 0.0, "complete")
        self.flown, self.short, self.more = self.flown + 1, False, 1
        self._rest()
        return True

    def _mapped(self) -> None:
        """One flight by the impact map, which says what became of it."""
        given = self.given if len(self.times) == 1 else (self.tau, self.v)
        step = impact_map(self.osc, *given, horizon=self.horizon)
        self.flown, self.short = self.flown + 1, False
        match step.status:
            case Status.hit | Status.graze:
                kind = Status(int(step.status)).name.replace("hit", "impact")
                self._go("flight", float(step.tau), float(step.v), kind)
            case Status.sticks:
                self._rest()
            case Status.no_return | Status.escaped:
                self._end("no_return", np.inf)
            case _:
                self._end("unresolved", np.nan)

    def _rest(self) -> None:
        lifted = release(self.osc, self.tau)
        if np.isfinite(lifted):
            self._go("sticking", lifted, 0.0, "release")
        else:
            self._end("sticking" if np.isinf(lifted) else "unresolved", lifted)
