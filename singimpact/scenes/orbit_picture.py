"""x(t) of an orbit: flights, impacts, rest on the obstacle, chatter that was summed up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.dynamics.orbit import Orbit
from singimpact.dynamics.sampling import Section
from singimpact.flights.flight_path import path


@dataclass(frozen=True)
class OrbitStyle:
    """The look of an orbit. Its parts differ in shape, width and lightness, so that they differ in grey too.

    Parameters
    ----------
    points : points of a whole picture, shared out by length; a flight gets at least `fewest`.
    tail : how far a last flight without return, or a rest without end, is drawn, as a part of the time before it.
    many : above this number of impacts, or of states of a section, their marks get small.
    """

    flight: str = "#0072B2"
    rest: str = "#D55E00"
    obstacle: str = "#4D4D4D"
    points: int = 4000
    fewest: int = 24
    tail: float = 0.15
    many: int = 40


STYLE = OrbitStyle()


def draw_orbit(orbit: Orbit, axes: Any, style: OrbitStyle = STYLE, since: float | None = None) -> Any:
    """Draw x(t) of an orbit on axes, or of its part from a time on."""
    clearance = as_float(orbit.oscillator.clearance)
    begin, end = float(orbit.tau[0]) if since is None else since, shown_end(orbit, style)
    times, places = _curve(orbit, (begin, end), style)
    axes.plot(times, places, color=style.flight, linewidth=1.1, label="flight $x(t)$", zorder=3)
    axes.axhline(clearance, color=style.obstacle, linewidth=0.8, label="wall $x = c$", zorder=1)
    _marks(orbit, axes, clearance, begin, style)
    _rests(orbit, axes, clearance, (begin, end), style)
    axes.set_xlabel("time $t$")
    axes.set_ylabel("displacement $x$")
    axes.set_xlim(begin, end)
    high = axes.get_ylim()[1]
    axes.set_ylim(clearance - 0.12 * (high - clearance), high)
    axes.axhspan(axes.get_ylim()[0], clearance, facecolor="0.92", hatch="////", edgecolor="0.75", linewidth=0, zorder=0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize="small")
    return axes


def draw_section(section: Section, axes: Any, style: OrbitStyle = STYLE) -> Any:
    """Draw the states of a section in the plane of x and x'."""
    size = 4.0 if section.t.size <= style.many else 1.2
    axes.plot(section.x, section.xdot, "o", color=style.flight, markersize=size, markeredgewidth=0, rasterized=True)
    axes.set_xlabel("displacement $x$")
    axes.set_ylabel("velocity $\\dot x$")
    return axes


def shown_end(orbit: Orbit, style: OrbitStyle) -> float:
    """The right edge: the last event, and a tail if a flight or a rest follows it."""
    first, last = float(orbit.tau[0]), float(orbit.tau[-1])
    open_ended = bool(orbit.phases) and not orbit.phases[-1][2] <= last
    period = orbit.oscillator.period
    usual = as_float(period) if period is not None else 1.0
    if not open_ended:
        return last if last > first else first + usual
    return last + max(style.tail * (last - first), 0.25 * usual)


def _curve(orbit: Orbit, ends: tuple[float, float], style: OrbitStyle) -> tuple[Any, Any]:
    times: list[Any] = []
    places: list[Any] = []
    speed = dict(zip(orbit.tau.tolist(), orbit.v.tolist(), strict=True))
    for kind, start, stop in orbit.phases:
        if kind not in ("flight", "no_return") or stop <= ends[0]:
            continue
        stop = min(stop, ends[1])
        count = max(style.fewest, int(style.points * (stop - start) / (ends[1] - ends[0])))
        inside = np.linspace(0.0, stop - start, count)
        times += [start + inside, [np.nan]]
        off_wall = orbit.height > 0 and start == orbit.tau[0]
        flight = orbit.sample(start + inside) if off_wall else path(orbit.oscillator, start, speed[start], inside)
        places += [flight.x, [np.nan]]
    return (np.concatenate(times), np.concatenate(places)) if times else ([], [])


def _marks(orbit: Orbit, axes: Any, clearance: float, begin: float, style: OrbitStyle) -> None:
    looks = {
        "impact": ("o", "impact", "white"),
        "graze": ("^", "graze", "white"),
        "complete": ("X", "end of chatter (summed)", style.rest),
        "release": (">", "lifts off", style.rest),
    }
    for kind, (marker, label, face) in looks.items():
        times = orbit.tau[(orbit.kind == kind) & (orbit.tau >= begin)]
        if not times.size:
            continue
        small = kind == "impact" and times.size > style.many
        axes.plot(
            times,
            np.full(times.size, clearance),
            linestyle="none",
            marker=marker,
            label=label,
            zorder=5,
            markersize=2.5 if small else 5.5,
            markerfacecolor=face,
            markeredgecolor="black",
            markeredgewidth=0.4 if small else 0.8,
            clip_on=False,
        )


def _rests(orbit: Orbit, axes: Any, clearance: float, ends: tuple[float, float], style: OrbitStyle) -> None:
    label: str | None = "at rest on the wall"
    for kind, start, stop in orbit.phases:
        if kind == "sticking" and stop > ends[0]:
            axes.plot(
                [start, min(stop, ends[1])],
                [clearance, clearance],
                color=style.rest,
                linewidth=4.0,
                label=label,
                solid_capstyle="butt",
                zorder=4,
            )
            label = None
