"""Pictures of branches of periodic orbits, their events in two numbers, bifurcation diagrams, and cascades."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches import BorderOrbit, Branch, Cascade, CascadeWindow, EventCurve, orbit_period
from singimpact.branches.events import KINDS, Event, kind_of
from singimpact.dynamics.bifurcation_diagram import Bifurcation
from singimpact.inputs import InputError, refuse, require
from singimpact.scenes import style as looks
from singimpact.scenes.label_places import legend_below, legend_entries, legend_mark, place_labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHTS = {
    "v": "velocity $v$ after an impact",
    "phase": "phase of an impact, in periods",
    "x": "lowest $x - c$",
    "walls": r"$\dot x$ after an impact",
}
WORDS = {"stable": "stable", "unstable": "unstable", "virtual": "virtual: goes through the wall"}


# Virtual parts are shown so far beyond the visible ones, of their height; free space around the curves
BEYOND, SPACE = 0.35, 0.06
# Of markers of events, in points
MARK = 5.5


def draw_branches(branches: Sequence[Branch], axes: Axes, height: str = "v") -> Axes:
    """Draw branches over the number that is varied, with their events.

    Parameters
    ----------
    branches : over one number. axes : of matplotlib; limits of a picture that is there, or that were set, are kept.
    height : "v", velocities after the impacts, or "phase", their phases in periods. Branches of orbits without impact
        lie at v = 0; where there are no others the lowest x - c is shown.
    """
    require(height in ("v", "phase"), "height", height, "'v' or 'phase'")
    names = sorted({branch.over for branch in branches})
    if len(names) > 1:
        raise refuse("branches to plot", f"over {' and '.join(names)}", "branches over one number")
    fresh = not axes.has_data()
    shown = "x" if fresh and height == "v" and not any(branch.n for branch in branches) else height
    drawn = [_Drawn(branch, shown) for branch in branches]
    kinds = {name for line in drawn for name in line.classes.tolist()}
    for line in drawn:
        line.lines(axes)
    if fresh:
        _limits(axes, drawn, shown)
        axes.set(xlabel=looks.LETTERS.get(names[0], names[0]), ylabel=HEIGHTS[shown])
        if shown == "v" and any(branch.wall is not None for branch in branches):
            axes.set_ylabel(HEIGHTS["walls"])
        if shown != "phase":
            axes.axhline(0, color=looks.BLACK, linewidth=0.6, zorder=1, gid="no impact")
    marks = [mark for line in drawn for mark in line.marks()]
    return _legend(axes, drawn, [name for name in looks.LINES if name in kinds], _draw_marks(axes, marks))


class _Drawn:
    """A branch with its events put between its points."""

    def __init__(self, branch: Branch, shown: str) -> None:
        self.branch, self.shown = branch, shown
        heights = self._heights()
        classes = np.where(branch.visible, np.where(branch.stable, "stable", "unstable"), "virtual")
        classes[branch.at_event] = ""
        self.events: list[tuple[Event, Array]] = []
        number, rows, kinds = branch.parameter.tolist(), list(heights), classes.tolist()
        for event in sorted(branch.events, key=lambda event: event.index, reverse=True):
            own, near = self._event_heights(event), rows[min(max(event.index, 0), len(rows) - 1)]
            # impacts in the order of the point of the branch: an orbit begins where it likes
            turned = [np.roll(own, shift) for shift in range(len(own))]
            heights_ = turned[int(np.argmin([np.nansum(np.abs(heights - near)) for heights in turned]))]
            self.events.append((event, heights_))
            at = min(max(event.index + 1, 0), len(number))
            number.insert(at, event.parameter)
            rows.insert(at, heights_)
            kinds.insert(at, "")
        self.number, self.heights = np.array(number), np.array(rows)
        self.classes = np.array(kinds)  # of an event none

    def _heights(self) -> Array:
        branch = self.branch
        if self.shown == "phase":
            periods = (branch.period / branch.k)[:, None]
            return np.asarray(np.mod(branch.tau / periods, 1.0)) if branch.n else np.full((len(branch), 1), np.nan)
        if branch.n:
            return _rebounds(branch.v, branch.wall)
        if self.shown == "v":
            return np.zeros((len(branch), 1))
        closing = branch.closing
        points = np.column_stack([branch.tau, branch.v, branch.parameter])
        return np.array([[min(height for _, height in closing.heights(point))] for point in points])

    def _event_heights(self, event: Event) -> Array:
        orbit = event.orbit
        if not self.branch.n:
            return np.full(1, np.nan if self.shown == "phase" else 0.0)
        if self.shown == "v":
            return _rebounds(np.asarray(orbit.v, dtype=float), orbit.wall)
        return np.asarray(np.mod(np.asarray(orbit.tau, dtype=float) / orbit_period(orbit), 1.0))

    def lines(self, axes: Axes) -> None:
        """One line for each impact and each stretch of one class."""
        color = looks.orbit_color(self.branch.n, self.branch.k)
        # the class of a step between points is that of its end that is not an event; of two events that of what follows
        ends = self.classes.tolist()
        steps = [next((name for name in ends[i:] if name), "virtual") for i in range(len(ends) - 1)]
        first = 0
        for i in range(1, len(steps) + 1):
            if i < len(steps) and steps[i] == steps[first]:
                continue
            style, width = looks.LINES[steps[first]]
            width *= looks.orbit_width(self.branch.n, self.branch.k)
            piece = slice(first, i + 1)
            for impact in range(self.heights.shape[1]):
                heights = self.heights[piece, impact].copy()
                numbers = self.number[piece]
                if self.shown == "phase":
                    # cut where a line leaves one side of a period and comes back on the other
                    jumps = np.flatnonzero(np.abs(np.diff(heights)) > 0.5) + 1
                    numbers, heights = np.insert(numbers, jumps, np.nan), np.insert(heights, jumps, np.nan)
                look = {"color": color, "linestyle": style, "linewidth": width, "zorder": 3 + (style == "solid")}
                axes.plot(numbers, heights, **look, gid=f"branch, {steps[first]}")
            first = i

    def marks(self) -> list[tuple[tuple[float, float, str], str | None]]:
        """Places and kinds of events, and the name that is written beside the first impact of each."""
        marks_: list[tuple[tuple[float, float, str], str | None]] = []
        for event, spot in self.events[::-1]:
            # a graze is one impact's; all impacts of the orbit are part of the other events
            alone = event.described.at_impact
            at = int(np.argmin(np.abs(spot))) if alone and self.shown == "v" else 0
            order = [at] if alone else [at, *(i for i in range(len(spot)) if i != at)]
            for rank, i in enumerate(order):
                if np.isfinite(spot[i]):
                    name = event.described.label if rank == 0 else None
                    marks_.append(((event.parameter, float(spot[i]), event.kind), name))
        return marks_


def _rebounds(v: Array, wall: Array | None) -> Array:
    """x' after impacts, which is negative at an upper wall."""
    return v if wall is None else np.where(wall == 1, -v, v)


