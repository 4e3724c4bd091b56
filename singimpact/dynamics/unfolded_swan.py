"""The named points of an unfolded swan, of any model: on V', their images under p and phi, and where orbits lead.

A < B are the two zeros of a_c that the swan has opened into.  Between them a_c < 0 at a positive swan, > 0 at a
negative one.  The letters are those of section 6.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.algebra.solving import halved
from singimpact.contact.points import tangency_points
from singimpact.dynamics.chatter import chatter_limit
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.flights.rebound_law import rebound
from singimpact.inputs import InputError, need
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.result import Result
from singimpact.status import Status
from singimpact.surface.impact_surface import Cusp, ImpactSurface, crossing
from singimpact.surface.rest_flights import RestFlights

Point = tuple[float, float]
REACH_TAU, REACH_T = 4.0, 6.0  # of the picture, in half distances of A and B: the unfolded swan fits


@dataclass(frozen=True)
class SwanConfiguration(Result):
    """An unfolded swan.

    Attributes
    ----------
    model : the oscillator. A, B : times of the two tangency points. kind : "positive" or "negative".
    """

    model: Oscillator
    A: float
    B: float
    kind: str

    @cached_property
    def surface(self) -> ImpactSurface:
        """V' in a window that holds the configuration."""
        middle, half = (self.A + self.B) / 2, (self.B - self.A) / 2
        tau = (middle - REACH_TAU * half, middle + REACH_TAU * half)
        return ImpactSurface(self.model, tau, (-REACH_T * half, REACH_T * half))

    @cached_property
    def points(self) -> dict[str, Point]:
        """A, B, C, D, E on V' as (tau, t) [s6-points]."""
        ahead, back = self._cusp(self.A, 1), self._cusp(self.B, -1)
        return {"A": (self.A, 0.0), "B": (self.B, 0.0), "C": (ahead.tau, ahead.t), "D": back.of_p, "E": self._bitangent}

    def _cusp(self, tau: float, side: int) -> Cusp:
        """The first crossing ahead of (behind) the flight from rest at a tangency point."""
        near = 1e-9 * (self.B - self.A)
        found = [cusp for cusp in self.surface.cusps if abs(cusp.tau - tau) < near and cusp.t * side > 0]
        if not found:
            raise InputError(f"the flight from rest at tau = {tau:.9g} does not cross c again near the swan")
        return min(found, key=lambda cusp: abs(cusp.t))

    @cached_property
    def _bitangent(self) -> Point:
        """The flight from rest to rest, launched before A."""
        at = [tuple(place) for curve in self.surface.zero_set for place in curve.marked("rest") if place[1] > 0]
        need(at, InputError("no flight near the swan starts and ends at rest"))
        tau, t = min(at, key=lambda place: float(place[1]))
        return float(tau), float(t)

    @cached_property
    def projected(self) -> dict[str, Point]:
        """A', B', C', D', E': the images (tau, v) under p."""
        # v_c: those on Z start at rest
        return {
            name: (tau, 0.0 if self._is_one_of("ABCE", tau, t) else self._speed(tau + t, -t))
            for name, (tau, t) in self.points.items()
        }

    @cached_property
    def reset(self) -> dict[str, Point]:
        """A'', B'', C'', D'', E'': the images (tau, x') under phi."""
        # x': those on H end at rest
        return {
            name: (tau + t, 0.0 if self._is_one_of("ABDE", tau, t) else self._speed(tau, t))
            for name, (tau, t) in self.points.items()
        }

    def _is_one_of(self, names: str, tau: float, t: float) -> bool:
        """Whether a point of V' is one of the named ones."""
        return any(np.isclose([tau, t], self.points[name], rtol=0, atol=1e-12).all() for name in names)

    def _speed(self, tau: float, t: float) -> float:
        return float(RestFlights(self.model).ends(np.array([tau]), np.array([t]))[1][0])

    @cached_property
    def Q(self) -> Point:
        """G(A) = R(C''), where the stable manifold through A meets the arc R(D''C'')."""
        tau, velocity = self.reset["C"]
        return tau, float(rebound(self.model, np.array(velocity)))

    @cached_property
    def X(self) -> float:
        """tau_3: where chatter from A comes to rest; W^s(X) contains A (negative swan)."""
        return float(chatter_limit(self.model, *self.Q).tau)

    @cached_property
    def gamma_end(self) -> float:
        """Where gamma, which leaves B, meets Pi_0 again, between E' and A (positive swan)."""
        low, high = halved(lambda tau: not self._completes(tau), self.points["E"][0], self.A)
        return (low + high) / 2

    def _completes(self, tau: float) -> bool:
        """Whether the orbit from rest at tau comes to rest before B."""
        (state,) = model_step(self.model, np.array([[tau, 0.0]]))
        if not np.isfinite(state).all():
            return False
        limit = chatter_limit(self.model, *state.tolist())
        return bool(limit.status == Status.complete and limit.tau <= self.B)

    @cached_property
    def N(self) -> Point:
        """Where the arc R(phi(AE)) ends on the outline (positive swan)."""
        flights = RestFlights(self.model)
        length = self.B - self.A

        def landed(tau: float, t: float) -> tuple[float, float, float]:
            at = crossing(flights, tau, t)
            return (np.nan,) * 3 if at is None else (tau + at[0], at[1], at[0])

        start = self._first_guess()

        def miss(unknown: Array) -> Array:
            phase, speed, _ = landed(unknown[0], start[1])
            launch, velocity, _ = landed(unknown[1], start[3])
            return np.array([(phase - launch) / length, float(rebound(self.model, np.array(speed))) - velocity])

        root = _zero(miss, np.array([start[0], start[2]]), length)
        phase, speed, _ = landed(root[0], start[1])
        return phase, float(rebound(self.model, np.array(speed)))

    def _first_guess(self) -> tuple[float, float, float, float]:
        """(tau, t) on the arc AE of Z and on the mirror image of BE, where their images nearly meet."""
        (curve,) = [c for c in self.surface.zero_set if len(c.marked("tangency")) == 2]
        (outline,) = [c for c in self.surface.outline if len(c.marked("tangency")) == 2]
        tau, t = curve.points.T
        ahead = (tau < self.A) & (t > 0) & (tau > self.points["E"][0])
        behind = (t < 0) & (outline.points[:, 1] > 0)
        images = outline.points[ahead].copy()
        images[:, 1] = rebound(self.model, images[:, 1])
        gaps = np.hypot(*((images[:, None] - outline.points[behind][None]) / np.ptp(images, axis=0)).transpose(2, 0, 1))
        inner = np.abs(images[:, 0] - self.A) > 0.05 * (self.B - self.A)
        gaps[~inner] = np.inf
        i, j = np.unravel_index(int(np.argmin(gaps)), gaps.shape)
        first, second = curve.points[ahead][i], curve.points[behind][j]
        return float(first[0]), float(first[1]), float(second[0]), float(second[1])


