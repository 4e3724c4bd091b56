"""Section 5: the maps p and phi blown up at a swan point."""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.claims.claim import Check, Claim, Statement
from singimpact.claims.verifiers import every, identity
from singimpact.theory import swan_route as swan
from singimpact.theory.sheet import generic_sheet

m, s, ell = swan.m, swan.s, swan.ell


def _p(stated: tuple[Any, Any]) -> Check:
    """p in (s, m) by the boundary value route with a = a' = 0 set first, and by the paper's own."""
    sheet = generic_sheet(2, 3)
    a2, sigma, t = sympy.symbols("a_d2 sigma t")
    velocity = sheet.to_sympy(sheet.v).subs({a2: -24 * ell, sigma: s, t: s * m})
    first = identity(lambda: (s, velocity), "the solution of the boundary value problem")(stated)
    second = identity(lambda: (s * swan.p_blown_up()[0], ell * s**3 * swan.p_blown_up()[1]))(stated)
    return every(
        [(first.evidence, first.holds), (second.evidence, second.holds)],
        witness=lambda: dict(first.witness or second.witness or {}),
    )


CLAIMS = (
    Claim(
        id="e:pdeg3",
        section="5",
        title="p at a swan point in the blown-up coordinates (sigma, t) = (s, s m)",
        printed=Statement(
            r"p:(s,m)\mapsto(s,\ \ell s^3(6m+4m^2+m^3+O(s))),\ \ell=-\tfrac1{24}a''",
            (s, ell * s**3 * (6 * m + 4 * m**2 + m**3)),
        ),
        verify=_p,
        mutants=((s, -ell * s**3 * (6 * m + 4 * m**2 + m**3)), (s, ell * s**3 * (6 * m + 8 * m**2 + m**3))),
        rests_on=("e:swan",),
    ),
)
