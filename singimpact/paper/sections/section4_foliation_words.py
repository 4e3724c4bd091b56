"""Section 4.1(b): a tangency point with a' < 0, where arcs of stable manifolds fill a neighbourhood."""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.documents.arranging import in_powers
from singimpact.documents.document_steps import Step
from singimpact.paper.claims.sections.section4b import M, ell, on_ray
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import k
from singimpact.paper.routes.implicit import r, sigma, t
from singimpact.paper.sections import section4_orbits_words as orbits
from singimpact.theory.notation import latex

share = sympy.Symbol("p")


def foliation() -> tuple[Step, ...]:
    """The steps of the case a' < 0."""
    return (*_sector(), *_rays(), *_bounds(), *_leaves())


def _sector() -> tuple[Step, ...]:
    launch, outline = sympy.factor(fold.p()[1]), fold.horizon()[1]
    rise = sympy.factor(sympy.diff(fold.p()[1], t))
    return (
        Step(
            "Now let $a'(\\tau_*) < 0$, so $k < 0$. The formulas for $p$ and $\\phi$ are the same; another part of "
            "them is flown. The image of the horizon lies below $v = 0$,",
            rf"v|_H = {latex(outline)} + O(3) < 0\,, \qquad \sigma \ne 0\,,",
            "s4b-continuous",
            ("s4b-continuous",),
        ),
        Step(
            "so no flight from $v \\ge 0$ grazes, and $F$ and $G$ are continuous. In the sector $3 \\sigma + t \\ge "
            "0$, $t \\ge 0$ the launch velocity is not negative, and it grows with $t$,",
            (rf"v &= {latex(launch)} \ge 0\,,", rf"\frac{{\partial v}}{{\partial t}} &= {latex(rise)} > 0\,,"),
            "s4b-sector",
            ("s4b-sector",),
        ),
        Step(
            "so $p$ is one to one there and $F$ takes a neighbourhood of $w_*$ in $v \\ge 0$ onto the sector. At the "
            "landing, $\\bar\\sigma = \\sigma + t$, let $p = t/\\bar\\sigma$, which runs from 0 to $\\frac32$ in the "
            "sector. The velocity is",
            rf"\frac{{\dot x}}{{k \bar\sigma^2}} = {in_powers(_landing(), share, rising=True)}",
            "s4b-T2-bounds",
            ("s4b-T2-bounds", "s4b-T2-place"),
            "figure6",
        ),
        Step(
            "which increases with $p$. So the image of the sector under $\\phi$ lies between $\\frac38 a' "
            "\\bar\\sigma^2$ and 0, in $v \\le 0$ as landings do, and after the bounce the states lie in",
            rf"0 \le v \le {latex(-r * _landing().subs(share, sympy.Rational(3, 2)) * k)}\, \bar\sigma^2\,, "
            r"\qquad \bar\sigma \ge 0",
            "s4b-after",
        ),
    )


def _landing() -> Any:
    """x-dot/(k s^2) as a polynomial in p = t/s, s = sigma + t the phase of landing."""
    first, second = fold.phi()
    return sympy.expand(sympy.cancel((second / (k * first**2)).subs(sigma, t * (1 - share) / share)))


