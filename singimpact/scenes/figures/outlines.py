"""Figures 1 and 2: the impact surface with its horizon, and how its outline changes."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from singimpact.impact_oscillator import ImpactOscillator
from singimpact.scenes.figures.contact import oscillator
from singimpact.scenes.figures.panel import Dot, Line, Panel, Picture
from singimpact.scenes.figures.sheet import launch_and_landing
from singimpact.surface.impact_surface import ImpactSurface

HIGH = 0.55  # velocities shown


def figure_1() -> Picture:
    """V_c over (tau, t), folded along H; lines over w_1, w_2, w_3 touch it there."""
    model = oscillator()
    tau, t = np.meshgrid(np.linspace(0.9, 3.3, 61), np.linspace(0.0, 2.2, 56))
    v = launch_and_landing(model, np.stack([tau.ravel(), t.ravel()], axis=1))[0].reshape(tau.shape)
    mesh = (tau, np.where((v >= -0.15) & (v <= HIGH), v, np.nan), t)
    surface = ImpactSurface(model, (0.9, 3.3), (-2.6, 2.6))
    lines = []
    for horizon, outline in zip(surface.horizon, surface.outline, strict=True):
        space = np.column_stack([outline.points, horizon.points[:, 1]])
        inside = (space[:, 0] > 0.9) & (space[:, 0] < 3.3) & (space[:, 2] >= 0) & (space[:, 2] < 2.2)
        inside &= (space[:, 1] >= 0) & (space[:, 1] < HIGH)
        lines += _stretches(space, inside)
    arcs = sorted((line for line in lines if line.name == "H"), key=lambda line: -len(line.points))
    for n, share in enumerate((0.3, 0.55, 0.8)):
        place = arcs[0].points[int(share * (len(arcs[0].points) - 1))]
        foot = place * [1, 1, 0]
        lines.append(Line(np.array([foot, place + [0, 0, 0.5]]), "orbit", f"line over w_{n + 1}", f"$w_{n + 1}$", 0.0))
    return Picture(1, "The impact surface and its horizon", ("s2-smooth", "s2-horizon", "s2-two-sheets"), str(model),
                   [Panel(((0.9, 3.3), (-0.15, HIGH)), mesh=mesh, lines=lines)])  # fmt: skip


def _stretches(space: np.ndarray, inside: np.ndarray) -> list[Line]:  # type: ignore[type-arg]
    edges = np.split(np.arange(len(space)), np.flatnonzero(np.diff(inside)) + 1)
    found = []
    for part in edges:
        if inside[part[0]] and len(part) > 3:
            found.append(Line(space[part], "H", "H", "$H$" if len(part) > 30 else "", 0.15))
            found.append(Line(space[part] * [1, 1, 0], "Z", "P", "$P$" if len(part) > 30 else "", 0.15))
    return found


@lru_cache(maxsize=1)
def duffing() -> ImpactOscillator:
    """x'' + x'/10 + x + 3x^3/10 = cos wt, whose outline shows all three transitions."""
    return ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(w*t)", "0.3", "0.6", parameters={"w": "1.7"})


# kind, what moves, its value and half the range shown, the flight (tau, t), half the window
TRANSITIONS = (
    ("lips", "w", 2.0882, 0.02, (2.407, 5.576), 0.5),
    ("beaks", "clearance", 0.2726, 0.01, (0.758, 11.779), 0.5),
    ("swallowtail", "clearance", 0.829052, 0.02, (0.0, 2.0), 0.6),
)


def figure_2() -> Picture:
    """The three generic transitions of the outline, each before, at and after."""
    panels, facts = [], {}
    for letter, (kind, over, value, step, (tau, t), half) in zip("abc", TRANSITIONS, strict=True):
        rows = []
        for sign, told in ((-1, "<"), (0, "="), (1, ">")):
            model = duffing().replace(**{over: value + sign * step})
            surface = ImpactSurface(model, (tau - half, tau + half), (t - half, t + half), 400)
            rows.append(surface.outline)
            facts[f"{kind} {told}"] = float(sum(len(curve.marked("cusp")) for curve in surface.outline))
            name = "c" if over == "clearance" else over
            lines = [Line(curve.points, "P", "P") for curve in surface.outline]
            cusps = [Dot("", (float(x), float(y))) for curve in surface.outline for x, y in curve.marked("cusp")]
            panels.append((f"({letter}) {kind}: ${name} {told} {name}_0$", lines, cusps))
        panels[-3:] = _same_box(panels[-3:])
    return Picture(2, "The three generic transitions of the outline", ("s2-fold-cusp-forms", "s6-lips"), str(duffing()),
                   panels, 3, facts)  # fmt: skip


def _same_box(rows):  # type: ignore[no-untyped-def]
    points = np.vstack([line.points for _, lines, _ in rows for line in lines])
    (left, low), (right, high) = points.min(axis=0), points.max(axis=0)
    margin = 0.08 * np.array([right - left, high - low])
    box = (left - margin[0], right + margin[0]), (low - margin[1], high + margin[1])
    return [Panel(box, title=title, lines=lines, dots=dots) for title, lines, dots in rows]