def _limits(axes: Axes, drawn: list[_Drawn], shown: str) -> None:
    """The picture is filled by the motions that occur; virtual parts are shown next to them."""
    numbers = np.concatenate([line.number for line in drawn])
    pad = SPACE / 2 * (np.ptp(numbers) or 1.0)
    if axes.get_autoscalex_on():
        axes.set_xlim(numbers.min() - pad, numbers.max() + pad)
    if not axes.get_autoscaley_on():
        return
    if shown == "phase":
        axes.set_ylim(-0.02, 1.02)
        return
    every = np.concatenate([line.heights.ravel() for line in drawn])
    seen = np.concatenate([line.heights[line.classes != "virtual"].ravel() for line in drawn])
    seen = np.append(seen, 0.0) if seen.size else every
    size = float(np.ptp(seen)) or float(np.abs(every).max()) or 1.0
    low = max(float(every.min()), float(seen.min()) - BEYOND * size)
    high = min(float(every.max()), float(seen.max()) + BEYOND * size)
    axes.set_ylim(low - SPACE * size, high + SPACE * size)


def _draw_marks(axes: Axes, marks: list[Any]) -> set[str]:
    """Markers with their names, if all of these have clear places and are few; otherwise the names for the legend."""
    for (number, height, kind), _ in marks:
        axes.plot(number, height, kind_of(kind).marker, **looks.OPEN, markersize=MARK, zorder=6, gid=kind)
    names = [(number, height, name) for (number, height, _), name in marks if name]
    # more events, or any whose name would hide a curve, are named in the legend, not beside their points
    if len(names) > 8:
        return {name for _, _, name in names}
    written, clear = place_labels(axes, names)
    if clear:
        return set()
    for text in written:
        text.remove()
    return {text.get_text() for text in written}


