"""Figures B4 to B6: heights of the loops of W^s(X), the foot X as a function of r, the orbit that is born at a swan."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.dynamics.orbit import orbit
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.paper.figures.panel import Array, Line, Panel, Picture, Region
from singimpact.paper.trials import loop_heights
from singimpact.paper.trials.universal_foot import covering, elastic, foot, scaled
from singimpact.scenes.style import SKY

SHOWN = 5  # generations in figure B4
BORN = ("0.9", "0.97", "0.999")  # clearances of figure B6, c_0 = 1
POWER = Fraction(3, 7)
PENS_OF_DEPTHS = ("manifold", "preimage", "graph")


def gamma_height(r: float) -> float:
    """w of gamma at a tangency."""
    roots = np.roots([1.0, 2.0, -2 * r, -r])  # lambda^2 (2 + lambda) = r (1 + 2 lambda)
    (rate,) = [float(root.real) for root in roots if abs(root.imag) < 1e-9 and 0 < root.real < 1]
    return (1 - rate) * (2 + rate) / 6


def figure_B4() -> Picture:
    """Heights of W^s(X), tears and gamma over A - h, in units of a'(A) h^2, against r."""
    rates = np.linspace(0.01, 0.99, 197)
    gamma = np.array([gamma_height(r) for r in rates.tolist()])
    kinds = {
        "outer": ("loop", "$W^s(X)$: upper and lower edge of each loop"),
        "tear": ("P", "tears: $\\delta$ and inverse images"),
        "inner": ("loop", "$W^s(X)$: upper and lower edge of each loop"),
    }
    curves = {
        name: np.array([loop_heights.generations(_start(name, r), r, SHOWN) for r in rates.tolist()]).T
        for name in kinds
    }
    plain, beside = [], []
    for name, (pen, words) in kinds.items():
        for row in curves[name]:
            plain.append(Line(np.stack([rates, row], axis=1), pen, name, words=words))
            beside.append(Line(np.stack([rates, np.log10(row - gamma)], axis=1), pen, name, words=words))
    plain.append(Line(np.stack([rates, gamma], axis=1), "gamma", "gamma", r"$\gamma$", 0.6))
    worst = 0.0
    for swan in loop_heights.SWANS:
        for rate in loop_heights.RATES:
            r = float(Fraction(rate))
            loops = loop_heights.heights(swan, rate).found[-1]
            limits = [w for name in ("outer", "inner") for w in loop_heights.generations(_start(name, r), r)]
            worst = max(worst, float(np.abs(np.array(loops) - limits).max()))
            for w in loops:
                plain.append(_point(r, w))
                beside.append(_point(r, float(np.log10(w - gamma_height(r)))))
    panels = [
        Panel(((0.0, 1.0), (0.0, 0.52)), "$r$", r"$v/(a'(A)h^2)$", "(a)", plain),
        Panel(((0.0, 1.0), (-4.2, -0.2)), "$r$", r"$\log_{10}(w - w_\gamma)$", "(b) above $\\gamma$", beside),
    ]
    caption = (
        r"Over the line $\tau = A - h$ the loops of $W^s(X)$, the tears around which they lie and $\gamma$ "
        r"have heights $a'(A)h^2 w$ with $w$ algebraic in $r$. Each tear lies between the two edges of its "
        r"loop, so close to the lower one that a loop looks like a hairpin. (a) $w$; (b) its distance from "
        r"that of $\gamma$. The dots are crossings on true orbits of the universal model and of two "
        r"oscillators, at $h$ = 1/2000 of the half distance of $A$ and $B$."
    )
    return Picture(
        "B4",
        "Heights of the loops next to A",
        ("b:loops-map", "b:loops"),
        "; ".join(swan.name for swan in loop_heights.SWANS),
        panels,
        2,
        {"farthest": worst},
        caption,
    )


