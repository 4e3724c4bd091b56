"""Formulas of section 2, from the equation of motion to the sheet v_c and the two maps, and of section 3, chatter."""

from typing import Any

import sympy

from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import f_symbol, sigma, t, v


def with_b(expression: Any) -> Any:
    """The damping in the paper's letter: f_01 = -b."""
    return sympy.expand(expression.subs(f_symbol(0, 1), -sympy.Symbol("b")))


def section2() -> dict[str, object]:
    """The formulas of section 2, by their names in its template."""
    landing, speed = route.phi_c(2)
    return {
        "sigma": sigma,
        "t": t,
        "v": v,
        "y_c": with_b(route.y_c(3)),
        "y_c_at_launch": route.y_c(3).subs(t, 0),
        "v_c": with_b(route.v_c(2)),
        "slope": route.slope_at_rest(),
        "launch_velocity": with_b(route.p_c(2)[1]),
        "landing": landing,
        "impact_velocity": with_b(speed),
    }


def section3() -> dict[str, object]:
    """The formulas of section 3, by their names in its template."""
    (rest, along), (rate, across) = ((value, vector.applyfunc(sympy.factor)) for value, vector in route.eigenvectors())
    return {
        "Dp": route.Dp(),
        "Dphi": route.Dphi(),
        "DG": route.DG(),
        "rest": rest,
        "along": along,
        "rate": rate,
        "across": across,
        "slope": across[1] / across[0],
    }