def _legend(axes: Axes, drawn: list[_Drawn], kinds: list[str], names: set[str]) -> Axes:
    """Colours of orbits, then line styles, then markers that are not named in the picture."""
    from matplotlib.lines import Line2D

    entries = legend_entries(axes)
    for line in drawn:
        n, k = line.branch.n, line.branch.k
        name = f"({line.branch.impacts}, {k}) orbits" if n else "without impact"
        entries.setdefault(name, Line2D([], [], color=looks.orbit_color(n, k), linewidth=2.4 * looks.orbit_width(n, k)))
    for kind in kinds:
        style, width = looks.LINES[kind]
        entries.setdefault(WORDS[kind], Line2D([], [], color=looks.BLACK, linestyle=style, linewidth=width))
    entries |= {kind.label: legend_mark(kind.marker, MARK) for kind in KINDS if kind.label in names}
    return legend_below(axes, entries, min(4, len(entries)))


def draw_event_curves(curves: Sequence[EventCurve], axes: Axes) -> Axes:
    """Draw curves of events in the plane of their two numbers, with points of codimension two."""
    planes = sorted({curve.over for curve in curves})
    if len(planes) > 1:
        raise refuse("curves to plot", " and ".join(map(str, planes)), "curves of one plane")
    fresh, entries = not axes.has_data(), dict[str, Any]()
    from matplotlib.lines import Line2D

    names = [f"({curve.impacts}, {curve.k}) orbits" for curve in curves]
    for curve, orbits in zip(curves, names, strict=True):
        pen = looks.EVENT_PENS[curve.kind]
        name = kind_of(curve.kind).label
        name = f"{name} of {orbits}" if len(set(names)) > 1 else name
        entries.setdefault(name, Line2D([], [], **pen.line()))
        for seen in (True, False):
            chosen = curve.visible == seen
            # a piece begins where the one before it ends
            joined = chosen | np.append(chosen[1:], False) | np.insert(chosen[:-1], 0, False) if not seen else chosen
            points = np.where(joined[:, None], curve.parameters, np.nan)
            line = pen.line() if seen else {"color": pen.color, "linestyle": looks.DOTS, "linewidth": 1.3}
            axes.plot(*points.T, **line, zorder=4 if seen else 3, gid=name)
    if not all(curve.visible.all() for curve in curves):
        entries[WORDS["virtual"]] = Line2D([], [], color=looks.BLACK, linestyle=looks.DOTS, linewidth=1.3)
    if fresh:
        across, up = curves[0].over
        axes.set(xlabel=looks.LETTERS.get(across, across), ylabel=looks.LETTERS.get(up, up))
        axes.margins(SPACE)
    marked = _apart([(*point.parameters, point.kind) for curve in curves for point in curve.special], axes)
    for x, y, _ in marked:
        axes.plot(x, y, "D", **looks.OPEN, markersize=5, zorder=6, gid="special point")
    place_labels(axes, marked)
    return legend_below(axes, entries, min(4, len(entries)))


def _apart(points: list[tuple[float, float, str]], axes: Axes) -> list[tuple[float, float, str]]:
    """Points each once: curves that leave one another at a point all name it."""
    width, high = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
    kept: list[tuple[float, float, str]] = []
    for x, y, name in points:
        near = [each for each in kept if abs(x - each[0]) < 1e-4 * width and abs(y - each[1]) < 1e-4 * high]
        if not any(each[2] == name for each in near):
            kept.append((x, y, name))
    return kept


# Bifurcation diagrams: velocities and phases of settled orbits, branches of periodic orbits over them.

SIZE = (8.0, 6.4)  # inches
ATTRACTORS = (looks.BLUE, looks.ORANGE, looks.GREEN, looks.PURPLE, looks.SKY)  # colours of those met at most values
SPREAD = 60_000.0  # impacts per square inch of area of their dots: few get large dots, many small ones


