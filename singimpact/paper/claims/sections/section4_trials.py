"""Sections 4 and 5: what is printed and what is corrected there, tried on two models or at two values of r."""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np
import sympy
from mpmath import nstr
from scipy.optimize import minimize_scalar

from singimpact.algebra.precision import digits_at
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.claims.claim import Trial, Trials, at_each, compared
from singimpact.paper.claims.sections.section2_trials import rest_at_tangency, second_component
from singimpact.paper.routes import fold, swan
from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.fold import eta
from singimpact.paper.routes.implicit import r as restitution, sigma
from singimpact.paper.trials import arcs, true_orbits
from singimpact.paper.trials.true_sheet import Place, damped, foliated, foliation, number, regular, swans, tangencies
from singimpact.status import Status
from singimpact.theory import fixed_points
from singimpact.theory.plane_forms import fold_form

RATES = ("1/2", "1/5")
DIGITS = 40
SMALL = 1e-30

# Section 4 and 4.1(a): coefficients of v_c, the maps next to a tangency with a' > 0, fixed points of the blown-up map.


@equation("s4-next-sigma")
def next_sigma() -> Any:
    """The next sigma in the coordinates of the fold form without higher terms, to second order, lengths in units of k.

    In (sigma, eta), eta = 3 sigma/2 + t, it is eta - sigma/2 exactly; the source change eta -> T(sigma, eta) of
    `fold_form`, which keeps the phase sigma, gives it quadratic terms, so that s' = (m - 1/2) s + O(s^2) there.
    Another T that keeps sigma is (1 + c sigma + ...) T, which moves the term in sigma eta alone.

    Examples
    --------
    >>> poly = sympy.Poly(next_sigma(), sigma, eta)
    >>> poly.coeff_monomial(eta), poly.coeff_monomial(sigma), poly.coeff_monomial(eta**2)
    (1, -1/2, -a_d2/48 - f_01/8)
    """
    source = sympy.Poly(fold_form(3).source, sigma, eta)
    bent = sum(value * sigma**i * eta**n for (i, n), value in source.terms() if i + n == 2)
    return sympy.expand(eta - sigma / 2 - bent)


def next_sigma_remainder(leading: sympy.Expr) -> tuple[Any, dict[tuple[int, int], Any]]:
    """(lowest degree, its terms) of `next_sigma` minus a polynomial; the degree is oo where nothing is left.

    Examples
    --------
    >>> next_sigma_remainder(eta - sigma / 2)[0], next_sigma_remainder(next_sigma())[0]
    (2, oo)
    """
    terms = {key: value for key, value in sympy.Poly(next_sigma() - leading, sigma, eta).terms() if value != 0}
    lowest = min((sum(key) for key in terms), default=sympy.oo)
    return lowest, {key: value for key, value in terms.items() if sum(key) == lowest}


def _coefficient(measured: Callable[[Place], float]) -> Trials:
    """Trials of a coefficient of v_c at a regular point of two damped models (f_v = 0 would hide the misprint)."""

    def trial(point: Place, *statements: tuple[Any, ...]) -> Trial:
        says = [number(part[0], point.jets()) for part in statements]
        return compared(point.name, "coefficient of v_c", measured(point), says[0], says[1], tolerance=1e-5)

    return at_each(damped, trial)


def _mixed(point: Place) -> float:
    """The coefficient of sigma t^2, by differences in sigma."""
    values = [point.taylor(0.02 * n, 2) for n in (1, -1, 2, -2)]
    return (8 * (values[0] - values[1]) - (values[2] - values[3])) / (12 * 0.02)


def _impact(point: Place, *statements: tuple[Any, ...]) -> Trial:
    """x-dot on the ray (sigma, t) = h (-1, 7/10) near a tangency, over h^2."""
    values = point.jets() | {"sigma": -1.0, "t": 0.7}
    truth = point.leading(lambda h: point.impact(-h, 0.7 * h) / h**2)
    stated = [number(part[1], values) for part in statements]
    return compared(point.name, "x-dot/h^2 at (sigma, t) = (-h, 0.7 h)", truth, *stated)


def _next_eta(point: Place, *statements: tuple[Any, ...]) -> Trial:
    """eta/h of the second flight after a launch at sigma = -h just below gamma."""
    first, after = (point.leading(lambda h, n=n: _etas(point, h)[n]) for n in (0, 1))
    values = point.jets() | {"sigma": -1.0, "eta": first}
    stated = [number(formula[1], values) for formula in statements]
    return compared(point.name, f"eta of the next launch, from eta = {first:.6f} at sigma = -1", after, *stated)


