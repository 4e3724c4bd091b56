"""Figures 1, 2, 9 and 10: the impact surface with its horizon, how its outline changes, outlines of a swan's zeros."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.flights.impact_map import first_hit
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.paper.figures.contact_figures import launch_and_landing, oscillator
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Point, picture_of
from singimpact.paper.figures.swan_figures import box, half, negative, positive, ring
from singimpact.surface import Curve, ImpactSurface

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
        lines += [
            Line(over, "hidden", f"line over w_{n + 1}", words="lines $w = $ const. that touch the surface on $H$"),
            Line(
                position[None],
                "orbit",
                f"touching point over w_{n + 1}",
                f"$w_{n + 1}$",
                beads=True,
                words="touching points",
            ),
        ]
    return picture_of(1, str(model), [Panel(((LEFT, RIGHT), (LOW, HIGH)), mesh=_mesh(), lines=lines)])


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
    width of the picture. pixels : of the curves, many where the shear magnifies. power : of ten by which v - q is
    multiplied.
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
    power: int = 0


CHANGES = (
    Change("lips", "w", 2.2346139563997207, 0.5665872036436089, 4.089046551292352, 0.2, 0.0001, 3, 0.03, 3000, 6),
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
    return picture_of(
        2,
        str(damped()),
        panels,
        facts,
        lips=f"{CHANGES[0].value:.6f}",
        beaks=f"{CHANGES[1].value:.6f}",
        swallowtail=f"{CHANGES[2].value:g}",
    )


def _equally_high(panels: list[Panel]) -> list[Panel]:
    """Panels with one vertical scale: their lower ends come up to the height of the least high."""
    height = min(panel.box[1][1] - panel.box[1][0] for panel in panels)
    return [replace(panel, box=(panel.box[0], (panel.box[1][1] - height, panel.box[1][1]))) for panel in panels]


def _panels(letter: str, change: Change, rows: list[tuple[str, list[Curve]]]) -> list[Panel]:
    middle = _middle(change, rows)
    shear = _shear(change, rows, middle)
    point = np.array([[change.tau + change.t, 0.0]])  # where lips are born; the shear of that panel goes through it
    box = _box(change, middle, [shear(curve.points) for _, surface in rows for curve in surface])
    name, panels = "c" if change.over == "clearance" else change.over, []
    y = r"$v - q(\tau)$" if not change.power else rf"$10^{change.power}\,(v - q(\tau))$"
    for relation, surface in rows:
        cusps = [shear(curve.marked("cusp")) for curve in surface]
        cusps += [point] if relation == "=" and change.kind == "lips" else []
        panels.append(
            Panel(
                box,
                y=y if relation == "<" else "",
                note=({"=": "one point", ">": "no outline here"}.get(relation, "") if change.kind == "lips" else ""),
                title=f"({letter}) {change.kind}: ${name} {relation} {name}_0$",
                lines=[Line(shear(curve.points), "P", "P") for curve in surface],
                dots=[Dot("", (float(x), float(y))) for cusp in cusps for x, y in cusp],
            )
        )
    return panels


def _shear(change: Change, rows: list[tuple[str, list[Curve]]], middle: float) -> Callable[[Array], Array]:
    """(tau, v) -> (tau, v - q(tau)) with q near to all branches."""
    points = np.vstack([curve.points for _, outline in rows for curve in outline])
    points = points[np.abs(points[:, 0] - middle) < change.shown]
    fitted = np.polyfit(points[:, 0] - middle, points[:, 1], change.degree)
    return lambda place: np.stack(
        [place[:, 0], 10.0**change.power * (place[:, 1] - np.polyval(fitted, place[:, 0] - middle))], axis=1
    )


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


# 9 and 10: a(tau) with the outlines that its zeros make, and sections of V' at constant tau.

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
        panels.append(
            Panel(
                box(swan, -4.2, 4.2, -v, v),
                title=f"({letter}) outline $P$, $c={values[2]}$",
                lines=[Line(ring(swan, "P"), "P", "P")],
                dots=[*letters, *[Dot("$D'$", swan.projected["D"]), Dot("$C''$", swan.reset["C"])]],
            )
        )
        facts[f"cusps_{kind}"] = float(sum(len(c.marked("cusp")) for c in swan.surface.outline if c.closed))
    return picture_of(9, "x'' + x = cos 2t", panels, facts)


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
            *(Line(piece, "graph", "first hits", words="first hits with $v > 0$") for piece in _visible(tau, curve)),
        ]
        letter = NAMED.get(point)
        panels.append(
            Panel(
                ((-3.2 * size, 7.2 * size), (1.1 * low, 1.1 * high)),
                "$t$" if n >= 4 else "",
                "$v$" if n % 4 == 0 else "",
                (f"$\\sigma = {point:.3g}$" if letter is None else f"$\\sigma = {point:.3g}$, ${letter}$"),
                lines,
                dots=(
                    []
                    if letter is None
                    else [Dot(f"${letter}$", (positive().points[letter][1], positive().projected[letter][1]))]
                ),
            )
        )
    return picture_of(10, str(swan.model), panels)


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
