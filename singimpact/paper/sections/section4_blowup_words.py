"""Section 4, second part: the blow-up at a tangency point, its fixed points and multipliers, all of it in lambda."""

from typing import Any

import sympy

from singimpact.documents.arranging import in_powers
from singimpact.documents.document_steps import Step
from singimpact.paper.routes import fold, ratios
from singimpact.paper.routes.fold import m
from singimpact.paper.routes.implicit import a_symbol, r, sigma, t
from singimpact.theory.multipliers import DG_on_ray, P, Q, leading_coefficient, mu_of_lambda, r_of_lambda
from singimpact.theory.notation import latex

# Steps of sections 4 and 5: which orbits chatter, which lose contact, and what fills a neighbourhood.

ell, rho = sympy.symbols("ell rho")


def beside_gamma(j: int) -> tuple[Step, ...]:
    """The relation between successive ratios of times before tau_*, at contact order j, and what follows from it."""
    launch, landing = (speed.subs(ratios.l, ell) for speed in ratios.reduced(j))
    slope = sympy.diff(launch, ell) * landing - launch * sympy.diff(landing, ell)
    rate = sympy.factor(sympy.cancel((j + 1) + ell * slope / (launch * landing)))
    claims = ("t:t2-smooth", "t:t2-sides") if j == 1 else ("t:t3-smooth",)
    return (
        Step(
            "The fate of an orbit beside $\\gamma$ follows from one function. Let a launch at $\\tau_* - S$ land "
            f"at $\\tau_* - \\ell S$. Launch and impact velocity are $S^{j + 1}$ times smooth functions of $(S, "
            "\\ell)$ with a factor $1 - \\ell$, so the ratio $\\ell_1$ of the next flight satisfies",
            rf"\ell^{j + 1} (1 - \ell_1) P(\ell_1) = r (1 - \ell) Q(\ell) + O(S)\,, \qquad P = {latex(launch)}\,,"
            rf"\quad Q = {latex(landing)}\,.",
            f"ratios-{j}",
        ),
        Step(
            "Here $((1 - \\ell) P)' = -Q < 0$, so $\\ell_1$ is a smooth function of $(S, \\ell)$, and the stable "
            "manifold of the saddle is a smooth graph $\\ell = L(S)$. Moreover",
            rf"\ell\, \frac{{d}}{{d\ell}} \ln \frac{{\ell^{j + 1} P}}{{Q}} = {latex(rate)} > 0 \quad"
            r"(0 \le \ell \le 1)\,.",
            f"ratios-rise-{j}",
            claims[:1],
        ),
        Step(
            "A strict inequality on a closed interval holds for small $S > 0$ too. It makes $q = (1 - \\ell)/(1 - "
            "L(S))$, which is 1 on $\\gamma$, fall in every impact below $\\gamma$ and grow above it. Below, $S$ "
            "cannot tend to 0, because then $\\ell$ would tend to $\\lambda$ and $q$ to 1: chatter is complete "
            "before $\\tau_*$. Above, the impacts before $\\tau_*$ are finitely many.",
            "",
            "",
            claims[1:],
        ),
    )


def shortening(j: int, side: int) -> Step:
    """The step that flights near a contact point shorten by a factor below 1: see `claims.sections.section4_orbits`."""
    launch, landing = (side * form for form in ratios.forms(j))
    again = sympy.factor(sympy.expand(launch.subs({sigma: sigma + t, t: rho * t}, simultaneous=True) - rho * landing))
    where = "Launches at $\\sigma \\ge 0$ behind the swan point" if j == 2 else "All launches near $w_*$"
    return Step(
        f"{where} have flights that shorten by a factor. With $p$ and $q$ for launch and impact speed of the flight "
        "of length $t$ from $\\sigma$, in the same unit, the next flight $t_1$ has $p(\\sigma + t, t_1) = r "
        "q(\\sigma, t)$ to leading order; $p$ grows with $t$, and for $r < \\rho < 1$",
        rf"p(\sigma + t, \rho t) - \rho\, q(\sigma, t) = {latex(again)} \ge 0\,, \qquad"
        r"\text{so}\quad t_1 \le \rho t\,.",
        f"ratios-shorter-{j}",
        ("s4b-contraction", "s4b-back") if j == 1 else ("t:t3-others", "t:t3-unique"),
    )


