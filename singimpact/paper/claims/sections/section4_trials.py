"""Sections 4 and 4.1(a): what is printed and what is corrected there, tried on two models or at two values of r."""

from collections.abc import Callable
from typing import Any

import numpy as np
import sympy
from mpmath import nstr
from scipy.optimize import minimize_scalar

from singimpact.algebra.precision import digits_at
from singimpact.paper.claims.claim import Trial, Trials, compared
from singimpact.paper.claims.next_sigma import next_sigma
from singimpact.paper.claims.sections.section2_trials import rest_at_tangency, second_component
from singimpact.paper.routes import fold
from singimpact.paper.routes.implicit import sigma
from singimpact.paper.trials import arcs, true_orbits
from singimpact.paper.trials.true_sheet import Place, damped, number, tangencies
from singimpact.status import Status
from singimpact.theory import fixed_points

RATES = ("1/2", "1/5")
DIGITS = 40


def _coefficient(measured: Callable[[Place], float]) -> Trials:
    """Trials of a coefficient of v_c at a regular point of two damped models (f_v = 0 would hide the misprint)."""

    def trials(printed: Any, corrected: Any) -> list[Trial]:
        return [
            compared(place.name, "coefficient of v_c", measured(place), says[0], says[1], tolerance=1e-5)
            for place in damped()
            for says in [[number(part[0], place.jets()) for part in (printed, corrected)]]
        ]

    return trials


def _mixed(place: Place) -> float:
    """The coefficient of sigma t^2, by differences in sigma."""
    ends = (1, -1, 2, -2)
    values = [place.taylor(0.02 * n, 2) for n in ends]
    return (8 * (values[0] - values[1]) - (values[2] - values[3])) / (12 * 0.02)


def _impact(printed: Any, corrected: Any) -> list[Trial]:
    """x-dot on the ray (sigma, t) = h (-1, 7/10) near a tangency, over h^2."""
    found = []
    for place in tangencies():
        values = place.jets() | {"sigma": -1.0, "t": 0.7}
        truth = place.leading(lambda h, place=place: place.impact(-h, 0.7 * h) / h**2)
        stated = [number(part[1], values) for part in (printed, corrected)]
        found.append(compared(place.name, "x-dot/h^2 at (sigma, t) = (-h, 0.7 h)", truth, *stated))
    return found


def _next_eta(printed: Any, corrected: Any) -> list[Trial]:
    """eta/h of the second flight after a launch at sigma = -h just below gamma."""
    rows = []
    for point, arc in zip(tangencies(), arcs.places(), strict=True):
        first = point.leading(lambda h, p=point, c=arc.coefficient: _etas(p, c, h)[0])
        after = point.leading(lambda h, p=point, c=arc.coefficient: _etas(p, c, h)[1])
        values = point.jets() | {"sigma": -1.0, "eta": first}
        stated = [number(formula[1], values) for formula in (printed, corrected)]
        rows.append(
            compared(point.name, f"eta of the next launch, from eta = {first:.6f} at sigma = -1", after, *stated)
        )
    return rows


def _etas(place: Place, coefficient: float, h: float) -> tuple[float, float]:
    """eta/h = (3 sigma/2 + t)/h of two flights, one after the other."""
    step = place.model.impact_map(place.tau - h, 0.9 * coefficient * h * h)
    again = place.model.impact_map(float(step.tau), float(step.v))
    sigma = float(step.tau) - place.tau
    return (-1.5 * h + float(step.flight_time)) / h, (1.5 * sigma + float(again.flight_time)) / h


RAY = 0.7  # t/h of flights from sigma = -h: before the horizon, which is at 3/2


def _bent_sigma(printed: Any, corrected: Any) -> list[Trial]:
    """(sigma' - (eta - sigma/2))/h^2 on a ray, eta in the fold form: -k eta^2 = v - P(sigma), P the outline.

    A statement is tried by its last part, the degree from which it leaves out terms: 0 is left for more than 2.
    """
    rows = []
    for point in tangencies():
        values = point.jets()
        truth = point.leading(lambda h, p=point, k=values["k"]: (RAY * h - h - _fold_eta(p, k, h) - h / 2) / h**2)
        jets = values | {"a_d2": values["a_d2"] / values["k"], "sigma": -1.0, "eta": RAY - 1.5}
        quadratic = number(next_sigma() - (fold.eta - sigma / 2), jets)
        says = [0.0 if order > 2 else quadratic for *_, order in (printed, corrected)]
        rows.append(compared(point.name, f"(sigma' - eta + sigma/2)/h^2 at sigma = -h, t = {RAY} h", truth, *says))
    return rows


