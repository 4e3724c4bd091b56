"""Figures B1 to B11, of what the paper does not have.

A linear oscillator as a ball, the first correction at a swan, exponents of the threshold; heights of the loops of
W^s(X), the foot X as a function of r, the orbit that is born at a swan; the visible outline where a swan's arc meets
other branches of P; gamma of impacts that lose a power of a low speed; all simple orbits of an oscillator; the
curves that end at a contact of order three.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import sqrt

import numpy as np
import sympy

from singimpact.algebra import Array, as_float, halved
from singimpact.branches.certified_diagram import certified_diagram
from singimpact.branches.events import KINDS
from singimpact.contact.points import tangency_points
from singimpact.dynamics.orbit import orbit
from singimpact.dynamics.threshold import threshold
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator import Oscillator, acceleration
from singimpact.paper.claims.beyond.every_order import j
from singimpact.paper.claims.beyond.hertz import EXPONENT, FACTOR, SECOND, q
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Point, Region, picture_of
from singimpact.paper.trials.universal_foot import covering, elastic, foot, scaled
from singimpact.scenes.style import SURFACE
from singimpact.surface import Curve, ImpactSurface, transitions

SHOWN = 5  # generations in figure B4
BORN = ("0.9", "0.97", "0.999")  # clearances of figure B6, c_0 = 1
POWER = Fraction(3, 7)
PENS_OF_DEPTHS = ("manifold", "preimage", "graph")


def gamma_height(r: float) -> float:
    """w of gamma at a tangency."""
    roots = np.roots([1.0, 2.0, -2 * r, -r])  # lambda^2 (2 + lambda) = r (1 + 2 lambda)
    (rate,) = [float(root.real) for root in roots if abs(root.imag) < 1e-9 and 0 < root.real < 1]
    return (1 - rate) * (2 + rate) / 6


def preimage(w: float, r: float) -> float:
    """The height whose image under the one-dimensional map is w: (2r + 6w) l^2 = r(1 + l), w' = (1-l)(2+l)/6.

    Examples
    --------
    >>> round(preimage(0.5, 0.5), 6)
    0.233462
    """
    lead = 2 * r + 6 * w
    ratio = (r + sqrt(r * r + 4 * r * lead)) / (2 * lead)
    return (1 - ratio) * (2 + ratio) / 6


def generations(w: float, r: float, count: int = SHOWN) -> list[float]:
    """A height and its inverse images.

    Examples
    --------
    >>> [round(each, 4) for each in generations(0.375, 0.5, 3)]
    [0.375, 0.216, 0.1777]
    """
    heights_ = [w]
    while len(heights_) < count:
        heights_.append(preimage(heights_[-1], r))
    return heights_


def inner_start(r: float) -> float:
    """The height below the tear whose flight lands behind A on W^s(X): r(1 + l - 2 l^2) = 3 l^2, -1/2 < l < 0."""
    ratio = (r - sqrt(r * r + 4 * r * (3 + 2 * r))) / (2 * (3 + 2 * r))
    return (1 - ratio) * (2 + ratio) / 6


def figure_B4() -> Picture:
    """Heights of W^s(X), tears and gamma over A - h, in units of a'(A) h^2, against r."""
    rates = np.linspace(0.01, 0.99, 197)
    gamma = np.array([gamma_height(r) for r in rates.tolist()])
    kinds = {
        "outer": ("loop", "$W^s(X)$: upper and lower edge of each loop"),
        "tear": ("P", "tears: $\\delta$ and inverse images"),
        "inner": ("loop", "$W^s(X)$: upper and lower edge of each loop"),
    }
    starts = {"outer": lambda _: 0.5, "tear": lambda _: 0.375, "inner": inner_start}
    curves = {name: np.array([generations(start(r), r) for r in rates.tolist()]).T for name, start in starts.items()}
    plain, beside = [], []
    for name, (pen, words) in kinds.items():
        for row in curves[name]:
            plain.append(Line(np.stack([rates, row], axis=1), pen, name, words=words))
            beside.append(Line(np.stack([rates, np.log10(row - gamma)], axis=1), pen, name, words=words))
    plain.append(Line(np.stack([rates, gamma], axis=1), "gamma", "gamma", r"$\gamma$", 0.6))
    panels = [
        Panel(((0.0, 1.0), (0.0, 0.52)), "$r$", r"$v/(a'(A)h^2)$", "(a) heights", plain),
        Panel(((0.0, 1.0), (-4.2, -0.2)), "$r$", r"$\log_{10}(w - w_\gamma)$", "(b) above $\\gamma$", beside),
    ]
    return picture_of("B4", "x'' = s next to A", panels)


