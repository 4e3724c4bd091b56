"""Figures B7 and B8: the visible outline before, at and after a swan's arc meets other branches of P."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator.model import Oscillator
from singimpact.paper.figures.panel import Array, Dot, Line, Panel, Picture, Point
from singimpact.surface.curve import Curve
from singimpact.surface.impact_surface import ImpactSurface
from singimpact.surface.outline_transitions import transitions
from singimpact.surface.swan_families import Transition


@dataclass(frozen=True)
class Row:
    """A transition with the clearances beside it.

    title : of its panels. value : of the transition, near to which it is searched. kinds : looked for. reach : longest
    time between rests. apart : clearances before and after, beyond it. tau, v : what is shown, around the launch of the
    transition, or its first rest; v from 0 where it is (low, high). long : longest flight. degree : of the polynomial
    in tau taken off v, so that branches that nearly coincide are seen apart; 0 takes off nothing. fine : parts of the
    longest flight that curves are followed to.
    """

    title: str
    value: float
    kind: str
    reach: float
    apart: tuple[float, float]
    tau: tuple[float, float]
    v: tuple[float, float]
    long: float
    degree: int = 0
    fine: int = 3000


def two_waves() -> ImpactOscillator:
    """A lightly damped oscillator whose swans meet every kind of transition."""
    return ImpactOscillator("x + 0.04*xdot", "cos(2.8*t) + 0.5*cos(5.6*t + 2)", 0, "0.8")


ASIDE = 0.01  # of the clearance before a transition: at it lines that cross are traced this far apart
B7 = (
    Row("tacnode", -0.0451779, "tacnode", 4.0, (0.0004, -0.0004), (-0.25, 0.2), (0, 0), 4.2, 3),
    Row("tangency to tangency", -0.0461684, "tangency", 4.0, (0.0004, -0.0004), (-0.16, 0.16), (-0.006, 0.022), 4.2),
)
B8 = (
    Row("triple point", -0.922413, "triple point", 12.0, (0.03, -0.03), (-0.23, 0.17), (0.95, 1.2), 18.0, 0, 1500),
    Row("tangency last", -0.0552099, "tangency", 4.0, (0.0014, -0.0014), (-0.1, 0.06), (0, 0), 4.7, 3, 1500),
    Row("tangency first", -1.19219, "tangency", 6.0, (0.02, -0.02), (-0.5, 0.5), (-0.05, 0.16), 9.0, 0, 2000),
)


def figure_B7() -> Picture:
    """A lens opens on the arc of a swan, and the flight released at one tangency point is at rest at another."""
    model = linear("2.8", 0, "0.8")
    panels, facts = _rows(model, B7)
    caption = (
        "What the swan of $c = 1$ meets first as the clearance falls: $x'' + x = \\cos 2.8t$. Above: at the tacnode "
        f"$c_0$ = {facts['tacnode']:.7f} (dot: the launch of its flight) an arc of the visible outline, bold, touches "
        "its copy of the period before; beyond it a lens of launches that miss both is open between them. Shown "
        r"is $v - q(\tau)$, $q$ a polynomial of degree 3. Below: the flight from tangency to tangency, released at A "
        f"(dot), at $c_0$ = {facts['tangency to tangency']:.7f}; beyond it the piece of the copy to the right of A is "
        "gone, and its tip lies above the arc that ends at A. The middle panels are a hair before the transition."
    )
    claims = ("b:events-first", "b:events-values", "b:events-met")
    return Picture("B7", "A swan meets its copy", claims, str(model), panels, 3, facts, caption)


def figure_B8() -> Picture:
    """A triple point, and the two tangencies."""
    model = two_waves()
    panels, facts = _rows(model, B8)
    caption = (
        "Three more transitions of the visible outline (bold), each before, at and after, with the launch of its "
        "flight as a dot. Top: a flight with three rests; two T-junctions trade places. Middle: as $c$ falls the tip "
        r"of an arc comes out from behind another; $v - q(\tau)$ is shown, $q$ a polynomial of degree 3. Bottom: the "
        "flight released at A is at rest again, and the arc that ended on both sides of A passes over it."
    )
    claims = ("b:events-front", "b:events-critical", "b:events-met")
    title = "A triple point and two tangencies of the outline"
    return Picture("B8", title, claims, str(model), panels, 3, facts, caption)


def _rows(model: Oscillator, rows: tuple[Row, ...]) -> tuple[list[Panel], dict[str, float]]:
    panels, facts = list[Panel](), dict[str, float]()
    for row in rows:
        transition = _transition(model, row)
        facts[row.title] = transition.value
        launch = transition.launch or (transition.rests[0], 0.0)
        tau = launch[0] + row.tau[0], launch[0] + row.tau[1]
        shifts = (row.apart[0], ASIDE * row.apart[0], row.apart[1])
        sides = [(transition.value + shift, sign) for shift, sign in zip(shifts, ">=<", strict=True)]
        surfaces = [(_surface(model, c, tau, row), c, sign) for c, sign in sides]
        facts |= {f"{row.title} {sign}": float(_ends(surface, tau)) for surface, _, sign in surfaces}
        panels += _drawn(row, launch, tau, surfaces)
    return panels, facts


def _transition(model: Oscillator, row: Row) -> Transition:
    ends = row.value - 1e-4, row.value + 1e-4
    (found,) = transitions(model, "clearance", ends, (-row.reach, row.reach), row.kind).visible
    return found


def _surface(model: Oscillator, clearance: float, tau: tuple[float, float], row: Row) -> ImpactSurface:
    """The surface in a window whose rests can be reached from the launches shown."""
    window = (tau[0], tau[1] + row.long), (-row.long, 0.01)
    return ImpactSurface(model.replace(clearance=clearance), *window, 1 / row.fine)


def _ends(surface: ImpactSurface, tau: tuple[float, float]) -> int:
    """The number of ends of visible arcs in the window."""
    ends = np.vstack([arc.points[[0, -1]] for arc in surface.discontinuities])
    return int(((ends[:, 0] > tau[0]) & (ends[:, 0] < tau[1])).sum())


def _drawn(
    row: Row, launch: Point, tau: tuple[float, float], surfaces: list[tuple[ImpactSurface, float, str]]
) -> list[Panel]:
    shift = _shift(row, launch, tau, surfaces)
    panels, box = [], (tau, row.v)
    if row.degree:
        inner = np.vstack([shift(line) for surface, _, _ in surfaces for line in _inside(surface.discontinuities, tau)])
        low, high = float(inner[:, 1].min()), float(inner[:, 1].max())
        box = tau, (low - 0.1 * (high - low), high + 0.1 * (high - low))
    for surface, _, sign in surfaces:
        lines = [Line(shift(curve), "P", "P") for curve in _inside(surface.outline, tau)]
        lines += [Line(shift(curve), "jump", "visible P") for curve in _inside(surface.discontinuities, tau)]
        dots = [Dot("", _pair(shift(np.array([launch]))))] if sign == "=" else []
        label = r"$v - q(\tau)$" if row.degree else "$v$"
        panels.append(Panel(box, y=label, title=f"{row.title}: $c {sign} c_0$", lines=lines, dots=dots))
    return panels


def _pair(points: Array) -> Point:
    return float(points[0, 0]), float(points[0, 1])


def _inside(curves: list[Curve], tau: tuple[float, float]) -> list[Array]:
    """The stretches of curves over the window, with a vertex beyond its edges."""
    found = []
    for curve in curves:
        near = (curve.points[:, 0] > tau[0]) & (curve.points[:, 0] < tau[1])
        wide = near | np.append(near[1:], False) | np.append(False, near[:-1])
        edges = np.flatnonzero(np.diff(np.concatenate([[0], wide.astype(int), [0]])))
        found += [curve.points[i:j] for i, j in edges.reshape(-1, 2) if j - i > 1]
    return found


def _shift(
    row: Row, place: Point, tau: tuple[float, float], made: list[tuple[ImpactSurface, float, str]]
) -> Callable[[Array], Array]:
    """(tau, v) -> (tau, v - q(tau)), q fitted to the visible arcs."""
    if not row.degree:
        return lambda points: points
    points = np.vstack([part for surface, _, _ in made for part in _inside(surface.discontinuities, tau)])
    q = np.polyfit(points[:, 0] - place[0], points[:, 1], row.degree)
    return lambda part: np.stack([part[:, 0], part[:, 1] - np.polyval(q, part[:, 0] - place[0])], axis=1)
