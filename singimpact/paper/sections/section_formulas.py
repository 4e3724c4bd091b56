"""Formulas of sections 2 to 6 by their names in the templates: each section a function, each value derived."""

from typing import Any

import sympy

from singimpact.documents.document_steps import Step
from singimpact.paper.claims.sections.section4_trials import next_sigma
from singimpact.paper.claims.sections.section4b import M, ell, on_ray
from singimpact.paper.claims.sections.section6_exact import LANDING, OUTLINE, z
from singimpact.paper.claims.sections.section6_loops import grazing, inner, next_length_slopes, preimage, resting
from singimpact.paper.routes import fold, implicit as route, ratios, swan, unfolding
from singimpact.paper.routes.fold import k, m
from singimpact.paper.routes.implicit import a_symbol, f_symbol, r, sigma, t, v
from singimpact.paper.sections.section_templates import steps_of
from singimpact.theory.multipliers import DG_on_ray, P, Q, leading_coefficient, mu_of_lambda, r_of_lambda


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


# Section 4: v_c expanded, and the tangency point from the fold to gamma and its multipliers.

share = sympy.Symbol("p")


def section4() -> dict[str, object]:
    """The formulas of section 4, by their names in its template."""
    return {
        "r": r,
        "sigma": sigma,
        "t": t,
        **_sheet(),
        **_fold(),
        **_blow_up(),
        **_in_lambda(),
        **_sector(),
        **_rays(),
        "fates": steps_of("fates", {}),
        "beside_gamma": beside_gamma(1),
        "shortening": shortening(1, -1),
    }


def _sheet() -> dict[str, object]:
    """The derivatives of y_c on t = 0, what the chain rule makes of them, and the series of v_c."""
    flight = route.y_c(3)
    at = {sigma: 0, t: 0, v: 0}
    first, mixed, second = (with_b(sympy.expand(sympy.diff(flight, *by).subs(at))) for by in ((t,), (t, v), (t, t)))
    return {
        "y_t": first,
        "y_tv": mixed,
        "y_tt": second,
        "v_t": -first,
        "v_tt": sympy.expand(-second + 2 * mixed * first),
        "v_c": with_b(route.v_c(3)),
        "v_c_tangency": route.v_c_tangency(2),
        "v_c_swan": route.v_c_swan(3),
    }


def _fold() -> dict[str, object]:
    """The maps at a tangency point, the fold of p, and the return map."""
    (_, launch), (landing, impact) = fold.p(), fold.phi()
    line, outline = fold.horizon()
    first, second = fold.psi_q()
    return {
        "determinant": sympy.factor(sympy.hessian(route.v_c_tangency(2), (sigma, t)).det()),
        "launch": sympy.factor(launch),
        "landing": landing,
        "impact": impact,
        "line": line,
        "outline": outline,
        "eta": fold.fold_coordinate(),
        "p_folded": fold.p_folded()[1],
        "psi": fold.psi(*sympy.symbols("u w")),
        "psi_p": fold.psi_p(),
        "psi_q_first": first,
        "psi_q_second": second,
        "next_sigma": next_sigma(),
        "Q_r": fold.Q_r(),
        "h_first": fold.h()[0],
        "h_root": fold.h()[1].subs(fold.Q_r(), sympy.Symbol("Qrest")),
    }


# Section 4.1(b): a tangency point with a' < 0, where arcs of stable manifolds fill a neighbourhood.


def _sector() -> dict[str, object]:
    """The sector that is flown, its landings, and the first flight from rest before tau_*."""
    first, second = fold.phi()
    # x-dot/(k s^2) as a polynomial in p = t/s, s = sigma + t the phase of landing
    speed = sympy.expand(sympy.cancel((second / (k * first**2)).subs(sigma, t * (1 - share) / share)))
    return {
        "p": share,
        "rise": sympy.factor(sympy.diff(fold.p()[1], t)),
        "landing_speed": speed,
        "fastest": -r * speed.subs(share, sympy.Rational(3, 2)) * k,
        "landing_from_rest": sympy.factor(first.subs(t, -3 * sigma)),
        "speed_from_rest": sympy.cancel((-r * second).subs(t, -3 * sigma) / first.subs(t, -3 * sigma) ** 2),
    }


def _rays() -> dict[str, object]:
    """The arcs t = l sigma, and the bounds by which each is mapped below itself."""
    launch, landed = on_ray()
    edge = sympy.Rational(3, 2) * (sympy.sqrt(1 + r) - 1)
    if sympy.expand((3 * ell + ell**2).subs(ell, edge)) != sympy.Rational(9, 4) * r:
        raise ArithmeticError("the last ray does not reach the states after one impact")
    factors = (1 - r, 2 - r)
    if sympy.expand(2 + r - r * (4 - r) - factors[0] * factors[1]) != 0:
        raise ArithmeticError("2 + r - r (4 - r) has other factors")
    below, above = (sympy.expand(3 + sign * (1 - r)) for sign in (-1, 1))  # three times 1 -+ (1 - r)/3
    return {
        "ray_launch": launch,
        "ray_landed": landed,
        "root": sympy.sqrt(1 + r),
        "ratio": sympy.factor(sympy.cancel(landed / launch)),
        "gap": sympy.factor(sympy.cancel(1 - M)),
        "below": below,
        "above": above,
        "factors": factors,
    }


