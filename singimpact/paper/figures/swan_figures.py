"""Figures 11 to 17: an unfolded swan on V', its images under p and phi, and the dynamics of G that it creates."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.dynamics import SwanConfiguration, before, gammas_within, held, stable_manifold, swan_configuration
from singimpact.flights.rebound_law import rebound
from singimpact.impact_oscillator import linear
from singimpact.paper.figures.contact_figures import rebounded, reset
from singimpact.paper.figures.panel import ARCS, Dot, Line, Panel, Picture, Point, Region, arc, picture_of
from singimpact.scenes.style import WHITE
from singimpact.surface import ImpactSurface, Window

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
        Panel(((left, right), (low, high)), title=f"{title}, magnified", y=y, lines=lines, dots=near, regions=regions),
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


LEAVES = 9
GENERATIONS = 3  # of inverse images of delta; further ones lie within a line's width of gamma


def figure_13() -> Picture:
    """gamma divides S': below it chatter to a point of AB, above it orbits leave."""
    swan, size, outline = positive(), half(positive()), ring(positive(), "P")
    places = swan.projected
    edge = arc(outline, places["E"], places["B"], places["D"])
    v = 1.35 * float(edge[:, 1].max())
    window = box(swan, -2.2, 1.7, -0.1 * v, v)
    frame = Window(window[0], (0.0, v), 1 / ARCS)
    lines = [Line(edge, "jump", "arc BE' of P", "$P$", 0.35, words="arc $BE'$ of the outline $P$")]
    for foot in np.linspace(swan.A, swan.B, LEAVES + 2)[1:-1].tolist():
        lines += [Line(curve.points, "manifold", "leaf") for curve in stable_manifold(swan.model, frame, repr(foot))]
    curve = next(gamma for gamma in gammas_within(swan.model, frame) if abs(gamma.points[0, 0] - swan.B) < 1e-6)
    lines += [
        Line(curve.points, "gamma", "gamma", r"$\gamma$", 0.55),
        Line(
            _epsilon(),
            "epsilon",
            "epsilon",
            r"$\varepsilon$",
            0.85,
            words=r"$\varepsilon$: image of the interval from $E'$ to $A$",
        ),
    ]
    facts = {"gamma_end": float(curve.points[-1, 0]), "E": places["E"][0], "A": swan.A, "N": float(swan.N[0])}
    panel = Panel(
        window,
        lines=lines,
        dots=[Dot("$A$", places["A"]), Dot("$B$", places["B"]), Dot("$E'$", places["E"]), Dot("$N$", swan.N)],
        regions=[Region(edge, words=r"$\mathcal{S}'$: states that hit before they leave the swan")],
    )
    return picture_of(13, str(swan.model), [panel], facts={**facts, "size": size})


def _epsilon() -> Array:
    """R(phi(AE)) from A to N."""
    swan, outline = positive(), ring(positive(), "P")
    lower = arc(outline, swan.reset["A"], swan.reset["E"], swan.projected["D"])
    upper = np.stack([lower[:, 0], rebound(swan.model, np.minimum(lower[:, 1], 0.0))], axis=1)
    return np.vstack([upper[upper[:, 0] < swan.N[0]], [swan.N]])


@lru_cache(maxsize=1)
def delta() -> Array:
    """The discontinuity arc AD' of the negative swan, from A on."""
    swan = negative()
    return arc(ring(swan, "P"), swan.projected["A"], swan.projected["D"], swan.reset["C"])