def _etas(point: Place, h: float) -> tuple[float, float]:
    """eta/h = (3 sigma/2 + t)/h of two flights, one after the other."""
    step = point.model.impact_map(point.tau - h, 0.9 * point.coefficient * h * h)
    again = point.model.impact_map(float(step.tau), float(step.v))
    sigma = float(step.tau) - point.tau
    return (-1.5 * h + float(step.flight_time)) / h, (1.5 * sigma + float(again.flight_time)) / h


RAY = 0.7  # t/h of flights from sigma = -h: before the horizon, which is at 3/2


def _bent_sigma(point: Place, *statements: tuple[Any, ...]) -> Trial:
    """(sigma' - (eta - sigma/2))/h^2 on a ray, eta in the fold form: -k eta^2 = v - P(sigma), P the outline.

    A statement is tried by its last part, the degree from which it leaves out terms: 0 is left for more than 2.
    """
    values = point.jets()
    truth = point.leading(lambda h: (RAY * h - h - _fold_eta(point, values["k"], h) - h / 2) / h**2)
    jets = values | {"a_d2": values["a_d2"] / values["k"], "sigma": -1.0, "eta": RAY - 1.5}
    quadratic = number(next_sigma() - (fold.eta - sigma / 2), jets)
    says = [0.0 if order > 2 else quadratic for *_, order in statements]
    return compared(point.name, f"(sigma' - eta + sigma/2)/h^2 at sigma = -h, t = {RAY} h", truth, *says)


def _fold_eta(point: Place, k: float, h: float) -> float:
    """eta < 0 with -k eta^2 = v_c(-h, RAY h) - P(-h)."""
    top = minimize_scalar(
        lambda t: -point.launch(-h, t), bounds=(1.2 * h, 1.8 * h), method="bounded", options={"xatol": 1e-4 * h}
    )
    return -float(np.sqrt((-top.fun - point.launch(-h, RAY * h)) / k))


def _arcs(places: Callable[[], tuple[Place, ...]], j: int) -> Trials:
    """The number of invariant arcs that end at a contact point, v > 0 on them or not.

    They are gamma, found by following G backwards, and the states at rest before the point.
    """

    def trial(point: Place, *_: object) -> Trial:
        case = {case.name.partition(",")[0]: case for case in true_orbits.gamma_cases(j)}[point.name.partition(",")[0]]
        before = [point.model.first_hit(point.tau - s, 0.0).status for s in (0.2, 0.1, 0.01, 0.001)]
        own, resting = case.error < 1e-3, set(before) == {Status.sticks}
        text = f"{own + resting}, of which {int(own)} with v > 0"
        return Trial(point.name, "invariant arcs that end at w_*", text, "1", "1 with v > 0", own + resting == 1, own)

    return at_each(places, trial)


def _eigenvalue(case: arcs.EigenvalueCase, *statements: object) -> Trial:
    stated = [number(part, {"lambda": true_orbits.lambda_of(case.r, 1)}) for part in statements]
    return compared(case.name, f"larger eigenvalue of DG at w_*, r = {case.r}", case.found, *stated)


def _cubic(point: Place, *orders: int) -> Trial:
    """v_c has a term in t^3 at a tangency, so eta^3 in the fold coordinates; a source change by terms of degree n alters
    p from degree n + 1 on, so changes that are the identity to second order leave it."""
    jets = point.jets()
    exact = -jets["a_d2"] / 24 + jets["a_d1"] * jets["b"] / 24
    says = [0.0 if order >= 2 else exact for order in orders]
    return compared(point.name, "coefficient of t^3 that the changes must remove", point.taylor(0.0, 3), *says)


def _fixed_points(rate: str, mp: Any) -> dict[str, Any]:
    """m1, m2, m3, m_minus, m_plus and r in an mpmath context."""
    points, exact = fixed_points.tangency(rate, DIGITS), Fraction(rate)
    numbers = {name: mp.convert(getattr(points, name).value) for name in ("m1", "m2", "m3", "m_minus", "m_plus")}
    return numbers | {"r": mp.mpf(exact.numerator) / exact.denominator}


