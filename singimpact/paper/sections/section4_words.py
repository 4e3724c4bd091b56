"""Section 4: the expansion of v_c, and the tangency point from the fold to the invariant curve."""

from __future__ import annotations

import sympy

from singimpact.documents.arranging import by_degree, factored, in_powers
from singimpact.documents.document_steps import Section, Step
from singimpact.paper.claims.next_sigma import next_sigma
from singimpact.paper.routes import fold
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import r, sigma, t, v
from singimpact.paper.sections.section4_blowup_words import blow_up, in_lambda
from singimpact.paper.sections.section4_foliation_words import foliation
from singimpact.paper.sections.shared_letters import rows, with_b
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