# Steps of sections 4 and 5: which orbits chatter, which lose contact, and what fills a neighbourhood.

rho = sympy.Symbol("rho")


def beside_gamma(j: int) -> tuple[Step, ...]:
    """The relation between successive ratios of times before tau_*, at contact order j, and what follows from it."""
    launch, landing = (speed.subs(ratios.l, ell) for speed in ratios.reduced(j))
    slope = sympy.diff(launch, ell) * landing - launch * sympy.diff(landing, ell)
    rate = sympy.factor(sympy.cancel((j + 1) + ell * slope / (launch * landing)))
    return steps_of("beside_gamma", {"j": j, "launch": launch, "landing": landing, "rate": rate})


def shortening(j: int, side: int) -> tuple[Step, ...]:
    """The step that flights near a contact point shorten by a factor below 1: see `claims.sections.section4_orbits`."""
    launch, landing = (side * form for form in ratios.forms(j))
    excess = launch.subs({sigma: sigma + t, t: rho * t}, simultaneous=True) - rho * landing
    return steps_of("shortening", {"j": j, "excess": sympy.factor(sympy.expand(excess))})


_Q, _Qdot = sympy.symbols("Q Qdot")


def with_Q(expression: Any) -> Any:
    """An expression in r and m with Q for Q_r(1, m), and Q' for its derivative by m where that is a factor."""
    slope = sympy.diff(fold.Q_at_one(), m)
    shown = expression.subs(sympy.expand(slope / 2), _Qdot / 2).subs(fold.Q_at_one(), _Q)
    back = shown.subs({_Q: fold.Q_at_one(), _Qdot: slope})
    if sympy.cancel(sympy.expand((back - expression) * sympy.sqrt(fold.Q_at_one()))) != 0:
        raise ArithmeticError("writing Q changed the expression")
    return shown


def _blow_up() -> dict[str, object]:
    """The formulas from h to the multipliers of its fixed points."""
    rate, image = fold.h_blown_up()
    trivial, cubic = fold.fixed_point_factors()
    return {
        "Q_at_one": fold.Q_at_one(),
        "s_rate": rate,
        "m_image": with_Q(image),
        "fixed_points": fold.fixed_point_equation(),
        "trivial": trivial,
        "cubic": cubic,
        "r_of_m": fold.r_of_m(),
        "N_r": with_Q(fold.N_r()),
        "N_r_collected": with_Q(fold.N_r_collected()),
        "N_r_at_fixed_points": fold.N_r_at_fixed_points(),
        # Q for Q_r(1, m) in every entry that has a root
        "Dh": fold.Dh_blown_up().applyfunc(lambda entry: with_Q(entry) if entry.has(fold.Q_at_one()) else entry),
        "gamma_leading": fold.gamma_leading(),
    }


def _in_lambda() -> dict[str, object]:
    """The formulas of the homogeneous model, every quantity a rational function of lambda."""
    matrix = DG_on_ray(1)
    return {
        "P_1": P(1),
        "Q_1": Q(1),
        "r_of_lambda": r_of_lambda(1),
        "mu_of_lambda": mu_of_lambda(1),
        "gamma_in_lambda": sympy.factor(a_symbol(1) * leading_coefficient(1)),
        "trace": sympy.factor(matrix.trace()),
        "det": sympy.factor(matrix.det()),
    }


# Section 5, the blow-up at a swan point, and section 6, the unfolded swan in its universal form.


def section5() -> dict[str, object]:
    """The formulas of section 5, by their names in its template."""
    (p_first, p_second), (phi_first, phi_second) = swan.p_blown_up(), swan.phi_blown_up()
    return {
        "r": r,
        "p_first": sympy.factor(swan.s * p_first),
        "p_second": sympy.factor(swan.ell * swan.s**3 * p_second),
        "phi_first": sympy.factor(swan.s * phi_first),
        "phi_second": sympy.factor(swan.ell * swan.s**3 * phi_second),
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
        "beside_gamma": beside_gamma(2),
        "shortening": shortening(2, 1),
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
        "by_place": next_length_slopes()[0],
        "grazing_start": grazing()[0],
        "resting_start": resting()[0],
    }


def section7() -> dict[str, object]:
    """The formulas of section 7, by their names in its template."""
    return {"inner": sympy.factor(inner()), "preimage": sympy.factor(preimage())}


def _slope(point: tuple[Any, Any], curve: Any, image: tuple[Any, Any]) -> Any:
    """The slope of the image of a curve at a point, along the curve's tangent."""
    along = (sympy.diff(curve, t), -sympy.diff(curve, sigma))
    rates = [sympy.diff(part, sigma) * along[0] + sympy.diff(part, t) * along[1] for part in image]
    at = {sigma: point[0], t: point[1]}
    first, second = (sympy.expand(rate.subs(at, simultaneous=True)) for rate in rates)
    return sympy.cancel(second / first)


def _rate(point: tuple[Any, Any]) -> Any:
    return sympy.diff(unfolding.acceleration(), sigma).subs(sigma, point[0])
