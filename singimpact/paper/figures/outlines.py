"""Figures 1 and 2: the impact surface with its horizon, and how its outline changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.figures.contact_figures import oscillator
from singimpact.paper.figures.panel import Array, Dot, Line, Panel, Picture, Point
from singimpact.paper.figures.projections import launch_and_landing
from singimpact.surface.curve import Curve
from singimpact.surface.impact_surface import ImpactSurface

LEFT, RIGHT, HIGH, LOW, LONG = 1.95, 2.65, 0.25, -0.06, 1.6  # times, velocities and flight times shown


def figure_1() -> Picture:
    """V_c over (tau, t), folded along H; the lines over w_1, w_2, w_3 touch it there."""
    model = oscillator()
    surface = ImpactSurface(model, (LEFT, RIGHT + LONG), (-2.5, 2.5))  # H is shifted Z
    folds = [
        np.column_stack([outline.points, horizon.points[:, 1]])[_shown(outline.points, horizon.points[:, 1])]
        for horizon, outline in zip(surface.horizon, surface.outline, strict=True)
    ]
    fold = max(folds, key=len)
    fold = fold[np.argsort(fold[:, 0])]
    lines = [Line(fold, "H", "H", "$H$", 0.1), Line(fold * [1, 1, 0], "P", "P", "$P$", 0.04)]
    for n, share in enumerate((0.2, 0.5, 0.8)):
        position = fold[int(share * (len(fold) - 1))]
        over = np.array([position * [1, 1, 0], position + np.array([0, 0, 0.25])])
        words = "lines $w = $ const. that touch the surface on $H$"
        lines.append(Line(over, "hidden", f"line over w_{n + 1}", words=words))
        lines.append(
            Line(
                position[None],
                "orbit",
                f"touching point over w_{n + 1}",
                f"$w_{n + 1}$",
                beads=True,
                words="touching points",
            )
        )
    panel = Panel(((LEFT, RIGHT), (LOW, HIGH)), mesh=_mesh(), lines=lines)
    caption = (
        r"The impact surface: for each launch time $\tau$ and flight time $t$ the velocity $v$ with which the "
        "flight comes back to the wall. Over states below $P$ it has two sheets, which meet in the fold $H$, the "
        "horizon, where flights land with velocity zero: a vertical line over a state $w_1$, $w_2$ or $w_3$ of "
        "$P$ touches the surface there. $P$ is the image of $H$ in the plane of states."
    )
    return Picture(
        1,
        "The impact surface and its horizon",
        ("s2-smooth", "s2-horizon", "s2-two-sheets"),
        str(model),
        [panel],
        caption=caption,
    )


def _shown(points: Array, t: Array) -> Array:
    tau, v = points.T
    return np.asarray((tau > LEFT) & (tau < RIGHT) & (v >= 0) & (v < HIGH) & (t >= 0) & (t < LONG))


def _mesh() -> tuple[Array, Array, Array]:
    """The surface from t = 0 on each line of constant tau up to where v leaves the box."""
    tau, t = np.linspace(LEFT, RIGHT, 61), np.linspace(0.0, LONG, 241)
    grid = np.stack([np.repeat(tau, t.size), np.tile(t, tau.size)], axis=1)
    v = launch_and_landing(oscillator(), grid)[0].reshape(tau.size, t.size)
    share = np.linspace(0.0, 1.0, 41)
    times, speeds = [], []
    for row in v:
        out = np.flatnonzero(row < LOW)
        end = t[out[0]] if out.size else LONG
        times.append(share * end)
        speeds.append(np.interp(share * end, t, row))
    return np.repeat(tau[:, None], share.size, axis=1), np.array(speeds), np.array(times)


@lru_cache(maxsize=1)
def damped() -> ImpactOscillator:
    """x'' + x'/10 + x = cos wt, whose outline shows all three transitions."""
    return ImpactOscillator("x + 0.1*xdot", "cos(w*t)", "0.3", "0.6", parameters={"w": "1.7"})


@dataclass(frozen=True)
class Change:
    """A transition of the outline of `damped`, as `surface.outline_transitions` finds it.

    over, value : the name of a number and its value. tau, t : the flight from rest. half : of the window around it.
    step : of the number, before and after. degree : of the polynomial in tau that is taken off v, so that branches
    which nearly coincide are seen apart; it does not change what kind a point of the outline is. shown : half of the
    width of the picture. pixels : of the curves, many where the shear magnifies.
    """

    kind: str
    over: str
    value: float
    tau: float
    t: float
    half: float
    step: float
    degree: int
    shown: float
    pixels: int


CHANGES = (
    Change("lips", "w", 2.2346139563997207, 0.5665872036436089, 4.089046551292352, 0.2, 0.0001, 3, 0.03, 3000),
    Change("beaks", "w", 1.9669260638735848, 2.5507220258801437, 5.89964018967169, 0.6, 0.003, 3, 0.25, 600),
    Change("swallowtail", "clearance", 1.0, 0.0, 5.1927096149235386, 0.6, 0.04, 1, 0.03, 1500),
)


