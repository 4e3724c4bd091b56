"""Formulas of section 5, the blow-up at a swan point, and of section 6, the unfolded swan in its universal form."""

from typing import Any

import sympy

from singimpact.paper.claims.sections.section6_exact import LANDING, OUTLINE, z
from singimpact.paper.routes import swan, unfolding
from singimpact.paper.routes.implicit import a_symbol, r
from singimpact.paper.routes.swan import ell, s
from singimpact.paper.routes.unfolding import sigma, t
from singimpact.paper.sections import tangency_formulas as orbits
from singimpact.theory.multipliers import P, Q, leading_coefficient, mu_of_lambda, r_of_lambda


def section5() -> dict[str, object]:
    """The formulas of section 5, by their names in its template."""
    (p_first, p_second), (phi_first, phi_second) = swan.p_blown_up(), swan.phi_blown_up()
    return {
        "r": r,
        "p_first": sympy.factor(s * p_first),
        "p_second": sympy.factor(ell * s**3 * p_second),
        "phi_first": sympy.factor(s * phi_first),
        "phi_second": sympy.factor(ell * s**3 * phi_second),
        "h_bar": swan.h_bar(),
        "f_map": swan.f_map(),
        "g_map": swan.g_map().subs(swan.m, swan.mbar),
        "fixed_points": swan.fixed_point_polynomial(),
        "r_of_m": swan.r_of_m(),
        "Dh_bar": swan.Dh_bar(),
        "mu_of_m": swan.mu_of_m(),
        "P_2": P(2),
        "Q_2": Q(2),
        "r_of_lambda": r_of_lambda(2),
        "mu_of_lambda": mu_of_lambda(2),
        "gamma": sympy.factor(a_symbol(2) / 2 * leading_coefficient(2)),
        "beside_gamma": orbits.beside_gamma(2),
        "shortening": orbits.shortening(2, 1),
    }


def section6() -> dict[str, object]:
    """The formulas of section 6, by their names in its template."""
    limit, rest = unfolding.scaled(unfolding.WEIGHTS)
    shown = {"alpha": r"\alpha", "phi_1": r"\varphi_1", "phi_2": r"\varphi_2", "y": "x'"}
    longer = unfolding.launch_velocity().subs({sigma: sigma + t, t: unfolding.r * t}, simultaneous=True)
    return {
        "t": t,
        "z": z,
        "scaled_limit": limit,
        "scaled_rest": rest.subs({name: sympy.Symbol(letter) for name, letter in shown.items()}),
        "limit_launch": unfolding.limit_launch(),
        "force_to_wall": -unfolding.limit_acceleration().subs(sigma, sympy.Symbol("s")),
        "acceleration": unfolding.acceleration(),
        "launch_velocity": unfolding.launch_velocity(),
        "impact_velocity": unfolding.impact_velocity(),
        "horizon": unfolding.horizon(),
        "zero_set": unfolding.zero_set(),
        "E": unfolding.E,
        "D": unfolding.D,
        "p_D": unfolding.project(unfolding.D),
        "phi_D": unfolding.reset(unfolding.D),
        "C": unfolding.C,
        "p_C": unfolding.project(unfolding.C),
        "phi_C": unfolding.reset(unfolding.C),
        "rate_A": _rate(unfolding.A),
        "rate_B": _rate(unfolding.B),
        "slope_E": _slope(unfolding.E, unfolding.horizon(), (sigma, unfolding.launch_velocity())),
        "outline": OUTLINE,
        "landing": LANDING,
        "shadow": unfolding.shadow(),
        "G_A": (unfolding.reset(unfolding.C)[0], sympy.expand(-unfolding.r * unfolding.reset(unfolding.C)[1])),
        "excess": sympy.expand(longer + unfolding.r * unfolding.impact_velocity()),
    }


def _slope(point: tuple[Any, Any], curve: Any, image: tuple[Any, Any]) -> Any:
    """The slope of the image of a curve at a point, along the curve's tangent."""
    along = (sympy.diff(curve, t), -sympy.diff(curve, sigma))
    rates = [sympy.diff(part, sigma) * along[0] + sympy.diff(part, t) * along[1] for part in image]
    at = {sigma: point[0], t: point[1]}
    first, second = (sympy.expand(rate.subs(at, simultaneous=True)) for rate in rates)
    return sympy.cancel(second / first)


def _rate(point: tuple[Any, Any]) -> Any:
    return sympy.diff(unfolding.acceleration(), sigma).subs(sigma, point[0])