def _zero(miss: Callable[[Array], Array], root: Array, size: float) -> Array:
    """Newton's method in two unknowns, with differences over a millionth of `size`: each step gains six digits."""
    h = 1e-6 * size
    for _ in range(20):
        value = miss(root)
        slopes = np.stack([(miss(root + step) - value) / h for step in h * np.eye(2)], axis=1)
        move = np.linalg.solve(slopes, -value)
        root = root + move
        if not np.abs(move).max() > 4e-16 * (size + np.abs(root).max()):
            break
    return root


def swan_configuration(model: Oscillator, near: Any = None) -> SwanConfiguration:
    """The unfolded swan of a model: its two nearest tangency points, or those around `near`.

    Parameters
    ----------
    near : a time between A and B, or beside them.

    Raises
    ------
    InputError : fewer than two tangency points.

    Examples
    --------
    >>> swan = swan_configuration(Oscillator("0", "-12*(t**2 - 1)", 0, "1/2"))
    >>> swan.kind, [round(value, 9) for value in swan.projected["D"]]
    ('negative', [-3.0, 64.0])
    """
    require_model("model", model)
    points = [(point.tau, point.kind) for point in tangency_points(model) if point.kind != "degenerate"]
    if model.period is not None:
        period = as_float(model.period)
        points = [(tau + n * period, kind) for n in (-1, 0, 1) for tau, kind in points]
    points.sort()
    pairs = list(pairwise(points))
    need(pairs, InputError("a_c of this model has fewer than two tangency points: there is no unfolded swan"))
    centre = None if near is None else as_float(constant("near", near))

    def distance(pair: Any) -> float:
        (left, _), (right, _) = pair
        return float(right - left if centre is None else abs(left + right - 2 * centre))

    (A, first), (B, _) = min(pairs, key=distance)
    return SwanConfiguration(model, A, B, "negative" if first == "gamma" else "positive")