def figure_2() -> Picture:
    """The three generic transitions of the outline, each before, at and after."""
    panels, facts = list[Panel](), dict[str, float]()
    for letter, change in zip("abc", CHANGES, strict=True):
        rows = [(relation, _outline(change, sign)) for sign, relation in ((-1, "<"), (0, "="), (1, ">"))]
        facts |= {
            f"{change.kind} {relation}": float(sum(len(c.marked("cusp")) for c in surface))
            for relation, surface in rows
        }
        together = [rows] if change.kind != "swallowtail" else [[row] for row in rows]  # its tip moves away at once
        panels += _equally_high([panel for curve in together for panel in _panels(letter, change, curve)])
    caption = (
        "How the apparent outline $P$ changes as one number of the model moves through a value where two cusps "
        "(dots) meet. (a) Lips: a closed piece with two cusps shrinks to a point at the frequency $w_0$ = "
        f"{CHANGES[0].value:.6f} and is gone. (b) Beaks: two cusps meet at $w_0$ = {CHANGES[1].value:.6f} and two "
        "smooth branches are left. (c) Swallowtail: two cusps and a crossing merge at the clearance $c_0$ = "
        rf"{CHANGES[2].value:g}. Vertically $v - q(\tau)$ is shown, $q$ a polynomial fitted to the branches (of "
        "degree 3 in (a) and (b), 1 in (c)), since branches that nearly coincide are not seen apart otherwise. In "
        "each row the scales are equal, and in (c) the window moves with the tip."
    )
    return Picture(
        2,
        "The three generic transitions of the outline",
        ("s2-fold-cusp-forms", "s6-lips"),
        str(damped()),
        panels,
        3,
        facts,
        caption,
    )


def _equally_high(panels: list[Panel]) -> list[Panel]:
    """Panels with one vertical scale: their lower ends come up to the height of the least high."""
    height = min(panel.box[1][1] - panel.box[1][0] for panel in panels)
    return [replace(panel, box=(panel.box[0], (panel.box[1][1] - height, panel.box[1][1]))) for panel in panels]


def _panels(letter: str, change: Change, rows: list[tuple[str, list[Curve]]]) -> list[Panel]:
    """Panels in one box, sheared alike."""
    middle = _middle(change, rows)
    shear = _shear(change, rows, middle)
    point = np.array([[change.tau + change.t, 0.0]])  # where lips are born; the shear of that panel goes through it
    shown = [shear(curve.points) for _, surface in rows for curve in surface]
    box = _box(change, middle, shown)
    name, panels = "c" if change.over == "clearance" else change.over, []
    for relation, surface in rows:
        cusps = [shear(curve.marked("cusp")) for curve in surface]
        cusps += [point] if relation == "=" and change.kind == "lips" else []
        dots = [Dot("", (float(x), float(y))) for cusp in cusps for x, y in cusp]
        lines = [Line(shear(curve.points), "P", "P") for curve in surface]
        note = {"=": "one point", ">": "no outline here"}.get(relation, "") if change.kind == "lips" else ""
        panels.append(
            Panel(
                box,
                y=r"$v - q(\tau)$",
                note=note,
                title=f"({letter}) {change.kind}: ${name} {relation} {name}_0$",
                lines=lines,
                dots=dots,
            )
        )
    return panels


def _shear(change: Change, rows: list[tuple[str, list[Curve]]], middle: float) -> Callable[[Array], Array]:
    """(tau, v) -> (tau, v - q(tau)) with q near to all branches."""
    points = np.vstack([curve.points for _, made in rows for curve in made])
    points = points[np.abs(points[:, 0] - middle) < change.shown]
    fitted = np.polyfit(points[:, 0] - middle, points[:, 1], change.degree)
    return lambda place: np.stack([place[:, 0], place[:, 1] - np.polyval(fitted, place[:, 0] - middle)], axis=1)


def _middle(change: Change, rows: list[tuple[str, list[Curve]]]) -> float:
    if change.kind != "swallowtail":
        return change.tau + change.t
    return min(float(curve.points[:, 0].min()) for _, made in rows for curve in made) + 0.8 * change.shown


def _outline(change: Change, sign: int) -> list[Curve]:
    if change.kind == "lips" and sign == 0:
        return []  # a single point, which no contour can hold
    aside = 1e-2 if change.kind == "beaks" and not sign else 0.0  # two lines that cross are traced a hair apart
    model = damped().replace(**{change.over: change.value + (sign + aside) * change.step})
    tau, t = ((middle - change.half, middle + change.half) for middle in (change.tau, change.t))
    found = ImpactSurface(model, tau, t, 1 / change.pixels).outline
    return [curve for curve in found if curve.closed] if change.kind == "lips" else found


def _box(change: Change, middle: float, lines: list[Array]) -> tuple[Point, Point]:
    points = np.vstack(lines)
    points = points[np.abs(points[:, 0] - middle) < change.shown]
    low, high = float(points[:, 1].min()), float(points[:, 1].max())
    margin = 0.1 * (high - low)
    ends = [end[1] for line in lines for end in line[[0, -1]] if abs(end[0] - middle) < change.shown]
    cut = [float(y) for y in ends if y < (low + high) / 2 and change.kind != "lips"]  # so that no curve ends in mid-air
    return (middle - change.shown, middle + change.shown), (max([low - margin, *cut]), high + margin)
