"""All kinds of events: those of the package, in the order in which a branch looks for them, and a user's."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING, Any

from singimpact.branches.events.graze import GRAZE, INTERIOR_GRAZE, ONSET_OF_REST
from singimpact.branches.events.kind import EventKind, Indexed, OrbitState, difference
from singimpact.branches.events.meeting_branches import BRANCH_POINT, PITCHFORK, TRANSCRITICAL
from singimpact.branches.events.unit_multipliers import FOLD, NEIMARK_SACKER, PERIOD_DOUBLING
from singimpact.inputs import InputError, refuse

if TYPE_CHECKING:
    from singimpact.branches.orbits import PeriodicOrbit

KINDS: tuple[EventKind, ...] = (
    FOLD,
    PERIOD_DOUBLING,
    NEIMARK_SACKER,
    BRANCH_POINT,
    GRAZE,
    INTERIOR_GRAZE,
    ONSET_OF_REST,
    PITCHFORK,
    TRANSCRITICAL,
)
_BY_NAME = {kind.name: kind for kind in KINDS}

TOUCHING = 1e-12  # height above the wall that is a rounding error
ACCEPTED = "a list of functions of an orbit that have a name, or of objects with .name and .test"


class OwnEvent(EventKind):
    """A kind that a user defines, or the name of one that was read from an event.

    Parameters
    ----------
    name : of its events. test : a function of a periodic orbit, whose zeros are the events.
    """

    marker = "h"
    is_own = True

    def __init__(self, name: str, test: Callable[[Any], Any] | None = None) -> None:
        self.name, self.word, self.function = name, name, test

    def tests(self, state: OrbitState) -> Indexed:
        """The function and its rate; the rate has no value where a flight beside the orbit leaves the domain."""
        yield 0, 0, difference(partial(self.value, impact=0), state)

    def value(self, state: OrbitState, impact: int) -> float:  # noqa: ARG002
        """The function of the orbit.

        Raises
        ------
        InputError : it raises, or its value is not finite.
        """
        assert self.function is not None
        orbit = orbit_in_order(state)
        try:
            number = float(self.function(orbit))
        except Exception as error:  # whatever a function of a user raises is reported with the orbit
            raise InputError(
                f"{self._at(state)} raises {type(error).__name__}: {error}; give a function that has a "
                f"finite value for {orbit!r}"
            ) from error
        if not isfinite(number):
            raise InputError(f"{self._at(state)} is {number}; give a function that has a finite value for {orbit!r}")
        return number

    def _at(self, state: OrbitState) -> str:
        return f"events: {self.name} at {state.closing.over[-1]} = {state.at[-1]:.12g}"


def orbit_in_order(state: OrbitState) -> PeriodicOrbit:
    """The orbit at a point, its impacts in the order of the columns of the branch: each varies continuously."""
    from singimpact.branches.solutions import orbit_of

    n, at = state.closing.n, state.at
    heights = [height for turns in state.turns for _, height in turns]
    seen = min([*at[n : 2 * n].tolist(), *heights], default=0.0) >= -TOUCHING
    orbit = orbit_of(state.closing, at, bool(seen))
    return replace(orbit, tau=at[:n].copy(), v=at[n : 2 * n].copy()) if n else orbit


def own_events(events: Iterable[Any], taken: Collection[str]) -> tuple[OwnEvent, ...]:
    """The kinds that functions define, or objects with `name` and `test`.

    Parameters
    ----------
    taken : names that other kinds have.

    Raises
    ------
    InputError : one has no name, or a name that is taken, or cannot be called.

    Examples
    --------
    >>> def fast(orbit):
    ...     return orbit.v[0] - 0.5
    >>> [kind.name for kind in own_events([fast], ())]
    ['fast']
    >>> own_events([fast, fast], ())
    Traceback (most recent call last):
    singimpact.inputs.InputError: events = 'fast' is not accepted: give a name that no other event has
    """
    if callable(events) or isinstance(events, str) or not isinstance(events, Iterable):
        raise refuse("events", events, ACCEPTED)
    kinds: list[OwnEvent] = []
    for event in events:
        name = getattr(event, "name", getattr(event, "__name__", None))
        test = getattr(event, "test", event)
        # a lambda has no name of its own, and two of them would not differ
        if not isinstance(name, str) or not name.strip() or name == "<lambda>" or not callable(test):
            raise refuse("events", event, ACCEPTED)
        if name in taken or name in [kind.name for kind in kinds]:
            raise refuse("events", name, "a name that no other event has")
        kinds.append(OwnEvent(name, test))
    return tuple(kinds)


def kind_of(name: str) -> EventKind:
    """The kind with a name; a name that is not in the table is that of a user's event.

    Examples
    --------
    >>> kind_of("torus").word
    'Neimark-Sacker bifurcation (torus)'
    """
    return _BY_NAME.get(name) or OwnEvent(name)
