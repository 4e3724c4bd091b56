"""A second wall beside V_c': which flights meet it, and the cut, along which flights graze it.

A flight that meets the other wall leaves V_c'.  The cut is parametrised by the time s at which a flight is at rest at
the other wall, pushed away from it there: run back its first hit is the launch, run on it is the landing.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.flights.impact_map import first_hit
from singimpact.flights.inverse_map import backwards
from singimpact.flights.off_wall import launch
from singimpact.flights.results import Flight
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status, Wall
from singimpact.surface.curve import Window

# Chord of the cut, in units of the resolution of the window
LONGEST = 2.0
# The end of a piece is located to this step, relative to 1 + |s|: nearer to a graze of the own wall flights are flown
# in many digits, and a curve that ends like a square root is 1e-5 longer
FINEST = 1e-10
# Columns of `OtherWall.grazes`: launch time and flight time, launch time and velocity.
TO_LAND, TO_LAUNCH = (0, 2), (0, 1)


def at_lower_wall(flights: Flight) -> Array:
    """Whether flights end in an impact with the lower wall."""
    regular: Array = np.isin(flights.status, (Status.hit, Status.graze))
    return regular if flights.wall is None else regular & (flights.wall == Wall.lower)


@dataclass(frozen=True)
class OtherWall:
    """The upper wall of a model, as flights from the lower one come to it."""

    osc: Oscillator

    @cached_property
    def _mirrored(self) -> Oscillator:
        return self.osc.mirrored

    def is_met(self, tau: Array, t: Array) -> Array:
        """Whether the flight from rest at tau meets the other wall before t, of either sign, also behind its own."""
        alone, start = self._mirrored.one_wall(), -as_float(self.osc.clearance)
        met = np.zeros(len(tau), dtype=bool)
        for side, model, turn in ((t > 0, alone, 1), (t < 0, backwards(alone), -1)):
            if side.any():
                at, rest = np.abs(t[side]), np.zeros(int(side.sum()))
                flown = launch(model, start + rest, rest, turn * tau[side], horizon=float(at.max()))
                met[side] = flown.flight_time < at
        return met

    def grazes(self, s: Array, longest: float) -> Array:
        """Launch time, launch velocity and flight time of flights that graze the other wall at s, shape (n, 3).

        nan where no launch from the own wall leads there; a flight time is nan too where the other wall is hit later.

        Parameters
        ----------
        longest : time from the launch to the graze, and from there to the landing.
        """
        flights = [
            first_hit(model, times, np.zeros(len(s)), horizon=longest)
            for model, times in ((backwards(self._mirrored), -s), (self._mirrored, s))
        ]
        own = [(flight.status == Status.hit) & (flight.wall == Wall.upper) for flight in flights]
        back, ahead = (np.where(at, flight.flight_time, np.nan) for at, flight in zip(own, flights, strict=True))
        return np.stack([s - back, np.where(own[0], flights[0].velocity, np.nan), back + ahead], axis=1)

    def cut(self, window: Window, columns: tuple[int, int], cell: float) -> list[Array]:
        """The cut in a window of launch times and flight times, as polylines of two columns of `grazes`.

        Parameters
        ----------
        cell : the largest step of s of the first sketch. Pieces that are shorter can be missed.
        """
        if not window.y[1] > 0:
            return []
        low, high = window.x[0], window.x[1] + window.y[1]
        # eight samples in a cell of the sketch of Z, 200 at least
        s = np.linspace(low, high, max(200, int(np.ceil(8 * (high - low) / cell))))
        points = self.grazes(s, window.y[1])[:, columns]
        sizes = np.array([window.longer, window.longer])
        if columns == TO_LAUNCH:
            sizes[1] = np.nanmax(points[:, 1], initial=0.0) or 1.0
        for _ in range(40):
            shown = _inside(points, window, columns)
            with np.errstate(invalid="ignore"):
                short = np.hypot(*(np.diff(points, axis=0) / sizes).T) <= LONGEST * window.resolution
            wide = np.diff(s) > FINEST * (1 + np.abs(s[1:]))
            at = np.flatnonzero(~short & wide & (shown[1:] | shown[:-1]))
            if not at.size:
                break
            middle = (s[at] + s[at + 1]) / 2
            between = self.grazes(middle, window.y[1])[:, columns]
            s, points = np.insert(s, at + 1, middle), np.insert(points, at + 1, between, axis=0)
        shown = _inside(points, window, columns)
        pieces = np.split(np.arange(len(s)), np.flatnonzero(~(short & shown[1:] & shown[:-1])) + 1)
        return [points[piece] for piece in pieces if len(piece) > 1]


def _inside(points: Array, window: Window, columns: tuple[int, int]) -> Array:
    """Which points of the cut lie in the window; velocities have no upper end."""
    inside = np.isfinite(points[:, 1]) & (points[:, 0] >= window.x[0]) & (points[:, 0] <= window.x[1])
    return np.asarray(inside & (points[:, 1] <= window.y[1]) if columns == TO_LAND else inside)