def _rays() -> tuple[Step, ...]:
    launch, landed = on_ray()
    edge = sympy.Rational(3, 2) * (sympy.sqrt(1 + r) - 1)
    if sympy.expand((3 * ell + ell**2).subs(ell, edge)) != sympy.Rational(9, 4) * r:
        raise ArithmeticError("the last ray does not reach the states after one impact")
    return (
        Step(
            "up to $O(3)$. To see where they go next, follow the arcs $t = \\ell \\sigma$, $\\sigma \\ge 0$. One is "
            "mapped by $p$ and by $q = R \\circ \\phi$ to the curves",
            (
                rf"\tilde p(\sigma) &= {latex(launch)}\, \sigma^2 + O(\sigma^3)\,,",
                rf"\tilde q(\sigma) &= {latex(landed)}\, \sigma^2 + O(\sigma^3)\,,",
            ),
            "s4b-rays",
            ("s4b-rays",),
        ),
        Step(
            "$\\tilde q$ as a function of its own phase $(1 + \\ell) \\sigma$; every remainder has a factor $\\ell$, "
            "so that what follows is uniform as $\\ell \\to 0$. The arcs have to cover the states after one impact, "
            "that is to reach $3 \\ell + \\ell^2 = \\frac94 r$. The last one is",
            rf"\ell = \tfrac32 \bigl({latex(sympy.sqrt(1 + r))} - 1\bigr) < \tfrac34 r",
            "s4b-last-ray",
            ("s4b-l-range",),
        ),
    )


def _bounds() -> tuple[Step, ...]:
    launch, landed = on_ray()
    ratio = sympy.factor(sympy.cancel(landed / launch))
    gap = sympy.factor(sympy.cancel(1 - M))
    parts = (1 - r, 2 - r)
    if sympy.expand(2 + r - r * (4 - r) - parts[0] * parts[1]) != 0:
        raise ArithmeticError("2 + r - r (4 - r) has other factors")
    below, above = (sympy.expand(3 + sign * (1 - r)) for sign in (-1, 1))  # three times 1 -+ (1 - r)/3
    return (
        Step(
            "On an arc the velocity after the impact, compared with that before at the same phase, is in the limit",
            rf"\frac{{\tilde q}}{{\tilde p}} \to {latex(ratio)} = r M\,, \qquad 1 - M = {latex(gap)}\,,",
            "s4b-M",
            ("s4b-M",),
        ),
        Step(
            "and $M < 1$ for every $\\ell > 0$. For small $\\sigma$ a part $\\frac13 (1 - r)$ of the limits is left "
            "for the remainders, below $\\tilde p$ and above $\\tilde q$:",
            (
                rf"\tilde p &> {latex(launch)}\, \tfrac13 ({latex(below)})\, \sigma^2\,,",
                rf"\tilde q &< {latex(landed)}\, \tfrac13 ({latex(above)})\, \sigma^2\,,",
            ),
            "s4b-bounds",
            ("s4b-p-bound", "s4b-q-bound", "s4b-conditions"),
        ),
        Step(
            "so that",
            rf"\frac{{\tilde q}}{{\tilde p}} < r M\, \frac{{{latex(above)}}}{{{latex(below)}}}",
            "s4b-ratio",
            ("s4b-ratio", "s4b-r-ineq"),
        ),
        Step(
            "The bound is below 1 where $r (4 - r) < 2 + r$, and the difference is a product of positive factors:",
            rf"2 + r - r (4 - r) = ({latex(parts[0])})({latex(parts[1])})",
            "s4b-below-one",
            ("s4b-Np",),
        ),
    )


def _leaves() -> tuple[Step, ...]:
    first, second = fold.phi()
    landing = sympy.factor(first.subs(t, -3 * sigma))
    speed = sympy.cancel((-r * second).subs(t, -3 * sigma) / first.subs(t, -3 * sigma) ** 2)
    return (
        Step(
            "So each arc is mapped below itself by a factor $N < 1$ that does not depend on the point: its images tend "
            "to $\\Pi_0$ uniformly, and all states near $w_*$ chatter to rest at phases after $\\tau_*$.",
        ),
        orbits.shortening(1, -1),
        orbits.leaves(),
        Step(
            "The launches at rest before $\\tau_*$, where the mass lifts off at once, show how: from $(\\sigma, 0)$ "
            "with $\\sigma < 0$ the flight ends at $t = -3 \\sigma$, that is at",
            rf"\bar\sigma = {latex(landing)} + O(2)\,, \qquad \bar v = {latex(speed)}\, \bar\sigma^2 + O(3)\,.",
            "s4b-eps",
            ("s4b-eps",),
            "figure7",
        ),
    )
