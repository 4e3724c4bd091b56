"""Steps of sections 4 and 5: which orbits chatter, which lose contact, and what fills a neighbourhood."""

from __future__ import annotations

import sympy

from singimpact.documents.document_steps import Step
from singimpact.paper.routes import ratios
from singimpact.paper.routes.implicit import sigma, t
from singimpact.theory.notation import latex

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
