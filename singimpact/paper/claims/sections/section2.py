"""Section 2: the impact surface and its sheet V_c'."""

from __future__ import annotations

import sympy

from singimpact.paper.claims.claim import Check, Claim, Statement
from singimpact.paper.claims.sections.section2_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, identity, is_zero
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import a_symbol, t, v

a = a_symbol(0)


def _divisible(power: int) -> Check:
    """x_c - c = t^power y with y smooth, and y = 0 defines v_c near Pi_0."""
    quotient = sympy.expand(t * route.y_c(4) / t**power)
    smooth = not sympy.fraction(sympy.together(quotient))[1].has(t)
    at_launch = quotient.subs(t, 0) if smooth else v**2
    return every(
        [
            ("x_c = c at t = 0, so (x_c - c)/t is smooth (Hadamard's lemma)", is_zero((t * route.y_c(4)).subs(t, 0))),
            (f"the Taylor polynomial of (x_c - c)/t^{power} to order 4 has no negative power of t", smooth),
            ("it vanishes on Pi_0", is_zero(at_launch.subs(v, 0))),
            ("its v-derivative there is 1, so the implicit function theorem gives v_c", sympy.diff(at_launch, v) == 1),
            ("v_c put back solves y_c = 0 to order 4", is_zero(route.at_launch(quotient, 4))),
        ]
        if smooth
        else [(f"(x_c - c)/t^{power} has no negative power of t", smooth)]
    )


CLAIMS = (
    Claim(
        id="e:yeq",
        section="2.1",
        title="near Pi_0, x_c = c + t y_c with y_c smooth, and V_c' is the graph of v_c, where y_c = 0",
        printed=Statement(r"x_c=c+t\,y_c(\tau,v;t),\qquad y_c(\tau,v_c(\tau,t);t)=0", 1),
        verify=_divisible,
        mutants=(0, 2),
    ),
    Claim(
        id="e:acc",
        section="2.1",
        title="dv_c/dt at t = 0 is minus half the acceleration at rest",
        printed=Statement(r"\frac{\partial}{\partial t}v_c(\tau,t)\Big|_{t=0}=-\tfrac12 a_c(\tau)", -a / 2),
        verify=identity(route.slope_at_rest),
        mutants=(a / 2, -a, -a / 3),
        rests_on=("e:yeq",),
    ),
)
