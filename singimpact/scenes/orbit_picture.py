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

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.dynamics import Fit, ReleaseMap
from singimpact.dynamics.orbit import Orbit, Section, orbit as flown
from singimpact.flights.flight_path import path
from singimpact.inputs import InputError, checked_keywords, refuse, require, takes_two_walls, whole
from singimpact.scenes.label_places import legend_below, legend_entries
from singimpact.scenes.style import BLACK, BLUE, GREY, HATCH, SHORT_DASHES, VERMILLION, WALL, WHITE
from singimpact.store import written
from singimpact.studies import interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL import Image


# Points of a flight at least; above this number of impacts, or of states of a section, their marks get small
FEWEST, MANY = 24, 40


def draw_orbit(orbit: Orbit, axes: Axes, since: float | None = None) -> Axes:
    """Draw x(t) of an orbit on axes, or of its part from a time on."""
    clearance = as_float(orbit.oscillator.clearance)
    begin, end = float(orbit.tau[0]) if since is None else since, shown_end(orbit)
    times, places = _curve(orbit, (begin, end))
    axes.plot(times, places, color=BLUE, linewidth=1.1, label="flight $x(t)$", zorder=3)
    axes.axhline(clearance, color=GREY, linewidth=0.8, label="wall $x = c$", zorder=1)
    _marks(orbit, axes, begin)
    _rests(orbit, axes, orbit.places, (begin, end), 4.0)
    axes.set(xlabel="time $t$", ylabel="displacement $x$", xlim=(begin, end))
    top = axes.get_ylim()[1] if orbit.oscillator.upper is None else as_float(orbit.oscillator.upper)
    margin = 0.12 * (top - clearance)
    axes.set_ylim(clearance - margin, top if orbit.oscillator.upper is None else top + margin)
    _walls(orbit, axes)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize="small")
    return axes


def _walls(orbit: Orbit, axes: Axes) -> None:
    low, high = axes.get_ylim()
    behind = [(low, as_float(orbit.oscillator.clearance))]
    if orbit.oscillator.upper is not None:
        behind.append((as_float(orbit.oscillator.upper), high))
    for begin, end in behind:
        axes.axhspan(begin, end, facecolor=WALL, hatch="////", edgecolor=HATCH, linewidth=0, zorder=0)


def draw_periodic(orbit: PeriodicOrbit, axes: Axes) -> Axes:
    """Draw x(t) of a periodic orbit from its first impact on, over its k periods."""
    if orbit.kind == "free" or not orbit.visible:
        raise refuse("orbit to plot", orbit, "a periodic orbit with impacts that is visible")
    impacts = IMPACTS if orbit.kind == "chatter" else int(orbit.n)
    wall = None if orbit.wall is None else int(orbit.wall[0])
    return draw_orbit(flown(orbit.oscillator, orbit.tau[0], orbit.v[0], impacts, wall=wall), axes)


def draw_section(section: Section, axes: Axes) -> Axes:
    """Draw the states of a section in the plane of x and x'."""
    size = 4.0 if section.t.size <= MANY else 1.2
    axes.plot(section.x, section.xdot, "o", color=BLUE, markersize=size, markeredgewidth=0, rasterized=True)
    axes.set(xlabel="displacement $x$", ylabel="velocity $\\dot x$")
    return axes


def draw_fit(result: Fit, axes: Axes) -> Axes:
    """Draw what was measured less the orbit that was fitted, in standard deviations of the noise."""
    axes.axhspan(-2, 2, color=GREY, alpha=0.2, linewidth=0, label="95 % of normal noise")
    words = {"tau": "times", "v": "velocities", "x": "places"}
    for (name, size), off, color in zip(result.noise.items(), result.residuals.T, (BLUE, VERMILLION), strict=False):
        axes.plot(result.t, off / size, ".", color=color, label=words[name])
    axes.set(xlabel="time $t$", ylabel="residual, in standard deviations")
    return legend_below(axes, legend_entries(axes))