def _fold_eta(place: Place, k: float, h: float) -> float:
    """eta < 0 with -k eta^2 = v_c(-h, RAY h) - P(-h)."""
    top = minimize_scalar(
        lambda t: -place.launch(-h, t), bounds=(1.2 * h, 1.8 * h), method="bounded", options={"xatol": 1e-4 * h}
    )
    return -float(np.sqrt((-top.fun - place.launch(-h, RAY * h)) / k))


def _arcs(_printed: Any, _corrected: Any) -> list[Trial]:
    """Invariant arcs that end at w_*: gamma, found by following G backwards, and the states at rest before it."""
    return arcs_at(tangencies(), 1)


def arcs_at(places: tuple[Place, ...], j: int) -> list[Trial]:
    """The number of invariant arcs that end at a contact point, v > 0 on them or not."""
    curves = {case.name.partition(",")[0]: case for case in true_orbits.gamma_cases(j)}
    rows = []
    for point in places:
        case = curves[point.name.partition(",")[0]]
        resting = all(
            point.model.first_hit(point.tau - s, 0.0).status == Status.sticks for s in (0.2, 0.1, 0.01, 0.001)
        )
        own = case.error < 1e-3
        text = f"{own + resting}, of which {int(own)} with v > 0"
        rows.append(
            Trial(point.name, "invariant arcs that end at w_*", text, "1", "1 with v > 0", own + resting == 1, own)
        )
    return rows


def _eigenvalue(printed: Any, corrected: Any) -> list[Trial]:
    found = []
    for case in arcs.eigenvalues():
        rate = {"lambda": true_orbits.lambda_of(case.r, 1)}
        stated = [number(part, rate) for part in (printed, corrected)]
        found.append(compared(case.name, f"larger eigenvalue of DG at w_*, r = {case.r}", case.found, *stated))
    return found


def _cubic(printed: int, corrected: int) -> list[Trial]:
    """v_c has a term in t^3 at a tangency, so eta^3 in the fold coordinates; a source change by terms of degree n alters
    p from degree n + 1 on, so changes that are the identity to second order leave it."""
    rows = []
    for point in tangencies():
        truth = point.taylor(0.0, 3)
        jets = point.jets()
        exact = -jets["a_d2"] / 24 + jets["a_d1"] * jets["b"] / 24
        says = [0.0 if order >= 2 else exact for order in (printed, corrected)]
        rows.append(compared(point.name, "coefficient of t^3 that the changes must remove", truth, *says))
    return rows


def _numbers(r: str, mp: Any) -> dict[str, Any]:
    """m1, m2, m3, m_minus, m_plus in an mpmath context, and r."""
    points = fixed_points.tangency(r, DIGITS)
    names = ("m1", "m2", "m3", "m_minus", "m_plus")
    return {name: mp.convert(getattr(points, name).value) for name in names} | {
        "r": mp.mpf(r.split("/")[0]) / int(r.split("/")[1])
    }


def _at(expression: Any, m: Any, r: Any) -> Any:
    """A polynomial in m and r at numbers of an mpmath context; sympy's own text has its rationals in mpmath.mp."""
    spaces = [{"mpf": r.context.mpf}, "mpmath"]
    return sympy.lambdify((fold.m, sympy.Symbol("r")), expression, spaces)(m, r)


def _image(m: Any, r: Any) -> Any:
    """sqrt(Q_r(1, m))/(m - 1/2), the ray that follows m under h'."""
    return r.context.sqrt(_at(fold.Q_at_one(), m, r)) / (m - r.context.mpf(1) / 2)


def _over_rates(trial: Callable[[str, dict[str, Any]], Trial]) -> Trials:
    def trials(_printed: Any, _corrected: Any) -> list[Trial]:
        with digits_at(DIGITS) as mp:
            return [trial(f"fixed points, r = {r}", _numbers(r, mp)) for r in RATES]

    return trials


SMALL = 1e-30


def _closed_end(name: str, at: dict[str, Any]) -> Trial:
    values = [_at(fold.Q_at_one(), at[end], at["r"]) for end in ("m_minus", "m_plus")]
    zero = all(abs(value) < SMALL for value in values)
    inside = (
        _at(fold.Q_at_one(), at["m_plus"] + 1, at["r"]) > 0 and _at(fold.Q_at_one(), at["m_minus"] - 1, at["r"]) > 0
    )
    told = ", ".join(nstr(value, 3) for value in values)
    return Trial(name, "Q_r(1, m) at m_-, m_+", told, "> 0", "0", not zero, zero and inside)


