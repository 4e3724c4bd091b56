"""Section 5: the blow-up at a swan point, its fixed point and its multipliers."""

import sympy

from singimpact.documents.arranging import factored, in_powers
from singimpact.documents.document_steps import Section, Step
from singimpact.paper.routes import swan
from singimpact.paper.routes.implicit import a_symbol, r, sigma
from singimpact.paper.routes.swan import ell, s
from singimpact.paper.sections import section4_blowup_words as orbits
from singimpact.theory.multipliers import P, Q, leading_coefficient, mu_of_lambda, r_of_lambda
from singimpact.theory.notation import latex


def told() -> Section:
    """The steps of section 5."""
    return Section("section5", "5. A swan point", (*_blow_up(), *_fixed_point(), *_multipliers(), *_in_lambda()))


def _blow_up() -> tuple[Step, ...]:
    maps = [
        tuple(sympy.factor(scale * image) for scale, image in zip((s, ell * s**3), images, strict=True))
        for images in (swan.p_blown_up(), swan.phi_blown_up())
    ]
    (p_first, p_second), (phi_first, phi_second) = maps
    return (
        Step(
            "At a swan point $v_c$ begins with cubic terms, and it has more than a fold there. The weights are those "
            "of a homogeneous polynomial, so polar-like coordinates $(\\sigma, t) = (s, s m)$ serve: $m$ is the "
            "flight time in units of the distance $s$ from $\\tau_*$. Launches before $\\tau_*$ with a landing "
            "before it have $s < 0$ and $-1 < m < 0$. In them $p$ is",
            rf"p : (s, m) \mapsto \bigl({latex(p_first)},\ {latex(p_second)} + O(s^4)\bigr)",
            "e:pdeg3",
            ("e:pdeg3",),
        ),
        Step(
            "and the impact, by the same substitution in $\\phi$, is",
            rf"\phi : (s, m) \mapsto \bigl({latex(phi_first)},\ {latex(phi_second)} + O(s^4)\bigr)",
            "s5-phi",
            ("s5-phi", "s5-coordinates"),
        ),
        Step(
            "The next flight starts at $\\bar s = (m + 1) s$ with the velocity $-r$ times the one of the impact, and "
            "has its own $\\bar m$, which $p$ gives at $(\\bar s, \\bar m)$. Equating the two and dividing by $\\ell "
            "s^3$ leaves an equation on $s = 0$:",
            rf"\bar h(m, \bar m) = {in_powers(swan.h_bar(), r)} = 0",
            "s5-hbar",
            ("s5-hbar",),
        ),
        Step(
            "The two unknowns separate: $\\bar h = 0$ is $f(m) = g(\\bar m)$ with one function for the impact,",
            rf"f(m) = {latex(swan.f_map())}",
            "s5-f",
        ),
        Step("and one for the launch,", rf"g(\bar m) = {factored(swan.g_map().subs(swan.m, swan.mbar))}", "s5-g"),
    )


def _fixed_point() -> tuple[Step, ...]:
    return (
        Step(
            "The derivative of $g$ is a quadratic without real zeros, so $g$ can be inverted and $\\bar m = "
            "g^{-1}(f(m))$ is the blown-up map on $s = 0$. Its fixed points solve $f(m) = g(m)$; the factor $m$, "
            "which stands for $\\Pi_0$, is divided out:",
            rf"{in_powers(swan.fixed_point_polynomial(), r, rising=True)} = 0",
            "s5-fixed",
            ("s5-unique",),
        ),
        Step(
            "This is linear in $r$, which is therefore a rational function of the root. The root in $(-1, 0)$ is "
            "called $m_*$:",
            rf"r = {latex(swan.r_of_m())}\,,\qquad m = m_*",
            "s5-r-of-m",
            ("s5-mstar-place",),
        ),
    )


def _multipliers() -> tuple[Step, ...]:
    return (
        Step(
            "Along $s$ the map multiplies by $m + 1$, and across by $f'/g'$, taken at the fixed point. The entry $*$ "
            "depends on the terms of fourth order in $v_c$ and has no part in the eigenvalues:",
            rf"D\bar h(0, m_*) = {latex(swan.Dh_bar())}",
            "s5-jacobian",
            ("s5-jacobian", "s5-slopes"),
        ),
        Step(
            "With $r$ eliminated by the equation of the fixed point the second eigenvalue is",
            rf"\mu = {latex(swan.mu_of_m())}\,,\qquad m = m_*",
            "s5-mu",
            ("s5-saddle",),
        ),
    )


def _in_lambda() -> tuple[Step, ...]:
    curve = sympy.factor(a_symbol(2) / 2 * leading_coefficient(2))
    return (
        Step(
            "As at a tangency point all is simplest in $\\lambda = 1 + m_*$. The homogeneous model is now $x'' = "
            "u^2$, and with the polynomial of its launch velocity,",
            (rf"P_2(\lambda) &= {latex(P(2))}\,,", rf"Q_2(\lambda) &= {latex(Q(2))}\,,"),
            "s5-lambda-P",
        ),
        Step(
            "restitution and transverse multiplier are",
            (rf"r &= {latex(r_of_lambda(2))}\,,", rf"\mu &= {latex(mu_of_lambda(2))}\,."),
            "s5-lambda-r",
        ),
        Step(
            "For $a'' < 0$ this is a saddle for every $r$ in $(0, 1)$, and the curve that it carries begins with",
            rf"\gamma : \ v = {latex(curve)}\, {latex(sigma**3)} + O(4)",
            "s5-gamma-leading",
            ("t:t3", "t:t3-attracting", "t:t3-eigenvalue-limit", "t:t3-repelling"),
        ),
        *orbits.beside_gamma(2),
        orbits.shortening(2, 1),
        Step(
            "For $a'' < 0$ the sheet rises with $t$ everywhere near $w_*$, so $F$ is defined and continuous there, "
            "with a cube root at $w_*$; states off $\\gamma$ lie on stable manifolds of regular points. For $a'' > 0$ "
            "the sheet lies in $v < 0$, and no impact of low velocity follows.",
            "",
            "",
            ("s5-vt-positive", "s5-F-smooth", "s5-positive"),
            "figure8",
        ),
    )