def figure_B5() -> Picture:
    """X (1 - r)^(3/7): enclosed for all r up to 19/20, some values beyond, the limit, and 3 within 2 %."""
    boxes = covering(Fraction(0), Fraction(19, 20))
    tops = np.array([[float(edge), float(scaled(box.high, box.r[0], POWER))] for box in boxes for edge in box.r])
    bottoms = np.array([[float(edge), float(scaled(box.low, box.r[1], POWER))] for box in boxes for edge in box.r])
    band = np.array([[0.0, 2.94], [1.0, 2.94], [1.0, 3.06], [0.0, 3.06]])
    thin = [Fraction(n, 40) for n in range(40)] + [
        Fraction(*bound) for bound in ((97, 100), (98, 100), (99, 100), (199, 200))
    ]
    curve = np.array([[float(r), float(scaled(foot(r, 1e-3)[0], r, POWER))] for r in thin])
    u = [float(bound) for bound in elastic().invariant]
    limit = (14 * u[0] / (3 * 12 ** (2 / 3))) ** (3 / 7)
    lines = [
        Line(curve, "graph", "X(1-r)^(3/7)", words=r"$X(r)\,(1-r)^{3/7}$"),
        Line(np.array([[0.0, limit], [1.0, limit]]), "before", "limit", words=r"its limit 2.94103 as $r \to 1$"),
    ]
    regions = [
        Region(band, words="3 within 2 %"),
        Region(np.vstack([tops, bottoms[::-1]]), SURFACE, words="proved bounds, for all $r$ up to 0.95"),
    ]
    return picture_of(
        "B5",
        "x'' = 12(1 - t^2), c = 0",
        [Panel(((0.0, 1.0), (2.92, 3.08)), "$r$", r"$X\,(1-r)^{3/7}$", lines=lines, regions=regions)],
        facts={"limit": limit, "most": float(tops[:, 1].max()), "least": float(bottoms[:, 1].min())},
    )


def figure_B6() -> Picture:
    """The orbit that is born: over two periods, and its hop in lengths scaled by H beside the limit."""
    first = linear(2, BORN[0], "0.8")
    run = orbit(first, 1, 0, 200)
    times = np.linspace(1.6, 1.6 + 2 * np.pi, 8001)
    height = run.sample(times).x - as_float(first.clearance)
    whole = Line(np.stack([times, height], axis=1), "orbit", "orbit", words=f"orbit that is born, $c = {BORN[0]}$")
    s = np.linspace(-1, 3, 400)
    hops, facts = list[Line](), dict[str, float]()
    for c, pen in zip(BORN, PENS_OF_DEPTHS, strict=True):
        points = hop_in_units(c)
        hops.append(Line(points, pen, f"c = {c}", words=f"$c = {c}$"))
        facts[f"height at c = {c}"] = float(points[:, 1].max())
    limit = np.stack([s, (s + 1) ** 3 * (3 - s) / 24], axis=1)
    hops.append(Line(limit, "at", "limit", words=r"$\frac{1}{24}(s+1)^3(3-s)$"))
    top = 1.15 * float(height.max())
    panels = [
        Panel(((times[0], times[-1]), (-0.08 * top, top)), "$t$", "$x - c$", "(a) two periods", [whole]),
        Panel(((-1.2, 6.6), (-0.1, 1.25)), "$s$", r"$(x-c)/(|a''|H^4)$", "(b) one hop", hops),
    ]
    return picture_of("B6", str(first), panels, facts)


