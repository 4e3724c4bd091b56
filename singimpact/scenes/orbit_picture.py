"""x(t) of an orbit: flights, impacts, rest on the obstacle, chatter that was summed up; and a sheet of three panels."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path as FilePath
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.dynamics.orbit import Orbit, orbit as flown
from singimpact.dynamics.sampling import Section
from singimpact.flights.flight_path import path
from singimpact.inputs import InputError, checked_keywords, refuse, whole
from singimpact.store import written
from singimpact.studies import interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL import Image


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


def draw_periodic(orbit: PeriodicOrbit, axes: Axes) -> Axes:
    """Draw x(t) of a periodic orbit from its first impact on, over its k periods."""
    if orbit.kind == "free" or not orbit.visible:
        raise refuse("orbit to plot", orbit, "a periodic orbit with impacts that is visible")
    impacts = IMPACTS if orbit.kind == "chatter" else int(orbit.n)
    draw_orbit(flown(orbit.oscillator, orbit.tau[0], orbit.v[0], impacts), axes)
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


# The sheet: x(t) of the last periods, their phase portrait, and all velocities after impacts.

SIZE = (9.6, 6.2)
"""Inches."""
PERIODS, IMPACTS = 6.0, 24
"""How much of the end of an orbit is shown: periods of the forcing, or impacts where it has none."""
SAMPLES = 4000
"""States of the phase portrait."""
LEAST = 1e-12
"""Velocities below this part of the largest one are drawn there."""


def orbit_sheet(orbit: Orbit, style: OrbitStyle = STYLE, figure: Figure | None = None) -> Figure:
    """The figure of an orbit with its three panels, a new one or an empty one that is given.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> figure = orbit_sheet(linear(2, "0.3", "0.5").orbit("1.2", "0.3", impacts=60))
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['time $t$', 'displacement $x$', 'time $t$']
    """
    from matplotlib.figure import Figure

    figure = figure or Figure(figsize=SIZE, dpi=150, layout="constrained")
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


# The mass that bounces, beside its x(t).

BLOCK = ((-1, 0), (1, 0), (1, 2), (-1, 2), (-1, 0))
"""The marker of the mass, which stands on its place."""


@dataclass(frozen=True, eq=False)
class OrbitAnimation:
    """The moving mass of an orbit; a notebook plays it.

    Parameters
    ----------
    figure : without what moves. show : puts what moves to its place in a picture, by number, and returns it.
    frames : pictures. rate : of them a second.
    """

    figure: Any
    show: Callable[[int], Sequence[Any]]
    frames: int
    rate: int = 30

    def save(self, path: str | FilePath) -> None:
        """Write it to a .gif, an .html page that plays without a network, or an .mp4, which needs ffmpeg.

        Raises
        ------
        InputError : another ending, or ffmpeg is not there.
        """
        ending = FilePath(path).suffix.lower()
        if ending not in (".gif", ".html", ".mp4"):
            raise refuse("path", path, "a file name ending in .gif, .html or .mp4")
        content = self._mp4(path) if ending == ".mp4" else self._gif()
        if ending == ".html":
            content = f"<!DOCTYPE html><meta charset='utf-8'>{self._repr_html_()}".encode()
        with written(path) as draft:
            draft.write_bytes(content)

    def _repr_html_(self) -> str:
        return f'<img alt="an orbit, moving" src="data:image/gif;base64,{b64encode(self._gif()).decode()}">'

    def _pictures(self) -> Iterator[Image.Image]:
        """The pictures; what does not move is drawn once."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from PIL import Image

        canvas: Any = FigureCanvasAgg(self.figure)
        for artist in self.show(0):
            artist.set_animated(True)
        canvas.draw()
        still = canvas.copy_from_bbox(self.figure.bbox)
        for at in range(self.frames):
            canvas.restore_region(still)
            for artist in self.show(at):
                artist.axes.draw_artist(artist)
            picture = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
            yield picture.quantize(32, dither=Image.Dither.NONE)

    def _gif(self) -> bytes:
        first, *others = self._pictures()
        stream = BytesIO()
        # a GIF counts hundredths of a second
        first.save(stream, "GIF", save_all=True, append_images=others, duration=round(1000 / self.rate, -1), loop=0)
        return stream.getvalue()

    def _mp4(self, path: str | FilePath) -> bytes:
        from matplotlib.animation import FFMpegWriter, FuncAnimation

        if not FFMpegWriter.isAvailable():
            raise InputError(f"{path} needs the program ffmpeg, which is not found: install it, or give .gif or .html")
        for artist in self.show(0):
            artist.set_animated(False)  # or it is left out of a film that is saved after a GIF
        with TemporaryDirectory() as folder:
            film = FuncAnimation(self.figure, self.show, frames=self.frames)
            film.save(FilePath(folder) / "film.mp4", writer=FFMpegWriter(fps=self.rate))
            return (FilePath(folder) / "film.mp4").read_bytes()


@checked_keywords
def animate(orbit: Orbit, between: tuple[float, float] | None = None, frames: int = 300) -> OrbitAnimation:
    """The bouncing mass of an orbit beside its x(t).

    Parameters
    ----------
    orbit : of `osc.orbit`. between : times of the first and the last picture; without it the last six periods, or the
        last impacts where the forcing has none. frames : pictures, from 2 to 10000, thirty a second.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> animate(linear(2, "0.3", "0.5").orbit("1.2", "0.3", impacts=60), frames=30).save("bounce.gif")  # doctest: +SKIP
    """
    from matplotlib.figure import Figure

    if not isinstance(orbit, Orbit):
        raise refuse("orbit", type(orbit).__name__, "an orbit of `osc.orbit`")
    first, last = float(orbit.tau[0]), max(shown_end(orbit, STYLE), orbit.end)
    begin, end = (_since(orbit), shown_end(orbit, STYLE)) if between is None else map(float, interval(between))
    if not first <= begin < end <= last:
        raise refuse("between", between, f"two times from {first:.6g} to {last:.6g}")
    times = np.linspace(begin, end, whole("frames", frames, 2, 10_000))
    heights, wall = orbit.sample(times).x, as_float(orbit.oscillator.clearance)
    figure = Figure(figsize=(7.2, 3.2), dpi=80, layout="constrained")
    still, moving = figure.subplots(1, 2, sharey=True, width_ratios=(1, 4))
    draw_orbit(orbit, moving, since=begin).get_legend().remove()
    moving.set(xlim=(begin, end), ylabel="")
    for line in moving.lines:
        line.set_clip_on(True)  # marks of impacts that are not among the pictures
    still.set(xlim=(-1, 1), xticks=[], ylabel="displacement $x$")
    still.axhspan(still.get_ylim()[0], wall, facecolor="0.92", hatch="////", edgecolor="0.75", linewidth=0)
    (mass,) = still.plot([0], [heights[0]], marker=BLOCK, color=STYLE.flight, markersize=32)
    (point,) = moving.plot([begin], [heights[0]], "o", color=STYLE.rest, markersize=6, zorder=6)

    def show(at: int) -> tuple[Any, Any]:
        mass.set_ydata([heights[at]])
        point.set_data([times[at]], [heights[at]])
        return mass, point

    return OrbitAnimation(figure, show, times.size)
