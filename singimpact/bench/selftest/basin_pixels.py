"""Pixels of basins of one model, each followed by itself with `bench.truth.plain_orbits`.

Truth: one orbit of fixed-step flights, chatter summed from such impacts, lift-offs by bisection of a_c. Shared with the
package: f, g, rho as expression trees, the period, and the horizon after which a flight counts as one without impact.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from singimpact.bench.selftest.draws import Flown
from singimpact.bench.selftest.fates import FOLLOWED, Fate, Follower
from singimpact.bench.selftest.rows import Row, Tally
from singimpact.dynamics import basins_of_attraction
from singimpact.flights.horizons import horizon_of
from singimpact.inputs import InputError

Array = np.ndarray[Any, Any]
NAME = "pixels of basins"
UNSETTLED = ("chaotic", "not decided")


@dataclass(frozen=True)
class PixelSettings:
    """The number of pixels, and the limit at which one is decided."""

    size: int = 8  # pixels a side
    followed: int = 16  # of them
    impacts: int = 3000  # of an orbit, in `basins` and here; the default of `basins` takes a minute here
    # relative changes of a state, far above the tolerance 1e-10 of the flights of `basins`: where one moves the orbit
    # into another class, rounding explains the difference
    moved: tuple[float, ...] = (-1e-8, -3e-9, 3e-9, 1e-8)
    transient: int = 200  # an orbit that settles sooner is no long transient, whatever its neighbours do
    same: float = 1e-3  # relative distance of states of one attractor
    longer: int = 20_000  # impacts of an orbit that has settled in `basins` and not here


PIXELS = PixelSettings()


def row(flown: Flown) -> Row:
    """The row of the table."""
    osc, fast = flown.osc, flown.scales.fast
    if flown.scales.period is None:
        return Row(NAME, note="does not apply: g has no period")
    tally = Tally(NAME)
    try:
        follower = Follower(flown.plain, fast, PIXELS.impacts, horizon_of(osc, None))
        with ThreadPoolExecutor(1) as pool:
            answer = basins_of_attraction.basins(osc, None, (0, fast), PIXELS.size, pool, None, PIXELS.impacts)
    except (InputError, TypeError) as reason:
        return Row(NAME, note=f"does not apply: {reason}")
    tally.restart()
    tau, v = (axis.ravel() for axis in np.meshgrid(answer.tau, answer.v))
    places = np.unique(np.linspace(0, tau.size - 1, PIXELS.followed).astype(int))
    first = answer.first_chatter_completes.ravel()
    for done, at in enumerate(places.tolist()):
        if tally.late:
            tally.leave("CPU time used up", places.size - done)
            break
        state = float(tau[at]), float(v[at])
        answered = answer.attractors[answer.codes.ravel()[at]]
        _pixel(follower, state, answered, bool(first[at]), tally)
    return tally.row()


def _pixel(
    follower: Follower, state: tuple[float, float], answer: basins_of_attraction.LongRun, first: bool, tally: Tally
) -> None:
    """Judge one pixel, or leave it with a cause."""
    call = f"basins from tau {state[0]!r}, v {state[1]!r}: {answer.name}, first chatter completes: {first}"
    if answer.kind == "unresolved":
        tally.leave("unresolved")
        return
    fate = follower.first(*state)
    if fate.kind == "unsettled" and answer.kind not in (*UNSETTLED, "sensitive"):
        fate = replace(follower, impacts=PIXELS.longer).first(*state)
    call += f"; followed: {fate.name} after {fate.impacts} impacts"
    if fate.kind == "undecided":
        tally.leave("steps do not settle")
    elif answer.kind == "sensitive":
        _sensitive(follower, state, fate, call, tally)
    elif answer.kind in UNSETTLED and not first and (open_ := _unsettled_beside(follower, state, fate)):
        _unsettled(follower, answer, open_, call, tally)
    elif _agrees(follower, answer, first, fate):
        tally.judge(0.0, call)
    elif cause := _explained(follower, state, answer, fate):
        tally.leave(cause)
    else:
        tally.judge(np.inf, call)


def _agrees(follower: Follower, answer: basins_of_attraction.LongRun, first: bool, fate: Fate) -> bool:
    """Whether the first chatter, and what comes of the orbit for ever, are those of `basins`."""
    if first != (fate.kind == "chatter"):
        return False
    last = follower.last(fate)
    if answer.kind == "orbit" and last.kind == "orbit":
        return (last.n, last.k) == (answer.n, answer.k) and _near(follower, answer, last)
    if answer.kind == "chatter":
        return last.kind == "chatter for ever" and last.k == answer.k
    if answer.kind in ("no impact", "never returns"):
        return last.kind == "no impact"
    if answer.kind in UNSETTLED:  # after a chatter
        return last.kind == "unsettled"
    return answer.kind == last.kind == "rest"


def _near(follower: Follower, answer: basins_of_attraction.LongRun, fate: Fate) -> bool:
    """Whether the last state is one of the attractor."""
    period = follower.plain.period
    assert period is not None
    away = (fate.tau - answer.tau) / period
    near = (np.abs(away - np.rint(away)) < PIXELS.same) & (np.abs(fate.v - answer.v) < PIXELS.same * follower.fast)
    return bool(near.any())


def _explained(follower: Follower, state: tuple[float, float], answer: basins_of_attraction.LongRun, fate: Fate) -> str:
    """Why a difference decides nothing; empty where nothing explains it."""
    last = follower.last(fate)
    if "undecided" in (last.kind, fate.kind):
        return "steps do not settle"
    if "orbit" == answer.kind == last.kind and last.n != answer.n and _near(follower, answer, last):
        few, many = sorted(((last.n, last.k), (int(answer.n), answer.k)))
        # an orbit that is another one several times over has equal states
        apart = np.abs(np.subtract.outer(answer.v, answer.v))[np.triu_indices(int(answer.n), 1)]
        doubled = answer.n < last.n or bool((apart > FOLLOWED.close * follower.fast).all())
        if many[0] * few[1] == few[0] * many[1] and doubled:
            return "settles slowly beside a period doubling"
    if last.kind == "unsettled":
        return "settles slowly"
    fates = [follower.first(state[0] + change, state[1] * (1 + change)) for change in PIXELS.moved]
    if any(follower.last(beside).name != last.name or beside.kind != fate.kind for beside in fates):
        return "rounding moves it to another class"
    return ""


def _unsettled_beside(follower: Follower, state: tuple[float, float], fate: Fate) -> Fate | None:
    """The fate of an orbit that does not settle, or of such a neighbour: rounding decides how long a transient is."""
    if fate.kind == "unsettled" or fate.impacts < PIXELS.transient:
        return fate if fate.kind == "unsettled" else None
    fates = (follower.first(state[0] + part, state[1] * (1 + part)) for part in PIXELS.moved)
    return next((beside for beside in fates if beside.kind == "unsettled"), None)


def _unsettled(follower: Follower, answer: basins_of_attraction.LongRun, fate: Fate, call: str, tally: Tally) -> None:
    """No period here either; "chaotic" says that neighbours separate too."""
    if answer.kind == "not decided" or follower.separates((fate.tau, fate.v), FOLLOWED.chaos, PIXELS.impacts):
        tally.judge(0.0, call)
    else:
        tally.leave("no period, and neighbours separate slowly if at all")


def _sensitive(follower: Follower, state: tuple[float, float], fate: Fate, call: str, tally: Tally) -> None:
    """Neighbours 1e-15 away part before the orbit settles; where some 1e-12 away do not, this is wrong."""
    count = max(fate.impacts, 1)
    if follower.separates(state, FOLLOWED.rounding, count):
        tally.judge(0.0, call)
    elif follower.separates(state, 1e3 * FOLLOWED.rounding, count):
        tally.leave("neighbours part at a distance above rounding")
    else:
        tally.judge(np.inf, call)