def hop_in_units(c: str) -> Array:
    """(s, (x - c)/(|a''| H^4)) from the release to the end of the chatter."""
    model = linear(2, c, "0.8")
    run = orbit(model, 1, 0, 200)
    released = float(run.tau[run.kind == "release"][0])
    rested = float(run.tau[(run.kind == "complete") & (run.tau > released)][0])
    middle = round(released / np.pi) * np.pi  # of A and B, as a_c is even about it
    half = middle - released
    bend = abs(float(acceleration(model, np.array([middle]), order=2)[0]))
    times = np.linspace(released, rested, 3001)
    height = run.sample(times).x - as_float(model.clearance)
    return np.stack([(times - middle) / half, height / (bend * half**4)], axis=1)


# B7 and B8: the visible outline before, at and after a swan's arc meets other branches of P.


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
    return picture_of("B7", str(model), *_rows(model, B7))


def figure_B8() -> Picture:
    """A triple point, and the two tangencies."""
    model = two_waves()
    return picture_of("B8", str(model), *_rows(model, B8))


def _rows(model: Oscillator, rows: tuple[Row, ...]) -> tuple[list[Panel], dict[str, float]]:
    panels, facts = list[Panel](), dict[str, float]()
    for row in rows:
        ends, rests = (row.value - 1e-4, row.value + 1e-4), (-row.reach, row.reach)
        (transition,) = transitions(model, "clearance", ends, rests, row.kind).visible
        facts[row.title] = transition.value
        launch = transition.launch or (transition.rests[0], 0.0)
        tau = launch[0] + row.tau[0], launch[0] + row.tau[1]
        shifts = (row.apart[0], ASIDE * row.apart[0], row.apart[1])
        sides = [(transition.value + shift, sign) for shift, sign in zip(shifts, ">=<", strict=True)]
        surfaces = [(_surface(model, c, tau, row), c, sign) for c, sign in sides]
        facts |= {f"{row.title} {sign}": float(_ends(surface, tau)) for surface, _, sign in surfaces}
        panels += _drawn(row, launch, tau, surfaces)
    return panels, facts


def _surface(model: Oscillator, clearance: float, tau: tuple[float, float], row: Row) -> ImpactSurface:
    """The surface in a window whose rests can be reached from the launches shown."""
    return ImpactSurface(
        model.replace(clearance=clearance), (tau[0], tau[1] + row.long), (-row.long, 0.01), 1 / row.fine
    )


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
        lines = [
            *(Line(shift(curve), "P", "P") for curve in _inside(surface.outline, tau)),
            *(Line(shift(curve), "jump", "visible P") for curve in _inside(surface.discontinuities, tau)),
        ]
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


# B9: gamma of impacts that lose a power of a low speed, its exponent and its second term.

ORDERS = {1: "graph", 2: "epsilon"}
LARGEST = 0.6  # q
POWERS = tuple(Fraction(n, 10) for n in (1, 2, 3, 4))
STARTS = (  # (f, g, j): a_c vanishes at tau = 0 to order j, with |a_j|/j! = 1
    ("0", "t", 1),
    ("x", "sin(t)", 1),
    ("0", "-t**2", 2),
    ("x", "(cos(2*t) - 1)/2", 2),
)
FLIGHTS = 1 / 100, 1 / 300  # v/h^(j+1) at two places, half the flight time over h: impacts grow like its inverse
FARTHEST = 0.01  # h of the first place; what an oscillator has beyond its leading term is of order h^2 here


def on_gamma(start: tuple[str, str, int], power: Fraction) -> tuple[float, list[tuple[float, float]]]:
    """C and two points (h, v) of gamma over tau = -h; C is chosen so that flights have the wanted length."""
    (f, g, order), share = start, float(1 - power)
    growth = (order + 1) * float(power) / share  # v/h^(j+1) is a constant times h^growth
    leading = 3 * share / (2 * (3 + (2 + float(power)) * order))
    loss = f"{(FLIGHTS[0] / FARTHEST**growth) ** share / leading:.3g}"
    osc = Oscillator(f, g, 0, f"-v*(1 - C*(-v)**({power}))", {"C": loss})
    distances = [FARTHEST * (flight / FLIGHTS[0]) ** (1 / growth) for flight in FLIGHTS]
    return float(loss), [(h, float(threshold(osc, -h).v)) for h in distances]