def draw_release_map(releases: ReleaseMap, axes: Axes) -> Axes:
    """Draw the map of release phases, its flat pieces in another colour, and the diagonal."""
    period = releases.period
    start, phase, flat = (np.ravel(column) for column in (releases.start, releases.phase, releases.flat))
    axes.plot([0, period], [0, period], color=GREY, linewidth=0.8, label="diagonal", zorder=1)
    for where, color, label in ((~flat, BLUE, "leaves at once"), (flat, VERMILLION, "rests: flat")):
        axes.plot(np.mod(start[where], period), phase[where], ".", color=color, markersize=2.5, label=label)
    axes.set(xlabel=r"release phase $\tau$", ylabel="next release phase", xlim=(0, period), ylim=(0, period))
    return legend_below(axes, legend_entries(axes))


def shown_end(orbit: Orbit) -> float:
    """The right edge: the last event, and a tail if a flight or a rest follows it."""
    first, last = float(orbit.tau[0]), float(orbit.tau[-1])
    open_ended = bool(orbit.phases) and not orbit.phases[-1][2] <= last
    period = orbit.oscillator.period
    usual = as_float(period) if period is not None else 1.0
    if not open_ended:
        return last if last > first else first + usual
    # a last flight without return, or a rest without end, is drawn for a part of the time before it
    return last + max(0.15 * (last - first), 0.25 * usual)


def _curve(orbit: Orbit, ends: tuple[float, float]) -> tuple[Any, Any]:
    times, places = list[Any](), list[Any]()
    speed = dict(zip(orbit.tau.tolist(), orbit.v.tolist(), strict=True))
    for kind, start, stop in orbit.phases:
        if kind not in ("flight", "no_return") or stop <= ends[0]:
            continue
        stop = min(stop, ends[1])
        # the points of a picture are shared out by length
        count = max(FEWEST, int(4000 * (stop - start) / (ends[1] - ends[0])))
        inside = np.linspace(0.0, stop - start, count)
        times += [start + inside, [np.nan]]
        off_wall = (orbit.height > 0 and start == orbit.tau[0]) or orbit.wall is not None
        flight = orbit.sample(start + inside) if off_wall else path(orbit.oscillator, start, speed[start], inside)
        places += [flight.x, [np.nan]]
    return (np.concatenate(times), np.concatenate(places)) if times else ([], [])


def _marks(orbit: Orbit, axes: Axes, begin: float) -> None:
    looks = {
        "impact": ("o", "impact", WHITE),
        "graze": ("^", "graze", WHITE),
        "complete": ("X", "end of chatter (summed)", VERMILLION),
        "release": (">", "lifts off", VERMILLION),
    }
    for kind, (marker, label, face) in looks.items():
        chosen = (orbit.kind == kind) & (orbit.tau >= begin)
        times = orbit.tau[chosen]
        if not times.size:
            continue
        small = kind == "impact" and times.size > MANY
        axes.plot(
            times,
            orbit.places[chosen],
            linestyle="none",
            marker=marker,
            label=label,
            zorder=5,
            markersize=2.5 if small else 5.5,
            markerfacecolor=face,
            markeredgecolor=BLACK,
            markeredgewidth=0.4 if small else 0.8,
            clip_on=False,
        )


def _rests(orbit: Orbit, axes: Axes, heights: Any, ends: tuple[float, float], width: float) -> None:
    """Bars while the mass is at rest, at the height of the event before."""
    label: str | None = "at rest on the wall"
    for (kind, start, stop), height in zip(orbit.phases, heights.tolist(), strict=False):
        if kind == "sticking" and stop > ends[0]:
            rest, level = (start, min(stop, ends[1])), (height, height)
            axes.plot(rest, level, color=VERMILLION, linewidth=width, label=label, solid_capstyle="butt", zorder=4)
            label = None


# The sheet: x(t) of the last periods, their phase portrait, all velocities after impacts, and the first chatter.

