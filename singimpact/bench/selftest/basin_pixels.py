"""Pixels of basins of one model, followed impact by impact with `osc.impact_map`."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from math import ceil, log
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.bench.selftest.draws import Flown
from singimpact.bench.selftest.rows import Row, Tally
from singimpact.dynamics import basins
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.inputs import InputError
from singimpact.status import Status

Array = np.ndarray[Any, Any]
OTHER, CHATTER, PLACES = 0, 1, 1000
NAME = "pixels of basins"


@dataclass(frozen=True)
class PixelSettings:
    """How many pixels, and how they are followed.

    Parameters
    ----------
    size, followed : pixels a side of the basins, and how many of them are followed.
    transient, most : impacts flown before an orbit is looked at, beyond those that chatter takes, and of all.
    rest : an impact slower than this part of the fastest state, with a_c < 0, is handed to `chatter_limit`.
    periods : most impacts of a periodic orbit that is told apart, as many as `basins` tells.
    close : how near two states are that are the same, relative to the period and to the fastest state.
    moved : relative change of the state, far above the tolerance 1e-10 of the flights of `basins`: where it moves the
        orbit into another class, rounding explains the difference.
    """

    size: int = 8
    followed: int = 16
    transient: int = 120
    most: int = 300
    rest: float = 1e-7
    periods: int = 8
    close: float = 1e-4
    moved: float = 1e-8


PIXELS = PixelSettings()


def row(flown: Flown) -> Row:
    """The row of the table."""
    osc, fast = flown.osc, flown.scales.fast
    if flown.scales.period is None:
        return Row(NAME, note="does not apply: g has no period")
    tally = Tally(NAME)
    try:
        with ThreadPoolExecutor(1) as pool:
            found = basins.basins(osc, None, (0, fast), PIXELS.size, pool)
    except InputError as reason:
        return Row(NAME, note=f"does not apply: {reason}")
    tally.restart()
    tau, v = (part.ravel() for part in np.meshgrid(found.tau, found.v))
    places = np.unique(np.linspace(0, tau.size - 1, PIXELS.followed).astype(int))
    tau, v, codes = tau[places], v[places], _seen_first(found).ravel()[places]
    classes = followed(osc, tau, v, fast, tally)
    for index, (code, seen) in enumerate(zip(codes.tolist(), classes.tolist(), strict=True)):
        told = f"basins from tau {float(tau[index])!r}, v {float(v[index])!r}: {_name(code)}"
        told += f", followed {_name(seen)}"
        if code == seen == OTHER:
            tally.leave("settles on no orbit of few impacts")
        elif code == seen:
            tally.judge(0.0, told)
        elif OTHER in (code, seen) or _multiple(code, seen):
            tally.leave("settles slowly")
        elif _moves(osc, (tau[index], v[index]), fast, code, tally):
            tally.leave("rounding moves it to another class")
        else:
            tally.judge(np.inf, told)
    return tally.row()


def _seen_first(found: basins.Basins) -> Array:
    """For every pixel, what the orbit does first: its first chatter completes, or it settles on an orbit."""
    orbits = [each.n * PLACES + each.k if each.kind == "orbit" else OTHER for each in found.attractors]
    return np.where(found.first_chatter_completes, CHATTER, np.array(orbits, dtype=int)[found.codes])


def _name(code: int) -> str:
    return {OTHER: "none", CHATTER: "chatter"}.get(code, f"({code // PLACES}, {code % PLACES}) orbit")


def _multiple(code: int, seen: int) -> bool:
    """Whether one periodic orbit is the other one several times over: next to a period doubling they look alike."""
    one, other = sorted((code, seen))
    return one >= PLACES and other % one == 0


def _moves(osc: ImpactOscillator, state: tuple[float, float], fast: float, code: int, tally: Tally) -> bool:
    """Whether a tiny change of a state moves its orbit to the class of `basins`."""
    sides = PIXELS.moved * np.array([-1.0, -0.3, 0.3, 1.0])
    tau, v = np.repeat(state[0] + sides, 4), np.tile(state[1] * (1 + sides), 4)
    classes = followed(osc, tau, v, fast, tally)
    return bool(np.any((classes == code) | (classes == OTHER)))


def followed(osc: ImpactOscillator, tau: Array, v: Array, fast: float, tally: Tally) -> Array:
    """The first behaviour of orbits: 1 for a chatter that completes, 1000 n + k for an orbit, 0 for neither."""
    r = as_float(osc.slope_at_rest())
    impacts = min(PIXELS.transient + (ceil(log(PIXELS.rest) / log(r)) if r < 1 else 0), PIXELS.most)
    codes, open_ = np.full(tau.size, OTHER), np.arange(tau.size)
    kept = np.full((PIXELS.periods + 1, 2, tau.size), np.nan)
    kept[-1] = tau, v
    for _ in range(impacts):
        if not open_.size or tally.late:
            break
        step = osc.impact_map(kept[-1, 0, open_], kept[-1, 1, open_])
        kept[:-1] = kept[1:]
        kept[-1][:, open_] = step.tau, step.v
        at_rest = (step.status == Status.sticks) | ((step.v < PIXELS.rest * fast) & (osc.acceleration(step.tau) < 0))
        for place in np.flatnonzero(at_rest).tolist():
            codes[open_[place]] = _chatter(osc, float(step.tau[place]), float(step.v[place]))
        # a rho that is steeper than -1 at high velocities can send an orbit out of the range of doubles
        open_ = open_[(step.status == Status.hit) & ~at_rest & np.isfinite(step.tau + step.v)]
    assert osc.period is not None
    for place in open_.tolist():
        codes[place] = _periodic(kept[:, :, place], as_float(osc.period), fast)
    return codes


def _chatter(osc: ImpactOscillator, tau: float, v: float) -> int:
    """Whether chatter that is nearly over is complete."""
    return CHATTER if v == 0 or osc.chatter_limit(tau, v).status == Status.complete else OTHER


def _periodic(kept: Array, period: float, fast: float) -> int:
    """The class of an orbit whose last impacts repeat; 0 where they do not."""
    (tau, v), before = kept[-1], kept[:-1]
    for n in range(1, PIXELS.periods + 1):
        passed = (tau - before[-n, 0]) / period
        k = round(passed) if np.isfinite(passed) else 0
        if k > 0 and abs(passed - k) < PIXELS.close and abs(v - before[-n, 1]) < PIXELS.close * fast:
            return n * PLACES + k
    return OTHER