def figure_B9() -> Picture:
    """The exponent against q, and what gamma has beyond the first term against the second term."""
    powers = np.linspace(0, LARGEST, 121)
    first = [
        Line(
            np.stack([powers, (order + 1) / (1 - powers)], axis=1),
            pen,
            f"j = {order}",
            f"$j = {order}$",
            0.7,
            words=f"contact order $j = {order}$",
        )
        for order, pen in ORDERS.items()
    ]
    second = [Line(np.array([[x, x] for x in (-4.0, -1.0)]), "before", "equal", words="equal")]
    for start in STARTS:
        for power in POWERS:
            values = {j: start[2], q: sympy.Rational(power.numerator, power.denominator)}
            n, k, g = (float(formula.subs(values)) for formula in (EXPONENT, FACTOR, SECOND))
            loss, points = on_gamma(start, power)
            w = (k * loss) ** (1 / (1 - float(power)))
            rows = [(np.log10(g * v / h ** (start[2] + 1)), np.log10(v / (w * h**n) - 1)) for h, v in points]
            ((run, rise),) = np.diff(np.log(points), axis=0)
            marks = [np.array([[float(power), rise / run]]), *(np.array([row]) for row in rows)]
            for lines, mark in zip((first, second, second), marks, strict=True):
                lines.append(Line(mark, "crossing", "true orbits", beads=True, words="thresholds of true orbits"))
    panels = [
        Panel(((0.0, LARGEST), (1.5, 7.0)), "$q$", r"exponent of $|\sigma|$", "(a) the exponent", first),
        Panel(
            ((-4.0, -1.0), (-4.0, -1.0)), r"$\log_{10} GP$", r"$\log_{10}$ of the excess", "(b) the second term", second
        ),
    ]
    return picture_of("B9", "; ".join(f"x'' + {f} = {g}" for f, g, _ in STARTS), panels)


# B10: all orbits of one and two impacts of an oscillator, over the clearance.

PENS_OF_EVENTS = "gamma", "crossing", "axis", "axis", "rest", "orbit"  # in the order of `KINDS`


def figure_B10() -> Picture:
    """Velocities after the impacts of every orbit, over the clearance, and the places where orbits change."""
    model = linear("2.8", 0, "0.8")
    diagram = certified_diagram(model, between=("-0.6", "1.8"), v=(0, 4))
    lines = list[Line]()
    for arc in diagram.arcs:
        pen = f"({arc.n}, {arc.k}) orbits, {'stable' if arc.stable else 'unstable'}"
        lines += [Line(np.stack([arc.clearance, row], axis=1), pen) for row in arc.v.T]
    looks = {kind.name: (pen, kind.word) for kind, pen in zip(KINDS, PENS_OF_EVENTS, strict=False)}
    for joint in diagram.joints:
        pen, words = looks.get(joint.kind, ("axis", "edge of the window"))
        dots = [np.array([[joint.clearance.value, speed.value]], float) for speed in joint.v]
        lines += [Line(dot, pen, joint.kind, beads=True, words=words) for dot in dots]
    lines += [
        Line(np.array([[sum(gap.between) / 2, sum(gap.v) / 2]]), "manifold", beads=True, words="left open")
        for gap in diagram.open_parts
    ]
    panels = [
        Panel(((-0.7, 1.9), (-0.1, 3.6)), "$c$", "$v$", "(a) all orbits", lines),
        Panel(((-0.2, 0.12), (-0.015, 0.48)), "$c$", "$v$", "(b) the orbits near grazing", lines),
    ]
    return picture_of("B10", str(model), panels, {"open": float(len(diagram.open_parts))})


# B11: the plane of p and q at a contact of order three, a_c = t^3 + p t + q.

SWAN = 2 / 3**1.5  # |kappa| of the swans
GRAZES = {  # impacts that an orbit beyond the curve has at most -> its look
    0: ("P", "graze of the hop"),
    1: ("loop", "graze after one impact"),
    2: ("preimage", "graze after two impacts"),
    10**9: ("gamma", r"border orbit, $\kappa_*(r)$"),
}


