"""Figures 11, 12, 14, 15: an unfolded swan on V', and its images under p and phi."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.dynamics.unfolded_swan import SwanConfiguration, swan_configuration
from singimpact.impact_oscillator import linear
from singimpact.paper.figures.contact_figures import reset
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Point, Region, arc, picture_of
from singimpact.scenes.style import WHITE
from singimpact.surface.impact_surface import ImpactSurface

FINE = 1 / 3000  # of the window of the configuration: its outline is magnified until the usual chords would show


@lru_cache(maxsize=2)
def negative() -> SwanConfiguration:
    """x'' + x = cos 2t near its negative swan at c_0 = 1."""
    return swan_configuration(linear(2, "0.97", "0.5"), 0)


@lru_cache(maxsize=2)
def positive() -> SwanConfiguration:
    """x'' + x = cos 2t near its positive swan at c_0 = -1."""
    return swan_configuration(linear(2, "-0.97", "0.5"), "pi/2")


def half(swan: SwanConfiguration) -> float:
    """Half the distance of A and B: the size of the configuration."""
    return (swan.B - swan.A) / 2


@lru_cache(maxsize=2)
def fine_surface(swan: SwanConfiguration) -> ImpactSurface:
    """V' of a configuration, its curves smooth at the size of a panel."""
    return ImpactSurface(swan.model, swan.surface.window.x, swan.surface.window.y, FINE)


def ring(swan: SwanConfiguration, name: str) -> Array:
    """The closed piece of H, Z or P through A and B."""
    surface = fine_surface(swan)
    curves = {"H": surface.horizon, "Z": surface.zero_set, "P": surface.outline}[name]
    return next(curve.points for curve in curves if curve.closed and len(curve.marked("tangency")) == 2)


def box(swan: SwanConfiguration, left: float, right: float, low: float, high: float) -> tuple[Point, Point]:
    """A window around the swan, in its own size for times; the second direction as given."""
    middle = (swan.A + swan.B) / 2
    return (middle + left * half(swan), middle + right * half(swan)), (low, high)


def on_surface(swan: SwanConfiguration) -> list[Dot]:
    """A to E on V'."""
    return [Dot(f"${name}$", place) for name, place in swan.points.items()]


def stretch(swan: SwanConfiguration, name: str, start: str, end: str) -> Array:
    """An arc of H or Z between two letters, in t >= 0."""
    places, size = swan.points, half(swan)
    other = (swan.A + size, -2 * size) if "E" not in (start, end) else places["D" if name == "H" else "C"]
    return arc(ring(swan, name), places[start], places[end], other)


def visible_positive() -> Array:
    """S: from A along Z to E, along H to B, back along t = 0."""
    swan = positive()
    return np.vstack([stretch(swan, "Z", "A", "E"), stretch(swan, "H", "E", "B")])


def shadow() -> Array:
    """The next hits behind the arc AD of H, from D to C (negative swan)."""
    swan = negative()
    (found,) = swan.surface.shadow
    return np.vstack([[swan.points["D"]], found.points[np.argsort(found.points[:, 0])], [swan.points["C"]]])


def hidden_negative() -> Array:
    """The loop A D C B A, outside of which V' is visible."""
    swan = negative()
    return np.vstack([stretch(swan, "H", "A", "D"), shadow(), stretch(swan, "Z", "C", "B")])


def figure_11() -> Picture:
    """The visible part S of an unfolded positive swan."""
    swan, size = positive(), half(positive())
    panel = Panel(
        box(swan, -4.4, 4.4, -6 * size, 6 * size),
        y="$t$",
        lines=_lettered(swan),
        dots=on_surface(swan),
        regions=[
            Region(
                visible_positive(),
                label=r"$\mathcal{S}$",
                words=r"$\mathcal{S}$: visible part of $V'$",
                place=(swan.A - 0.1 * size, 1.3 * size),
            )
        ],
    )
    return picture_of(11, str(swan.model), [panel], facts={"tangencies": 2.0})


def _lettered(swan: SwanConfiguration) -> list[Line]:
    """H and Z with their letters where they are far apart, in t < 0."""
    found = []
    for name in ("H", "Z"):
        points = ring(swan, name)
        at = int(np.argmax(points[:, 0] if name == "H" else -points[:, 1]))
        found.append(Line(points, name, name, f"${name}$", at / (len(points) - 1)))
    return found


def figure_14() -> Picture:
    """The visible part of an unfolded negative swan, with the shadow DC of H."""
    swan, size = negative(), half(negative())
    window = box(swan, -4.6, 4.6, -5 * size, 6 * size)
    (left, right), (_, high) = window
    panel = Panel(
        window,
        y="$t$",
        lines=[
            *_lettered(swan),
            Line(shadow(), "shadow", "shadow DC", "shadow", 0.5, words="shadow: next hits behind the visible arc $AD$"),
            Line(stretch(swan, "H", "A", "D"), "jump", "visible arc AD of H", words="visible arc $AD$ of $H$"),
        ],
        dots=on_surface(swan),
        regions=[
            Region(
                np.array([[left, 0], [right, 0], [right, high], [left, high]]),
                label=r"$\mathcal{T}$",
                words=r"$\mathcal{T}$: visible part of $V'$",
                place=(right - 1.9 * size, 4.6 * size),
            ),
            Region(hidden_negative(), WHITE),
        ],
    )
    return picture_of(14, str(swan.model), [panel])


