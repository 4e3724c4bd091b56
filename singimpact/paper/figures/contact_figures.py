"""Figures 3 to 8: the dynamics of G near Pi_0, at regular, tangency and swan points."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.contact.points import tangency_points
from singimpact.dynamics.invariant_arcs import gammas_within, model_step, stable_manifold
from singimpact.flights.flight_path import many_paths
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator import Oscillator, acceleration
from singimpact.paper.figures.panel import ARCS, Dot, Line, Panel, Picture, Point, Region, picture_of
from singimpact.studies import swan_points
from singimpact.surface import Curve, ImpactSurface, Window

# p and phi at points of V' of a model that is linear in x: two flights give the launch velocity of any return.


def launch_and_landing(model: Oscillator, points: Array) -> tuple[Array, Array]:
    """v and x' at the return, of flights from tau that are back at c after t; 0 at t = 0.

    Examples
    --------
    >>> launch_and_landing(Oscillator("0", "-2", 0, 1), np.array([[0.0, 3.0], [1.0, 0.0]]))
    (array([3., 0.]), array([-3., -0.]))
    """
    tau, t = points.T
    times = [np.array([time if time else 1.0]) for time in t.tolist()]
    rest, fast = (
        np.array([path[0] for path in many_paths(model, tau, np.full(len(tau), v), times)]) for v in (0.0, 1.0)
    )
    v = np.where(t == 0, 0.0, -rest[:, 0] / (fast[:, 0] - rest[:, 0]))
    return v, np.where(t == 0, -0.0, rest[:, 1] + v * (fast[:, 1] - rest[:, 1]))


def projected(model: Oscillator, points: Array) -> Array:
    """p: (tau, t) -> (tau, v)."""
    return np.stack([points[:, 0], launch_and_landing(model, points)[0]], axis=1)


def reset(model: Oscillator, points: Array) -> Array:
    """phi: (tau, t) -> (tau + t, x')."""
    return np.stack([points.sum(axis=1), launch_and_landing(model, points)[1]], axis=1)


def rebounded(points: Array, restitution: float) -> Array:
    """R: (tau, x') -> (tau, -r x')."""
    return np.stack([points[:, 0], -restitution * points[:, 1] + 0.0], axis=1)


R = 0.5
FINE = 1 / 40000  # of a window far wider than the panel, whose outline would show its chords otherwise
Map = tuple[str, str, Callable[[Array], Array]]  # title, name of the second axis, the map


@lru_cache(maxsize=1)
def oscillator() -> ImpactOscillator:
    """x'' + x = cos 2t, c = 3/10, r = 1/2: a tangency of either kind in a period."""
    return linear(2, "0.3", "0.5")


def tangency(kind: str) -> float:
    """tau_* with a' > 0 ("gamma") or a' < 0 ("foliation")."""
    return next(point.tau for point in tangency_points(oscillator()) if point.kind == kind)


def leaves(model: Any, frame: Window, feet: Iterable[float], pen: str = "manifold") -> list[Line]:
    """Stable manifolds of times with a < 0."""
    kept = [foot for foot in feet if float(acceleration(model, np.array([foot]))[0]) < 0]
    return [Line(curve.points, pen, "leaf") for foot in kept for curve in stable_manifold(model, frame, repr(foot))]


def figure_3() -> Picture:
    """Nondegenerate chatter: the linearised map, and the foliation by stable manifolds."""
    model, centre = linear(2, "1.2", "0.5"), 0.8
    slope = (1 - R) * float(acceleration(model, np.array([centre]))[0]) / 2
    low, high, v = centre - 1.0, centre + 1.0, 0.3
    feet = np.linspace(low, high + 0.8, 15)
    straight = [
        Line(
            np.array([[foot + v / slope, v], [foot, 0.0]]),
            "manifold",
            "eigendirection",
            at=0.6,
            arrow=True,
            words="eigendirections of the linearised map, stable manifolds of $G$",
        )
        for foot in feet
    ]
    frame = Window((low, high), (0.0, v), 1 / ARCS)
    curved = leaves(model, frame, feet.tolist())
    curved = [
        Line(line.points[::-1], line.pen, line.name, at=0.6, arrow=True, words=straight[0].words) for line in curved
    ]
    chosen = Line(
        np.array([[centre + v / slope, v], [centre, 0.0]]),
        "loop",
        "through w_*",
        at=0.6,
        arrow=True,
        words="those through $w_*$",
    )
    (through,) = stable_manifold(model, frame, repr(centre))[:1]
    panels = [
        Panel(
            ((low, high), (-0.1 * v, v)),
            title="(a) linearised at $w_*$",
            lines=[*straight, chosen],
            dots=[Dot("$w_*$", (centre, 0.0))],
        ),
        Panel(
            ((low, high), (-0.1 * v, v)),
            title=r"(b) stable manifolds $W^s_\tau$",
            lines=[*curved, Line(through.points[::-1], "loop", "W^s", at=0.6, arrow=True, words=chosen.words)],
            dots=[Dot("$w_*$", (centre, 0.0))],
        ),
    ]
    step = np.diff(through.points[:4], axis=0)
    return picture_of(3, str(model), panels, {"slope": slope, "drawn": float(step[0, 1] / step[0, 0])})


def _near(curves: list[Curve], tau: float, size: float, side: int) -> Array:
    """The stretch of a traced curve that leaves (tau, 0) into t > 0 on one side, from there on."""
    found = []
    for curve in curves:
        sigma, t = curve.points[:, 0] - tau, curve.points[:, 1]
        kept = (side * sigma > 0) & (np.abs(sigma) < size) & (t > 0) & (t < 4 * size)
        found += [each.points for each in curve.parts(kept) if np.abs(each.points[:, 0] - tau).min() < 0.2 * size]
    points = max(found, key=len)
    return np.vstack([[tau, 0.0], points[np.argsort(np.abs(points[:, 0] - tau))]])


def _window(tau: float, size: float) -> ImpactSurface:
    return ImpactSurface(oscillator(), (tau - 1.5 * size, tau + 1.5 * size), (-4.5 * size, 4.5 * size))


def _segment(start: Any, end: Any) -> Array:
    return np.linspace(np.asarray(start), np.asarray(end), 40)


WORDS = {
    "H": "horizon $H$ and its images",
    "Z": "zero set $Z$ and its images",
    "rest": r"$\Pi_0$: $t = 0$ or $v = 0$, fixed by the maps",
}


def _actions(tau: float, edges: dict[str, tuple[Array, str, str]], boxes: list[tuple[Point, Point]]) -> list[Panel]:
    """A region of V' and what p, phi and R make of it, edge by edge."""
    model = oscillator()
    maps: list[Map] = [
        ("$V'$", "$t$", lambda z: z),
        ("$p(V')$", "$v$", lambda z: projected(model, z)),
        (r"$\phi(V')$", r"$\dot x$", lambda z: reset(model, z)),
        (r"$R\phi(V')$", "$v$", lambda z: rebounded(reset(model, z), R)),
    ]
    panels = []
    for n, (title, y, turn) in enumerate(maps):
        images = {name: turn(points) - np.array([tau, 0.0]) for name, (points, _, _) in edges.items()}
        panels.append(
            Panel(
                boxes[n],
                x=r"$\sigma$",
                y=y,
                title=title,
                lines=[
                    Line(
                        images[name],
                        pen,
                        f"image of {name}",
                        label if pen != "hidden" else "",
                        0.7 if pen == "rest" else 0.35,
                        words=WORDS.get(pen, ""),
                    )
                    for name, (_, pen, label) in edges.items()
                ],
                regions=[Region(np.vstack(list(images.values())), words="part of $V'$ and its images")],
                dots=[Dot("$w_*$", (0.0, 0.0))],
            )
        )
    return panels


def figure_4() -> Picture:
    """a' > 0: what is visible lies between Pi_0 and H; p folds it along H."""
    tau, s = tangency("gamma"), 0.3
    H = _near(_window(tau, s).horizon, tau, s, -1)
    edges = {
        "Pi_0": (_segment((tau - s, 0), (tau, 0)), "rest", r"$\Pi_0$"),
        "H": (H, "H", "$H$"),
        "cut": (_segment(H[-1], (tau - s, 0)), "hidden", ""),
    }
    v = 1.2 * float(projected(oscillator(), H)[:, 1].max())
    sigma = (-1.08 * s, 0.8 * s)
    boxes = [
        (sigma, (-0.3 * s, 1.8 * s)),
        (sigma, (-0.15 * v, v)),
        (sigma, (-0.6 * v, 0.15 * v)),
        (sigma, (-0.1 * v, 0.4 * v)),
    ]
    return picture_of(4, str(oscillator()), _actions(tau, edges, boxes))


def figure_6() -> Picture:
    """a' < 0: the sector T between Z and Pi_0 goes under phi to T'', a thin region below Pi_0."""
    tau, s = tangency("foliation"), 0.2
    Z = _near(_window(tau, s).zero_set, tau, s, -1)[::-1]
    top = float(Z[0, 1])
    edges = {
        "Z": (Z, "Z", "$Z$"),
        "Pi_0": (_segment((tau, 0), (tau + s, 0)), "rest", r"$\Pi_0$"),
        "right": (_segment((tau + s, 0), (tau + s, top)), "hidden", ""),
        "top": (_segment((tau + s, top), Z[0]), "hidden", ""),
    }
    v = 1.15 * float(projected(oscillator(), edges["right"][0])[:, 1].max())
    low = 1.1 * float(reset(oscillator(), edges["right"][0])[:, 1].min())
    sigma = (-1.2 * s, 4.4 * s)
    boxes = [
        (sigma, (-0.15 * top, 1.1 * top)),
        (sigma, (-0.15 * v, v)),
        (sigma, (low, -0.2 * low)),
        (sigma, (0.1 * low, -0.6 * low)),
    ]
    return picture_of(6, str(oscillator()), _actions(tau, edges, boxes))


def figure_5() -> Picture:
    """Degenerate chatter: gamma between P_* and Pi_0."""
    model, tau = oscillator(), tangency("gamma")
    low, high, v = tau - 0.62, tau + 0.1, 0.11
    frame = Window((low, high), (0.0, v), 1 / ARCS)
    surface = ImpactSurface(model, (low - 0.5, high + 2), (-3, 3), FINE)  # H is shifted Z
    jump = next(c.points for c in surface.discontinuities if np.hypot(*(c.points - [tau, 0.0]).T).min() < 1e-9)
    (curve, *_) = gammas_within(model, frame)
    lines = [
        *leaves(model, frame, np.linspace(low, tau, 14)[1:-1].tolist()),
        Line(jump, "jump", "P_*", "$P_*$", _share(jump, tau - 0.25), words="$P_*$: discontinuities of $G$"),
        Line(curve.points, "gamma", "gamma", r"$\gamma$", _share(curve.points, tau - 0.45)),
        *(
            Line(
                _orbit(model, curve.points, low + 0.05, share),
                "orbit",
                "orbit above gamma",
                beads=True,
                words="impacts of two orbits above $\\gamma$,\njoined in their order",
            )
            for share in (0.1, 0.3)
        ),
    ]
    near = curve.points[(curve.points[:, 0] < tau - 0.02) & (curve.points[:, 0] > tau - 0.2)]
    below = np.interp(near[:, 0], *jump[np.argsort(jump[:, 0])].T)
    return picture_of(
        5,
        str(model),
        [Panel(((low, high), (-0.1 * v, v)), lines=lines, dots=[Dot("$w_*$", (tau, 0.0))])],
        facts={"gamma_below_P": float((near[:, 1] / below).max()), "order": _order(near, tau)},
    )


def _order(points: Array, tau: float) -> float:
    return float(np.polyfit(np.log(tau - points[:, 0]), np.log(points[:, 1]), 1)[0])


def _share(points: Array, tau: float) -> float:
    return float(np.argmin(np.abs(points[:, 0] - tau))) / (len(points) - 1)


def _orbit(model: Any, curve: Array, start: float, share: float) -> Array:
    """Impacts of an orbit that starts above gamma by a share of its height, while they come close together."""
    state = np.array([[start, (1 + share) * float(np.interp(start, *curve[np.argsort(curve[:, 0])].T))]])
    states = [state[0]]
    for _ in range(12):
        state = model_step(model, state)
        if not np.isfinite(state).all() or state[0, 0] - states[-1][0] > 0.6:
            break
        states.append(state[0])
    return np.array(states)


def figure_7() -> Picture:
    """a' < 0: every orbit nearby chatters to a point right of w_*; epsilon is the image of [w_1, w_*]."""
    model, tau = oscillator(), tangency("foliation")
    low, high, v = tau - 0.35, tau + 0.85, 0.13
    frame = Window((low, high), (0.0, v), 1 / ARCS)
    start = tau - 0.25
    rest = np.stack([np.linspace(start, tau, 80)[:-1], np.zeros(79)], axis=1)
    epsilon = np.vstack([model_step(model, rest), [[tau, 0.0]]])
    lines = [
        *leaves(model, frame, (tau + np.linspace(0.03, 0.85, 20)).tolist()),
        Line(
            epsilon,
            "epsilon",
            "epsilon",
            r"$\varepsilon$",
            0.12,
            words=r"$\varepsilon$: image of $[w_1, w_*]$ under $G$",
        ),
        Line(np.array([[start, 0.0], [tau, 0.0]]), "rest", "[w_1, w_*]", words="interval $[w_1, w_*]$ of $\\Pi_0$"),
    ]
    middle = epsilon[-30:-3]
    panel = Panel(
        ((low, high), (-0.1 * v, v)),
        lines=lines,
        dots=[
            Dot("$w_*$", (tau, 0.0)),
            Dot("$w_1$", (start, 0.0)),
            Dot("$G(w_1)$", (float(epsilon[0, 0]), float(epsilon[0, 1]))),
        ],
    )
    return picture_of(
        7,
        str(model),
        [panel],
        facts={"order": float(np.polyfit(np.log(middle[:, 0] - tau), np.log(middle[:, 1]), 1)[0])},
    )


def figure_8() -> Picture:
    """At a swan point with a'' < 0 every stable manifold flattens, and gamma touches Pi_0 to third order."""
    model = next(point for point in swan_points("x", "cos(2*t)") if point.kind == "negative").oscillator("0.5")
    low, high, v = -0.45, 0.45, 0.03
    frame = Window((low, high), (0.0, v), 1 / ARCS)
    (curve, *_) = gammas_within(model, frame)
    feet = [*np.linspace(-0.42, -0.1, 7).tolist(), *np.linspace(0.1, 0.58, 9).tolist()]
    words = r"stable manifolds $W^s_\tau$; hairpins are the ends of their loops"
    lines = [
        *(replace(line, words=words) for line in leaves(model, frame, feet)),
        Line(curve.points, "gamma", "gamma", r"$\gamma$", _share(curve.points, -0.13)),
    ]
    near = curve.points[(curve.points[:, 0] < -0.02) & (curve.points[:, 0] > -0.2)]
    return picture_of(
        8,
        str(model),
        [Panel(((low, high), (-0.1 * v, v)), lines=lines, dots=[Dot("$w_*$", (0.0, 0.0))])],
        facts={"order": _order(near, 0.0)},
    )