def impacts_before_leaving(r: float, kappa: float) -> float:
    """The impacts before t_3 of the orbit that is released at t_1, p = -1; infinite where its chatter completes.

    Examples
    --------
    >>> [impacts_before_leaving(0.5, kappa) for kappa in (-0.3, -0.2, -0.05)]
    [inf, 1, 0]
    """
    model = Oscillator("0", "t**3 - t + q", 0, repr(r), {"q": kappa})
    run = orbit(model, tangency_points(model)[0].tau, 0, 2000)
    return np.inf if "complete" in run.kind else int((run.kind == "impact").sum())


def _end_of(r: float, most: int) -> float:
    return halved(lambda kappa: impacts_before_leaving(r, kappa) > most, -SWAN, 0.0, 1e-5)[0]


def figure_B11() -> Picture:
    """The curves of q over p at r = 1/2, and what they are at p = -1 for every r."""
    rates, p = np.linspace(0.02, 0.98, 17), np.linspace(-1.2, 0, 200)
    half, curves = list[Line](), list[Line]()
    for most, (pen, words) in GRAZES.items():
        ends = [_end_of(r, most) for r in rates.tolist()]
        half.append(Line(np.stack([p, ends[8] * (-p) ** 1.5], axis=1), pen, words, words=words))
        curves.append(Line(np.stack([rates, np.array(ends)], axis=1), pen, words, words=words))
    for sign in (-1, 1):
        half.append(Line(np.stack([p, sign * SWAN * (-p) ** 1.5], axis=1), "before", "swan", words="swans"))
    curves.append(Line(np.array([[0.0, -SWAN], [1.0, -SWAN]]), "before", "swan", words="swans"))
    panels = [
        Panel(((-1.2, 0.1), (-0.55, 0.55)), "$p$", "$q$", "(a) $r = 1/2$", half),
        Panel(((0.0, 1.0), (-0.41, -0.08)), "$r$", "$q/|p|^{3/2}$", "(b) every $r$", curves),
    ]
    return picture_of("B11", "x'' = t^3 + pt + q, c = 0", panels)


DAMPING, CLEARANCE = 0.4, 0.9
WINDOW = -0.45, 1.0  # of t in figure B1; pi/omega_d is 3.2
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
    return picture_of("B1", str(model), panels, {"A": float(swan.A), "X": float(swan.X), "impacts": float(hits.size)})


def _box(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def figure_B2() -> Picture:
    """The coefficient of chi H in the foot of an unfolded swan, against r."""
    rates = [Fraction(n, 40) for n in range(39)]
    feet = np.array([[float(r), float(foot(r, 1e-3)[0])] for r in rates])
    curve = np.stack([feet[:, 0], (1 - feet[:, 1] ** 2) / 10], axis=1)
    line = Line(curve, "graph", "(1 - X^2)/10", words=r"$-\frac{1}{10}(X(r)^2 - 1)$")
    panel = Panel(((0.0, 1.0), (-13.0, 0.0)), "$r$", r"$(X_H - X)/(\chi H)$ as $H \to 0$", lines=[line])
    return picture_of("B2", "x'' = 12(1 - t^2), c = 0", [panel], facts={"at r = 0": float(curve[0, 1])})


def threshold_exponents(order: int) -> Array:
    """(r, alpha) at a contact order, along the multiplier lambda in (0, 1)."""
    rate = 1 - np.geomspace(1e-3, 1 - 1e-3, 400)[::-1]
    up = sum((order + 1 - i) * rate**i for i in range(order + 1))
    down = sum((i + 1) * rate**i for i in range(order + 1))
    mu = (up / down) ** 2 / rate
    return np.stack([rate ** (order + 1) * up / down, np.log(1 / rate) / np.log(mu)], axis=1)


def figure_B3() -> Picture:
    """The exponent alpha of the threshold against r, for contact orders 0 to 5."""
    lines, facts = list[Line](), dict[str, float]()
    for order, pen in enumerate(PENS_OF_ORDERS):
        curve = threshold_exponents(order)
        lines.append(
            Line(curve, pen, f"j = {order}", f"$j = {order}$", NAMED[order], words=f"contact order $j = {order}$")
        )
        facts[f"alpha at r = 1, j = {order}"] = float(curve[-1, 1])
    return picture_of(
        "B3",
        "every contact point",
        [Panel(((0.0, 1.0), (0.1, 1.05)), "$r$", r"$\alpha$", lines=lines)],
        facts,
    )