SIZE = (9.6, 6.2)  # inches
PERIODS, IMPACTS = 6.0, 24  # that are shown of the end of an orbit; impacts where the forcing has no period
SAMPLES = 4000  # states of the phase portrait, and of the first chatter
LEAST = 1e-12  # velocities below this part of the largest one are drawn there


def orbit_sheet(orbit: Orbit, figure: Figure | None = None) -> Figure:
    """The figure of an orbit, a new one or an empty one that is given; a first chatter has a panel of its own.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> figure = orbit_sheet(linear(2, "0.3", "0.5").orbit("1.2", "0.3", impacts=60))
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['time $t$', 'displacement $x$', 'time $t$', 'time before its end']
    """
    from matplotlib.figure import Figure

    figure = figure or Figure(figsize=SIZE, dpi=150, layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2.0, 1.0))
    since = _since(orbit)
    motion = draw_orbit(orbit, figure.add_subplot(grid[0, 0]), since)
    whole = since <= orbit.tau[0]
    motion.set_title("displacement" if whole else f"displacement, from t = {since:.6g}", fontsize="medium")
    legend_below(motion, legend_entries(motion), under=0.2)
    _portrait(orbit, figure.add_subplot(grid[0, 1]), since)
    chatter = _first_chatter(orbit)
    _velocities(orbit, figure.add_subplot(grid[1, 0] if chatter.size else grid[1, :]), None if whole else since)
    if chatter.size:
        _hops(orbit, figure.add_subplot(grid[1, 1]), chatter)
    return figure


def _since(orbit: Orbit) -> float:
    """Where the last part begins: at an event, so that no flight is cut."""
    first, last = float(orbit.tau[0]), shown_end(orbit)
    if orbit.oscillator.period is None:
        return float(orbit.tau[max(orbit.tau.size - IMPACTS, 0)])
    wanted = last - PERIODS * as_float(orbit.oscillator.period)
    return first if wanted <= first else float(orbit.tau[np.searchsorted(orbit.tau, wanted, side="right") - 1])


def _portrait(orbit: Orbit, axes: Axes, since: float) -> None:
    """x and x' of the last part; impacts are dashed lines along the walls."""
    end = shown_end(orbit)
    for kind, start, stop in orbit.phases:
        if kind not in ("flight", "no_return") or stop <= since or start >= end:
            continue
        stop = min(stop, end)
        inside = np.linspace(start, stop, max(FEWEST, int(SAMPLES * (stop - start) / (end - since))))
        inside[-1] = np.nextafter(stop, start)  # before the impact, not after it
        places = orbit.sample(inside)
        axes.plot(places.x, places.xdot, color=BLUE, linewidth=0.9)
    hits = (orbit.kind == "impact") & (orbit.tau >= since)
    if hits.any():
        before = orbit.sample(np.nextafter(orbit.tau[hits], -np.inf)).xdot
        after = orbit.v[hits] if orbit.wall is None else (1 - 2 * orbit.wall[hits]) * orbit.v[hits]
        jumps = np.stack([before, after, np.full(before.size, np.nan)], axis=1).ravel()
        wide = np.repeat(orbit.places[hits], 3)
        axes.plot(wide, jumps, color=VERMILLION, linewidth=1.4, linestyle=SHORT_DASHES, label="impact", zorder=4)
    for wall in {as_float(orbit.oscillator.clearance), float(orbit.places.max())}:
        axes.axvline(wall, color=GREY, linewidth=0.8)
    axes.set(xlabel="displacement $x$", ylabel=r"velocity $\dot x$")
    axes.set_title("phase portrait", fontsize="medium")
    if hits.any():
        axes.legend(loc="upper right", frameon=False, fontsize="small")