def _converse(name: str, at: dict[str, Any]) -> Trial:
    kept = all(abs(_image(at[n], at["r"]) - at[n]) < SMALL for n in ("m1", "m3"))
    image = _image(at["m2"], at["r"])
    holds = abs(image - at["m2"]) < SMALL
    told = f"{nstr(image, 12)}; m1 and m3 return"
    return Trial(name, "image of m2", told, f"m2 = {nstr(at['m2'], 12)}", "nothing is said of m2", holds, kept)


def _trivial(name: str, at: dict[str, Any]) -> Trial:
    half = at["r"].context.mpf(3) / 2
    value = _at(fold.fixed_point_equation(), half, at["r"])
    zero = abs(value) < SMALL
    return Trial(name, "Q_r(1,m) - m^2(m-1/2)^2 at m = 3/2", nstr(value, 3), "not 0", "0", not zero, zero)


def _third_form(name: str, at: dict[str, Any]) -> Trial:
    """dm'/dm by differences, at m = 3/2 and at m3."""
    rate, mp = at["r"], at["r"].context
    step = mp.mpf(10) ** -12
    slope = {m: (_image(m + step, rate) - _image(m - step, rate)) / (2 * step) for m in (mp.mpf(3) / 2, at["m3"])}
    (extra, own), (_, m3) = slope.values(), slope
    formula = [_at(fold.N_r_at_fixed_points(), m, rate) for m in (mp.mpf(3) / 2, m3)]
    text = f"{nstr(extra, 12)} at 3/2, {nstr(own, 12)} at m3"
    says = [nstr(value, 12) for value in formula]
    near = [abs(a - b) < 1e-15 for a, b in zip((extra, own), formula, strict=True)]
    return Trial(name, "dm'/dm", text, f"{says[0]} at 3/2", f"{says[1]} at m3, nothing of 3/2", near[0], near[1])


def _m2_line(printed: int, corrected: int) -> list[Trial]:
    """v of q over v of p on the line of m2, both over sigma^2: on one parabola, so the quotient has size 1."""
    found = []
    for place in tangencies():
        r = {0.5: "1/2", 0.6: "3/5"}[place.r]
        m2 = float(fixed_points.tangency(r, 20).m2.value)
        truth = place.leading(lambda h, p=place, m=m2: _line_quotient(p, m, h))
        found.append(compared(place.name, "v/sigma^2 after, over that before", truth, float(printed), float(corrected)))
    return found


def _line_quotient(place: Place, m2: float, h: float) -> float:
    t = (m2 - 1.5) * h
    before = place.launch(h, t) / h**2
    after = -place.r * place.impact(h, t) / (h + t) ** 2
    return after / before


def _tangent(_printed: Any, _corrected: Any) -> list[Trial]:
    """eta/sigma on gamma: 3/2 + t/sigma, t/sigma = sigma'/sigma - 1 on true orbits."""
    cases = [case for case in true_orbits.gamma_cases(1) if "DOP853" in case.name]
    return [compared(c.name, "eta/sigma on gamma", c.ratio + 0.5, 0.0, c.multiplier + 0.5) for c in cases]


TRIALS: dict[str, Trials] = {
    "e:phi": second_component,
    "e:vtaylor-t2": _coefficient(lambda place: place.taylor(0.0, 2)),
    "e:vtaylor-st2": _coefficient(_mixed),
    "e:vtaylor-t3": _coefficient(lambda place: place.taylor(0.0, 3)),
    "e:phinew": _impact,
    "e:defq": _bent_sigma,
    "e:hdef": lambda printed, corrected: [*_next_eta(printed, corrected), *_bent_sigma(printed, corrected)],
    "s4-blowup": _bent_sigma,
    "t:t2-unique": _arcs,
    "t:t2-fixed": rest_at_tangency,
    "t:t2-eigenvalue-limit": _eigenvalue,
    "s4-normal-id2": _cubic,
    "s4-Er-closed": _over_rates(_closed_end),
    "e:fixm-converse": _over_rates(_converse),
    "s4-m32-r1": _over_rates(_trivial),
    "s4-Nr-3-all": _over_rates(_third_form),
    "s4-m2-sign": _m2_line,
    "s4-beta-tangent": _tangent,
}
