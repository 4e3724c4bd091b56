"""An orbit in three panels: x(t) of its last periods, their phase portrait, and all velocities after impacts."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.dynamics.orbit import Orbit
from singimpact.scenes.orbit_picture import STYLE, OrbitStyle, draw_orbit, shown_end

SIZE = (9.6, 6.2)
"""Inches."""
PERIODS, IMPACTS = 6.0, 24
"""How much of the end of an orbit is shown: periods of the forcing, or impacts where it has none."""
SAMPLES = 4000
"""States of the phase portrait."""
LEAST = 1e-12
"""Velocities below this part of the largest one are drawn there."""


def orbit_sheet(orbit: Orbit, style: OrbitStyle = STYLE) -> Any:
    """The figure of an orbit with its three panels.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> figure = orbit_sheet(linear(2, "0.3", "0.5").orbit("1.2", "0.3", impacts=60))
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['time $t$', 'displacement $x$', 'time $t$']
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, dpi=150, layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2.0, 1.0))
    since = _since(orbit)
    motion = draw_orbit(orbit, figure.add_subplot(grid[0, 0]), style, since)
    whole = since <= orbit.tau[0]
    motion.set_title("displacement" if whole else f"displacement, from t = {since:.6g}", fontsize="medium")
    motion.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3, frameon=False, fontsize="small")
    _portrait(orbit, figure.add_subplot(grid[0, 1]), since, style)
    _velocities(orbit, figure.add_subplot(grid[1, :]), style, None if whole else since)
    return figure


def _since(orbit: Orbit) -> float:
    """Where the last part begins: at an event, so that no flight is cut."""
    first, last = float(orbit.tau[0]), shown_end(orbit, STYLE)
    if orbit.oscillator.period is None:
        return float(orbit.tau[max(orbit.tau.size - IMPACTS, 0)])
    wanted = last - PERIODS * as_float(orbit.oscillator.period)
    return first if wanted <= first else float(orbit.tau[np.searchsorted(orbit.tau, wanted, side="right") - 1])


def _portrait(orbit: Orbit, axes: Any, since: float, style: OrbitStyle) -> None:
    """x and x' of the last part; impacts are dashed lines along the wall."""
    wall, end = as_float(orbit.oscillator.clearance), shown_end(orbit, style)
    first = True
    for kind, start, stop in orbit.phases:
        if kind not in ("flight", "no_return") or stop <= since or start >= end:
            continue
        stop = min(stop, end)
        inside = np.linspace(start, stop, max(style.fewest, int(SAMPLES * (stop - start) / (end - since))))
        inside[-1] = np.nextafter(stop, start)  # before the impact, not after it
        places = orbit.sample(inside)
        axes.plot(places.x, places.xdot, color=style.flight, linewidth=0.9)
    hits = np.flatnonzero((orbit.kind == "impact") & (orbit.tau >= since))
    for index in hits.tolist():
        after = float(orbit.v[index])
        before = float(orbit.sample([np.nextafter(orbit.tau[index], -np.inf)]).xdot[0])
        axes.plot(
            [wall, wall],
            [before, after],
            color=style.rest,
            linewidth=1.4,
            linestyle=(0, (3, 2)),
            label="impact" if first else None,
            zorder=4,
        )
        first = False
    axes.axvline(wall, color=style.obstacle, linewidth=0.8)
    axes.set(xlabel="displacement $x$", ylabel=r"velocity $\dot x$")
    axes.set_title("phase portrait", fontsize="medium")
    if not first:
        axes.legend(loc="upper right", frameon=False, fontsize="small")


def _velocities(orbit: Orbit, axes: Any, style: OrbitStyle, since: float | None) -> None:
    """The velocity after every impact over time, logarithmic: a chatter is a row of points that falls."""
    hits = orbit.kind == "impact"
    largest = float(orbit.v[hits].max()) if hits.any() else 1.0
    speeds = np.maximum(orbit.v[hits], LEAST * largest)
    size = 4.0 if hits.sum() <= style.many else 1.8
    axes.plot(
        orbit.tau[hits],
        speeds,
        "o",
        color=style.flight,
        markersize=size,
        markeredgewidth=0,
        label="impact",
        rasterized=bool(hits.sum() > 5000),
    )
    end = shown_end(orbit, style)
    low = float(speeds.min()) / 3 if hits.any() else LEAST
    label: str | None = "at rest on the wall"
    for kind, start, stop in orbit.phases:
        if kind == "sticking":
            axes.plot(
                [start, min(stop, end)], [low, low], color=style.rest, linewidth=5, solid_capstyle="butt", label=label
            )
            label = None
    if since is not None:
        axes.axvspan(since, end, color="0.92", zorder=0, label="part shown above")
    axes.set_yscale("log")
    axes.set(xlabel="time $t$", ylabel="velocity $v$ after an impact", xlim=(orbit.tau[0], end))
    axes.set_title("all impacts", fontsize="medium")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3, frameon=False, fontsize="small")
