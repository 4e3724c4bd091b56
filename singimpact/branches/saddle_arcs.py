"""W^s and W^u next to a saddle, as polynomials, with the length to which they hold.

    K(s) = p + s e + s^2 k + O(s^3),   G^n(K(s)) = K(mu s),   (mu^2 - D G^n) k = D^2 G^n(e, e)/2

G^n is the return map of an orbit of n impacts, its forcing periods taken off; e is an eigenvector, mu its multiplier.
The expansion holds for |s| of 1e-5. Its images at Chebyshev nodes give a polynomial that holds a thousand times as far:
a curve that is grown from there is stretched less, and rounding in s with it.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from singimpact.algebra.numbers import Array
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import orbit_period
from singimpact.dynamics.invariant_arcs import before, model_step
from singimpact.flights.derivative import derivative
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.model import require_rebound


@dataclass(frozen=True)
class LocalArcSettings:
    """Reach of the polynomial arcs at a saddle; lengths are relative to `LocalArc.scales`."""

    # by how much G^n(K(s)) may miss K(mu s) at the end of the expansion
    trust: float = 1e-13
    # it falls eightfold with half the arc; where it does not fall by half from below this, the flights' error is left
    floor: float = 1e-10
    # the longest expansion; it is halved until the above holds, down to the shortest
    longest: float = 0.1
    shortest: float = 1e-9
    # step of the difference that gives D^2 G^n: its error is the step squared, and is multiplied by s^2 of the arc
    nudge: float = 1e-5
    # multipliers nearer to 1 in size leave no hyperbolic saddle in doubles
    hyperbolic: float = 1e-8
    # of the polynomial, which is doubled in length while it misses states of the curve by no more than `across` across
    # the curve; along the curve rounding of s shows, and moves no point off it
    degree: int = 20
    across: float = 2e-13
    along: float = 30.0  # errors of the expansion, stretched
    rounding: float = 1e-14
    furthest: float = 0.3


SETTINGS = LocalArcSettings()


@dataclass(frozen=True)
class Expansion:
    """p + s e + s^2 k of W^s or W^u at the first impact of a saddle.

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

    def carried(self, s: Array) -> Array:
        """States of the curve at any s: images of the expansion."""
        outwards = 1 / self.multiplier if self.stable else self.multiplier
        with np.errstate(divide="ignore"):
            turns = np.maximum(np.ceil(np.log(np.abs(s) / self.size) / np.log(abs(outwards))), 0)
        points = self.points(s / outwards**turns)
        for turn in range(int(turns.max(initial=0))):
            left = turns > turn
            points[left] = returned(self.saddle, points[left], self.stable)
        return points


@dataclass(frozen=True)
class LocalArc:
    """The arc K(s), |s| <= size, of W^s or W^u at the first impact of a saddle.

    Parameters
    ----------
    saddle, stable, multiplier, scales, direction : as of `Expansion`. size : the largest |s|.
    coefficients : of Chebyshev polynomials of s/size, shape (degree + 1, 2).
    error : of the arc, across it, in units of `scales`: what it was seen to miss, and the error of its expansion.
    """

    saddle: PeriodicOrbit
    stable: bool
    multiplier: float
    scales: Array
    direction: Array
    size: float
    coefficients: Array
    error: float

    def points(self, s: Array) -> Array:
        """K(s), shape (m, 2)."""
        return np.asarray(chebyshev.chebval(np.asarray(s) / self.size, self.coefficients).T)

    def slope(self, s: float) -> Array:
        """K'(s), shape (2,)."""
        return np.asarray(chebyshev.chebval(s / self.size, chebyshev.chebder(self.coefficients)) / self.size)

    @property
    def ratio(self) -> float:
        """The ratio of |s| on one image of the fundamental piece to the piece: |mu|, or 1/|mu| of W^s."""
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
    """The orbit, if it is a saddle with visible impacts.

    Raises
    ------
    InputError : no orbit of `osc.periodic(n, k)` with impacts, a virtual one, or one that is no saddle.
    """
    if not isinstance(saddle, PeriodicOrbit) or saddle.oscillator is None:
        raise refuse("saddle", saddle, "an unstable orbit of osc.periodic(n, k)")
    require_rebound(saddle.oscillator, "W^s or W^u of a saddle")
    if saddle.kind != "impacts":
        raise refuse("saddle", repr(saddle), "an orbit with finitely many impacts: the others have no states to leave")
    if not saddle.visible:
        raise refuse("saddle", repr(saddle), "an orbit that does not pass through the wall")
    sizes = np.sort(np.abs(np.asarray(saddle.multipliers, dtype=complex)))
    if not (sizes[0] < 1 - SETTINGS.hyperbolic and sizes[1] > 1 + SETTINGS.hyperbolic and np.isfinite(sizes).all()):
        multipliers = ", ".join(
            f"{complex(multiplier).real:.6g}{complex(multiplier).imag:+.6g}i" for multiplier in saddle.multipliers
        )
        raise InputError(
            f"saddle has the multipliers {multipliers}: "
            "W^s and W^u belong to one inside and one outside the unit circle"
        )
    return saddle