def figure_16() -> Picture:
    """The images under phi o F of the edges of the cut delta, of AB and of the axis left of A."""
    swan, size = negative(), half(negative())
    model, v = swan.model, 1.15 * swan.projected["D"][1]
    jump, landed = delta(), reset(model, shadow())
    bottom = arc(ring(swan, "P"), swan.reset["C"], swan.reset["B"], swan.projected["D"])
    left = np.array([[swan.A - 3 * size, 0.0], [swan.A, 0.0]])
    between, right = np.array([[swan.A, 0.0], [swan.B, 0.0]]), np.array([[swan.B, 0.0], [swan.B + 3 * size, 0.0]])
    B = negative().B
    onto = np.array([[B, 0.0], [B + 0.75 * (4 * size), 0.0]])
    words = {
        "1": "1, 5: on $\\Pi_0$ outside $AB$, at rest",
        "2": r"2: lower edge of the cut $\delta$, and its image",
        "3": r"3: upper edge of $\delta$ (drawn moved away), and its image",
        "4": "4: interval $AB$, and its image (drawn moved right)",
    }

    def step(points: Array, name: str, number: str, at: float = 0.5, arrow: bool = True) -> Line:
        pen = {"2": "graph", "3": "shadow", "4": "Z"}.get(number, "rest")
        return Line(points, pen, name, number, at, arrow and pen != "rest", words.get(number, words["1"]))

    first = [
        step(left, "left of A", "1"),
        step(jump, "lower edge", "2", 0.6),
        step(jump + np.array([0.09 * size, 0.035 * v]), "upper edge", "3", 0.55),
        step(between, "AB", "4"),
        step(right, "right of B", "5"),
    ]
    second = [
        step(left, "image of 1", "1"),
        step(np.array([swan.reset["A"], swan.reset["D"]]), "image of 2", "2"),
        step(landed[::-1], "image of 3", "3"),
        step(bottom + np.array([0.2 * size, 0.0]), "image of 4, moved right", "4", 0.4),
        step(onto, "image of 5", "5"),
    ]
    third = [replace(line, points=rebounded(line.points, 0.5)) for line in second]
    letters = [Dot("$A$", (swan.A, 0.0)), Dot("$B$", (swan.B, 0.0))]
    panels = [
        Panel(
            box(swan, -4, 4.2, -0.25 * v, 1.1 * v),
            title=r"$\Pi^+$, cut along $\delta$",
            lines=first,
            dots=[*letters, Dot("$D'$", swan.projected["D"])],
        ),
        Panel(
            box(swan, -4, 4.2, -1.1 * v, 0.25 * v),
            title=r"after $\phi\circ F$",
            y=r"$\dot x$",
            lines=second,
            dots=[Dot("$A''$", swan.reset["A"]), Dot("$D''=B''$", swan.reset["B"]), Dot("$C''$", swan.reset["C"])],
        ),
        Panel(
            box(swan, -4, 4.2, -0.25 * v, 1.1 * v), title=r"after $R$", lines=third, dots=[*letters, Dot("$Q$", swan.Q)]
        ),
    ]
    return picture_of(16, str(model), panels)


def figure_17() -> Picture:
    """W^s(X) with its loops, the inverse images of delta, and gamma on which they accumulate."""
    swan, size = negative(), half(negative())
    v = 1.12 * swan.projected["D"][1]
    window = box(swan, -4.2, 5.6, -0.1 * v, v)
    frame = Window((window[0][0] - size, window[0][1]), (0.0, 1.3 * v), 1 / ARCS)
    manifold = stable_manifold(swan.model, frame, repr(swan.X))
    loops, arcs = _loops([curve.points for curve in manifold], swan.A), gammas_within(swan.model, frame)
    across = rebounded(reset(swan.model, shadow()), 0.5)
    lines = [
        *(
            Line(curve.points, "manifold", "beyond X", words="stable manifolds of times after $X$")
            for foot in (1.02, 1.08, 1.16)
            for curve in stable_manifold(swan.model, frame, repr(swan.X + (foot - 1) * 5 * size))
        ),
        *_foot_and_lambda(manifold[0].points, swan.A, swan.Q),
        *(
            Line(
                branch,
                "loop",
                f"G^-{n}(lambda), {side} branch",
                r"$G^{-1}(\lambda)$" if label else "",
                0.45,
                words="$W^s(X)$: stable manifold of $X$",
            )
            for n, branches in enumerate(loops, 1)
            for side, branch, label in (("right", branches[0], n == 1), ("left", branches[1], False))
        ),
        *(
            Line(points, "preimage", f"G^-{n}(delta)", at=0.6, words=rf"$G^{{-n}}(\delta)$, $n \leq {GENERATIONS}$")
            for n, points in enumerate(_preimages(frame), 1)
        ),
        Line(delta(), "jump", "delta", r"$\delta$", 0.75, words=r"$\delta$: $G$ is discontinuous"),
        Line(arcs[0].points, "gamma", "gamma", r"$\gamma$", 0.35),
        Line(across, "epsilon", "R(D''C'')", r"$R(D''C'')$", 0.45, words=r"$R(D''C'')$: image of $\delta$ from above"),
    ]
    dots = [
        Dot("$A$", (swan.A, 0.0)),
        Dot("$B=D''$", (swan.B, 0.0)),
        Dot("$X$", (swan.X, 0.0)),
        Dot("$Q$", swan.Q),
        Dot("$D'$", swan.projected["D"]),
    ]
    facts = {"X": swan.X, "Q": swan.Q[0], "pieces": float(len(manifold)), "generations": float(len(loops))}
    facts |= _accumulation(loops, arcs[0].points, swan.projected["D"][1] / 2)
    panels = [Panel(window, title="(a)", lines=lines, dots=dots), _beside_gamma(lines, arcs[0].points, window[1][1])]
    return picture_of(17, str(swan.model), panels, facts)


