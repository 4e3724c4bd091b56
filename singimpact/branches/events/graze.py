"""Grazes: an impact of the orbit has no velocity, or an orbit without impact touches the wall.

`TouchingKind` and `heights` serve interior grazes too, at which a flight touches the wall between impacts. Where the
restitution is 0 no impact leaves a velocity: an orbit changes where an impact lies at a lift-off phase (`OnsetOfRest`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.events.kind import CurveLook, EventKind, Indexed, OrbitState, Test, difference, grazes
from singimpact.oscillator.wall_acceleration import acceleration

if TYPE_CHECKING:
    from singimpact.branches.orbits import PeriodicOrbit
    from singimpact.branches.solutions import AnyClosing

DEGENERATE = 1e-6  # a_c at the graze, of the largest a_c in a period, below which the graze is called degenerate


class TouchingKind(EventKind):
    """A kind at which the orbit touches the wall; a zero of smooth equations, which Krawczyk's operator proves."""

    touches = True
    proof = "an orbit that touches the wall in the point tau[0], where a_c > 0, and is above it between its impacts"

    def others(self, orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:  # noqa: ARG002
        """The orbit with an impact where it touches the wall."""
        from singimpact.branches.branch_points import with_impact

        return [with_impact(orbit)]

    def graze_time(self, orbit: PeriodicOrbit) -> float:
        """The time of the lowest place, of an orbit without impact; else of the flight that touches the wall."""
        from singimpact.branches.branch_points import touching_flight

        times = np.asarray(orbit.tau, dtype=float)
        if not orbit.n:
            return float(times[0])
        flight, _, time = touching_flight(orbit)
        return float(times[flight] + time)


def heights(state: OrbitState) -> Indexed:
    """x - c at the local minima of each flight."""
    for i, turns in enumerate(state.turns):
        span = state.closing.span(state.at, i)
        for j, (time, height) in enumerate(turn for turn in turns if np.isfinite(turn[1])):
            yield i, j, Test(height, state.closing.rise(state.at, state.direction, i, time), time / span)


class Graze(TouchingKind):
    """Graze of an impact: its velocity vanishes. Of an orbit without impact x - c vanishes at a local minimum."""

    name = "graze"
    word = "graze"
    marker = "^"
    look = CurveLook("black", "solid", 1.4)
    at_impact = True

    def tests(self, state: OrbitState) -> Indexed:
        """v of each impact; of an orbit without impact the heights of its minima."""
        n = state.closing.n
        if not n:
            yield from heights(state)
        for i in range(0 if state.closing.plastic else n):
            yield i, 0, Test(float(state.at[n + i]), float(state.direction[n + i]))

    def value(self, state: OrbitState, impact: int) -> float:
        """v of an impact."""
        return float(state.at[state.closing.n + impact])

    def remark(self, orbit: PeriodicOrbit, time: float, parameter: float) -> str:
        """Where a_c vanishes too, the graze is degenerate."""
        from singimpact.branches.solutions import orbit_period

        if not orbit.n or orbit.span is not None:  # without a clock a_c is one number
            return ""
        at_impact = float(acceleration(orbit.oscillator, np.array([time]))[0])
        largest = float(np.abs(acceleration(orbit.oscillator, np.linspace(0, 1, 9) * orbit_period(orbit))).max())
        if not abs(at_impact) < DEGENERATE * largest:
            return ""
        return f"the graze at {parameter:.12g} is one with a_c = 0: a degenerate graze"

    def others(self, orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:
        """The orbit without the impact; of an orbit without impact the one with an impact there."""
        from singimpact.branches.branch_points import without_impact

        # a cycle without impact is not an orbit of this package, nor one between two walls
        if orbit.n == 1 and (orbit.span is not None or orbit.wall is not None):
            return []
        return [without_impact(orbit)] if orbit.n else super().others(orbit, over, parameter)

    def touching(self, closing: AnyClosing, orbit: PeriodicOrbit) -> int:  # noqa: ARG002
        """The slowest impact."""
        return int(np.argmin(np.abs(np.asarray(orbit.v, dtype=float))))

    def graze_time(self, orbit: PeriodicOrbit) -> float:
        """The time of the impact without velocity."""
        if not orbit.n:
            return super().graze_time(orbit)
        return float(np.asarray(orbit.tau, dtype=float)[np.argmin(np.abs(np.asarray(orbit.v, dtype=float)))])

    def equation(self, state: OrbitState) -> float:
        """v of the impact that grazes, over its scale."""
        return self.value(state, state.impact) / float(state.scales[state.closing.n])

    def gradient(self, state: OrbitState) -> Array:
        """1 over the scale, at the velocity."""
        n, slope = state.closing.n, np.zeros(len(state.at))
        slope[n + state.impact] = 1.0 / state.scales[n]
        return slope

    def degenerate(self, state: OrbitState, gradient: Callable[[], Array]) -> dict[str, float]:  # noqa: ARG002
        """Folds and doublings that leave the curve, a_c = 0, and another impact that grazes."""
        from singimpact.branches.closing import Closing

        closing = state.closing
        assert isinstance(closing, Closing)
        tests = {"degenerate graze": float(closing.pushes(state.at)[state.impact])} | grazes(
            state, "two grazes", but=state.impact
        )
        if not closing.clocked:  # the determinants vanish at every graze of a cycle
            return tests
        return {"fold at a graze": state.determinant(1.0), "doubling at a graze": state.determinant(-1.0)} | tests


GRAZE = Graze()


class InteriorGraze(TouchingKind):
    """Interior graze: x - c vanishes at a local minimum of a flight."""

    name = "hidden impact"
    word = "interior graze (hidden impact)"
    marker = "v"
    look = CurveLook("green", "dash-dot", 1.6)

    def tests(self, state: OrbitState) -> Indexed:
        """The heights of the minima of all flights of an orbit with impacts."""
        return heights(state) if state.closing.n else iter(())

    def touching(self, closing: AnyClosing, orbit: PeriodicOrbit) -> int:
        """The flight whose lowest place is nearest to the wall."""
        from singimpact.branches.branch_points import states_of
        from singimpact.branches.solutions import closing_of

        plain = closing_of(orbit.oscillator, closing.word, closing.k, ())
        return int(np.argmin([abs(height) for _, height in plain.heights(states_of(orbit))]))

    def equation(self, state: OrbitState) -> float:
        """x - c at the lowest place of the flight."""
        return state.closing.heights(state.at)[state.impact][1]


INTERIOR_GRAZE = InteriorGraze()


# ---- what a graze is where impacts leave no velocity


class OnsetOfRest(EventKind):
    """An impact that leaves no velocity where a_c = 0: where a_c < 0 the mass rests, and the orbit is another one."""

    name = "onset of rest"
    word = "onset of rest (an impact where a_c = 0, restitution 0)"
    marker = "d"
    look = CurveLook("black", "dash-dot", 1.4)

    def tests(self, state: OrbitState) -> Indexed:
        """a_c at each impact, where impacts leave no velocity."""
        for i in range(state.closing.n if state.closing.plastic else 0):
            yield i, 0, difference(partial(self.value, impact=i), state)

    def value(self, state: OrbitState, impact: int) -> float:
        """a_c at an impact."""
        return float(state.closing.pushes(state.at)[impact])

    def equation(self, state: OrbitState) -> float:
        """a_c at the impact of the event."""
        return self.value(state, state.impact)

    def touching(self, closing: AnyClosing, orbit: PeriodicOrbit) -> int:  # noqa: ARG002
        """The impact at which |a_c| is least."""
        times: Array = np.asarray(orbit.tau, dtype=float)
        return int(np.argmin(np.abs(acceleration(orbit.oscillator, times))))


ONSET_OF_REST = OnsetOfRest()
