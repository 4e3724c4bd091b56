"""W^s and W^u next to a saddle, to the second order, with the length to which that is enough.

    K(s) = p + s e + s^2 k,   G^n(K(s)) = K(mu s),   (mu^2 - D G^n) k = D^2 G^n(e, e)/2

G^n is the return map of an orbit of n impacts, its forcing periods taken off; e is an eigenvector, mu its multiplier.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import orbit_period
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.flights.derivative import derivative
from singimpact.inputs import InputError, refuse

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class LocalArcSettings:
    """How far from a saddle its arcs are taken from their expansion; lengths are relative to `LocalArc.scales`."""

    # by how much G^n(K(s)) may miss K(mu s) at the end of the arc
    trust: float = 1e-13
    # it falls eightfold with half the arc; where it does not fall by half from below this, the flights' error is left
    floor: float = 1e-10
    # the longest arc; it is halved until the above holds, down to the shortest
    longest: float = 0.1
    shortest: float = 1e-9
    # step of the difference that gives D^2 G^n: its error is the step squared, and is multiplied by s^2 of the arc
    nudge: float = 1e-5
    # multipliers nearer to 1 in size leave no hyperbolic saddle in doubles
    hyperbolic: float = 1e-8


SETTINGS = LocalArcSettings()


@dataclass(frozen=True)
class LocalArc:
    """The arc K(s), |s| <= size, of W^s or W^u at the first impact of a saddle.

    Parameters
    ----------
    saddle : the orbit. stable : W^s. multiplier : mu. scales : (period, largest v of the orbit), the units of s.
    state, direction, bend : p, e, k, shape (2,). size : the largest |s|.
    error : of G^n(K(s)) against K(mu s) at |s| = size, measured, in units of `scales`.
    """

    saddle: PeriodicOrbit
    stable: bool
    multiplier: float
    scales: Array
    state: Array
    direction: Array
    bend: Array
    size: float
    error: float

    def points(self, s: Array) -> Array:
        """K(s), shape (m, 2)."""
        along = np.asarray(s)[:, None]
        return np.asarray(self.state + along * self.direction + along**2 * self.bend)

    def slope(self, s: float) -> Array:
        """K'(s), shape (2,)."""
        return np.asarray(self.direction + 2 * s * self.bend)

    @property
    def ratio(self) -> float:
        """What divides |s| from one image of the fundamental piece to the piece: |mu|, or 1/|mu| of W^s."""
        return 1 / abs(self.multiplier) if self.stable else abs(self.multiplier)

    @property
    def sides(self) -> tuple[float, ...]:
        """Ends s of arcs whose images are all of the manifold: a negative multiplier takes one side to the other."""
        return (self.size,) if self.multiplier < 0 else (self.size, -self.size)

    @property
    def turns(self) -> int:
        """Turns of the orbit after which a side comes back to itself."""
        return 2 if self.multiplier < 0 else 1


def checked_saddle(saddle: Any) -> PeriodicOrbit:
    """The orbit, if it is a saddle whose impacts the mass sees.

    Raises
    ------
    InputError : no orbit of `osc.periodic(n, k)` with impacts, a virtual one, or one that is no saddle.
    """
    if not isinstance(saddle, PeriodicOrbit) or saddle.oscillator is None:
        raise refuse("saddle", saddle, "an unstable orbit of osc.periodic(n, k)")
    if saddle.kind != "impacts":
        raise refuse("saddle", repr(saddle), "an orbit with finitely many impacts: the others have no states to leave")
    if not saddle.visible:
        raise refuse("saddle", repr(saddle), "an orbit that does not pass through the wall")
    sizes = np.sort(np.abs(np.asarray(saddle.multipliers, dtype=complex)))
    if not (sizes[0] < 1 - SETTINGS.hyperbolic and sizes[1] > 1 + SETTINGS.hyperbolic and np.isfinite(sizes).all()):
        told = ", ".join(f"{complex(each).real:.6g}{complex(each).imag:+.6g}i" for each in saddle.multipliers)
        raise InputError(f"saddle has the multipliers {told}: W^s and W^u belong to one inside and one outside the "
                         "unit circle")  # fmt: skip
    return saddle


