"""Truncation measured: remainders of v_c, p and phi on true flights fall off with the degree of the first omitted term.

That degree is computed exactly before it is measured: a part of the series counts as absent when its coefficients are
zero as polynomials in those jets that are not exactly zero, and as present when a ball excludes zero.
"""

from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.jets import Jet
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES, EXACT, Multiprecision
from singimpact.algebra.solving import secant
from singimpact.contact.contact import Contact, acceleration_jet, contact_order, derivative_name, force_jet
from singimpact.contact.points import tangency_points
from singimpact.oscillator.model import Oscillator
from singimpact.paper.trials import true_orbits
from singimpact.theory.impact_sheet import Sheet, generic_sheet, sheet

RAY = (Fraction(-1), Fraction(7, 10))  # (sigma, t) = h RAY: inside the visible part, off every curve named in the paper
STEPS = (0.02, 0.01, 0.005)  # h for DOP853: small enough for one term to rule, remainders well above rounding
DIGIT_STEPS = (-5, -6)  # powers of ten for the closed form
BITS = 256


@dataclass(frozen=True)
class RemainderCase:
    """One remainder: `expected` degree from the exact series, `measured` on true flights.

    Attributes
    ----------
    name : the model, the contact and the flow. quantity : "v_c" or "phi". order : the last degree kept.
    """

    name: str
    quantity: str
    order: int
    expected: int
    measured: float

    @property
    def agrees(self) -> bool:
        """Whether the measured degree is the expected one, to a quarter of a degree."""
        return abs(self.measured - self.expected) < 0.25

    def line(self) -> str:
        """One line for a table."""
        return f"{self.quantity} on {self.name}: O({self.expected}), measured {self.measured:.2f}"


@dataclass(frozen=True)
class Setting:
    """A model at a contact point: `tau` for the flow, `exact_tau` when the point is a rational number."""

    name: str
    model: Oscillator
    j: int
    tau: Any
    exact_tau: Fraction | None


def setting(name: str, j: int) -> Setting:
    """A model of `true_orbits.MODELS` at a regular point, at its tangency, or at its own swan (tau = 0)."""
    model = true_orbits.MODELS[name]
    if j == 0:
        return Setting(name, model, 0, 1.2, Fraction(6, 5))
    at, tau = true_orbits.contact_model(model, j)
    return Setting(name, at, j, tau, Fraction(0) if j == 2 else None)


def exact_zeros(setting_: Setting, generic: Sheet) -> set[str]:
    """Names of the jets that are exactly zero at the point: found over the rationals where that is possible."""
    zeros: set[str] = set()
    if setting_.exact_tau is not None:
        with suppress(ArithmeticError):
            a = acceleration_jet(setting_.model, setting_.exact_tau, max(generic.contact.a), EXACT)
            zeros |= {derivative_name(k) for k in generic.contact.a if k > setting_.j and a[k] == 0}
    with suppress(ArithmeticError):
        f = force_jet(setting_.model, setting_.j, generic.order, EXACT)
        zeros |= {f"f_{i}{k}" for i, k in generic.contact.f if f.get((i, k), 0) == 0}
    return zeros


def first_omitted(setting_: Setting, order: int, quantity: str, search: int = 4) -> int:
    """The degree of the first term after `order` that does not vanish along `RAY`.

    Raises
    ------
    ArithmeticError : a part is not zero exactly, yet no ball of 256 bits excludes zero.
    """
    generic = generic_sheet(setting_.j, order + search)
    jet = generic.v if quantity == "v_c" else generic.xdot
    zeros = exact_zeros(setting_, generic)
    balls = Balls(BITS)
    with balls_at(BITS):
        values = _ball_values(setting_, generic, balls)
    for degree in range(order + 1, order + search + 1):
        terms = _without(_on_ray(jet, degree, generic), generic.contact.ring, zeros)
        if terms == 0:
            continue
        with balls_at(BITS):
            if not _evaluated(terms, generic.contact.ring.names, values).contains(0):
                return degree
        raise ArithmeticError(f"the part of degree {degree} of {quantity} at {setting_.name} is not decided")
    raise ArithmeticError(f"no part of degree up to {order + search} is left in {quantity} at {setting_.name}")


def _on_ray(jet: Jet, degree: int, generic: Sheet) -> Any:
    """The part of one degree on RAY: a polynomial in the jets."""
    ring = generic.contact.ring
    total = ring.rational(Fraction(0))
    for (i, k), value in jet.terms.items():
        if i + k == degree:
            total = total + value * ring.rational(RAY[0] ** i * RAY[1] ** k)
    return total