def _start(name: str, r: float) -> float:
    return {"outer": 0.5, "tear": 0.375}.get(name) or loop_heights.inner_start(r)


def _point(x: float, y: float) -> Line:
    return Line(np.array([[x, y]]), "orbit", "true orbit", beads=True, words="true orbits")


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
    level = np.array([[0.0, limit], [1.0, limit]])
    lines = [
        Line(curve, "graph", "X(1-r)^(3/7)", words=r"$X(r)\,(1-r)^{3/7}$"),
        Line(level, "before", "limit", words=r"its limit 2.94103 as $r \to 1$"),
    ]
    regions = [
        Region(band, words="3 within 2 %"),
        Region(np.vstack([tops, bottoms[::-1]]), SKY, words="proved bounds, for all $r$ up to 0.95"),
    ]
    facts = {"limit": limit, "most": float(tops[:, 1].max()), "least": float(bottoms[:, 1].min())}
    caption = (
        r"The time $X$ at which chatter from $A$ ends in the universal negative swan, for every restitution: "
        r"$X(1-r)^{3/7}$ stays within 2 % of 3. It is enclosed for all $r$ up to 0.95 by balls, as $X$ rises "
        r"with $r$. The limit as $r \to 1$ is $(14u/(3\cdot 12^{2/3}))^{3/7}$, where $u = 13.919146$ is the "
        r"adiabatic invariant of the elastic ball from $A$."
    )
    panel = Panel(((0.0, 1.0), (2.92, 3.08)), "$r$", r"$X\,(1-r)^{3/7}$", lines=lines, regions=regions)
    return Picture(
        "B5",
        "The foot X for every restitution",
        ("b:foot-monotone", "b:foot", "b:foot-limit"),
        "x'' = 12(1 - t^2), c = 0",
        [panel],
        facts=facts,
        caption=caption,
    )


def figure_B6() -> Picture:
    """The orbit that is born: over two periods, and its hop in lengths scaled by H beside the limit."""
    first = _swan(BORN[0])
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
        Panel(((times[0], times[-1]), (-0.08 * top, top)), "$t$", "$x - c$", "(a)", [whole]),
        Panel(((-1.2, 6.6), (-0.1, 1.25)), "$s$", r"$(x-c)/(|a''|H^4)$", "(b) one hop", hops),
    ]
    caption = (
        r"Past a negative swan one orbit is born. (a) The mass rests on the wall, is thrown at $A$, hops, "
        r"chatters and rests again, once a period, whatever it did before: $x'' + x = \cos 2t$, $r = 4/5$, "
        r"$c_0 = 1$. (b) One hop in lengths scaled by the half distance $H$ of $A$ and $B$, $s$ from the "
        r"middle, for three clearances: the first arc tends to $\frac{1}{24}(s+1)^3(3-s)$, of height 9/8, and "
        r"hits with the speed $8/3$ after the time 4."
    )
    return Picture(
        "B6",
        "The orbit that is born at a negative swan",
        ("b:onset-none", "b:onset-hop", "b:onset"),
        str(first),
        panels,
        2,
        facts,
        caption,
    )


def _swan(c: str) -> ImpactOscillator:
    return linear(2, c, "0.8")


def hop_in_units(c: str) -> Array:
    """(s, (x - c)/(|a''| H^4)) from the release to the end of the chatter."""
    model = _swan(c)
    run = orbit(model, 1, 0, 200)
    released = float(run.tau[run.kind == "release"][0])
    rested = float(run.tau[(run.kind == "complete") & (run.tau > released)][0])
    middle = round(released / np.pi) * np.pi  # of A and B, as a_c is even about it
    half = middle - released
    bend = abs(float(acceleration(model, np.array([middle]), order=2)[0]))
    times = np.linspace(released, rested, 3001)
    height = run.sample(times).x - as_float(model.clearance)
    return np.stack([(times - middle) / half, height / (bend * half**4)], axis=1)
