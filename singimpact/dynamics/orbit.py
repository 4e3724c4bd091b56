"""Orbits: impact after impact, rest on the obstacle and complete chatter in between."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.dynamics.chatter import ENDING, chatter_left, impacts_until
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
    # two lift-offs are one when their phases differ by at most this, relative: both are doubles next to one zero of a_c
    same: float = 4 * EPSILON


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
    impacts : how many flights are flown; a chatter that is summed up counts as one.
    horizon : flight time at which a flight is given up; None for the package default.

    Notes
    -----
    What follows a lift-off is fixed by its phase. When the mass lifts off at a phase again, the events since the first
    time are repeated, shifted by whole periods; they are not flown again.

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
    run = _Run(osc, states, horizon, whole("impacts", impacts, 0, 10**7))
    while run.flown < run.most and not run.over:
        run.advance()
    times, velocities = np.concatenate(run.times), np.concatenate(run.velocities)
    return Orbit(osc, times, velocities, np.concatenate(run.kinds), run.phases)


class _Run:
    """An orbit that is being flown: its events in blocks, its phases."""

    def __init__(self, osc: Oscillator, states: States, horizon: Any, most: int) -> None:
        self.osc, self.horizon, self.most, self.given = osc, horizon, most, states.given(0)
        self.tau, self.v = float(states.tau[0]), float(states.v[0])
        self.begun, self.flown, self.over = self.tau, 0, False
        self.times, self.velocities = [np.array([self.tau])], [np.array([self.v])]
        self.kinds: list[Array] = [np.array(["start"], dtype="U8")]
        self.phases: list[tuple[str, float, float]] = []
        # whether the chatter left is short, and how many impacts are flown before it can be summed up
        self.short, self.more = False, 0
        # time of every lift-off, and how many blocks of events there were
        self.lifted: list[tuple[float, int]] = []

    def advance(self) -> None:
        """At least one flight, or the end of a chatter."""
        if self.v > 0 and self.horizon is None:
            if self.short and self._summed():
                return
            left = self.most - self.flown
            if self.short:
                found = orbit_segment(self.osc, self.tau, self.v, min(left, self.more))
            else:
                found = orbit_segment(self.osc, self.tau, self.v, min(left, SETTINGS.block), ENDING.near)
            self._impacts(found.tau, found.v)
            self.short = not found.status and (self.short or found.short)
            if not found.status or self.flown == self.most:
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
        left = chatter_left(self.osc, self.tau, self.v)
        if left is None:  # a_c presses no more
            self.short = False
            return False
        time, error = left
        resolution = EPSILON * max(abs(self.tau), self.tau - self.begun)
        if not error <= resolution:
            self.more = impacts_until(self.osc, error, resolution)
            return False
        self._go("chatter", self.tau + time, 0.0, "complete")
        self.flown, self.short = self.flown + 1, False
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
        if not np.isfinite(lifted):
            self._end("sticking" if np.isinf(lifted) else "unresolved", lifted)
            return
        self._go("sticking", lifted, 0.0, "release")
        period = 0.0 if self.osc.period is None else as_float(self.osc.period)
        for earlier, block in self.lifted if period else ():
            turns = np.rint((lifted - earlier) / period)
            if abs(lifted - earlier - turns * period) <= SETTINGS.same * max(abs(lifted), period):
                self._repeat(block, turns * period)
                return
        self.lifted.append((lifted, len(self.times)))

    def _repeat(self, block: int, time: float) -> None:
        """The events since a lift-off at this phase, again and again, until all flights asked for are there."""
        times, velocities, kinds = (np.concatenate(part[block:]) for part in (self.times, self.velocities, self.kinds))
        flights = np.count_nonzero(kinds != "release")
        left = self.most - self.flown
        again = -(-left // flights)
        shifts = time * np.arange(1, again + 1)
        counted = np.cumsum(np.tile(kinds != "release", again))
        kept = int(np.searchsorted(counted, left, side="right"))
        phases = ([kind for kind, *_ in self.phases[-times.size :]] * again)[:kept]
        ends = np.add.outer(shifts, times).ravel()[:kept]
        self.phases += zip(phases, [self.tau, *ends[:-1].tolist()], ends.tolist(), strict=True)
        self.times.append(ends)
        self.velocities.append(np.tile(velocities, again)[:kept])
        self.kinds.append(np.tile(kinds, again)[:kept])
        self.flown = self.most