def _without(poly: Any, ring: Any, zeros: set[str]) -> Any:
    if poly == 0 or not zeros:
        return poly
    index = {name: n for n, name in enumerate(ring.names)}
    kept = {
        key: value for key, value in poly.to_dict().items() if not any(key[index[name]] for name in zeros & set(index))
    }
    return poly.context().from_dict(kept)


def _ball_values(place: Setting, generic: Sheet, balls: Balls) -> dict[str, Any]:
    top = max(generic.contact.a)
    a = acceleration_jet(place.model, _tau_ball(place, balls), top, balls)
    f = force_jet(place.model, place.j, generic.order, balls)
    return {derivative_name(k): a[k] * factorial(k) for k in generic.contact.a} | {
        f"f_{i}{k}": f.get((i, k), balls.rational(Fraction(0))) * (factorial(i) * factorial(k))
        for i, k in generic.contact.f
    }


def _tau_ball(place: Setting, balls: Balls) -> Any:
    if place.exact_tau is not None:
        return balls.rational(place.exact_tau)
    return next(p for p in tangency_points(place.model) if p.kind == "gamma").ball(BITS)


def _evaluated(poly: Any, names: tuple[str, ...], values: dict[str, Any]) -> Any:
    total = Balls(BITS).rational(Fraction(0))
    for exponents, coefficient in poly.to_dict().items():
        term = Balls(BITS).rational(Fraction(int(coefficient.p), int(coefficient.q)))
        for name, exponent in zip(names, exponents, strict=True):
            if exponent:
                term = term * values[name] ** int(exponent)
        total = total + term
    return total


def _numeric(jet: Jet, sigma: Any, t: Any) -> Any:
    return sum((value * sigma**i * t**k for (i, k), value in jet.terms.items()), sigma * 0)


def measured(series: Sheet, flow: true_orbits.Flow, quantity: str, steps: list[Any]) -> float:
    """The order of the remainder along RAY as h falls: the slope between the two smallest h.

    v_c: a flight launched with the truncated v_c misses c after t by t y, and dy/dv = 1 + O(h), so y is the remainder.
    phi: the launch velocity is first made true, then the impact velocity is compared.
    """
    misses = []
    for h in steps:
        sigma, t = h * RAY[0].numerator, h * RAY[1].numerator / RAY[1].denominator
        v = _numeric(series.v, sigma, t)
        if quantity == "phi":
            v = _true_launch(flow, sigma, v, t)
            misses.append(abs(flow(sigma, v, t)[1] - _numeric(series.xdot, sigma, t)))
        else:
            misses.append(abs(flow(sigma, v, t)[0]))
    return float(np.log(float(misses[-2] / misses[-1])) / np.log(float(steps[-2] / steps[-1])))


def _true_launch(flow: true_orbits.Flow, sigma: Any, v: Any, t: Any) -> Any:
    """The launch velocity whose flight is back after t, by the secant method from the truncated one."""
    return secant(lambda speed: flow(sigma, speed, t)[0], v, v * (1 + v * 0 + 1e-6))


@lru_cache(maxsize=16)
def remainders(j: int | str, order: int) -> tuple[RemainderCase, ...]:
    """Remainders of v_c (which is p) and of phi on both models by DOP853, on the linear one in many digits too."""
    j = contact_order(j)
    cases = []
    for name in true_orbits.MODELS:
        setting_ = setting(name, j)
        series = sheet(Contact.of(setting_.model, setting_.tau, j, order, DOUBLES), order)
        flow = true_orbits.scipy_flow(setting_.model, float(setting_.tau))
        cases += [
            RemainderCase(
                f"{name}, DOP853",
                quantity,
                order,
                first_omitted(setting_, order, quantity),
                measured(series, flow, quantity, list(STEPS)),
            )
            for quantity in ("v_c", "phi")
        ]
    return tuple(cases) + _with_digits(j, order)


def _with_digits(j: int, order: int) -> tuple[RemainderCase, ...]:
    """The linear model in closed form with true_orbits.SETTINGS.digits digits."""
    setting_ = setting("linear, omega 2", j)
    context, origin, clearance = true_orbits.many_digits(j)
    model = setting_.model.replace(clearance=clearance)
    series = sheet(Contact.of(model, origin, j, order, Multiprecision(context)), order)
    flow = true_orbits.closed_flow(Fraction(2), clearance, origin, context)
    steps = [context.mpf(10) ** power for power in DIGIT_STEPS]
    return tuple(
        RemainderCase(
            "linear, closed form, 40 digits and more",
            quantity,
            order,
            first_omitted(setting_, order, quantity),
            measured(series, flow, quantity, steps),
        )
        for quantity in ("v_c", "phi")
    )
