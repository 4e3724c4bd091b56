"""`bench grid`: a grid of orbits, in lanes, beside a terminal event an impact; time of one impact."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.bench.peers import taylor_events
from singimpact.bench.problems import Problem
from singimpact.flights.orbits import iterate
from singimpact.impact_oscillator import linear

START = Problem("linear", "generic", 2.8, 0.0, 0.8, 0.0, 0.0, "0", "0")
FEW, FEW_IMPACTS = 100, 30  # of the peer
FEW_MAPS = 10  # of the public map, which also says how each flight ends


def cases(effort: Effort) -> Iterator[Case]:
    """x'' + x = cos 2.8 t, c = 0, r = 0.8, v from 0.05 to 2."""
    side, impacts = (64, 50) if effort.quick else (300, 200)
    osc = linear("2.8", 0, "0.8")
    tau, v = (part.ravel() for part in np.meshgrid(np.linspace(0, 2.2, side), np.linspace(0.05, 2, side)))
    chosen = np.linspace(0, tau.size - 1, FEW).astype(int)
    own = [
        Method("kernel, lanes", f"{tau.size} states, {impacts} impacts", lambda: [iterate(osc, tau, v, impacts)],
               problems=tau.size * impacts),
        Method("singimpact, an array", f"{tau.size} states, {FEW_MAPS} impacts", lambda: _mapped(osc, tau, v),
               problems=tau.size * FEW_MAPS),
    ]  # fmt: skip

    def peer() -> list[Method]:
        fly = taylor_events.stepper("linear")
        return [Method("heyoka", f"{FEW} states, {FEW_IMPACTS} impacts", lambda: _flown(fly, tau[chosen], v[chosen]),
                       problems=FEW * FEW_IMPACTS)]  # fmt: skip

    methods, skipped = with_peers(own, peer)
    yield Case(f"linear, {side} x {side} states", methods, skipped=skipped)


def _mapped(osc: Any, tau: Any, v: Any) -> list[None]:
    """The public map, again and again; orbits that ended stay where they are."""
    for _ in range(FEW_MAPS):
        step = osc.impact_map(tau, v)
        tau, v = np.where(np.isfinite(step.tau), step.tau, tau), np.where(np.isfinite(step.v), step.v, v)
    return [None]


def _flown(fly: Callable[[Problem], tuple[float, float]], tau: Any, v: Any) -> list[None]:
    for start, speed in zip(tau.tolist(), v.tolist(), strict=True):
        for _ in range(FEW_IMPACTS):
            time, velocity = fly(replace(START, tau=start, v=max(speed, 1e-3)))
            if not time < taylor_events.LONGEST:  # it went through the wall
                break
            start, speed = (start + time) % (2 * np.pi / 2.8), 0.8 * abs(velocity)
    return [None]
