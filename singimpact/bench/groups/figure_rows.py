"""`bench figures`: what each of the paper's figures costs, computed and drawn; and a zero set beside a grid's contour.

The first time computes the curves, by kernels as a new process has them; then the numbers come from the cache.
"""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.impact_oscillator import linear
from singimpact.paper.figures import FIGURES, figure

# The zero set of a function by the contour of its values on a grid, as matplotlib draws it.


def zero_set(
    function: Callable[[Any, Any], Any], x: tuple[float, float], y: tuple[float, float], side: int
) -> list[Any]:
    """Polylines, arrays (points, 2), from side x side values."""
    from contourpy import contour_generator

    across, up = np.linspace(*x, side), np.linspace(*y, side)
    return list(contour_generator(across, up, function(*np.meshgrid(across, up))).lines(0.0))


OMEGA, CLEARANCE = 2.0, 0.7
TAU, T, PIXELS = (-1.2, 1.0), (0.2, 4.0), 800
HALF_A_POINT = 0.5 / PIXELS
SIDES = (50, 100, 200, 400, 800)
QUICK_FIGURES = (4, 6, 9, 12, 16, 17)  # one of each kind


def cases(effort: Effort) -> Iterator[Case]:
    """The zero set Z as a curve; then a case a figure."""
    methods, skipped = with_peers([_method("kernel", f"{PIXELS} points wide", _own)], partial(_contours, effort))
    places = max(len(method.run()) for method in methods)
    yield Case("zero set of x'' + x = cos 2t", methods, [1] * places, (), skipped)
    for number in QUICK_FIGURES if effort.quick else FIGURES:
        made = [Method("singimpact", "first time", partial(_whole, number), first=True)]
        if not effort.quick:
            made.append(Method("singimpact, again", "numbers kept", partial(_whole, number)))
        yield Case(f"figure {number}", made)


def _whole(number: int) -> list[None]:
    figure(number)
    return [None]


def _method(name: str, setting: str, curves: Callable[[], list[Any]]) -> Method:
    return Method(name, setting, lambda: _distances(curves()), epsilon=HALF_A_POINT / 10, problems=1)


def _own() -> list[Any]:
    from singimpact.surface.impact_surface import ImpactSurface

    surface = ImpactSurface(linear(2, "0.7", "0.5"), TAU, T, 1 / PIXELS)
    return [line.points for line in surface.lines]  # whether a flight gets there first is not asked of a contour


def _contours(effort: Effort) -> list[Method]:
    sides = SIDES[1::2] if effort.quick else SIDES
    return [_method("contour of a grid", f"{n} x {n}", partial(zero_set, _rise, TAU, T, n)) for n in sides]


def _rise(tau: Any, t: Any) -> Any:
    """x - c after t, launched at rest: closed form."""
    size = 1 / (1 - OMEGA**2)
    wave, turned = size * np.cos(OMEGA * tau), size * OMEGA * np.sin(OMEGA * tau)
    later = size * np.cos(OMEGA * (tau + t))
    return later + (CLEARANCE - wave) * np.cos(t) + turned * np.sin(t) - CLEARANCE


def _distances(curves: list[Any]) -> Any:
    """1 + how far the middles of the chords are from Z, in units of the window: its relative error from 1."""
    middles = np.concatenate([(points[1:] + points[:-1]) / 2 for points in curves])
    width, height = TAU[1] - TAU[0], T[1] - T[0]
    tau, t, h = *middles.T, 1e-6
    by_tau = (_rise(tau + h, t) - _rise(tau - h, t)) / (2 * h) * width
    by_t = (_rise(tau, t + h) - _rise(tau, t - h)) / (2 * h) * height
    return 1 + np.abs(_rise(tau, t)) / np.hypot(by_tau, by_t)