def leaves() -> Step:
    """Proof that the levels of the time at which chatter ends are arcs."""
    return Step(
        "Flight times therefore sum to a continuous function $E(\\sigma, v)$, the phase at which chatter ends. It "
        "grows strictly with $v$: with the landing phase the next flight time grows or falls by at most a part $b$ "
        "of it, $(1 - b)^2 > r$, and this is kept from impact to impact. So a level of $E$ is an arc $v = "
        "V(\\sigma)$ between its two points on $\\Pi_0$, at rest behind $\\tau_*$ and lifting off before.",
        "",
        "",
        ("t:foliate", "t:foliate-smooth"),
    )


_Q, _Qdot = sympy.symbols("Q Qdot")


def with_Q(expression: Any) -> Any:
    """An expression in r and m with Q for Q_r(1, m), and Q' for its derivative by m where that is a factor."""
    slope = sympy.diff(fold.Q_at_one(), m)
    shown = expression.subs(sympy.expand(slope / 2), _Qdot / 2).subs(fold.Q_at_one(), _Q)
    back = shown.subs({_Q: fold.Q_at_one(), _Qdot: slope})
    if sympy.cancel(sympy.expand((back - expression) * sympy.sqrt(fold.Q_at_one()))) != 0:
        raise ArithmeticError("writing Q changed the expression")
    return shown


def blow_up() -> tuple[Step, ...]:
    """From h to the multipliers of its fixed points."""
    return (*_blown_up(), *_fixed_points(), *_multipliers())


def _blown_up() -> tuple[Step, ...]:
    rate, image = fold.h_blown_up()
    return (
        Step(
            "$Q_r$ is a quadratic form, so $h$ is not differentiable at the tangency point, but it takes rays to "
            "rays. Put $(\\sigma, \\eta) = (s, s m)$; then $\\Pi_0$ is $m = \\tfrac32$, the horizon $m = 0$, and on "
            "the ray of slope $m$",
            rf"Q_r(1, m) = {in_powers(fold.Q_at_one(), r)}",
            "s4-Q1m",
            ("s4-Qr-zeros", "s4-Er-closed"),
        ),
        Step(
            "which is $Q$ for short, with $Q'$ its derivative by $m$. The blown-up map on the visible part, $s < 0$ "
            "and $m > \\tfrac12$, is",
            (rf"\bar s &= \bigl({latex(rate)}\bigr)\, s + O(s^2)\,,", rf"\bar m &= {latex(with_Q(image))} + O(s)\,."),
            "s4-blowup",
            ("s4-blowup", "s4-domain"),
        ),
    )


def _fixed_points() -> tuple[Step, ...]:
    rate, _ = fold.h_blown_up()
    trivial, cubic = fold.fixed_point_factors()
    return (
        Step(
            "A fixed point on $s = 0$ is a ray that is mapped into itself. The equation $\\bar m = m$, squared and "
            "cleared of its denominator, is",
            rf"Q_r(1, m) - m^2 \bigl({latex(rate)}\bigr)^2 = {in_powers(fold.fixed_point_equation(), r)} = 0",
            "e:fixm",
            ("e:fixm", "e:fixm-converse"),
        ),
        Step(
            "One root is known beforehand: $\\Pi_0$ is invariant for every $r$. Dividing by it leaves a cubic,",
            rf"\bigl({latex(trivial)}\bigr) \Bigl[{in_powers(cubic, r, rising=True)}\Bigr] = 0",
            "e:meq",
            ("e:meq", "s4-root-places", "s4-m32-r1"),
        ),
        Step(
            "with one root in each of $m_1 < -\\tfrac32$, $0 < m_2 < \\tfrac12$ and $\\tfrac12 < m_3 < \\tfrac32$. "
            "Only the last one is a flight that is seen. The cubic is linear in $r$, so that instead of solving it "
            "one may read $r$ from the root:",
            rf"r = {latex(fold.r_of_m())}",
            "s4-r-of-m",
            ("s4-m3",),
        ),
        Step(
            "On the ray of $m_1$ the images under $p$ and $q$ run in opposite directions and lie in $v \\le 0$; on "
            "that of $m_2$ they run in opposite directions too, since $m_2 - \\tfrac12 < 0$, though in $v > 0$.",
            "",
            "",
            ("s4-m1", "s4-m1-gradient", "s4-m2", "s4-m2-sign"),
        ),
    )