def local_arc(saddle: PeriodicOrbit, stable: bool) -> LocalArc:
    """The arc of W^s or of W^u at a saddle.

    Examples
    --------
    >>> from singimpact.branches.periodic import periodic
    >>> from singimpact.oscillator.model import Oscillator
    >>> (saddle,) = periodic(Oscillator("x", "cos(2.8*t)", 0, "0.8"), 1, 1)
    >>> arc = local_arc(saddle, stable=False)
    >>> round(arc.multiplier, 6), arc.error < 1e-12, arc.size > 0.01
    (-2.958095, True, True)
    """
    near = expansion(saddle, stable)
    best = _fitted(near, near.size)
    size = 2 * near.size
    while size <= SETTINGS.furthest:
        arc = _fitted(near, size)
        if not arc.error <= 3 * near.error + SETTINGS.across:  # near.error: of flights, where that is the larger part
            break
        best, size = arc, 2 * size
    return best


def _fitted(near: Expansion, size: float) -> LocalArc:
    """The polynomial through states of the curve; its error is inf where it misses others of them."""
    nodes = chebyshev.chebpts1(SETTINGS.degree + 1)
    with np.errstate(invalid="ignore"):
        coefficients = chebyshev.chebfit(nodes, np.nan_to_num(near.carried(size * nodes)), SETTINGS.degree)
    arc = LocalArc(near.saddle, near.stable, near.multiplier, near.scales, near.direction, size, coefficients, np.inf)
    between = size * np.cos(np.linspace(0, np.pi, 2 * SETTINGS.degree + 1))
    missed = (near.carried(between) - arc.points(between)) / near.scales
    along = np.array([arc.slope(s) for s in between.tolist()]) / near.scales
    across = np.abs(missed[:, 0] * along[:, 1] - missed[:, 1] * along[:, 0]) / np.hypot(*along.T)
    if not np.hypot(*missed.T).max() <= SETTINGS.along * (size / near.size) * (near.error + SETTINGS.rounding):
        across = np.append(across, np.inf)
    return replace(arc, error=near.error + float(across.max()))


def expansion(saddle: PeriodicOrbit, stable: bool) -> Expansion:
    """The expansion of W^s or W^u to the second order."""
    period = orbit_period(saddle)
    state = np.array([float(saddle.tau[0]), float(saddle.v[0])])
    scales = np.array([period, float(np.max(np.asarray(saddle.v, dtype=float)))])
    matrix = return_slope(saddle, state)
    values, vectors = np.linalg.eig(matrix)
    at = int(np.argmin(np.abs(values)) if stable else np.argmax(np.abs(values)))
    multiplier, direction = float(values[at].real), vectors[:, at].real
    direction = direction / np.linalg.norm(direction / scales)
    direction *= np.sign(direction[1] or direction[0])
    nudge = SETTINGS.nudge * direction
    if not np.abs(nudge[1]) < state[1]:
        raise InputError("the saddle lies too near to a graze: the expansion of its manifolds has no second order")
    second = (return_slope(saddle, state + nudge) - return_slope(saddle, state - nudge)) @ direction
    second /= 2 * SETTINGS.nudge
    bend = np.linalg.solve(multiplier**2 * np.eye(2) - matrix, second / 2)
    if not np.isfinite(bend).all():
        raise InputError("a flight next to the saddle grazes: the expansion of its manifolds has no second order")
    best = Expansion(saddle, stable, multiplier, scales, state, direction, bend, SETTINGS.longest, np.inf)
    size = SETTINGS.longest
    while size > SETTINGS.shortest and best.error > SETTINGS.trust:
        arc = replace(best, size=size)
        ends = np.array([size, -size])
        missed = returned(saddle, arc.points(ends)) - arc.points(multiplier * ends)
        error = float(np.abs(missed / scales).max())
        if best.error < SETTINGS.floor and error > best.error / 2:
            break
        if error < best.error:  # false where a flight of the arc has no impact
            best = replace(arc, error=error)
        size /= 2
    if not np.isfinite(best.error):
        raise InputError("no arc next to the saddle comes back to it: the orbit lies too near to a graze")
    return best


def returned(saddle: PeriodicOrbit, points: Array, backwards: bool = False) -> Array:
    """G^n of points, with the k periods taken off, or its inverse, shape (m, 2)."""
    for _ in range(int(saddle.n)):
        points = (before if backwards else model_step)(saddle.oscillator, points)
    span = saddle.period
    return np.asarray(points + np.array([span if backwards else -span, 0.0]))


def return_slope(saddle: PeriodicOrbit, state: Array) -> Array:
    """D G^n at a state, shape (2, 2); nan where there is none."""
    matrix, point = np.eye(2), state[None]
    for _ in range(int(saddle.n)):
        if not np.isfinite(point).all():
            return np.full((2, 2), np.nan)
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