def _over_rates(trial: Callable[[str, dict[str, Any]], Trial]) -> Trials:
    """Trials at the fixed points for each value of r."""

    def trials(_printed: object, _corrected: object) -> list[Trial]:
        with digits_at(DIGITS) as mp:
            return [trial(f"fixed points, r = {rate}", _fixed_points(rate, mp)) for rate in RATES]

    return trials


def _at(expression: sympy.Expr, m: Any, r: Any) -> Any:
    """A polynomial in m and r at numbers of an mpmath context; sympy's own text has its rationals in mpmath.mp."""
    return sympy.lambdify((fold.m, sympy.Symbol("r")), expression, [{"mpf": r.context.mpf}, "mpmath"])(m, r)


def _image(m: Any, r: Any) -> Any:
    """sqrt(Q_r(1, m))/(m - 1/2), the ray that follows m under h'."""
    return r.context.sqrt(_at(fold.Q_at_one(), m, r)) / (m - r.context.mpf(1) / 2)


def _closed_end(name: str, at: dict[str, Any]) -> Trial:
    ends = [_at(fold.Q_at_one(), at[end], at["r"]) for end in ("m_minus", "m_plus")]
    beyond = [_at(fold.Q_at_one(), m, at["r"]) for m in (at["m_plus"] + 1, at["m_minus"] - 1)]
    zero = all(abs(value) < SMALL for value in ends)
    text = ", ".join(nstr(value, 3) for value in ends)
    return Trial(name, "Q_r(1, m) at m_-, m_+", text, "> 0", "0", not zero, zero and min(beyond) > 0)


def _converse(name: str, at: dict[str, Any]) -> Trial:
    kept = all(abs(_image(at[n], at["r"]) - at[n]) < SMALL for n in ("m1", "m3"))
    image = _image(at["m2"], at["r"])
    holds = abs(image - at["m2"]) < SMALL
    text = f"{nstr(image, 12)}; m1 and m3 return"
    return Trial(name, "image of m2", text, f"m2 = {nstr(at['m2'], 12)}", "nothing is said of m2", holds, kept)


def _trivial(name: str, at: dict[str, Any]) -> Trial:
    value = _at(fold.fixed_point_equation(), at["r"].context.mpf(3) / 2, at["r"])
    zero = abs(value) < SMALL
    return Trial(name, "Q_r(1,m) - m^2(m-1/2)^2 at m = 3/2", nstr(value, 3), "not 0", "0", not zero, zero)


def _third_form(name: str, at: dict[str, Any]) -> Trial:
    """dm'/dm by differences, at m = 3/2 and at m3."""
    rate, mp = at["r"], at["r"].context
    step, places = mp.mpf(10) ** -12, (mp.mpf(3) / 2, at["m3"])
    slopes = [(_image(m + step, rate) - _image(m - step, rate)) / (2 * step) for m in places]
    formula = [_at(fold.N_r_at_fixed_points(), m, rate) for m in places]
    text = "{} at 3/2, {} at m3".format(*(nstr(slope, 12) for slope in slopes))
    says = [nstr(value, 12) for value in formula]
    near = [abs(a - b) < 1e-15 for a, b in zip(slopes, formula, strict=True)]
    return Trial(name, "dm'/dm", text, f"{says[0]} at 3/2", f"{says[1]} at m3, nothing of 3/2", near[0], near[1])


def _m2_line(point: Place, printed: int, corrected: int) -> Trial:
    """v of q over v of p on the line of m2, both over sigma^2: on one parabola, so the quotient has size 1."""
    m2 = float(fixed_points.tangency({0.5: "1/2", 0.6: "3/5"}[point.r], 20).m2.value)

    def quotient(h: float) -> float:
        t = (m2 - 1.5) * h
        before = point.launch(h, t) / h**2
        return -point.r * point.impact(h, t) / (h + t) ** 2 / before

    name = "v/sigma^2 after, over that before"
    return compared(point.name, name, point.leading(quotient), float(printed), float(corrected))


def _tangent(case: true_orbits.GammaCase, *_: object) -> Trial:
    """eta/sigma on gamma: 3/2 + t/sigma, t/sigma = sigma'/sigma - 1 on true orbits."""
    return compared(case.name, "eta/sigma on gamma", case.ratio + 0.5, 0.0, case.multiplier + 0.5)


# Section 4.1(b): next to a tangency with a' < 0.

