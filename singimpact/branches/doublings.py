"""A cascade of period doublings: orbits of 1, 2, 4, 8, ... times as many impacts, each followed to its own doubling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.branch import Branch, branch
from singimpact.branches.events import PERIOD_DOUBLING, Event
from singimpact.inputs import checked_keywords, refuse, takes_two_walls, whole
from singimpact.oscillator import Oscillator, value_of
from singimpact.result import Result

# Parts of the distance between the last two doublings within which the next one is looked for, the nearest first; of
# the first distance, which is not known, the parameter itself stands for four times as much.
REACHES = (0.4, 1.2, 4.0)
STEP = 0.1  # of such a branch: shorter where its tests turn


@dataclass(frozen=True, eq=False)
class DoublingCascade(Result):
    """Period doublings, each of the orbits that begin at the one before.

    Parameters
    ----------
    model : of the first doubling. over : the parameter.
    parameter : its value at each doubling, shape (m,). n, k : impacts and periods of the orbits
        that double there, shape (m,).
    ratios : the distance of the two doublings before over that to this one, shape (m,), nan at the first two. They tend
        to 4.6692... of Feigenbaum.
    limit : where the doublings accumulate if the last ratio repeats, an extrapolation; nan of fewer than three.
    note : why it ends. events : the doublings as events of branches.
    """

    heads_csv = True
    model: Oscillator
    over: str
    parameter: Array
    n: Array
    k: Array
    ratios: Array
    limit: float
    note: str
    events: tuple[Event, ...]

    def __repr__(self) -> str:
        lines = [f"  ({event.orbit.n:.0f}, {event.orbit.k}) {event!r}" for event in self.events]
        return "\n".join([f"<cascade of doublings, limit {self.limit:.10g}", *lines, f"  {self.note}>"])


@checked_keywords
@takes_two_walls
def cascade(start: Branch | Event, *, doublings: int = 6) -> DoublingCascade:
    """The cascade of period doublings that begins at a doubling.

    Parameters
    ----------
    start : an event of kind "period-doubling", or a branch with one: its first of orbits that exist (`visible`).
    doublings : at most so many; the orbits of the last one have 2^(doublings - 1) times the impacts of the first.

    Returns
    -------
    DoublingCascade : it ends early, and `.note` says so, where orbits become virtual before they double, as at a graze,
        where they do not double within four times the last distance, and at a doubling that is degenerate.

    Notes
    -----
    The doubled orbits are followed by `branch`, from beside each doubling to the next, which is located to rounding.
    Ratios lose digits as distances shrink: the sixth has about nine digits less than a doubling.

    Raises
    ------
    InputError : `start` is neither, or its orbits do not exist.

    Examples
    --------
    >>> from singimpact.branches.periodic import periodic
    >>> from singimpact.oscillator.model import Oscillator
    >>> ball = Oscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.4"})
    >>> branches = [branch(orbit, "G", (1.2, 2)) for orbit in periodic(ball, 1, 1)]
    >>> found = cascade(branches[1], doublings=4)
    >>> [round(G, 6) for G in found.parameter.tolist()], found.ratios.round(3).tolist()[2:]
    ([1.526824, 1.667131, 1.696781, 1.703181], [4.732, 4.633])
    """
    events = [_first(start)]
    whole("doublings", doublings, 1, 12)
    near, note = abs(events[0].parameter) / 4 or 0.25, f"as many as asked for: {doublings}"
    while len(events) < doublings:
        following = _next(events[-1], near)
        if isinstance(following, str):
            note = following
            break
        near = abs(following.parameter - events[-1].parameter)
        events.append(following)
    parameter = np.array([event.parameter for event in events])
    distances = np.diff(parameter)
    ratios = np.append([np.nan, np.nan], distances[:-1] / distances[1:])[: len(events)]
    limit = float(parameter[-1] + distances[-1] / (ratios[-1] - 1)) if len(events) > 2 else np.nan
    n, k = (np.array([getattr(event.orbit, name) for event in events]) for name in "nk")
    model = events[0].orbit.oscillator
    return DoublingCascade(model, events[0].over, parameter, n, k, ratios, limit, note, tuple(events))


def _first(start: object) -> Event:
    for event in start.events if isinstance(start, Branch) else (start,):
        if isinstance(event, Event) and event.kind == PERIOD_DOUBLING.name and event.orbit.visible:
            return event
    raise refuse("start", start, "a period doubling of orbits that exist (`visible`), or a branch with one")


def _next(event: Event, near: float) -> Event | str:
    """The doubling of the orbits that begin at a doubling, or why there is none."""
    if event.criticality == "degenerate":
        return f"the first coefficient at the last doubling is {event.normal_form.value:.2g}: degenerate"
    doubled = f"the ({2 * event.orbit.n:.0f}, {2 * event.orbit.k}) orbits"
    for orbit in event.others():
        side = value_of(orbit.oscillator, event.over) - event.parameter
        for reach in REACHES:
            # not back through the doubling, where the branch turns
            ends = sorted(event.parameter + end for end in (side / 2, np.copysign(reach * near, side)))
            events = branch(orbit, event.over, ends, step=STEP).events
            later = [other for other in events if other.kind == PERIOD_DOUBLING.name]
            if later:
                following = min(later, key=lambda other: abs(other.parameter - event.parameter))
                virtual = f"{doubled} are virtual where they double: {following!r}"
                return following if following.orbit.visible else virtual
    return f"{doubled} do not double within {REACHES[-1] * near:.3g}"
