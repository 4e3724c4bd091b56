"""Orbits and chatter limits of one model: each state of an orbit satisfies the impact map again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import compare
from singimpact.bench.selftest.draws import Flown
from singimpact.bench.selftest.rows import Row, Tally
from singimpact.status import Status

EPSILON = 2.0**-52
Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class OrbitSettings:
    """How many orbits and chatter sequences.

    Parameters
    ----------
    orbits, impacts : orbits that are flown, and impacts of each.
    limits, most : chatter sequences, and impacts flown of each at most: r = 0.99 takes 2000.
    slow : velocities of chatter are below this part of the largest one drawn.
    least : a difference of so many epsilon of tau and v is a rounding.
    """

    orbits: int = 6
    impacts: int = 40
    limits: int = 20
    most: int = 3000
    slow: float = 0.03
    least: float = 4.0


ORBITS = OrbitSettings()


def orbits(flown: Flown) -> Row:
    """Flights of `osc.orbit` against `osc.impact_map` from the state where each begins."""
    tally = Tally("orbits against the impact map")
    for at in np.argsort(-flown.v, kind="stable")[:: max(flown.v.size // ORBITS.orbits, 1)][: ORBITS.orbits].tolist():
        if tally.late:
            break
        orbit = flown.osc.orbit(flown.tau[at], flown.v[at], ORBITS.impacts)
        # an impact is flown from the event before it, unless chatter was summed up in between
        ends = np.flatnonzero((orbit.kind[1:] == "impact") | (orbit.kind[1:] == "graze")) + 1
        if ends.size:
            _satisfied(flown, at, (orbit.tau, orbit.v), ends, tally)
    found = tally.row()
    return found if found.tried else Row(tally.compared, note="no orbit that was flown has an impact")


def _satisfied(flown: Flown, at: int, events: tuple[Array, Array], ends: Array, tally: Tally) -> None:
    tau, v = events
    step = flown.osc.impact_map(tau[ends - 1], v[ends - 1])
    least = ORBITS.least * EPSILON
    for place, index in enumerate(ends.tolist()):
        call = f"{flown.call(at, 'orbit').split(', horizon')[0]}), event {index}: "
        if step.status[place] == Status.unresolved:
            tally.leave("unresolved")
            continue
        # two flights of one state may round differently: twice the errors of one
        late = 2 * step.time_error[place] * step.flight_time[place] + least * (
            abs(tau[index]) + step.flight_time[place]
        )
        fast = (2 * step.velocity_error[place] + least) * v[index]
        # the orbit continues from a time in two doubles; the event stores one double of it
        rounded = EPSILON * abs(tau[index - 1]) * np.nan_to_num(step.condition[place], posinf=0.0)
        late += rounded
        turn = np.nan_to_num(step.velocity_condition[place], posinf=0.0) / max(step.flight_time[place], 1e-300)
        fast += EPSILON * abs(tau[index - 1]) * turn * v[index]
        if step.status[place] == Status.graze:
            late, fast = np.nan_to_num(late) + least * abs(tau[index]), least
        ratios = (abs(step.tau[place] - tau[index]) / late, abs(step.v[place] - v[index]) / (fast or least))
        numbers = [float(part) for part in (tau[index], v[index], step.tau[place], step.v[place])]
        told = "tau {!r}, v {!r}; the map gives {!r}, {!r}".format(*numbers)
        tally.judge(float(np.max(ratios)), call + told)


def limits(flown: Flown) -> Row:
    """Chatter limits of a state and of its image agree within their errors."""
    tally = Tally("chatter limits of images")
    name = tally.compared
    if compare(flown.osc.slope_at_rest(), 1) == 0:
        return Row(name, note="does not apply: with restitution 1 impacts do not accumulate")
    pressed = flown.osc.acceleration(flown.tau) < 0
    slow = (flown.v < ORBITS.slow * flown.scales.fast) & (flown.step.status == Status.hit)
    places = np.flatnonzero(pressed & slow)[: ORBITS.limits].tolist()
    for done, at in enumerate(places):
        if tally.late:
            tally.leave("CPU time used up", len(places) - done)
            break
        _limit(flown, at, tally)
    return tally.row() if places else Row(name, note="does not apply: no slow state that was drawn is pressed")


def _limit(flown: Flown, at: int, tally: Tally) -> None:
    osc, step = flown.osc, flown.step
    here = osc.chatter_limit(flown.tau[at], flown.v[at], impacts=ORBITS.most)
    there = osc.chatter_limit(step.tau[at], step.v[at], impacts=ORBITS.most)
    statuses = [Status(int(each.status)) for each in (here, there)]
    told = (
        flown.call(at, "chatter_limit").split(", horizon")[0]
        + "), then of its image: "
        + ", ".join(
            f"{float(each.tau)!r} with error {each.error:.2g}, {status.name}"
            for each, status in zip((here, there), statuses, strict=True)
        )
    )
    if Status.unresolved in statuses:
        tally.leave("impacts do not accumulate within the number flown")
    elif statuses[0] != statuses[1]:
        tally.judge(np.inf, told)
    elif statuses[0] == Status.lifts_off and here.impacts <= 1:
        tally.leave("contact is lost at the first impact")
    elif statuses[0] not in (Status.complete, Status.lifts_off):
        tally.leave(statuses[0].name)
    else:
        tally.judge(float(abs(here.tau - there.tau) / (here.error + there.error)), told)
