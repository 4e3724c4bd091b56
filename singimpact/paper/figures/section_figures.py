"""Figures 9 and 10: a(tau) with the outlines that its zeros make, and sections of V' at constant tau."""

from __future__ import annotations

import numpy as np

from singimpact.flights.impact_map import first_hit
from singimpact.impact_oscillator import linear
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.paper.figures.panel import Array, Dot, Line, Panel, Picture
from singimpact.paper.figures.projections import launch_and_landing
from singimpact.paper.figures.swan_figures import box, half, negative, positive, ring

PLACES = (-4.0, -3.0, -2.4, -(3**0.5), -1.35, -1.0, -0.5, 0.0)  # of tau, in half distances of A and B
VALUES = ("-1.03", "-1", "-0.97"), ("1.03", "1", "0.97")  # of c, before, at and after c_0
WORDS = tuple(f"$a_c$ for $c = {a}$ in (a), ${b}$ in (b)" for a, b in zip(*VALUES, strict=True))
NAMED = {-3.0: "D", -(3**0.5): "E", -1.0: "A"}


def figure_9() -> Picture:
    """A swan over the clearance: two zeros of a appear as c passes c_0, and the outline is born with two cusps."""
    panels, facts = [], {}
    for letter, swan, values in (("a", positive(), VALUES[0]), ("b", negative(), VALUES[1])):
        kind = swan.kind
        middle, size = (swan.A + swan.B) / 2, half(swan)
        tau = np.linspace(middle - 2.4 * size, middle + 2.4 * size, 121)
        curves = [
            Line(np.stack([tau, acceleration(linear(2, c, "0.5"), tau)], axis=1), pen, f"a for c = {c}", words=words)
            for c, pen, words in zip(values, ("before", "at", "graph"), WORDS, strict=True)
        ]
        height = 1.3 * max(float(np.abs(curve.points[30:91, 1]).max()) for curve in curves)
        bounds = (-0.6 * height, height) if kind == "positive" else (-height, 0.6 * height)
        letters = [Dot("$A$", (swan.A, 0.0)), Dot("$B$", (swan.B, 0.0))]
        panels.append(
            Panel(
                box(swan, -2.4, 2.4, *bounds),
                y=r"$a(\tau)$",
                title=f"({letter}) {kind} swan: $a_c$",
                lines=curves,
                dots=letters,
            )
        )
        v = 1.25 * abs(swan.projected["D"][1])
        cusps = [Dot("$D'$", swan.projected["D"]), Dot("$C''$", swan.reset["C"])]
        panels.append(
            Panel(
                box(swan, -4.2, 4.2, -v, v),
                title=f"({letter}) outline $P$, $c={values[2]}$",
                lines=[Line(ring(swan, "P"), "P", "P")],
                dots=[*letters, *cusps],
            )
        )
        facts[f"cusps_{kind}"] = float(sum(len(c.marked("cusp")) for c in swan.surface.outline if c.closed))
    caption = (
        "A swan point opens as the clearance $c$ passes $c_0$ = -1 (a, positive) or 1 (b, negative). Left: the "
        "acceleration at the wall, $a_c$, gets two zeros $A$ and $B$. Right: a closed piece of the apparent "
        "outline $P$ is born, which touches the axis at $A$ and $B$ and has a cusp at either end, $D'$ and $C''$."
    )
    return Picture(
        9,
        "Graphs of a and the outlines of unfolded swans",
        ("s6-d", "s6-lips"),
        "x'' + x = cos 2t",
        panels,
        2,
        facts,
        caption,
    )


def figure_10() -> Picture:
    """v against t for tau <= tau_*: where the return time folds, and which part is a first hit."""
    swan, size = positive(), half(positive())
    middle, panels = (swan.A + swan.B) / 2, []
    for n, point in enumerate(PLACES):
        tau = {"A": swan.A, "D": swan.points["D"][0], "E": swan.points["E"][0]}.get(
            NAMED.get(point, ""), middle + point * size
        )
        t = np.linspace(-3.2, 7.2, 261) * size
        v = launch_and_landing(swan.model, np.stack([np.full(t.size, tau), t], axis=1))[0]
        local = v[(t > -0.8 * size) & (t < 5.5 * size)]
        low, high = float(local.min()), max(float(local.max()), 0.35 * float(-local.min()))
        curve = np.stack([t, v], axis=1)
        lines = [
            Line(np.array([[0.0, 1.1 * low], [0.0, 1.1 * high]]), "axis", "t = 0"),
            Line(curve, "P", "section", words="section of $V'$: $v$ against flight time $t$"),
        ]
        lines += [Line(piece, "graph", "first hits", words="first hits with $v > 0$") for piece in _visible(tau, curve)]
        letter = NAMED.get(point)
        dots = [] if letter is None else [Dot(f"${letter}$", _on(letter))]
        title = f"$\\sigma = {point:.3g}$" if letter is None else f"$\\sigma = {point:.3g}$, ${letter}$"
        panels.append(
            Panel(
                ((-3.2 * size, 7.2 * size), (1.1 * low, 1.1 * high)),
                "$t$" if n >= 4 else "",
                "$v$" if n % 4 == 0 else "",
                title,
                lines,
                dots=dots,
            )
        )
    caption = (
        r"Sections of $V'$ for launch times $\tau = \tau_* + \sigma$, with $\sigma$ in half distances of $A$ and "
        r"$B$: the velocity $v$ of the flight that is back at the wall after the time $t$. A state $(\tau, v)$ has "
        "as many returns as the horizontal line at $v$ has crossings with $t > 0$; the blue part is the first of "
        "them. To the right of $D$ the section has two folds, whose flights land with velocity zero. The numbers "
        "on the vertical axes show that each panel has a scale of its own."
    )
    return Picture(
        10,
        "Sections of V' at constant tau near a positive swan (sigma in half distances of A and B)",
        ("s6-sections", "s6p-BE", "s6p-AE"),
        str(swan.model),
        panels,
        4,
        caption=caption,
    )


def _on(letter: str) -> tuple[float, float]:
    place = positive().points[letter]
    return place[1], positive().projected[letter][1]


def _visible(tau: float, curve: Array) -> list[Array]:
    """The stretches with v >= 0 and t > 0 that are first hits."""
    swan = positive()
    t, v = curve.T
    inside = (t > 1e-9) & (v > 0)
    time = np.full(t.size, np.nan)
    if inside.any():
        time[inside] = first_hit(swan.model, np.full(int(inside.sum()), tau), v[inside]).flight_time
    seen = np.isfinite(time) & (np.abs(time - t) < 1e-6)
    return [
        curve[indices]
        for indices in np.split(np.arange(t.size), np.flatnonzero(np.diff(seen)) + 1)
        if seen[indices[0]] and len(indices) > 1
    ]
