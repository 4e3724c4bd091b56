"""One call for everything that can be drawn."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.border import BorderOrbit
from singimpact.branches.branch import Branch
from singimpact.branches.enclosed_crossing import EnclosedCrossing
from singimpact.branches.event_curve import EventCurve
from singimpact.branches.homoclinic import Crossings
from singimpact.branches.horseshoe import Horseshoe
from singimpact.branches.manifold import Manifold
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.transitions import BothSides
from singimpact.dynamics.basins_of_attraction import Basins
from singimpact.dynamics.bifurcation_diagram import Bifurcation
from singimpact.dynamics.orbit import Orbit
from singimpact.dynamics.release_map import ReleaseMap
from singimpact.dynamics.sampling import Section
from singimpact.inputs import InputError, checked_keywords, refuse, takes_two_walls
from singimpact.scenes.basins_picture import draw_basins, draw_both_sides
from singimpact.scenes.border_picture import draw_border
from singimpact.scenes.branch_picture import (
    bifurcation_sheet,
    draw_bifurcation,
    draw_branches,
    draw_event_curves,
)
from singimpact.scenes.manifolds import draw_certified_crossing, draw_crossings, draw_horseshoe, draw_manifolds
from singimpact.scenes.orbit_picture import (
    SIZE as SHEET,
    draw_orbit,
    draw_periodic,
    draw_release_map,
    draw_section,
    orbit_sheet,
)
from singimpact.scenes.scene import Scene
from singimpact.scenes.style import BLACK, PENS, darken
from singimpact.surface.curve import Curve
from singimpact.surface.impact_surface import ImpactSurface

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDE, HIGH, BRANCHES = (8.0, 4.0), (7.2, 5.2), (7.2, 4.8)  # inches
LETTERS = {"tau": r"time $\tau$", "t": "flight time $t$", "v": "velocity $v$"}


@checked_keywords
@takes_two_walls
def plot(
    thing: Any, ax: Any = None, *, height: str = "v", sheet: bool = False, dark: bool = False, **style: object
) -> Any:
    """Draw a thing and return the matplotlib axes.

    Parameters
    ----------
    thing : an orbit, a periodic orbit with impacts, a section of an orbit, a map of release phases, a scene, basins, a
        bifurcation diagram, a branch or an event curve or a list of them, W^s or W^u of a saddle or a list of them, the
        points where two cross, a certified orbit in which they do, a certified horseshoe, a border orbit, of which the
        cascade is drawn, both sides of a transition (on two axes), a curve or a list of curves of one plane, or an
        impact surface, of which Z and H are drawn.
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
    if "axes" in style:
        warnings.warn("plot(axes=...) is plot(ax=...) now", FutureWarning, stacklevel=3)
        ax = style.pop("axes")
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
        return np.array(orbit_sheet(diagram, _figure(SHEET)).axes, dtype=object)
    if not isinstance(diagram, Bifurcation):
        raise refuse("thing to plot as a sheet", type(diagram).__name__, "an orbit, or a diagram and branches over it")
    return np.array(bifurcation_sheet(diagram, branches, _figure(HIGH)).axes, dtype=object)


def _children(axes: Any) -> list[Any]:
    """The artists on axes, or on several."""
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


def _drawn(thing: Any, axes: Any, height: str) -> Any:
    if isinstance(thing, Scene):
        return thing.draw(axes)
    if isinstance(thing, ImpactSurface):
        thing = [*thing.zero_set, *thing.horizon]
    if isinstance(thing, Bifurcation):
        return draw_bifurcation(thing, _new_axes() if axes is None else axes, height)
    if isinstance(thing, BothSides):
        return draw_both_sides(thing, _beside() if axes is None else axes)
    for kind, size, draw in ALONE:
        if isinstance(thing, kind):
            return draw(thing, _new_axes(size) if axes is None else axes)
    several = list(thing) if isinstance(thing, list | tuple) else [thing]
    if several and all(isinstance(item, Branch) for item in several):
        return draw_branches(several, _new_axes(BRANCHES) if axes is None else axes, height)
    if isinstance(thing, BorderOrbit):
        return draw_border(thing, *(_two_axes() if axes is None else (axes,)))
    for kind, size, draw in TOGETHER:
        if several and all(isinstance(item, kind) for item in several):
            return draw(several, _new_axes(size) if axes is None else axes)
    raise refuse(
        "thing to plot",
        type(thing).__name__,
        "an orbit, a scene, basins, a bifurcation, branches, event curves, manifolds, border orbits, or curves",
    )


def _curves(curves: Sequence[Curve], axes: Any) -> Any:
    """Pieces of one curve share their line in the legend."""
    planes = sorted({piece.axes for piece in curves})
    if len(planes) > 1:
        raise refuse("curves to plot", " and ".join(map(str, planes)), "curves of one plane")
    for curve in curves:
        _curve(curve, axes)
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    axes.legend(once.values(), once.keys(), loc="best")
    return axes


def _curve(curve: Curve, axes: Any) -> None:
    pen = PENS.get(curve.name, PENS["graph"])
    axes.plot(*curve.points.T, **pen.line(), label=pen.words if curve.name in PENS else curve.name)
    for mark in curve.marks:
        place = curve.points[mark.index]
        axes.plot(*place, "o", color=BLACK, markersize=4)
        axes.annotate(mark.name, place, (5, 5), textcoords="offset points")
    across, up = curve.axes
    axes.set(xlabel=LETTERS.get(across, across), ylabel=LETTERS.get(up, up))


def _figure(size: tuple[float, float]) -> Figure:
    """A new figure of pyplot, which notebooks show."""
    import matplotlib.pyplot

    return matplotlib.pyplot.figure(figsize=size, dpi=150, layout="constrained")


def _new_axes(size: tuple[float, float] = WIDE) -> Any:
    return _figure(size).add_subplot()


def _two_axes() -> Any:
    """Two axes that share their horizontal one, the upper one higher."""
    return _figure(HIGH).subplots(2, sharex=True, height_ratios=(3, 2))


def _beside() -> Any:
    """Two axes beside each other that share their vertical one."""
    return _figure((11.0, 5.2)).subplots(1, 2, sharey=True)


Drawer = Callable[[Any, Any], Any]
# types that are drawn alone: the size of the picture, and the function that draws it
ALONE: tuple[tuple[type, tuple[float, float], Drawer], ...] = (
    (Crossings, HIGH, draw_crossings),
    (EnclosedCrossing, HIGH, draw_certified_crossing),
    (Horseshoe, WIDE, draw_horseshoe),
    (Orbit, WIDE, draw_orbit),
    (PeriodicOrbit, WIDE, draw_periodic),
    (Section, HIGH, draw_section),
    (ReleaseMap, HIGH, draw_release_map),
    (Basins, HIGH, draw_basins),
)
# types that are drawn alone, or several in one picture
TOGETHER: tuple[tuple[type, tuple[float, float], Drawer], ...] = (
    (Curve, WIDE, _curves),
    (EventCurve, BRANCHES, draw_event_curves),
    (Manifold, HIGH, draw_manifolds),
)
