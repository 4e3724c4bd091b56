"""Section 4: the expansion of v_c, and the tangency point from the fold to the invariant curve."""

from typing import Any

import sympy

from singimpact.documents.arranging import by_degree, factored, in_powers
from singimpact.documents.document_steps import Section, Step
from singimpact.paper.claims.next_sigma import next_sigma
from singimpact.paper.claims.sections.section4b import M, ell, on_ray
from singimpact.paper.routes import fold, implicit as route
from singimpact.paper.routes.fold import k
from singimpact.paper.routes.implicit import r, sigma, t, v
from singimpact.paper.sections import section4_blowup_words as orbits
from singimpact.paper.sections.section2_words import rows, with_b
from singimpact.paper.sections.section4_blowup_words import blow_up, in_lambda
from singimpact.theory.notation import latex

u, w = sympy.symbols("u w")


def told() -> Section:
    """The steps of section 4."""
    steps = (*_derivatives(), *_sheet(), *_fold(), *_return(), *blow_up(), *in_lambda(), *foliation())
    return Section("section4", "4. Tangency points", steps)


def _derivatives() -> tuple[Step, ...]:
    """The derivatives of y_c on t = 0, and what the chain rule makes of them."""
    flight = route.y_c(3)
    at = {sigma: 0, t: 0, v: 0}
    first, mixed, second = (with_b(sympy.expand(sympy.diff(flight, *by).subs(at))) for by in ((t,), (t, v), (t, t)))
    slope = -first
    bend = sympy.expand(-second - 2 * mixed * slope)
    return (
        Step(
            "The zeros of $a_c$ move with the clearance, so $a', a'', \\ldots$ at $\\tau_*$ depend on $c$. For $x'' "
            "+ x = \\cos \\omega t$ they are those of $a_c(\\tau) = \\cos \\omega\\tau - c$, and simple for all $c$ "
            "but $\\pm 1$.",
            "",
            "",
            ("s4-depends-on-c", "e:lin", "s4-zeros"),
        ),
        Step(
            "The expansion of $v_c$ follows from derivatives of $y_c$ at $t = 0$: those by $t$ are half the "
            "acceleration and a third of the jerk at rest, and the jerk is $a' + ab$, since the force of damping "
            "changes by $-b$ times the velocity that the acceleration gives:",
            (
                rf"\frac{{\partial y_c}}{{\partial t}} &= {latex(first)}\,,",
                rf"\frac{{\partial^2 y_c}}{{\partial t\, \partial v}} &= {latex(mixed)}\,,",
                rf"\frac{{\partial^2 y_c}}{{\partial t^2}} &= {factored(second)}\,.",
            ),
            "s4-y-derivatives",
        ),
        Step(
            "Differentiating $y_c(\\tau, v_c; t) = 0$ twice by $t$, with $\\partial y_c/\\partial v = 1$ and $v_t = "
            f"{latex(slope)}$ for $\\partial v_c/\\partial t$, gives $v_{{tt}} = -y_{{tt}} - 2 y_{{tv}} v_t$:",
            rf"\frac{{\partial^2 v_c}}{{\partial t^2}} = -\bigl({latex(second)}\bigr) - 2 \bigl({latex(mixed)}\bigr) "
            rf"\bigl({latex(slope)}\bigr) = {latex(bend)}",
            "s4-chain-rule",
        ),
        Step(
            "With the jerk taken as $a'$ alone the last term would be $\\frac12 ab$ instead of $\\frac16 ab$, and the "
            "coefficient of $t^2$, half of it, would have $\\frac14 ab$ for $\\frac1{12} ab$."
        ),
    )


def _sheet() -> tuple[Step, ...]:
    return (
        Step(
            "The implicit equation $y_c = 0$ is solved to third order, which is enough for the first two kinds of "
            "degenerate point. Each line is one degree in $(\\sigma, t)$:",
            rows(r"v_c(\tau_* + \sigma, t)", by_degree(with_b(route.v_c(3)), sigma, t), 4),
            "e:vtaylor",
            ("e:vtaylor-st", "e:vtaylor-t2", "e:vtaylor-st2", "e:vtaylor-t3"),
        ),
        Step(
            "At a tangency point $a = 0$ removes the first line and all of the second that is not $a'$:",
            rf"v_c = {factored(route.v_c_tangency(2))} + O(3)",
            "e:degen",
            ("e:degen",),
        ),
        Step(
            "At a swan point $a = a' = 0$, and of the third line only $a''$ is left:",
            rf"v_c = {factored(route.v_c_swan(3))} + O(4)",
            "e:swan",
            ("e:swan",),
        ),
    )


