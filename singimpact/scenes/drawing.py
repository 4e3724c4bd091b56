"""One call for everything that can be drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches import (
    BorderOrbit,
    BothSides,
    Branch,
    CrossedSet,
    Crossings,
    EnclosedCrossing,
    EventCurve,
    Horseshoe,
    Manifold,
    PeriodicOrbit,
)
from singimpact.dynamics import Basins, BasinsOver, Bifurcation, Fit, Orbit, Regions, ReleaseMap, Section, model_step
from singimpact.inputs import InputError, checked_keywords, refuse, takes_two_walls
from singimpact.scenes import branch_picture, orbit_picture
from singimpact.scenes.basins_picture import draw_basins, draw_basins_over, draw_both_sides, draw_regions
from singimpact.scenes.label_places import legend_below, legend_entries, legend_mark
from singimpact.scenes.scene import Scene
from singimpact.scenes.style import BLACK, BLUE, DASHES, GREEN, OPEN, ORANGE, PENS, WHITE, darken
from singimpact.surface import Curve, ImpactSurface

# Pictures of W^s and W^u of saddles, of points where they cross, of certified crossings and of horseshoes.


# Sizes of the marks in a picture of manifolds, in points; of the impacts of a certified orbit
SADDLE, CUT, CROSSING, IMPACT = 6.0, 3.2, 4.5, 5.0


def draw_manifolds(manifolds: Sequence[Manifold], axes: Axes) -> Axes:
    """Draw manifolds of one model with their saddles and their cuts.

    Parameters
    ----------
    manifolds : manifolds. axes : of matplotlib; limits of a picture that is there are kept.
    """
    from matplotlib.lines import Line2D

    if len({manifold.saddle.oscillator for manifold in manifolds}) > 1:
        raise refuse("manifolds to plot", "those of several models", "manifolds of one model")
    fresh, entries = not axes.has_data(), legend_entries(axes)
    periods, highest = manifolds[0].window.x, max(manifold.window.y[1] for manifold in manifolds)
    limits = (periods, (0.0, highest)) if fresh else (axes.get_xlim(), axes.get_ylim())
    for manifold in manifolds:
        line = PENS[manifold.name].line()
        if not fresh:  # over basins, whose colours are strong
            line |= {"color": BLACK, "linewidth": 0.8, "linestyle": "solid" if manifold.stable else DASHES}
        saddle = f"({manifold.saddle.n:.0f}, {manifold.saddle.k}) saddle"
        entries.setdefault(f"${manifold.name}$ of the {saddle}", Line2D([], [], **line))
        for turn in _turns(limits[0], periods[1], fresh):
            for piece in manifold.pieces:
                axes.plot(piece.points[:, 0] + turn, piece.points[:, 1], **line, zorder=4, gid=manifold.name)
            tau = np.mod(np.asarray(manifold.saddle.tau, dtype=float), manifold.window.x[1]) + turn
            v = np.asarray(manifold.saddle.v, dtype=float)
            axes.plot(tau, v, "s", **OPEN, markersize=SADDLE, zorder=6, gid="saddle")
            _cuts(manifold, turn, axes, entries)
    entries["saddle"] = legend_mark("s", SADDLE)
    return _dressed(axes, limits, entries, fresh)


def _dressed(axes: Axes, limits: tuple[Any, Any], entries: dict[str, Any], fresh: bool, columns: int = 3) -> Axes:
    """The axes with limits and a legend; those that were empty get the names of launches."""
    if fresh:
        axes.set(xlabel=r"launch phase $\tau$", ylabel="launch velocity $v$")
    axes.set(xlim=limits[0], ylim=limits[1])
    return legend_below(axes, entries, columns)


def draw_crossings(crossings: Crossings, axes: Axes) -> Axes:
    """Draw both manifolds, a point of each orbit in which they cross, and all impacts of the first one."""
    draw_manifolds(crossings.manifolds, axes)
    entries, limits = legend_entries(axes), (axes.get_xlim(), axes.get_ylim())
    color = PENS["crossing"].color
    hollow: dict[str, Any] = {"color": BLACK, "markerfacecolor": "none"}
    filled: dict[str, Any] = {"color": color, "markerfacecolor": color}
    kind = crossings[0].kind if crossings else "homoclinic"
    for crossing in crossings:
        dot: dict[str, Any] = {"markersize": CROSSING, "markeredgewidth": 0, "zorder": 6, "gid": f"{kind} point"}
        axes.plot(crossing.tau, crossing.v, "o", **filled, **dot)
    # impacts are all marked of the first orbit alone
    for crossing in crossings[:1]:
        axes.plot(*crossing.states.T, "o", **hollow, markersize=1.8 * CROSSING, zorder=7)
        entries[f"impacts of the first {kind} orbit"] = legend_mark("o", 1.8 * CROSSING, **hollow)
    if crossings:
        entries[f"{kind} points, one of each orbit"] = legend_mark("o", CROSSING, **filled)
    return _dressed(axes, limits, entries, fresh=False)


def draw_certified_crossing(crossing: EnclosedCrossing, axes: Axes) -> Axes:
    """Draw the impacts of a certified orbit; those away from the saddles are numbered in their order.

    Parameters
    ----------
    axes : of matplotlib; limits of a picture that is there are kept.
    """
    from matplotlib.patheffects import withStroke

    fresh, entries = not axes.has_data(), legend_entries(axes)
    limits, pen = (axes.get_xlim(), axes.get_ylim()), PENS["certified"]
    assert crossing.oscillator.period is not None
    period = as_float(crossing.oscillator.period)
    states = np.array([[float(tau.value) % period, float(v.value)] for tau, v in crossing.states])
    saddles = np.array(
        [
            [float(tau.value) % period, float(v.value)]
            for saddle in (crossing.unstable, crossing.stable)
            for tau, v in zip(saddle.tau, saddle.v, strict=True)
        ]
    )
    top = 1.2 * float(max(states[:, 1].max(), saddles[:, 1].max()))
    gaps = (states[:, None] - saddles) / [period, top]
    gaps[..., 0] -= np.rint(gaps[..., 0])
    # impacts farther from the saddles, in sides of the picture, are numbered
    away = np.hypot(*gaps.transpose(2, 0, 1)).min(axis=1) > 0.1
    axes.plot(*states.T, "o", color=pen.color, markersize=IMPACT, zorder=8)
    for number, spot in enumerate(states[away], start=1):
        axes.annotate(
            str(number),
            spot,
            (6, 5),
            textcoords="offset points",
            zorder=9,
            fontweight="bold",
            color=pen.color,
            path_effects=[withStroke(linewidth=3, foreground=WHITE)],
        )
    axes.plot(*saddles.T, "s", **OPEN, markersize=SADDLE, zorder=8)
    at = int(away[: crossing.index + 1].sum())
    words = f"impacts of a certified {crossing.kind} orbit, angle {float(crossing.angle.value):.4f} at {at}"
    entries[words] = legend_mark("o", IMPACT, color=pen.color, markerfacecolor=pen.color)
    entries["saddle"] = legend_mark("s", SADDLE)
    return _dressed(axes, ((0.0, period), (0.0, top)) if fresh else limits, entries, fresh, 2)


def _turns(limits: tuple[float, float], period: float, fresh: bool) -> list[float]:
    """Whole periods that bring the curves into a picture that is there."""
    if fresh:
        return [0.0]
    low, high = np.floor(limits[0] / period), np.ceil(limits[1] / period)
    return [float(turn) * period for turn in np.arange(low, max(high, low + 1))]


def _cuts(found: Manifold, turn: float, axes: Axes, entries: dict[str, Any]) -> None:
    # more discontinuities are not marked
    if not found.cuts or len(found.cuts) > 60:
        return
    places = np.array([(cut.tau + turn, cut.v) for cut in found.cuts])
    axes.plot(*places.T, "D", **OPEN, markersize=CUT, zorder=5, gid="cut by a graze")
    entries["cut by a graze"] = legend_mark("D", CUT)


# A certified horseshoe: the set round the saddle, and the images that cross it.

SIDE_POINTS = 60  # points of each side of a set


def draw_horseshoe(horseshoe: Horseshoe, axes: Axes) -> Axes:
    """Draw N and B_1 with the image of N, which crosses both, and that of the last set, which crosses N.

    Parameters
    ----------
    axes : of matplotlib. Lengths are relative to N, along the directions in which the map stretches and contracts.
    """
    home, first, last = horseshoe.sets[0], horseshoe.sets[1], horseshoe.sets[-1]
    short = horseshoe.loops[0]
    looks = [
        (_seen(_image_of_set(horseshoe, home, short), home, horseshoe), ORANGE, "solid", "image of $N$"),
        (
            _seen(_image_of_set(horseshoe, last, 1), home, horseshoe),
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
    axes.plot(0, 0, "s", **OPEN, markersize=SADDLE, label="saddle")
    reach = 1.1 * float(np.abs(looks[0][0][:, 0]).max())
    axes.set(xlim=(-reach, reach), ylim=(-1.3, 1.3), ylabel="along $W^s$")
    digits, power = f"{float(home.radii[0]):.1e}".split("e")
    axes.set_xlabel(f"along $W^u$, in half widths of $N$, ${digits}\\cdot10^{{{int(power)}}}$")
    return legend_below(axes, legend_entries(axes))


def _outline(one: CrossedSet) -> Array:
    corners = np.vstack([one.corners, one.corners[:1]])
    share = np.linspace(0, 1, SIDE_POINTS)[:, None]
    return np.vstack([a + share * (b - a) for a, b in pairwise(corners)])


def _image_of_set(found: Horseshoe, one: CrossedSet, impacts: int) -> Array:
    points = _outline(one)
    for _ in range(impacts):
        points = model_step(found.oscillator, points)
    return points


def _seen(points: Array, home: CrossedSet, found: Horseshoe) -> Array:
    assert found.oscillator.period is not None
    period = as_float(found.oscillator.period)
    away = points - [float(part) for part in home.centre]
    away[:, 0] -= period * np.rint(away[:, 0].mean() / period)
    frame = np.array([[float(part) for part in row] for row in home.frame])
    return np.asarray(np.linalg.solve(frame, away.T).T / [float(part) for part in home.radii])


if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZES = (8.0, 4.0), (7.2, 5.2), (7.2, 4.8)  # inches
LETTERS = {"tau": r"time $\tau$", "t": "flight time $t$", "v": "velocity $v$"}


@checked_keywords
@takes_two_walls
def plot(
    thing: Any, ax: Any = None, *, height: str = "v", sheet: bool = False, dark: bool = False, **style: object
) -> Any:
    """Draw a thing and return the matplotlib axes.

    Parameters
    ----------
    thing : an orbit, a periodic orbit with impacts, a section of an orbit, a map of release phases, a scene, basins,
        basins over a number, regions over two, a fit, a bifurcation diagram, a branch or an event curve or a list of
        them, W^s or W^u of a saddle or a list of them, the points where two cross, a certified orbit in which they do,
        a horseshoe, a border orbit, of which the cascade is drawn, both sides of a transition (on two axes), a curve or
        a list of curves of one plane, or an impact surface, of which Z and H are drawn, with the cut at a second wall.
    ax : where to draw; those of a new figure of pyplot when it is not given, so that a notebook shows it and
        `matplotlib.pyplot.show()` does. Branches drawn on the axes of a bifurcation diagram keep its limits, and so do
        manifolds on those of basins, and a certified orbit on those of manifolds.
    height : of branches and bifurcation diagrams: "v", velocities after the impacts, or "phase", their phases in
        periods. A branch of orbits without impact alone is shown by its lowest x - c, beside others at v = 0.
    sheet : whether a figure of several axes is made, which are returned: of an orbit its last part, the phase portrait
        and all velocities; of a diagram, or a list of one and of branches, velocities and phases.
    dark : light lines on a dark ground, in the whole figure.
    style : properties of matplotlib for all lines and points that are drawn, such as color, linewidth or alpha. Each
        has a name, its label where a legend shows it and its gid elsewhere.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> axes = plot(linear("2.8", 0, "0.8").orbit(0.9, 0.3, impacts=5), color="black", linewidth=2)
    >>> axes.get_xlabel(), axes.lines[0].get_color()
    ('time $t$', 'black')
    """
    before = [] if ax is None else _children(ax)
    axes = _sheet(thing) if sheet else _drawn(thing, ax, height)
    if style:
        from matplotlib.collections import Collection
        from matplotlib.lines import Line2D

        drawn = [child for child in _children(axes) if child not in before]
        _styled([child for child in drawn if isinstance(child, Line2D | Collection)], style)
    if dark:
        darken(np.ravel(axes)[0].figure)
    return axes


def _sheet(thing: Any) -> Array:
    """The axes of a figure of pyplot that shows an orbit or a diagram from several sides."""
    diagram, *branches = thing if isinstance(thing, list | tuple) else [thing]
    if isinstance(diagram, Orbit):
        return np.array(orbit_picture.orbit_sheet(diagram, _figure(orbit_picture.SIZE)).axes, dtype=object)
    if not isinstance(diagram, Bifurcation):
        raise refuse("thing to plot as a sheet", type(diagram).__name__, "an orbit, or a diagram and branches over it")
    return np.array(branch_picture.bifurcation_sheet(diagram, branches, _figure(SIZES[1])).axes, dtype=object)


def _children(axes: Any) -> list[Any]:
    return [child for panel in np.ravel(axes) for child in panel.get_children()]


def _styled(artists: Sequence[Any], style: dict[str, object]) -> None:
    """Set properties of the artists that have them."""
    for name, value in style.items():
        having = [artist for artist in artists if hasattr(artist, f"set_{name}")]
        if not having:
            raise InputError(f"plot has no argument {name!r}: give thing, ax, height, or a property of lines or points")
        try:
            for artist in having[: 1 if name == "label" else None]:
                artist.set(**{name: value})
        except (TypeError, ValueError):
            raise refuse(name, value, f"what matplotlib takes as {name}") from None


def _drawn(thing: Any, axes: Axes, height: str) -> Any:
    if isinstance(thing, Scene):
        return thing.draw(axes)
    if isinstance(thing, ImpactSurface):
        thing = [*thing.zero_set, *thing.horizon, *thing.beyond, *thing.cut]
    several = list(thing) if isinstance(thing, list | tuple) else [thing]
    for kind, alone, new, draw in PICTURES:
        if isinstance(thing, kind) if alone else several and all(isinstance(item, kind) for item in several):
            more = {"height": height} if draw in (branch_picture.draw_bifurcation, branch_picture.draw_branches) else {}
            return draw(thing if alone else several, new() if axes is None else axes, **more)
    raise refuse(
        "thing to plot",
        type(thing).__name__,
        "an orbit, a scene, basins, regions, a bifurcation, branches, event curves, manifolds, border orbits or curves",
    )


def _curves(curves: Sequence[Curve], axes: Axes) -> Axes:
    """Pieces of one curve share their line in the legend."""
    planes = sorted({piece.axes for piece in curves})
    if len(planes) > 1:
        raise refuse("curves to plot", " and ".join(map(str, planes)), "curves of one plane")
    for curve in curves:
        pen = PENS.get(curve.name, PENS["graph"])
        axes.plot(*curve.points.T, **pen.line(), label=pen.words if curve.name in PENS else curve.name)
        for mark in curve.marks:
            point = curve.points[mark.index]
            axes.plot(*point, "o", color=BLACK, markersize=4)
            axes.annotate(mark.name, point, (5, 5), textcoords="offset points")
        across, up = curve.axes
        axes.set(xlabel=LETTERS.get(across, across), ylabel=LETTERS.get(up, up))
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    axes.legend(once.values(), once.keys(), loc="best")
    return axes


def _figure(size: tuple[float, float]) -> Figure:
    """A new figure of pyplot, which notebooks show."""
    import matplotlib.pyplot

    return matplotlib.pyplot.figure(figsize=size, dpi=150, layout="constrained")


def _new_axes(size: tuple[float, float], *grid: int, **panels: Any) -> Any:
    return _figure(size).subplots(*grid, **panels)


Drawer = Callable[..., Any]
New = Callable[[], Any]
WIDE, HIGH, LOW = (partial(_new_axes, size) for size in SIZES)
UPRIGHT = partial(_new_axes, SIZES[1], 2, sharex=True, height_ratios=(3, 2))
BESIDE = partial(_new_axes, (11.0, 5.2), 1, 2, sharey=True)
# types, whether each is drawn alone or several in one picture, new axes, and the function that draws
PICTURES: tuple[tuple[type, bool, New, Drawer], ...] = (
    (Bifurcation, True, WIDE, branch_picture.draw_bifurcation),
    (BothSides, True, BESIDE, draw_both_sides),
    (Crossings, True, HIGH, draw_crossings),
    (EnclosedCrossing, True, HIGH, draw_certified_crossing),
    (Horseshoe, True, WIDE, draw_horseshoe),
    (Orbit, True, WIDE, orbit_picture.draw_orbit),
    (PeriodicOrbit, True, WIDE, orbit_picture.draw_periodic),
    (Section, True, HIGH, orbit_picture.draw_section),
    (Fit, True, WIDE, orbit_picture.draw_fit),
    (ReleaseMap, True, HIGH, orbit_picture.draw_release_map),
    (Basins, True, HIGH, draw_basins),
    (BasinsOver, True, HIGH, draw_basins_over),
    (Regions, True, HIGH, draw_regions),
    (BorderOrbit, True, UPRIGHT, lambda border, axes: branch_picture.draw_border(border, *np.ravel(axes))),
    (Branch, False, LOW, branch_picture.draw_branches),
    (Curve, False, WIDE, _curves),
    (EventCurve, False, LOW, branch_picture.draw_event_curves),
    (Manifold, False, HIGH, draw_manifolds),
)
