"""Figure B9: gamma of impacts that lose a power of a low speed, its exponent and its second term on true orbits."""

from __future__ import annotations

import numpy as np
import sympy

from singimpact.paper.claims.beyond.every_order import j
from singimpact.paper.claims.beyond.hertz import EXPONENT, FACTOR, SECOND, q
from singimpact.paper.figures.panel import Array, Line, Panel, Picture
from singimpact.paper.trials.hertz_orbits import POWERS, STARTS, measured

ORDERS = {1: "graph", 2: "epsilon"}
LARGEST = 0.6  # q


def exponents(order: int) -> Array:
    """(q, (j+1)/(1-q)) at a contact order."""
    powers = np.linspace(0, LARGEST, 121)
    return np.stack([powers, (order + 1) / (1 - powers)], axis=1)


def figure_B9() -> Picture:
    """The exponent against q, and what true orbits have beyond the first term against the second term."""
    first, second, facts = list[Line](), list[Line](), dict[str, float]()
    for order, pen in ORDERS.items():
        words = f"contact order $j = {order}$"
        first.append(Line(exponents(order), pen, f"j = {order}", f"$j = {order}$", 0.7, words=words))
    guide = np.array([[x, x] for x in (-4.0, -1.0)])
    second.append(Line(guide, "before", "equal", words="equal"))
    for start in STARTS:
        for power in POWERS:
            measurement = measured(start, power)
            values = {j: start.order, q: sympy.Rational(power.numerator, power.denominator)}
            n, k, g = (float(formula.subs(values)) for formula in (EXPONENT, FACTOR, SECOND))
            w = (k * measurement.loss) ** (1 / (1 - float(power)))
            rows = [
                (np.log10(g * v / h ** (start.order + 1)), np.log10(v / (w * h**n) - 1))
                for h, v in zip(measurement.distances, measurement.speeds, strict=True)
            ]
            mark = np.array([[float(power), measurement.exponent]])
            first.append(Line(mark, "crossing", "true orbits", beads=True, words="true orbits"))
            for row in rows:
                second.append(Line(np.array([row]), "crossing", "true orbits", beads=True, words="true orbits"))
            facts[f"{start.name}, q = {power}"] = measurement.exponent - n
    caption = (
        r"Impacts that lose $Cv^q$ of a low speed $v$: $\rho(-v) = v(1 - Cv^q)$, $0 < q < 1$. (a) $\gamma$ is "
        r"$|\sigma|^{(j+1)/(1-q)}$ times a constant, so it is flatter at the contact point than $|\sigma|^{j+1}$; "
        r"the dots are slopes of $\ln v$ between two points of $\gamma$ found by halving, on four oscillators. (b) "
        r"The relative excess of $v$ over the first term, against the second term $GP$, at all points of (a)."
    )
    panels = [
        Panel(((0.0, LARGEST), (1.5, 7.0)), "$q$", r"exponent of $|\sigma|$", "(a) the exponent", first),
        Panel(
            ((-4.0, -1.0), (-4.0, -1.0)), r"$\log_{10} GP$", r"$\log_{10}$ of the excess", "(b) the second term", second
        ),
    ]
    claims = ("b:hertz", "b:hertz-next", "b:hertz-measured")
    models = "; ".join(start.name for start in STARTS)
    return Picture("B9", "Gamma where impacts lose a power of the speed", claims, models, panels, 2, facts, caption)