ELL = 1.0  # the ray t = ell sigma on which the bounds are tried
NEAR = 5e-3  # sigma there: the leading terms rule, and rounding does not


def _half_plane(point: Place, *_: object) -> Trial:
    """phi of a point of the sector: v over s^2, s = sigma + t."""
    value = point.leading(lambda h: point.impact(h, h) / (2 * h) ** 2)
    return Trial(point.name, "v/s^2 of phi(sigma, sigma)", f"{value:.8g}", ">= 0", "<= 0", value >= 0, value <= 0)


@lru_cache(maxsize=1)
def _gentle() -> tuple[Place, ...]:
    """The two models forced a tenth and a fifth as much, so that k is small."""
    models = {
        "x'' + x = cos(2t)/10, c = 0.03": ImpactOscillator("x", "cos(2*t)/10", "0.03", "0.5"),
        "damped Duffing, forced by cos(1.7t)/5": ImpactOscillator(
            "x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)/5", "0.05", "0.6"
        ),
    }
    return tuple(Place(name, model, foliation(model)) for name, model in models.items())


def _range(point: Place, *formulas: object) -> Trial:
    """t/sigma of true flights from the edge v = -(9/4) r k sigma^2, against the last ray of each statement."""
    jets = point.jets()
    edge = -2.25 * point.r * jets["k"]
    last = point.leading(lambda h: float(point.model.impact_map(point.tau + h, edge * h * h).flight_time) / h)
    ends = [number(formula, jets) for formula in formulas]
    says = [f"l <= {end:.8g}" for end in ends]
    name = "l of the edge that the rays must reach"
    return Trial(point.name, name, f"{last:.8g}", says[0], says[1], last <= ends[0], last <= ends[1])


def _velocities(point: Place, sigma: float) -> tuple[float, float]:
    """p~ and q~ at sigma: launch on the ray there, and the velocity with which the flight that lands there goes on."""
    start = sigma / (1 + ELL)
    return point.launch(sigma, ELL * sigma), -point.r * point.impact(start, ELL * start)


def _bound(quantity: str, sign: int, measured: Callable[[Place], float]) -> Trials:
    """Trials of a bound from below, sign 1, or from above, -1."""

    def trial(point: Place, *formulas: object) -> Trial:
        value = measured(point)
        bounds = [number(formula, point.jets() | {"ell": ELL, "sigma": NEAR}) for formula in formulas]
        says = [f"{'>' if sign > 0 else '<'} {bound:.8g}" for bound in bounds]
        holds = [(value - bound) * sign > 0 for bound in bounds]
        return Trial(point.name, quantity, f"{value:.8g}", says[0], says[1], holds[0], holds[1])

    return at_each(foliated, trial)


def _ratio(point: Place) -> float:
    return point.leading(lambda h: _velocities(point, h)[1] / _velocities(point, h)[0])


def _back(name: str, *_: object) -> Trial:
    """The other end of the leaf with its foot at tau_* + sigma, as sigma -> 0."""
    own = sorted((leaf for leaf in arcs.leaves() if leaf.name == name), key=lambda leaf: leaf.foot)
    (one, two), before = own[:2], all(leaf.end < 0 < leaf.foot for leaf in own)
    limit = (one.end * two.foot - two.end * one.foot) / (two.foot - one.foot)
    gone = abs(limit) < 0.05 * abs(one.end)
    text = f"{limit:.1e} at sigma = 0, {one.end:.4g} at sigma = {one.foot:.4g}"
    return Trial(name, "sigma' of the other end", text, "< 0 at 0", "< 0 for sigma > 0", not gone, before)


# Section 5: next to swans.


def _coordinates(point: Place, *readings: object) -> Trial:
    """v/(ell s^3) of true flights with the flight time that each reading of (s, m) gives, against the formula."""
    formula, ell = number(swan.p_blown_up()[1], {"m": -0.5}), point.jets()["ell"]
    times = [number(reading, {"s": 1.0, "m": -0.5}) for reading in readings]
    values = [point.leading(lambda h, t=t: point.launch(h, t * h) / (ell * h**3)) for t in times]
    return compared(point.name, "v/(ell s^3) at m = -1/2 by the formula", formula, *values)


