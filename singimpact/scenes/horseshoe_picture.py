"""A picture of a certified horseshoe: the set round the saddle, and the images that cross it."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.branches.horseshoe import CrossedSet, Horseshoe
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.scenes.style import BLACK, BLUE, DASHES, GREEN, ORANGE

Array = np.ndarray[Any, Any]
SIDE = 60  # points of each side of a set


def draw_horseshoe(horseshoe: Horseshoe, axes: Any) -> Any:
    """Draw N and B_1 with the image of N, which crosses both, and that of the last set, which crosses N.

    Parameters
    ----------
    axes : of matplotlib. Lengths are relative to N, along the directions in which the map stretches and contracts.
    """
    home, first, last = horseshoe.sets[0], horseshoe.sets[1], horseshoe.sets[-1]
    short = horseshoe.loops[0]
    looks = [
        (_seen(_image(horseshoe, home, short), home, horseshoe), ORANGE, "solid", "image of $N$"),
        (
            _seen(_image(horseshoe, last, 1), home, horseshoe),
            BLUE,
            DASHES,
            f"image of $B_{{{len(horseshoe.sets) - 1}}}$",
        ),
        (_seen(_outline(first), home, horseshoe), GREEN, "solid", "$B_1$, the first set of the long loop"),
        (_seen(_outline(home), home, horseshoe), BLACK, "solid", "$N$, round the saddle"),
    ]
    for points, color, style, words in looks:
        axes.fill(*points.T, color=color, alpha=0.12, linewidth=0)
        axes.plot(*points.T, color=color, linestyle=style, linewidth=1.4, label=words)
    axes.plot(0, 0, "s", color=BLACK, markerfacecolor="white", markersize=6, label="saddle")
    reach = 1.1 * float(np.abs(looks[0][0][:, 0]).max())
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-1.3, 1.3)
    digits, power = f"{float(home.radii[0]):.1e}".split("e")
    axes.set_xlabel(f"along $W^u$, in half widths of $N$, ${digits}\\cdot10^{{{int(power)}}}$")
    axes.set_ylabel("along $W^s$")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3, frameon=False, fontsize="small")
    return axes


def _outline(one: CrossedSet) -> Array:
    corners = np.vstack([one.corners, one.corners[:1]])
    share = np.linspace(0, 1, SIDE)[:, None]
    return np.vstack([a + share * (b - a) for a, b in pairwise(corners)])


def _image(found: Horseshoe, one: CrossedSet, impacts: int) -> Array:
    points = _outline(one)
    for _ in range(impacts):
        points = model_step(found.oscillator, points)
    return points


def _seen(points: Array, home: CrossedSet, found: Horseshoe) -> Array:
    """States in the coordinates of N."""
    assert found.oscillator.period is not None
    period = as_float(found.oscillator.period)
    away = points - [float(part) for part in home.centre]
    away[:, 0] -= period * np.rint(away[:, 0].mean() / period)
    frame = np.array([[float(part) for part in row] for row in home.frame])
    return np.asarray(np.linalg.solve(frame, away.T).T / [float(part) for part in home.radii])
