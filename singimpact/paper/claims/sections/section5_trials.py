"""Section 5: what is printed and what is corrected there, tried at the swans of two models or at two values of r."""

from fractions import Fraction
from typing import Any

import numpy as np
import sympy

from singimpact.paper.claims.claim import Trial, Trials, compared
from singimpact.paper.claims.sections.section4_trials import RATES, arcs_at
from singimpact.paper.routes import swan
from singimpact.paper.routes.implicit import r as restitution
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.true_sheet import Place, number, swans


def _coordinates(printed: Any, corrected: Any) -> list[Trial]:
    """v/(ell s^3) of true flights with the flight time that each reading of (s, m) gives, against the formula."""
    m = -0.5
    formula = number(swan.p_blown_up()[1], {"m": m})
    rows = []
    for point in swans():
        ell = point.jets()["ell"]
        times = [number(reading, {"s": 1.0, "m": m}) for reading in (printed, corrected)]
        values = [point.leading(lambda h, p=point, t=t, e=ell: p.launch(h, t * h) / (e * h**3)) for t in times]
        rows.append(compared(point.name, "v/(ell s^3) at m = -1/2 by the formula", formula, *values))
    return rows


def _intersections(printed: int, corrected: int) -> list[Trial]:
    """Real m > -1 with f(m) = g(m), at two values of r."""
    rows = []
    for r in RATES:
        difference = sympy.fraction(sympy.cancel((swan.f_map() - swan.g_map()).subs(restitution, sympy.Rational(r))))[0]
        roots = [root for root in sympy.Poly(difference, swan.m).real_roots() if root > -1]
        text = f"{len(roots)}: {', '.join(f'{float(root):.8g}' for root in roots)}"
        holds = (len(roots) == printed, len(roots) == corrected)
        rows.append(Trial(f"f and g, r = {r}", "common points", text, str(printed), str(corrected), holds[0], holds[1]))
    return rows


def _cube_root(_printed: Any, _corrected: Any) -> list[Trial]:
    """d log t/d log v of the flight time on sigma = 0: 1 for a smooth F, 1/3 for t ~ (-24 v/a'')^(1/3)."""
    found = []
    for place in swans():
        v = np.array([1e-8, 1e-10])
        times = np.asarray(place.model.impact_map(place.tau, v).flight_time)
        slope = float(np.log(times[0] / times[1]) / np.log(v[0] / v[1]))
        found.append(compared(place.name, "exponent of v in the flight time", slope, 1.0, 1 / 3, tolerance=1e-2))
    return found


def _arcs(_printed: Any, _corrected: Any) -> list[Trial]:
    return arcs_at(swans(), 2)


def _eigenvalue(printed: Any, corrected: Any) -> list[Trial]:
    """The larger eigenvalue of the exact DG at points of gamma, found backwards on true flights, as sigma -> 0."""
    rows = []
    for point in swans():
        rate = true_orbits.lambda_of(point.r, 2)
        truth = float(true_orbits.extrapolated([(s, _larger(point, s, v)) for s, v in _on_gamma(point, rate)]))
        stated = [number(formula, {"lambda": rate}) for formula in (printed, corrected)]
        rows.append(
            compared(
                point.name,
                f"larger eigenvalue of DG at w_*, r = {Fraction(point.r).limit_denominator(99)}",
                truth,
                *stated,
            )
        )
    return rows


def _on_gamma(place: Place, rate: float) -> list[tuple[float, float]]:
    flow, start = true_orbits.scipy_flow(place.model, place.tau), true_orbits.SETTINGS.start[1]
    first = abs(place.jets()["ell"]) * start**3
    return true_orbits.backwards(flow, place.r, -start, first, rate, 0.06)[-4:]


def _larger(place: Place, sigma: float, v: float) -> float:
    matrix = np.asarray(place.model.derivative(place.tau + sigma, v).matrix)
    return float(max(np.linalg.eigvals(matrix).real))


TRIALS: dict[str, Trials] = {
    "s5-coordinates": _coordinates,
    "s5-unique": _intersections,
    "s5-F-smooth": _cube_root,
    "t:t3-unique": _arcs,
    "t:t3-eigenvalue-limit": _eigenvalue,
}