def _fold() -> tuple[Step, ...]:
    (_, launch), (landing, impact) = fold.p(), fold.phi()
    line, outline = fold.horizon()
    determinant = sympy.factor(sympy.hessian(route.v_c_tangency(2), (sigma, t)).det())
    return (
        Step(
            "From here to the end of the section $\\tau_*$ is a tangency point, and $k = a'/6$. The surface has a "
            "saddle there:",
            rf"\det D^2 v_c(0, 0) = {latex(determinant)}",
            "s4-saddle",
            ("s4-saddle",),
        ),
        Step(
            "The map to the launch is",
            rf"p : (\sigma, t) \mapsto \bigl({latex(sigma)},\ {factored(launch)} + O(3)\bigr)",
            "e:pnew",
            ("e:pnew",),
        ),
        Step(
            "and the map to the impact",
            rf"\phi : (\sigma, t) \mapsto \bigl({latex(landing)},\ {factored(impact)} + O(3)\bigr)",
            "e:phinew",
            ("e:phinew", "s4-Z-line"),
        ),
        Step(
            "The map $p$ is singular on the horizon, where $\\partial v_c/\\partial t = 0$: flights that touch the "
            "wall with velocity zero when they land. To first order it is a line, and its image under $p$ a parabola:",
            (rf"t &= {latex(line)} + O(2)\,,", rf"v &= {latex(outline)} + O(3)\,."),
            "s4-horizon-line",
            ("s4-horizon-line",),
        ),
        Step(
            "Count $t$ from the horizon, which completes the square in $v_c$. The new coordinate is",
            rf"\eta = {latex(fold.fold_coordinate())}",
            "s4-fold-eta",
        ),
        Step(
            "and in $(\\sigma, \\eta)$ the map $p$ shows its fold along $\\eta = 0$:",
            rf"p = \bigl({latex(sigma)},\ {latex(fold.p_folded()[1])} + O(3)\bigr)",
            "s4-fold-form",
            ("s4-fold-form",),
        ),
        Step(
            "The image of the horizon is straightened by a change of the target,",
            rf"\psi : (u, w) \mapsto {latex(fold.psi(u, w))}",
            "s4-psi",
        ),
        Step(
            "after which only the square is left. Terms of higher order can be removed by further changes of source "
            "and target; these agree with the identity to first order only, as quadratic terms are needed to remove "
            "cubic ones.",
            rf"\psi \circ p : (\sigma, \eta) \mapsto {latex(fold.psi_p())}",
            "e:pdef",
            ("e:pdef", "s4-normal-id2"),
        ),
    )


def _return() -> tuple[Step, ...]:
    first, second = fold.psi_q()
    root = fold.h()[1].subs(fold.Q_r(), sympy.Symbol("Qrest"))
    return (
        Step(
            "The state after the impact is $q = R \\circ \\phi$. From here on $(\\sigma, \\eta)$ are the coordinates "
            "in which $\\psi \\circ p$ is the fold without higher terms; they keep $\\sigma$, and agree with those "
            "above to first order only. The first component, which was $\\eta - \\frac12 \\sigma$ exactly, is now",
            rf"\psi \circ q = \bigl({latex(first)} + O(2),\ {in_powers(second, r)} + O(3)\bigr)",
            "e:defq",
            ("e:defq",),
        ),
        Step(
            "with the quadratic terms (lengths in units of $k$)",
            rf"\bar\sigma = {latex(next_sigma())} + O(3)",
            "s4-next-sigma",
        ),
        Step(
            "Of these only the one in $\\sigma\\eta$ depends on how $\\eta$ was chosen. They do not matter on $s = 0$ "
            "after the blow-up below, nor for $D\\bar h$ there. One impact is the map $h = p^{-1} \\circ q$ of the "
            "surface into itself: the next flight $(\\bar\\sigma, \\bar\\eta)$ starts where this one ends, "
            "$\\psi \\circ p\\, (\\bar\\sigma, \\bar\\eta) = \\psi \\circ q\\, (\\sigma, \\eta)$. The second "
            "components give $\\bar\\eta^2 = Q_r(\\sigma, \\eta) + O(3)$, with",
            rf"Q_r(\sigma, \eta) = {in_powers(fold.Q_r(), r)}",
            "e:qdef",
            ("e:qdef",),
        ),
        Step(
            "Of the two roots the first return is the one before the horizon, and $\\eta$ is negative there:",
            rf"h(\sigma, \eta) = \bigl({latex(fold.h()[0])} + O(2),\ {latex(root)}\,\bigr)\,, \qquad \sigma < 0",
            "e:hdef",
            ("e:hdef",),
        ),
    )


# Section 4.1(b): a tangency point with a' < 0, where arcs of stable manifolds fill a neighbourhood.

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
