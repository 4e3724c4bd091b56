"""x and x' of an orbit at given times: within flights, in chatter that was summed up, at rest; its sections."""

from dataclasses import dataclass
from math import ceil, log

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.flights.flight_path import along, dropped
from singimpact.flights.orbits import orbit_segment
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result

# Through a chatter that was summed up velocities below this part of the largest one are 0: heights are then below its
# square
SLOW = 2.0**-52
# Impacts of one call into compiled code
BLOCK = 4096


@dataclass(frozen=True, eq=False)
class Section(Result):
    """States of an orbit once a period.

    Parameters
    ----------
    t : times, one a period. x, xdot : the state at each.
    """

    t: Array
    x: Array
    xdot: Array

    def __repr__(self) -> str:
        return f"Section({self.t.size} states, one a period)"

    def after(self, states: int) -> "Section":
        """The section without its first states, such as those of a transient."""
        return Section(self.t[states:], self.x[states:], self.xdot[states:])


def sampled(
    osc: Oscillator, events: tuple[Array, Array, Array], last: str, end: float, height: float, times: Array
) -> Array:
    """x and x' at rising times, shape (n, 2); nan before the first event and after `end`.

    Parameters
    ----------
    osc : the model. events : tau, v and kind of every event. last : the kind of the phase after the last event.
    height : x - c at the first event.

    Examples
    --------
    >>> osc = Oscillator("0", "-2", "0.5", "1/2")
    >>> events = np.array([0.0, 1.0]), np.array([1.0, 0.5]), np.array(["start", "impact"])
    >>> sampled(osc, events, "", 1.0, 0.0, np.array([0.5, 1.0, 1.5])).tolist()
    [[0.75, 0.0], [0.5, 0.5], [nan, nan]]
    """
    tau, v, kind = events
    out = np.full((times.size, 2), np.nan)
    which = np.searchsorted(tau, times, side="right") - 1
    within = (which >= 0) & (times <= end)
    # a phase ends in the event after it; the last event itself is a state, of which a flight of no time is sampled
    flights = np.append((kind[1:] == "impact") | (kind[1:] == "graze"), last in ("", "no_return", "unresolved"))
    sums = np.append(kind[1:] == "complete", False)
    out[within] = 0.0
    for at in np.unique(which[within & sums[which]]).tolist():
        inside = np.flatnonzero(within & (which == at))
        out[inside] = _in_chatter(osc, float(tau[at]), float(v[at]), times[inside], SLOW * float(v.max()))
    flying = np.flatnonzero(within & flights[which])
    if height > 0:
        first = flying[which[flying] == 0]
        out[first] = dropped(osc, (float(tau[0]), float(v[0]), height), times[first] - tau[0])
        flying = flying[which[flying] > 0]
    launch = which[flying]
    out[flying] = along(osc, tau, v, launch, times[flying] - tau[launch])
    # rounding next to an impact would place the mass behind the obstacle
    out[:, 0] = np.maximum(out[:, 0], 0.0) + as_float(osc.clearance)
    return out


def _in_chatter(osc: Oscillator, tau: float, v: float, times: Array, slow: float) -> Array:
    """x - c and x' at rising times after a state whose impacts accumulate."""
    out, done = np.zeros((times.size, 2)), 0
    rate = -log(as_float(osc.slope_at_rest()))
    while done < times.size and v > slow:
        # where r = 1 the speeds fall like a power of the number of impacts
        count = min(BLOCK, ceil(log(v / slow) / rate) + 1) if rate else BLOCK
        segment = orbit_segment(osc, tau, v, count)
        starts, speeds = np.append(tau, segment.tau), np.append(v, segment.v)
        inside = np.arange(done, np.searchsorted(times, starts[-1]))
        launch = np.searchsorted(starts, times[inside], side="right") - 1
        out[inside] = along(osc, starts, speeds, launch, times[inside] - starts[launch])
        done += inside.size
        if segment.status or not starts[-1] > tau:  # doubles do not tell the impacts left apart
            break
        tau, v = float(starts[-1]), float(speeds[-1])
    return out
