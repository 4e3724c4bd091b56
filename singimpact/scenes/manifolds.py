"""Pictures of W^s and W^u of saddles, of points where they cross, of certified crossings and of horseshoes."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.enclosed_crossing import EnclosedCrossing
from singimpact.branches.homoclinic import Crossings
from singimpact.branches.horseshoe import CrossedSet, Horseshoe
from singimpact.branches.manifold import Manifold
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.inputs import refuse
from singimpact.scenes.label_places import legend_below, legend_entries, legend_mark
from singimpact.scenes.style import BLACK, BLUE, DASHES, GREEN, OPEN, ORANGE, PENS, WHITE


@dataclass(frozen=True)
class ManifoldPictureSettings:
    """Marks of a picture of manifolds."""

    saddle: float = 6.0
    cut: float = 3.2
    crossing: float = 4.5
    # more discontinuities than this are not marked
    marked: int = 60
    # orbits whose impacts are all marked, the first ones
    orbits: int = 1
    # of a certified orbit: size of its impacts; those farther from the saddle than this are numbered, in sides
    impact: float = 5.0
    away: float = 0.1


SETTINGS = ManifoldPictureSettings()


def draw_manifolds(manifolds: Sequence[Manifold], axes: Any) -> Any:
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
    limits = (axes.get_xlim(), axes.get_ylim())
    for manifold in manifolds:
        line = PENS[manifold.name].line()
        if not fresh:  # over basins, whose colours are strong
            line |= {"color": BLACK, "linewidth": 0.8, "linestyle": "solid" if manifold.stable else DASHES}
        saddle = f"({manifold.saddle.n:.0f}, {manifold.saddle.k}) saddle"
        entries.setdefault(f"${manifold.name}$ of the {saddle}", Line2D([], [], **line))
        for turn in _turns(limits[0], periods[1], fresh):
            for piece in manifold.pieces:
                axes.plot(piece.points[:, 0] + turn, piece.points[:, 1], **line, zorder=4, gid=manifold.name)
            _saddle(manifold, turn, axes)
            _cuts(manifold, turn, axes, entries)
    entries["saddle"] = legend_mark("s", SETTINGS.saddle)
    if fresh:
        limits = periods, (0.0, highest)
        axes.set(xlabel=r"launch phase $\tau$", ylabel="launch velocity $v$")
    axes.set(xlim=limits[0], ylim=limits[1])
    return legend_below(axes, entries)


def draw_crossings(crossings: Crossings, axes: Any) -> Any:
    """Draw both manifolds, a point of each orbit in which they cross, and all impacts of the first one."""
    draw_manifolds(crossings.manifolds, axes)
    entries, limits = legend_entries(axes), (axes.get_xlim(), axes.get_ylim())
    color, hollow = PENS["crossing"].color, {"color": BLACK, "markerfacecolor": "none"}
    filled = {"color": color, "markerfacecolor": color}
    kind = crossings[0].kind if crossings else "homoclinic"
    for crossing in crossings:
        dot = {"markersize": SETTINGS.crossing, "markeredgewidth": 0, "zorder": 6, "gid": f"{kind} point"}
        axes.plot(crossing.tau, crossing.v, "o", **filled, **dot)
    for crossing in crossings[: SETTINGS.orbits]:
        axes.plot(*crossing.states.T, "o", **hollow, markersize=1.8 * SETTINGS.crossing, zorder=7)
        entries[f"impacts of the first {kind} orbit"] = legend_mark("o", 1.8 * SETTINGS.crossing, **hollow)
    if crossings:
        entries[f"{kind} points, one of each orbit"] = legend_mark("o", SETTINGS.crossing, **filled)
    axes.set(xlim=limits[0], ylim=limits[1])
    return legend_below(axes, entries)


def draw_certified_crossing(crossing: EnclosedCrossing, axes: Any) -> Any:
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
    away = np.hypot(*gaps.transpose(2, 0, 1)).min(axis=1) > SETTINGS.away
    axes.plot(*states.T, "o", color=pen.color, markersize=SETTINGS.impact, zorder=8)
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
    axes.plot(*saddles.T, "s", **OPEN, markersize=SETTINGS.saddle, zorder=8)
    at = int(away[: crossing.index + 1].sum())
    words = f"impacts of a certified {crossing.kind} orbit, angle {float(crossing.angle.value):.4f} at {at}"
    entries[words] = legend_mark("o", SETTINGS.impact, color=pen.color, markerfacecolor=pen.color)
    entries["saddle"] = legend_mark("s", SETTINGS.saddle)
    if fresh:
        limits = (0.0, period), (0.0, top)
        axes.set(xlabel=r"launch phase $\tau$", ylabel="launch velocity $v$")
    axes.set(xlim=limits[0], ylim=limits[1])
    return legend_below(axes, entries, 2)


def _turns(limits: tuple[float, float], period: float, fresh: bool) -> list[float]:
    """Whole periods that bring the curves into a picture that is there."""
    if fresh:
        return [0.0]
    low, high = np.floor(limits[0] / period), np.ceil(limits[1] / period)
    return [float(turn) * period for turn in np.arange(low, max(high, low + 1))]


def _saddle(found: Manifold, turn: float, axes: Any) -> None:
    period = found.window.x[1]
    tau = np.mod(np.asarray(found.saddle.tau, dtype=float), period) + turn
    v = np.asarray(found.saddle.v, dtype=float)
    axes.plot(tau, v, "s", **OPEN, markersize=SETTINGS.saddle, zorder=6, gid="saddle")


def _cuts(found: Manifold, turn: float, axes: Any, entries: dict[str, Any]) -> None:
    """The states at which manifolds are cut."""
    if not found.cuts or len(found.cuts) > SETTINGS.marked:
        return
    places = np.array([(cut.tau + turn, cut.v) for cut in found.cuts])
    axes.plot(*places.T, "D", **OPEN, markersize=SETTINGS.cut, zorder=5, gid="cut by a graze")
    entries["cut by a graze"] = legend_mark("D", SETTINGS.cut)


# A certified horseshoe: the set round the saddle, and the images that cross it.

SIDE_POINTS = 60  # points of each side of a set


def draw_horseshoe(horseshoe: Horseshoe, axes: Any) -> Any:
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
    axes.plot(0, 0, "s", **OPEN, markersize=SETTINGS.saddle, label="saddle")
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
    """States in the coordinates of N."""
    assert found.oscillator.period is not None
    period = as_float(found.oscillator.period)
    away = points - [float(part) for part in home.centre]
    away[:, 0] -= period * np.rint(away[:, 0].mean() / period)
    frame = np.array([[float(part) for part in row] for row in home.frame])
    return np.asarray(np.linalg.solve(frame, away.T).T / [float(part) for part in home.radii])