def _velocities(orbit: Orbit, axes: Axes, since: float | None) -> None:
    """The velocity after every impact over time, logarithmic: a chatter is a row of points that falls."""
    hits = orbit.kind == "impact"
    largest = float(orbit.v[hits].max()) if hits.any() else 1.0
    speeds = np.maximum(orbit.v[hits], LEAST * largest)
    axes.plot(
        orbit.tau[hits],
        speeds,
        "o",
        color=BLUE,
        markersize=4.0 if hits.sum() <= MANY else 1.8,
        markeredgewidth=0,
        label="impact",
        rasterized=bool(hits.sum() > 5000),
    )
    end = shown_end(orbit)
    low = float(speeds.min()) / 3 if hits.any() else LEAST
    _rests(orbit, axes, np.full(len(orbit.phases), low), (float(orbit.tau[0]), end), 5.0)
    if since is not None:
        axes.axvspan(since, end, color=WALL, zorder=0, label="part shown above")
    axes.set(xlabel="time $t$", ylabel="velocity $v$ after an impact", xlim=(orbit.tau[0], end))
    axes.set_yscale("log" if largest > 0 else "linear")
    axes.set_title("all impacts", fontsize="medium")
    legend_below(axes, legend_entries(axes), under=0.2)


def _first_chatter(orbit: Orbit) -> Array:
    """The launch or lift-off before the first complete chatter, its impacts and its end; empty without two impacts."""
    end = orbit.tau[orbit.kind == "complete"].min(initial=np.inf)
    begin = orbit.tau[(orbit.tau < end) & (orbit.kind == "release")].max(initial=orbit.tau[0])
    times = np.append(orbit.tau[(orbit.tau >= begin) & (orbit.tau < end)], end)
    return times if times.size > 3 and np.isfinite(end) else times[:0]


def _hops(orbit: Orbit, axes: Axes, times: Array) -> None:
    """The distance from the wall during a chatter, on logarithmic axes: its hops are about equally wide there."""
    left = np.geomspace(times[-1] - times[0], times[-1] - times[-2], SAMPLES)[1:-1]
    heights = np.abs(orbit.sample(times[-1] - left).x - orbit.places[orbit.tau == times[-1]][0])
    axes.plot(left, heights, color=BLUE, linewidth=0.9)
    least = heights[left < times[-1] - times[-3]].max() / 10  # below the top of the last hop
    axes.set(xscale="log", xlim=(left[0], left[-1]), xlabel="time before its end")
    axes.set(
        yscale="log",
        ylim=(least, 2 * heights.max()),
        ylabel="displacement $x - c$" if orbit.wall is None else "distance from the wall",
    )
    axes.set_title(f"first chatter, complete at t = {times[-1]:.6g}", fontsize="medium")


# The mass that bounces, beside its x(t).

BLOCK = ((-1, 0), (1, 0), (1, 2), (-1, 2), (-1, 0))  # the marker of the mass, which stands on its place


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
        require(ending in (".gif", ".html", ".mp4"), "path", path, "a file name ending in .gif, .html or .mp4")
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
@takes_two_walls
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
    first, last = float(orbit.tau[0]), max(shown_end(orbit), orbit.end)
    begin, end = (_since(orbit), shown_end(orbit)) if between is None else map(float, interval(between))
    require(first <= begin < end <= last, "between", between, f"two times from {first:.6g} to {last:.6g}")
    times = np.linspace(begin, end, whole("frames", frames, 2, 10_000))
    heights = orbit.sample(times).x
    figure = Figure(figsize=(7.2, 3.2), dpi=80, layout="constrained")
    still, moving = figure.subplots(1, 2, sharey=True, width_ratios=(1, 4))
    draw_orbit(orbit, moving, since=begin).legend().remove()
    moving.set(xlim=(begin, end), ylabel="")
    for line in moving.lines:
        line.set_clip_on(True)  # marks of impacts that are not among the pictures
    still.set(xlim=(-1, 1), xticks=[], ylabel="displacement $x$")
    _walls(orbit, still)
    (mass,) = still.plot([0], [heights[0]], marker=BLOCK, color=BLUE, markersize=32)
    (point,) = moving.plot([begin], [heights[0]], "o", color=VERMILLION, markersize=6, zorder=6)

    def show(at: int) -> tuple[Any, Any]:
        mass.set_ydata([heights[at]])
        point.set_data([times[at]], [heights[at]])
        return mass, point

    return OrbitAnimation(figure, show, times.size)