def local_arc(saddle: PeriodicOrbit, stable: bool) -> LocalArc:
    """The arc of W^s or of W^u at a saddle.

    Examples
    --------
    >>> from singimpact.branches.periodic import periodic
    >>> from singimpact.oscillator.model import Oscillator
    >>> (saddle,) = periodic(Oscillator("x", "cos(2.8*t)", 0, "0.8"), 1, 1)
    >>> arc = local_arc(saddle, stable=False)
    >>> round(arc.multiplier, 6), arc.error < 1e-13
    (-2.958095, True)
    """
    osc, period = saddle.oscillator, orbit_period(saddle)
    state = np.array([float(saddle.tau[0]), float(saddle.v[0])])
    scales = np.array([period, float(np.max(np.asarray(saddle.v, dtype=float)))])
    matrix = return_slope(saddle, state)
    values, vectors = np.linalg.eig(matrix)
    at = int(np.argmin(np.abs(values)) if stable else np.argmax(np.abs(values)))
    multiplier, direction = float(values[at].real), vectors[:, at].real
    direction = direction / np.linalg.norm(direction / scales)
    direction *= np.sign(direction[1] or direction[0])
    nudge = SETTINGS.nudge * direction
    second = (return_slope(saddle, state + nudge) - return_slope(saddle, state - nudge)) @ direction
    second /= 2 * SETTINGS.nudge
    bend = np.linalg.solve(multiplier**2 * np.eye(2) - matrix, second / 2)
    if not np.isfinite(bend).all():
        raise InputError("a flight next to the saddle grazes: the expansion of its manifolds has no second order")
    best = LocalArc(saddle, stable, multiplier, scales, state, direction, bend, SETTINGS.longest, np.inf)
    size = SETTINGS.longest
    while size > SETTINGS.shortest and best.error > SETTINGS.trust:
        arc = LocalArc(saddle, stable, multiplier, scales, state, direction, bend, size, 0.0)
        ends = np.array([size, -size])
        missed = returned(osc, saddle, arc.points(ends)) - arc.points(multiplier * ends)
        error = float(np.abs(missed / scales).max())
        if best.error < SETTINGS.floor and error > best.error / 2:
            break
        if error < best.error:  # false where a flight of the arc has no impact
            best = LocalArc(saddle, stable, multiplier, scales, state, direction, bend, size, error)
        size /= 2
    if not np.isfinite(best.error):
        raise InputError("no arc next to the saddle comes back to it: the orbit lies too near to a graze")
    return best


def returned(osc: Any, saddle: PeriodicOrbit, points: Array) -> Array:
    """G^n of points, with the k periods taken off, shape (m, 2)."""
    for _ in range(int(saddle.n)):
        points = model_step(osc, points)
    return np.asarray(points - np.array([saddle.k * orbit_period(saddle), 0.0]))


def return_slope(saddle: PeriodicOrbit, state: Array) -> Array:
    """D G^n at a state, shape (2, 2)."""
    matrix, point = np.eye(2), state[None]
    for _ in range(int(saddle.n)):
        matrix = derivative(saddle.oscillator, *point[0].tolist()).matrix @ matrix
        point = model_step(saddle.oscillator, point)
    return matrix


def directions(arc: LocalArc) -> Array:
    """Unit tangents of the manifold at the impacts of the orbit, shape (n, 2), each with v' >= 0."""
    found, tangent = [], arc.direction
    for tau, v in zip(arc.saddle.tau, arc.saddle.v, strict=True):
        unit = tangent / np.linalg.norm(tangent)
        found.append(unit * np.sign(unit[1] or unit[0]))
        tangent = derivative(arc.saddle.oscillator, float(tau), float(v)).matrix @ unit
    return np.array(found)
