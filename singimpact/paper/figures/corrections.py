"""Figures B1 to B3: a linear oscillator as a ball, the first correction at a swan, exponents of the threshold."""

from functools import lru_cache
from math import log

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.dynamics.orbit import orbit
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.paper.claims.beyond import holder
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, picture_of
from singimpact.paper.trials import first_order_feet

DAMPING, CLEARANCE = 0.4, 0.9
WINDOW = -0.45, 1.0  # of t in figure B1; pi/omega_d is 3.2
SIZES = tuple(0.06 * 2.0**-n for n in range(7))  # of H in figure B2
PENS_OF_ORDERS = ("before", "graph", "loop", "gamma", "orbit", "epsilon")
NAMED = 0.35, 0.3, 0.27, 0.24, 0.21, 0.18  # share of the vertices, from r = 0 on, at which each curve has its letter


@lru_cache(maxsize=1)
def damped() -> ImpactOscillator:
    """x'' + 2x'/5 + x = cos 2t, c = 9/10, r = 1/2: an unfolded negative swan."""
    return linear(2, str(CLEARANCE), "0.5", damping=str(DAMPING))


def _frequency() -> float:
    return float(np.sqrt(1 - DAMPING**2 / 4))


def in_new_time(t: Array) -> tuple[Array, Array]:
    """s and the factor e^(beta t)/cos(omega_d t) of x - c."""
    omega, beta = _frequency(), DAMPING / 2
    return np.tan(omega * t) / omega, np.exp(beta * t) / np.cos(omega * t)


def gravity(t: Array) -> Array:
    """A(s) at the s of t."""
    return np.asarray(np.exp(DAMPING / 2 * t) * np.cos(_frequency() * t) ** 3 * acceleration(damped(), t))


def figure_B1() -> Picture:
    """One swan, and one orbit from A, in t and in the s of the ball."""
    model = damped()
    swan = swan_configuration(model, near=0)
    t = np.linspace(*WINDOW, 2001)
    s, _ = in_new_time(t)
    run = orbit(model, swan.A, 0, 40)
    flown = np.linspace(swan.A, WINDOW[1], 4001)
    height = run.sample(flown).x - as_float(model.clearance)
    places, factor = in_new_time(flown)
    hits = run.tau[(run.tau > swan.A) & (run.tau < WINDOW[1]) & np.isin(run.kind, ["impact", "complete"])]
    landed = in_new_time(hits)[0]
    top, tall = 1.15 * float(height.max()), 1.15 * float((height * factor).max())
    ends = [(np.array([swan.A, swan.B, swan.X]), "t"), (in_new_time(np.array([swan.A, swan.B, swan.X]))[0], "s")]

    def pressed(n: int, points: Array, title: str, label: str) -> Panel:
        low, high = float(points[:, 1].min()), float(points[:, 1].max())
        room = 0.12 * (high - low)
        line = Line(points, "graph", label, words="acceleration at the wall, or gravity of the ball")
        dots = [Dot(f"${name}$", (float(x), 0.0)) for name, x in zip("AB", ends[n][0][:2], strict=True)]
        box = _box(points[:, 0]), (low - room, high + room)
        return Panel(box, f"${ends[n][1]}$", f"${label}$", title, [line], dots=dots)

    def moved(n: int, points: Array, title: str, label: str, high: float, at: Array) -> Panel:
        lines = [
            Line(points, "orbit", label, words="orbit from rest at $A$"),
            *(Line(np.array([[x, 0.0]]), "crossing", "impacts", beads=True, words="impacts") for x in at.tolist()),
        ]
        names = zip("AX", (ends[n][0][0], ends[n][0][2]), strict=True)
        return Panel(
            (_box((t, s)[n]), (-0.12 * high, high)),
            f"${ends[n][1]}$",
            f"${label}$",
            title,
            lines,
            dots=[Dot(f"${name}$", (float(x), 0.0)) for name, x in names],
        )

    first = np.stack([t, acceleration(model, t)], axis=1)
    second = np.stack([s, gravity(t)], axis=1)
    panels = [
        pressed(0, first, "(a) the oscillator", "a_c"),
        pressed(1, second, "(b) the ball", "A"),
        moved(0, np.stack([flown, height], axis=1), "(c) its orbit from $A$", "x - c", top, hits),
        moved(1, np.stack([places, height * factor], axis=1), "(d) the same orbit", "y", tall, landed),
    ]
    facts = {
        "A": float(swan.A),
        "X": float(swan.X),
        "impacts": float(hits.size),
        "bends": _bends(places, height * factor, landed[0]),
    }
    return picture_of("B1", str(model), panels, facts)


