"""The map of release phases: impacts with restitution 0 leave a motion of one dimension, from release to release.

A mass at rest on the wall leaves it where a_c > 0: at once, or at the next rise of a_c through 0. It lands, and what
follows depends on the phase of the landing alone. The map is flat where the mass rests on the way.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.dynamics.lift_off import next_lift_offs
from singimpact.flights.impact_map import impact_map
from singimpact.flights.response import response
from singimpact.flights.states import States
from singimpact.inputs import checked_keywords, refuse, require
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.result import Result, value_in_words
from singimpact.status import Status, status_array

# Phases of a period where none are given
PHASES = 1000


@dataclass(frozen=True, eq=False, repr=False)
class ReleaseMap(Result):
    """The next release of a mass at rest on the wall.

    Parameters
    ----------
    start : times at which the mass is at rest on the wall; the fields have their shape. landing : time of its impact.
    tau : time at which it leaves the wall after that; inf where it rests for ever or does not return. phase : the same
        within a period; of a mass that rests, the double next to the zero of a_c, one number for each.
    slope : d tau/d start; 0 on the flat pieces, infinite at a graze.
    flat : bool, whether the mass rests before it leaves or after it lands: tau does not depend on `start` there.
    status : `hit`, or `graze` of a landing without velocity; `sticks` for ever; the status of a flight that does not
        land, whose landing and phase are nan. period : of the forcing.
    """

    start: Any
    landing: Any
    tau: Any
    phase: Any
    slope: Any
    flat: Any
    status: Any
    period: float

    def __repr__(self) -> str:
        statuses = value_in_words(np.asarray(self.status), Status)
        if not np.ndim(self.tau):
            return f"ReleaseMap(start={self.start}, tau={self.tau}, slope={self.slope}, status={statuses})"
        share = 100 * float(np.mean(self.flat)) if np.size(self.flat) else 0.0
        return f"ReleaseMap({np.size(self.tau)} phases: {share:.3g} % on flat pieces; {statuses})"


@checked_keywords
def release_map(osc: Oscillator, tau: Any = None) -> ReleaseMap:
    """The times at which a mass at rest on the wall leaves it again, with restitution 0: a map of the circle.

    Parameters
    ----------
    osc : a model with restitution 0 and a period. tau : times at which the mass is at rest on the wall; 1000 phases of
        a period without it.

    Returns
    -------
    ReleaseMap : `.tau`, the next release; `.phase`, the same within a period, from which the map goes on; `.landing`,
        `.slope`, `.flat`, `.status`.

    Raises
    ------
    InputError : the restitution is not 0, or the model has no period.

    Notes
    -----
    From a phase at which a_c presses, the mass leaves at the next lift-off: the map is flat there too, and continuous
    at the lift-off, where its slope is 0. A periodic orbit that meets a flat piece is superstable.

    Examples
    --------
    >>> ball = Oscillator("1", "7/2*cos(t)", 0, 0)  # on a vibrating table
    >>> found = release_map(ball)
    >>> found
    ReleaseMap(1000 phases: 94.1 % on flat pieces; 1000 hit)
    >>> fixed = 2 * np.pi - np.arcsin(np.pi / 3.5)  # of Mehta and Luck, slope 1 - sqrt(G^2 - pi^2)
    >>> after = release_map(ball, fixed)
    >>> round(float(after.tau - fixed), 12), round(float(after.slope), 12)
    (6.28318530718, -0.54285307107)
    """
    require_model("osc", osc)
    if not osc.plastic:
        raise refuse("restitution", osc.restitution, "0: the motion after an impact depends on its velocity otherwise")
    require(osc.period is not None, "model", osc, "one with a period: release phases are those of the forcing")
    period = as_float(osc.period)
    states = States.of(osc, np.linspace(0, period, PHASES, endpoint=False) if tau is None else tau, 0.0)
    times, presses = states.tau, _presses(states)
    phases, turns = times.copy(), np.zeros(times.size)
    phases[presses], turns[presses] = next_lift_offs(osc, times[presses])
    leaving, places = np.unique(phases, return_inverse=True)
    one = _from_leaving(osc, leaving)
    columns = [column[places] for column in (one.landing, one.tau, one.phase, one.slope, one.flat, one.status)]
    landing, later, phase, slope, flat, status = columns
    shift = turns * period + states.turns
    slope[presses], flat[presses] = 0.0, True
    columns = [times + states.turns, landing + shift, later + shift, phase, slope, flat, status_array(status)]
    start, landing, later, phase, slope, flat, status = (column.reshape(states.shape)[()] for column in columns)
    return ReleaseMap(start, landing, later, phase, slope, flat, status, period)


def _presses(states: States) -> Array:
    """Whether a_c presses masses at rest to the wall."""
    return np.array([states.rest[index].sign <= 0 for index in range(states.v.size)], dtype=bool)


def _from_leaving(osc: Oscillator, times: Array) -> ReleaseMap:
    """The map at times, shape (n,), at which the mass leaves the wall at once; inf and nan are of a rest for ever."""
    period, size = as_float(osc.period), times.size
    empty = np.full(size, np.nan)
    flat, status = np.zeros(size, bool), np.where(np.isnan(times), Status.unresolved, Status.sticks).astype(np.int8)
    result = ReleaseMap(times, empty, times.copy(), empty.copy(), empty.copy(), flat, status, period)
    going = np.flatnonzero(np.isfinite(times))
    step = impact_map(osc, times[going], 0.0)
    status[going] = step.status
    result.tau[going] = step.tau
    lands = np.isin(step.status, (Status.hit, Status.graze))
    at, landed = going[lands], np.asarray(step.tau)[lands]
    result.landing[at], result.phase[at] = landed, landed - period * np.floor(landed / period)
    with np.errstate(all="ignore"):
        slopes = response(osc, times[at], 0 * landed, step.flight_time[lands], step.velocity[lands]).time_by_tau
    result.slope[at] = np.where(step.status[lands] == Status.graze, np.inf, 1 + slopes)
    stays = _presses(States.of(osc, landed, 0.0))
    rests, (phases, turns) = at[stays], next_lift_offs(osc, landed[stays])
    result.phase[rests], result.slope[rests], result.flat[rests] = phases, 0.0, True
    result.tau[rests] = phases + turns * period
    ends = rests[~np.isfinite(phases)]
    status[ends] = np.where(np.isnan(result.phase[ends]), Status.unresolved, Status.sticks)
    result.phase[ends] = np.nan
    return result
