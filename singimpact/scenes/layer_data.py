"""The data of layers: each list of curves (a need) is computed once, at its first use, or read from the cache.

The inputs of a need are needs too, so a further layer costs only what is new.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from singimpact import cache
from singimpact.dynamics.invariant_arcs import gammas_within, stable_manifold
from singimpact.dynamics.orbit import orbit
from singimpact.flights.results import counted
from singimpact.oscillator import Oscillator, acceleration
from singimpact.status import Wall
from singimpact.store import cache_folder
from singimpact.surface import STATES, Curve, ImpactSurface, Mark, Window

# Needs that are read from the cache; the rest costs no flight.
STORED = ("lines", "beyond", "cut", "visible", "shadow", "gamma", "stable-manifolds", "foliation", "orbits")


class Shown(NamedTuple):
    """Values that the layers of a scene are computed from; `times`, `speeds` : the windows of t and v."""

    osc: Oscillator  # its lower wall is shown
    tau: tuple[float, float]
    times: tuple[float, float]
    speeds: tuple[float, float]
    pixels: int
    feet: tuple[Any, ...]
    leaves: int
    orbits: tuple[tuple[Any, Any], ...]
    impacts: int

    def depends(self, need: str) -> tuple[Any, ...]:
        """The values that the curves of a need depend on; a cached result is used where all are equal."""
        more = {
            "gamma": (self.speeds,),
            "stable-manifolds": (self.speeds, list(map(str, self.feet))),
            "foliation": (self.speeds, self.leaves),
            "orbits": ([list(map(str, state)) for state in self.orbits], self.impacts),
        }
        return (self.osc.to_dict(), self.tau, self.pixels, *more.get(need, (self.times,)))


class Results:
    """The needs of a scene, each evaluated once.

    Attributes
    ----------
    flights : computed for each need. seconds : spent on each, without those that it is computed from.
    cached : needs taken from disk.
    """

    def __init__(self, scene: Shown) -> None:
        self.scene, self.found = scene, dict[str, list[Curve]]()
        self.flights, self.seconds, self.cached = dict[str, int](), dict[str, float](), list[str]()

    def get(self, need: str) -> list[Curve]:
        """The curves of a need."""
        if need not in self.found:
            key = key_of(need, *self.scene.depends(need))
            stored = recall(key) if need in STORED else None
            if stored is not None:
                self.found[need] = stored
                self.cached.append(need)
            else:
                self.found[need] = self._computed(need)
                if need in STORED:
                    keep(key, self.found[need])
        return self.found[need]

    def _computed(self, need: str) -> list[Curve]:
        compute, below = NEEDS[need]
        for name in below:
            self.get(name)
        start = perf_counter()
        with counted() as count:
            curves = compute(self)
        self.flights[need], self.seconds[need] = count.flights, perf_counter() - start
        return curves

    @cached_property
    def surface(self) -> ImpactSurface:
        """V_c' of the scene; what is known of it is not flown again."""
        scene = self.scene
        return ImpactSurface(scene.osc, scene.tau, scene.times, 1 / scene.pixels)

    @property
    def states(self) -> Window:
        """The window of the (tau, v)-plane from v = 0, where gamma and W^s begin."""
        return Window(self.scene.tau, (0.0, self.scene.speeds[1]), 1 / self.scene.pixels)


def _of_surface(name: str) -> Callable[[Results], list[Curve]]:
    def compute(results: Results) -> list[Curve]:
        shared: dict[str, list[Any]] = {"lines": results.get("lines")}
        if "visible" in results.found:
            shared["horizon"] = results.found["visible"]
        results.surface.take(**shared)
        curves: list[Curve] = getattr(results.surface, name)
        return curves

    return compute


def _with_first_hits(curves: list[Curve]) -> list[Curve]:
    return [replace(curve, first_hits=curve.visible) for curve in curves]


def _manifolds(results: Results, feet: Iterable[Any]) -> list[Curve]:
    return [curve for foot in feet for curve in stable_manifold(results.scene.osc, results.states, foot)]


def _leaves(results: Results) -> list[Curve]:
    """Stable manifolds of evenly spaced points at which a_c < 0."""
    low, high = results.scene.tau
    count = results.scene.leaves
    feet = low + (np.arange(count) + 0.5) * (high - low) / count
    return _manifolds(results, map(repr, feet[acceleration(results.scene.osc, feet) < 0].tolist()))


def _orbits(results: Results) -> list[Curve]:
    flown = [orbit(results.scene.osc, tau, v, results.scene.impacts) for tau, v in results.scene.orbits]
    made = [np.stack([np.asarray(each.tau), np.asarray(each.v)], axis=1) for each in flown]
    made = [
        points if each.wall is None else points[each.wall == Wall.lower]
        for points, each in zip(made, flown, strict=True)
    ]
    return [Curve("orbit", points, STATES) for points in made]


NEEDS: dict[str, tuple[Callable[[Results], list[Curve]], tuple[str, ...]]] = {
    "lines": (lambda results: results.surface.lines, ()),
    "zero-set": (_of_surface("zero_set"), ("lines",)),
    "horizon": (_of_surface("horizon"), ("lines",)),
    # the horizon, with its first hits flown
    "visible": (lambda results: _with_first_hits(_of_surface("horizon")(results)), ("lines",)),
    "shadow": (_of_surface("shadow"), ("lines", "visible")),
    "beyond": (lambda results: results.surface.beyond, ()),
    "cut": (lambda results: results.surface.cut, ()),
    "outline": (_of_surface("outline"), ("lines",)),
    "discontinuities": (_of_surface("discontinuities"), ("lines", "visible")),
    "gamma": (lambda results: gammas_within(results.scene.osc, results.states), ()),
    "stable-manifolds": (lambda results: _manifolds(results, results.scene.feet), ()),
    "foliation": (_leaves, ()),
    "orbits": (_orbits, ()),
}


# Curves kept in the user's cache folder, under what they depend on; arrays alone, never pickled objects.

LIBRARIES = ("numpy", "numba", "contourpy")
ABOVE = ("paper/", "documents/", "scenes/", "bench/", "cli/")  # rooms that no curve depends on


def key_of(*parts: Any) -> str:
    """A digest of texts, of the source below the pictures and of the versions of what computes.

    Examples
    --------
    >>> key_of("horizon", 1) == key_of("horizon", 1), len(key_of("horizon", 2))
    (True, 64)
    """
    return cache.key_of(parts, LIBRARIES, ABOVE)


def recall(key: str) -> list[Curve] | None:
    """The curves under a key, or None when there are none or the file is damaged."""
    content = cache.recall(_place(key))
    if content is None:
        return None
    found: list[Curve] = cache.unpacked(content, (Curve, Mark))
    return found


def keep(key: str, curves: list[Curve]) -> None:
    """Put curves on disk, with what is visible of them; a cache that cannot be written is no reason to fail."""
    cache.keep(_place(key), cache.packed(_with_first_hits(curves)))


def _place(key: str) -> Path:
    return cache_folder() / "curves" / f"{key}.curves"