def _bends(s: Array, y: Array, end: float) -> float:
    """The largest |y'' - A(s)| over the first flight, as a part of the largest |A|, by differences."""
    until = int(np.searchsorted(s, end))
    first = np.diff(y[:until]) / np.diff(s[:until])
    second = np.diff(first) / np.diff((s[: until - 1] + s[1:until]) / 2)
    wanted = gravity(np.arctan(_frequency() * s[1 : until - 1]) / _frequency())
    return float(np.abs(second - wanted).max() / np.abs(wanted).max())


def _box(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def figure_B2() -> Picture:
    """X_H - X against H, as it is and without its term of first order."""
    left, right, facts = list[Array](), list[Array](), dict[str, float]()
    for model in first_order_feet.MODELS:
        feet = first_order_feet.measured(model, "1/2", SIZES)
        term = -(feet.limit**2 - 1) / 10 * feet.chi
        size, off = np.array(feet.sizes), np.array(feet.offsets)
        rest = off - term * size
        left.append(np.stack([np.log10(size), np.log10(np.abs(off))], axis=1))
        right.append(np.stack([np.log10(size), np.log10(np.abs(rest))], axis=1))
        facts |= {
            f"order, {model.name}": feet.order(off[-2:].tolist()),
            f"without, {model.name}": feet.order(rest[-2:].tolist()),
        }
    box = ((-3.1, -0.8), (-6.0, -0.4))

    def panel(title: str, rows: list[Array], slope: int) -> Panel:
        low = box[0]
        start = -0.8 if slope == 1 else -2.2
        guide = np.array([[x, start + slope * (x - low[1])] for x in low])
        lines = [
            Line(guide, "before", f"slope {slope}", f"slope {slope}", 0.35, words="slopes 1 and 2"),
            *(Line(points, "orbit", "errors", beads=True, words="five oscillators, $r = 1/2$") for points in rows),
        ]
        return Panel(box, r"$\log_{10} H$", r"$\log_{10}$ of the error", title, lines)

    return picture_of(
        "B2",
        "; ".join(model.name for model in first_order_feet.MODELS),
        [panel("(a) $|X_H - X|$", left, 1), panel("(b) without the known term", right, 2)],
        facts,
    )


def exponents(order: int) -> Array:
    """(r, alpha) at a contact order, along the multiplier lambda in (0, 1)."""
    rate = 1 - np.geomspace(1e-3, 1 - 1e-3, 400)[::-1]
    up = sum((order + 1 - i) * rate**i for i in range(order + 1))
    down = sum((i + 1) * rate**i for i in range(order + 1))
    mu = (up / down) ** 2 / rate
    return np.stack([rate ** (order + 1) * up / down, np.log(1 / rate) / np.log(mu)], axis=1)


def figure_B3() -> Picture:
    """The exponent alpha of the threshold against r, for contact orders 0 to 5, with true orbits."""
    lines, facts = list[Line](), dict[str, float]()
    for order, pen in enumerate(PENS_OF_ORDERS):
        curve = exponents(order)
        lines.append(
            Line(curve, pen, f"j = {order}", f"$j = {order}$", NAMED[order], words=f"contact order $j = {order}$")
        )
        facts[f"alpha at r = 1, j = {order}"] = float(curve[-1, 1])
    for start in holder.STARTS:
        for rate in holder.RATES:
            orbits = holder.beside(start, rate)
            mark = np.array([[_value(rate), orbits.slope]])
            lines.append(Line(mark, "crossing", "true orbit", beads=True, words="slopes of true orbits"))
            facts[f"{start.name}, r = {rate}"] = orbits.slope - log(1 / orbits.lambda_) / log(orbits.mu)
    return picture_of(
        "B3",
        "; ".join(start.name for start in holder.STARTS),
        [Panel(((0.0, 1.0), (0.1, 1.05)), "$r$", r"$\alpha$", lines=lines)],
        facts,
    )


def _value(rate: str) -> float:
    above, _, below = rate.partition("/")
    return int(above) / int(below)