def _intersections(rate: str, printed: int, corrected: int) -> Trial:
    """Real m > -1 with f(m) = g(m), at one value of r."""
    gap = (swan.f_map() - swan.g_map()).subs(restitution, sympy.Rational(rate))
    roots = [root for root in sympy.Poly(sympy.fraction(sympy.cancel(gap))[0], swan.m).real_roots() if root > -1]
    count, text = len(roots), f"{len(roots)}: {', '.join(f'{float(root):.8g}' for root in roots)}"
    name = f"f and g, r = {rate}"
    return Trial(name, "common points", text, str(printed), str(corrected), count == printed, count == corrected)


def _cube_root(point: Place, *_: object) -> Trial:
    """d log t/d log v of the flight time on sigma = 0: 1 for a smooth F, 1/3 for t ~ (-24 v/a'')^(1/3)."""
    v = np.array([1e-8, 1e-10])
    times = np.asarray(point.model.impact_map(point.tau, v).flight_time)
    slope = float(np.log(times[0] / times[1]) / np.log(v[0] / v[1]))
    return compared(point.name, "exponent of v in the flight time", slope, 1.0, 1 / 3, tolerance=1e-2)


def _swan_eigenvalue(point: Place, *formulas: object) -> Trial:
    """The larger eigenvalue of the exact DG at points of gamma, found backwards on true flights, as sigma -> 0."""
    rate = true_orbits.lambda_of(point.r, 2)
    flow, start = true_orbits.scipy_flow(point.model, point.tau), true_orbits.SETTINGS.start[1]
    first = abs(point.jets()["ell"]) * start**3
    orbit = true_orbits.backwards(flow, point.r, -start, first, rate, 0.06)[-4:]
    matrices = [(s, np.asarray(point.model.derivative(point.tau + s, v).matrix)) for s, v in orbit]
    truth = true_orbits.extrapolated([(s, float(max(np.linalg.eigvals(matrix).real))) for s, matrix in matrices])
    stated = [number(formula, {"lambda": rate}) for formula in formulas]
    name = f"larger eigenvalue of DG at w_*, r = {Fraction(point.r).limit_denominator(99)}"
    return compared(point.name, name, float(truth), *stated)


AT = f"at sigma = {NEAR}, l = {ELL}"
BENT = at_each(tangencies, _bent_sigma)
NEXT = at_each(tangencies, _next_eta)
TRIALS: dict[str, Trials] = {
    "e:phi": at_each(regular, second_component),
    "e:vtaylor-t2": _coefficient(lambda point: point.taylor(0.0, 2)),
    "e:vtaylor-st2": _coefficient(_mixed),
    "e:vtaylor-t3": _coefficient(lambda point: point.taylor(0.0, 3)),
    "e:phinew": at_each(tangencies, _impact),
    "e:defq": BENT,
    "e:hdef": lambda printed, corrected: [*NEXT(printed, corrected), *BENT(printed, corrected)],
    "s4-blowup": BENT,
    "t:t2-unique": _arcs(tangencies, 1),
    "t:t2-fixed": at_each(arcs.LIFT_OFF.items, rest_at_tangency),
    "t:t2-eigenvalue-limit": at_each(arcs.eigenvalues, _eigenvalue),
    "s4-normal-id2": at_each(tangencies, _cubic),
    "s4-Er-closed": _over_rates(_closed_end),
    "e:fixm-converse": _over_rates(_converse),
    "s4-m32-r1": _over_rates(_trivial),
    "s4-Nr-3-all": _over_rates(_third_form),
    "s4-m2-sign": at_each(tangencies, _m2_line),
    "s4-beta-tangent": at_each(lambda: [c for c in true_orbits.gamma_cases(1) if "DOP853" in c.name], _tangent),
    "s4b-T2-place": at_each(foliated, _half_plane),
    "s4b-l-range": at_each(_gentle, _range),
    "s4b-p-bound": _bound(f"p~ {AT}", 1, lambda point: _velocities(point, NEAR)[0]),
    "s4b-q-bound": _bound(f"q~ {AT}", -1, lambda point: _velocities(point, NEAR)[1]),
    "s4b-ratio": _bound("limit of q~/p~", -1, _ratio),
    "s4b-back": at_each(lambda: {leaf.name: None for leaf in arcs.leaves()}, _back),
    "s5-coordinates": at_each(swans, _coordinates),
    "s5-unique": at_each(lambda: RATES, _intersections),
    "s5-F-smooth": at_each(swans, _cube_root),
    "t:t3-unique": _arcs(swans, 2),
    "t:t3-eigenvalue-limit": at_each(swans, _swan_eigenvalue),
}