IMAGES = r"images of the visible part $\mathcal{S}$"
ZOOM = 5.0  # the swan's body is so much flatter than its cusps are high


def _views(
    swan: SwanConfiguration,
    title: str,
    y: str,
    lines: list[Line],
    far: list[Dot],
    near: list[Dot],
    regions: list[Region],
) -> list[Panel]:
    """The whole outline, and its body magnified."""
    v = 1.25 * abs(swan.projected["D"][1])
    steep = ("shadow", "Z")  # these leave the magnified panel: their letters stand in the whole one
    plain = [line if line.pen in steep else replace(line, label="") for line in lines]
    lines = [replace(line, label="") if line.pen in steep else line for line in lines]
    (left, right), (low, high) = box(swan, -3.0, 3.0, -v / ZOOM, v / ZOOM)
    frame = np.array([[left, low], [right, low], [right, high], [left, high], [left, low]])
    return [
        Panel(
            box(swan, -4.2, 4.2, -v, v),
            title=title,
            y=y,
            lines=[*plain, Line(frame, "hidden", "frame", words="part that is magnified below")],
            dots=far,
            regions=[Region(curve.points, curve.tone, words=curve.words) for curve in regions if curve.label],
        ),
        Panel(
            ((left, right), (low, high)),
            title=f"{title}, magnified",
            y=y,
            lines=lines,
            dots=near,
            regions=regions,
        ),
    ]


def figure_12() -> Picture:
    """S' = p(S) and S'' = phi(S) of the positive swan."""
    swan, size, outline = positive(), half(positive()), ring(positive(), "P")
    v = abs(swan.projected["D"][1])
    places, images = swan.projected, swan.reset
    arc_p = arc(outline, places["E"], places["B"], places["D"])
    arc_phi = arc(outline, images["A"], images["E"], places["D"])
    first = _views(
        swan,
        "(a) under $p$",
        "$v$",
        [Line(outline, "P", "P"), Line(arc_p, "jump", "arc BE'")],
        [Dot("$D'$", places["D"])],
        [Dot("$A'=C'$", places["A"]), Dot("$B'$", places["B"]), Dot("$E'$", places["E"])],
        [Region(arc_p, label=r"$\mathcal{S}'$", words=IMAGES, place=(swan.A + 0.35 * size, 0.11 * v))],
    )
    second = _views(
        swan,
        r"(b) under $\phi$",
        r"$\dot x$",
        [Line(outline, "P", "P"), Line(arc_phi, "Z", "arc AE''", words=r"$\phi$ of the visible arc $AE$ of $Z$")],
        [Dot("$C''$", images["C"])],
        [Dot("$A''$", images["A"]), Dot("$B''=D''$", images["B"]), Dot("$E''$", images["E"])],
        [Region(arc_phi, label=r"$\mathcal{S}''$", words=IMAGES, place=(swan.B - 0.25 * size, -0.11 * v))],
    )
    return picture_of(12, str(swan.model), [first[0], second[0], first[1], second[1]], zoom=f"{ZOOM:g}")


def figure_15() -> Picture:
    """The cut AD' of the plane of states, and the two edges' images, of the negative swan."""
    swan, outline = negative(), ring(negative(), "P")
    places, images = swan.projected, swan.reset
    delta = arc(outline, places["A"], places["D"], images["C"])
    jump = reset(swan.model, shadow())
    bottom = arc(outline, images["C"], images["B"], places["D"])
    rest = np.array([images["A"], images["D"]])
    first = _views(
        swan,
        "(a) under $p$",
        "$v$",
        [
            Line(outline, "P", "P"),
            Line(delta, "jump", "arc AD'", r"$\delta$", 0.2, words=r"$\delta$: $G$ is discontinuous"),
        ],
        [Dot("$D'$", places["D"])],
        [Dot("$A'=C'$", places["A"]), Dot("$B'$", places["B"]), Dot("$E'$", places["E"])],
        [],
    )
    lines = [
        Line(outline, "P", "P"),
        Line(rest, "H", "interval A''D''", words=r"$\phi$ of the visible arc $AD$ of $H$"),
        Line(jump, "shadow", "arc D''C''", words=r"$\phi(DC)$, $DC$ the shadow"),
        Line(bottom, "Z", "arc C''B''", r"$\phi(DC)$, $\phi(CB)$", 0.4, words=r"$\phi(CB)$, $CB$ on $Z$: the same arc"),
    ]
    second = _views(
        swan,
        r"(b) under $\phi$",
        r"$\dot x$",
        lines,
        [Dot("$C''$", images["C"])],
        [Dot("$A''$", images["A"]), Dot("$B''=D''$", images["B"]), Dot("$E''$", images["E"])],
        [],
    )
    panels, gap = [first[0], second[0], first[1], second[1]], float(np.hypot(*(jump[0] - np.array(images["D"]))))
    return picture_of(15, str(swan.model), panels, {"gap": gap}, zoom=f"{ZOOM:g}")