def _beside_gamma(lines: list[Line], gamma: Array, height: float) -> Panel:
    """The curves left of A, with tau reckoned from gamma at the same velocity."""
    order = np.argsort(gamma[:, 1])
    nearby, wide = [], 0.16
    for line in lines:
        v = np.clip(line.points[:, 1], 0.0, None)
        points = np.stack([line.points[:, 0] - np.interp(v, gamma[order, 1], gamma[order, 0]), v], axis=1)
        if line.pen != "epsilon" and line.points[:, 0].min() < negative().A:
            label = r"$G^{-1}(\delta)$" if line.name == "G^-1(delta)" else line.label
            nearby.append(replace(line, points=points, name=f"{line.name}, beside gamma", label=label))
    return Panel(((-0.04 * wide, wide), (-0.1 * height, height)), r"$\tau - \tau_\gamma(v)$", title="(b)", lines=nearby)


def _foot_and_lambda(points: Array, foot: float, crossing: tuple[float, float]) -> list[Line]:
    """W^s(X) from X to Q, and lambda from Q to A."""
    turn = _turn(points, foot)
    met = int(np.argmin(np.abs(points[:turn, 0] - crossing[0])))
    at = met if points[met, 0] > crossing[0] else met - 1
    first, second = np.vstack([points[: at + 1], [crossing]]), np.vstack([[crossing], points[at + 1 : turn + 1]])
    return [
        Line(first, "loop", "W^s(X)", words="$W^s(X)$: stable manifold of $X$"),
        Line(
            np.vstack([second, [[foot, 0.0]]]),
            "loop",
            "lambda",
            r"$\lambda\subset W^s(X)$",
            0.4,
            words="$W^s(X)$: stable manifold of $X$",
        ),
    ]


def _turn(points: Array, foot: float) -> int:
    """Where a stretch of W^s(X) comes nearest to A from the left."""
    return int(np.argmin(np.where(points[:, 0] < foot, points[:, 1], np.inf)))


def _loops(pieces: list[Array], foot: float) -> list[tuple[Array, Array]]:
    """G^{-n}(lambda), n = 1, 2, ...: the branch from A up, to the right, and the one down to A again, to the left.

    W^s(X) runs from X over lambda to A, up out of the picture and down again: it is parted where v is least, at A.
    """
    turns = [_turn(piece, foot) for piece in pieces]
    up = [piece[turn:] for piece, turn in zip(pieces, turns, strict=True)]
    down = [piece[: turn + 1] for piece, turn in zip(pieces, turns, strict=True)]
    return [pair for pair in zip(up, down[1:], strict=False) if min(map(len, pair)) > 1]


def _accumulation(loops: list[tuple[Array, Array]], gamma: Array, height: float) -> dict[str, float]:
    """Distances to the right of gamma at which the branches, and delta, pass a height."""

    def at(points: Array) -> float:
        order = np.argsort(points[:, 1])
        return float(np.interp(height, points[order, 1], points[order, 0]))

    names = ("right", "left")
    return {"gap delta": at(delta()) - at(gamma)} | {
        f"gap {n} {side}": at(branch) - at(gamma)
        for n, branches in enumerate(loops, 1)
        for side, branch in zip(names, branches, strict=True)
    }


def _preimages(frame: Window) -> list[Array]:
    curves, points = [], delta()[delta()[:, 1] > 0]
    share = np.linspace(0, len(points) - 1, 600)
    points = np.stack([np.interp(share, np.arange(len(points)), column) for column in points.T], axis=1)
    for _ in range(GENERATIONS):
        points = before(negative().model, points)
        points = points[np.isfinite(points).all(axis=1)]
        inside = points[held(frame, points)]
        if len(inside) > 1:
            curves.append(inside)
    return curves