def bifurcation_sheet(diagram: Bifurcation, branches: Sequence[Branch] = (), figure: Figure | None = None) -> Figure:
    """The figure of a diagram, a new one or an empty one: velocities above, phases below, branches over both.

    Parameters
    ----------
    diagram : of `bifurcation`. branches : over the same number.

    Examples
    --------
    >>> from singimpact.dynamics.bifurcation_diagram import bifurcation
    >>> from singimpact.oscillator.model import Oscillator
    >>> found = bifurcation(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", (0.2, 0.3), 2, impacts=60, kept=4)
    >>> [axes.get_ylabel() for axes in bifurcation_sheet(found).axes]
    ['velocity $v$ after an impact', 'phase of an impact, in periods']
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    figure = figure or Figure(figsize=SIZE, dpi=150, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    entries = dict[str, Any]()
    for axes, height in ((below, "phase"), (above, "v")):
        draw_bifurcation(diagram, axes, height)
        if branches:
            draw_branches(branches, axes, height)
        entries |= legend_entries(axes)
        if axes.get_legend() is not None:
            axes.get_legend().remove()
    above.set_xlabel("")
    look: dict[str, Any] = {"ncols": 4, "frameon": False, "fontsize": "small"}
    for handle in figure.legend(entries.values(), list(entries), loc="outside lower center", **look).legend_handles:
        if isinstance(handle, Line2D):
            handle.set_markersize(max(handle.get_markersize(), 4.0))
    return figure


def draw_bifurcation(diagram: Bifurcation, axes: Any, height: str = "v") -> Any:
    """Velocities after the impacts of settled orbits, or their phases; ends of complete chatter in another colour."""
    values = np.repeat(diagram.values, diagram.events.shape[1])
    phase, v, ended = diagram.events.reshape(-1, 3).T
    places = (
        v
        if height == "v"
        else phase / np.repeat(np.broadcast_to(diagram.periods, diagram.values.shape), diagram.events.shape[1])
    )
    resting = ended == 1.0
    inches = float(np.prod(axes.figure.get_size_inches()))
    size = float(np.clip(np.sqrt(SPREAD * inches / max(values.size, 1)) / 20, 0.9, 3.0))
    dots: dict[str, Any] = {"marker": "o", "linestyle": "none", "markeredgewidth": 0, "rasterized": True}
    large, dots = dots | {"markersize": 1.5 * size, "clip_on": False}, dots | {"markersize": size}
    for at, color, name in _attractors(diagram):
        chosen = np.repeat(at, diagram.events.shape[1]) & ~resting
        axes.plot(values[chosen], places[chosen], color=color, label=name, **dots)
    if resting.any():
        axes.plot(values[resting], places[resting], color=looks.VERMILLION, label="end of complete chatter", **large)
    above = height == "v" and bool((v < 0).any())  # impacts at an upper wall
    axes.set(xlabel=looks.LETTERS.get(diagram.over, diagram.over), ylabel=HEIGHTS["walls" if above else height])
    low, top = axes.get_ylim()
    # velocities 0 stand above the edge, so that markers of grazes are whole
    ends = (low if above else -0.03 * top, top) if height == "v" else (0, 1)
    axes.set(xlim=(diagram.values.min(), diagram.values.max()), ylim=ends)
    if not np.isfinite(v).any():
        axes.text(
            0.5, 0.5, "no orbit of this window has an impact", transform=axes.transAxes, ha="center", color=looks.GREY
        )
    if len(axes.get_legend_handles_labels()[1]) > 1:
        axes.legend(loc="best", fontsize="small", markerscale=2)
    return axes


def _attractors(diagram: Bifurcation) -> list[tuple[Array, str, str]]:
    """Values at which an attractor is met, its colour and its name; those met at few values, in grey, have one name.

    The colour is that of a branch of the same orbits, where no other attractor has it.
    """
    labels, first_way = diagram.labels, np.arange(diagram.values.size) < diagram.values.size / 2
    free, rest = list(ATTRACTORS), np.zeros(labels.size, dtype=bool)
    rows: list[tuple[Array, str, str]] = []
    for label in np.argsort(-np.bincount(labels), kind="stable").tolist():
        run, at = diagram.attractors[int(np.argmax(labels == label))], labels == label
        chaotic = run.kind == "chaotic"
        if not free and not chaotic:
            rest |= at
            continue
        own = looks.orbit_color(int(run.n), run.k) if run.kind == "orbit" else ""
        color = looks.BLACK if chaotic else free.pop(free.index(own) if own in free else 0)
        ways = [name for name, way in (("up", first_way), ("down", ~first_way)) if at[way].any()]
        only = f", on the way {ways[0]}" if diagram.direction == "both" and len(ways) == 1 else ""
        rows.append((at, color, ("chaos" if chaotic else run.name) + only))
    return [*rows, (rest, looks.GREY, "other attractors")] if rest.any() else rows


# The cascade beside a border orbit: impacts of the released orbit, and what attracts it, over the distance.

CASCADE_WORDS = {
    "same": "attractor that closes at each return",
    "more": "attractor that closes after more returns",
    "rest": "attractor with complete chatter",
    "none": "no periodic attractor seen",
}
CASCADE_MARKS = {
    "same": ("o", looks.BLUE),
    "more": ("D", looks.ORANGE),
    "rest": ("^", looks.VERMILLION),
    "none": (".", looks.GREY),
}


def draw_border(border: BorderOrbit, axes: Any, below: Any = None) -> Any:
    """Draw the cascade of a border orbit and return the axes.

    Parameters
    ----------
    axes : for the number of impacts a return. below : for the size of the larger multiplier, or None.
    """
    cascade = border.cascade
    if len(cascade) < 2:
        raise InputError(f"this border orbit has no cascade to draw: {'; '.join(cascade.notes)}")
    # an orbit is flown until it settles at so many places of each window; many windows have smaller marks
    samples, size = cascade.sampled(8), 3.6 * min(1.0, 35 / len(cascade))
    _stairs(cascade, axes)
    for kind, (marker, color) in CASCADE_MARKS.items():
        rows = [(sample.distance, _height(sample, border)) for sample in samples if _kind(sample, border) == kind]
        if rows:
            look: dict[str, Any] = {"color": color, "linestyle": "none", "markeredgewidth": 0.9, "zorder": 4}
            axes.plot(*np.array(rows).T, marker, markersize=size, label=CASCADE_WORDS[kind], **look)
    name = looks.LETTERS.get(border.over, border.over)
    axes.set_title(
        f"border orbit at {name} = {float(border.parameter):.12g}, chatter completes {border.side}", fontsize="medium"
    )
    axes.set(xscale="log", ylabel="impacts a return")
    if below is not None:
        _multipliers(samples, border, below, size)
        axes.tick_params(labelbottom=False)
    last = axes if below is None else below
    last.set_xlabel(f"distance from the border orbit in {name}")
    legend_below(last, legend_entries(axes), 2, 0.18 if below is None else 0.3)
    return axes


def _stairs(cascade: Cascade, axes: Any) -> None:
    """N of the released orbit, constant between edges."""
    distance = np.array(cascade.distance, dtype=float)
    # beyond the first edge one impact less, beyond the last one as long as the window before
    places = np.concatenate([[distance[0] ** 2 / distance[1]], distance, [distance[-1] ** 2 / distance[-2]]])
    axes.plot(
        np.repeat(places, 2)[1:-1],
        np.repeat(np.concatenate([[cascade.impacts[0] - 1], cascade.impacts]), 2),
        color=looks.BLACK,
        linewidth=1.0,
        zorder=2,
        label="released orbit, up to the end of $\\gamma$",
    )
    axes.set_xlim(places[-1], places[0])


def _kind(window: CascadeWindow, border: BorderOrbit) -> str:
    if window.orbit is None:
        return "none"
    if window.orbit.kind == "chatter":
        return "rest"
    return "same" if window.orbit.k == round(border.period) else "more"


def _height(window: CascadeWindow, border: BorderOrbit) -> float:
    """Impacts of an attractor a return; those with rest, or none, at the released orbit's."""
    orbit = window.orbit
    if orbit is None or orbit.kind == "chatter":
        return float(window.impacts)
    return float(orbit.n) * border.period / orbit.k


def _multipliers(samples: tuple[CascadeWindow, ...], border: BorderOrbit, axes: Any, size: float) -> None:
    """The size of the larger multiplier; 0 of a superstable orbit has no place on this axis."""
    for kind in ("same", "more"):
        marker, color = CASCADE_MARKS[kind]
        rows = [
            (sample.distance, abs(complex(sample.orbit.multipliers[0])))
            for sample in samples
            if sample.orbit is not None and _kind(sample, border) == kind
        ]
        if rows:
            axes.plot(*np.array(rows).T, marker, color=color, markersize=size, linestyle="none", zorder=4)
    axes.axhline(1, color=looks.BLACK, linewidth=0.6, zorder=1)
    axes.set(yscale="log", ylim=(10**-2.5, 2), ylabel="larger multiplier, size")