def _multipliers() -> tuple[Step, ...]:
    return (
        Step(
            "Stability across the ray is the derivative $N_r = \\partial \\bar m/\\partial m$ on $s = 0$. The "
            "quotient rule gives",
            rf"N_r(m) = {latex(with_Q(fold.N_r()))}",
            "s4-Nr-1",
            ("s4-Nr-1",),
        ),
        Step(
            "where, over one denominator, everything but one product cancels:",
            rf"N_r(m) = {latex(with_Q(fold.N_r_collected()))}",
            "s4-Nr-2",
            ("s4-Nr-2",),
        ),
        Step(
            "At a fixed point $\\sqrt Q = m (m - \\tfrac12)$, and $r$ is known there as a function of $m$, so that "
            "neither remains:",
            rf"N_r(m) = {latex(fold.N_r_at_fixed_points())}\,, \qquad m = m_1, m_3",
            "s4-Nr-3",
            ("s4-Nr-3", "s4-Nr-3-all"),
        ),
        Step(
            "Along $s$ the map multiplies by $m - \\tfrac12$. The derivative is triangular, because $s = 0$ is "
            "mapped into itself; the entry $*$ depends on cubic terms and does not touch the eigenvalues. For every "
            "$r$ in $(0, 1)$ the point $m_3$ is a saddle:",
            rf"D\bar h(0, m) = {latex(with_Q_in(fold.Dh_blown_up()))}",
            "s4-Dh-form",
            ("s4-Dh-form", "s4-saddle-m3", "s4-mu-direction"),
        ),
        Step(
            "For $a' > 0$ the ray of $m_3$ lies in $v > 0$. The stable manifold of the saddle leaves $s = 0$ there, "
            "and $p$ takes it to the invariant curve $\\gamma$, whose leading term is that of $p$ on the ray $\\eta "
            "= m_3 \\sigma$:",
            rf"\gamma : \ v = {latex(fold.gamma_leading())}\, {latex(sigma**2)} + O(3)\,, \qquad m = m_3",
            "s4-gamma-leading",
            ("t:t2-exists", "s4-beta-tangent"),
        ),
    )


def with_Q_in(matrix: Any) -> Any:
    """A matrix with Q for Q_r(1, m) in every entry that has a root."""
    return matrix.applyfunc(lambda entry: with_Q(entry) if entry.has(fold.Q_at_one()) else entry)


def in_lambda() -> tuple[Step, ...]:
    """The homogeneous model, with every quantity a rational function of lambda."""
    curve = sympy.factor(a_symbol(1) * leading_coefficient(1))
    matrix = DG_on_ray(1)
    return (
        Step(
            "All of this becomes rational in $\\lambda = m_3 - \\tfrac12$, the factor by which $\\sigma$ shrinks at "
            "each impact on $\\gamma$. The leading part of the problem is the oscillator $x'' = u$ with the wall at "
            "0: a flight from $u = 1$ to $u = \\lambda$ is launched with a velocity proportional to $(1 - \\lambda) "
            "P_1$ and lands with one proportional to $(1 - \\lambda) Q_1$, where",
            (rf"P_1(\lambda) &= {latex(P(1))}\,,", rf"Q_1(\lambda) &= {latex(Q(1))}\,."),
            "s4-lambda-P",
        ),
        Step(
            "The coefficients of one are those of the other in reverse, because reversing time exchanges launch and "
            "landing. Invariance of $\\gamma$ under the bounce then fixes the restitution,",
            rf"r = {latex(r_of_lambda(1))}",
            "s4-lambda-r",
            ("t:t2-attracting",),
        ),
        Step("the multiplier across,", rf"\mu = {latex(mu_of_lambda(1))}", "s4-lambda-mu"),
        Step(
            "and the curve itself,",
            rf"\gamma : \ v = {latex(curve)}\, {latex(sigma**2)} + O(3)",
            "s4-lambda-gamma",
        ),
        Step(
            "The derivative of $G$ in the original coordinates is another matter, as $p$ degenerates at the tangency "
            "point. At points of $\\gamma$ close to it the eigenvalues of $DG$ tend to the roots $\\Lambda$ of "
            "$\\Lambda^2 - \\Lambda \\operatorname{tr} DG + \\det DG$ with",
            (
                rf"\operatorname{{tr}} DG &= {latex(sympy.factor(matrix.trace()))}\,,",
                rf"\det DG &= {latex(sympy.factor(matrix.det()))}\,,",
            ),
            "s4-lambda-DG",
            ("t:t2-repelling", "t:t2-eigenvalue-limit"),
        ),
        Step(
            "so that one of them stays above 1 as long as $r < 1$: $\\gamma$ repels orbits beside it while it "
            "attracts those on it. Its orbits reach the tangency point after infinitely many impacts; orbits below "
            "chatter to rest before, orbits above leave the wall across the arc $P_*$ of the outline, where $F$ is "
            "torn. At the tangency point itself the mass lifts off.",
            "",
            "",
            ("t:t2-unique", "t:t2-fixed", "s4-P-star"),
            "figure5",
        ),
        *beside_gamma(1),
    )
