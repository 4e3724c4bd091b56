"""Flights of a nonlinear model that are proved never to return: f a polynomial that cannot turn a rising mass back.

From x = x_1, x' = u_1 > 0 the mass rises for ever if g - f(x, x') > 0 for all x >= x_1, x' >= u_1 and all times.  f is
a polynomial in what x and x' are more than there; if its coefficients are <= 0 apart from the constant one, and that is
below every g, it is so.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, Name, Number, Power, Product, Sum, evaluate, names_in
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import Array, as_float, sign_of
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.model_numbers import turn
from singimpact.oscillator.linear import LinearForm, at_rest
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import reduced


@dataclass(frozen=True)
class ProofSettings:
    """Settings of the check of the inequality.

    Parameters
    ----------
    part : x_1 and u_1 are taken so much smaller than a flight came with, which is far above its error.
    pieces : of a period, on each of which g is enclosed; what encloses it too widely proves nothing.
    degree : of f at most; (x + x')**64 takes 0.3 s, and half a million coefficients of (x + x')**1000 hours.
    """

    part: float = 1e-6
    pieces: int = 256
    bits: int = 128
    degree: int = 64


PROOF = ProofSettings()


def never_turns(osc: Oscillator, z: Array, u: Array) -> Array:
    """Whether flights that came to x - c = z and x' = u are proved to rise for ever; False proves nothing.

    Examples
    --------
    >>> osc = Oscillator("-x**3", "cos(t)", 0, 1)
    >>> never_turns(osc, np.array([5.0, 0.1]), np.array([30.0, 30.0])).tolist()
    [True, False]
    """
    degree = None if osc.parametric else degree_of(osc.force())
    extremes = None if degree is None or degree > PROOF.degree else extremes_of_forcing(osc)
    if degree is None or extremes is None:
        return np.zeros(z.shape, dtype=bool)
    least = extremes[0]
    return np.array(
        [a > 0 and b > 0 and _rises(osc, degree, least, float(a), float(b)) for a, b in zip(z, u, strict=True)],
        dtype=bool,
    )


def degree_of(tree: Expression) -> int | None:
    """The degree of a polynomial in x and xdot; None for anything else.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> degree_of(parse("x**3*xdot - 2*x", ["x", "xdot"])), degree_of(parse("sin(x)", ["x"]))
    (4, None)
    """
    match tree:
        case Name():
            return 1
        case Sum(terms):
            parts = [degree_of(term) for term in terms]
            return None if None in parts else max(degree for degree in parts if degree is not None)
        case Product(factors):
            parts = [degree_of(factor) for factor in factors]
            return None if None in parts else sum(degree for degree in parts if degree is not None)
        case Power(base, Number(exponent)) if exponent.denominator == 1 and exponent > 0 and names_in(base):
            inner = degree_of(base)
            return None if inner is None else inner * int(exponent)
    return None if names_in(tree) else 0


def _rises(osc: Oscillator, degree: int, least: Any, z: float, u: float) -> bool:
    if not (np.isfinite(z) and np.isfinite(u)):
        return False
    balls = Balls(PROOF.bits)
    space = JetSpace(("x", "xdot"), max(degree, 1), balls)
    smaller = Fraction(1) - Fraction(PROOF.part)
    x, xdot = space.generators()
    with balls_at(balls.bits):
        x = x + space.constant(balls.evaluate(osc.clearance, {}) + balls.rational(Fraction(z) * smaller))
        xdot = xdot + space.constant(balls.rational(Fraction(u) * smaller))
        terms = dict(space.evaluate(osc.force(), {"x": x, "xdot": xdot}).terms)
    constant = terms.pop((0, 0), balls.rational(Fraction(0)))
    return bool(constant < least and all(value <= 0 for value in terms.values()))


def least_on_a_grid(osc: Oscillator) -> float:
    """The least value of g at some times of a period, in doubles: a bound from above on its minimum; nan without one.

    Examples
    --------
    >>> least_on_a_grid(Oscillator("x", "cos(2*t)", 0, 1))
    -1.0
    """
    forcing = osc.forcing()
    if "t" in names_in(forcing) and osc.period is None:
        return float("nan")
    period = 1.0 if osc.period is None else as_float(osc.period)
    with np.errstate(all="ignore"):
        return float(np.min(evaluate(forcing, {"t": period * np.arange(64) / 64}, DOUBLES)))


@lru_cache(maxsize=64)
def extremes_of_forcing(osc: Oscillator) -> tuple[Any, Any] | None:
    """Numbers below and above g at all times, from its enclosures over a period; None where there are none."""
    balls, forcing = Balls(PROOF.bits), osc.forcing()
    if "t" not in names_in(forcing):
        enclosures = [balls.evaluate(forcing, {})]
    elif osc.period is None:
        return None
    else:
        period = balls.evaluate(osc.period, {})
        with balls_at(balls.bits):
            ends = [period * piece / PROOF.pieces for piece in range(PROOF.pieces + 1)]
            enclosures = [balls.evaluate(forcing, {"t": low.union(high)}) for low, high in pairwise(ends)]
    if not all(value.is_finite() for value in enclosures):
        return None
    with balls_at(balls.bits):
        return min(value.lower() for value in enclosures), max(value.upper() for value in enclosures)


# Flights of a linear model that are proved never to return, by bounds on what the free motion can still do.
#
# x - c = steady + drift + free motion + waves, each part bounded from below for all later times; the flight has been
# followed without impact to the time at which the bounds are taken.


# The part of the size of all terms that must be left over: 2^20 roundings, far above what the few operations here do
MARGIN = 2.0**-32


def never_returns(osc: Oscillator, form: LinearForm, tau: Array, time: Array, z: Array, u: Array) -> Array:
    """Whether flights in the state x - c = z, x' = u, `time` after their launch at tau, are proved to stay above c.

    Returns
    -------
    array of bool; False means nothing but that this bound does not prove it.

    Examples
    --------
    >>> from singimpact.oscillator.linear import linear_form
    >>> osc, one = Oscillator("0", "1 + cos(t)", 0, 1), np.array([1.0])
    >>> never_returns(osc, linear_form(osc), one, 10 * one, 40 * one, 10 * one).tolist()
    [True]
    """
    damping, stiffness = as_float(form.damping), as_float(form.stiffness)
    h = as_float(at_rest(form, osc.clearance))
    position, speed, bound = np.zeros(z.shape), np.zeros(z.shape), 0.0
    with np.errstate(all="ignore"):
        for wave in form.harmonics:
            rate = as_float(wave.rate)
            angle = rate * (reduced(tau, turn(wave.rate)) + time) + as_float(wave.phase)
            reply = stiffness - rate * rate + 1j * damping * rate
            if not reply:
                return np.zeros(z.shape, bool)  # resonance: the forced motion grows without a bound
            answer = (as_float(wave.cosine) - 1j * as_float(wave.sine)) / reply
            turned = answer * np.exp(1j * angle)
            position, speed, bound = position + turned.real, speed + (1j * rate * turned).real, bound + abs(answer)
        low, size = _lowest(
            sign_of(form.stiffness), sign_of(form.damping), stiffness, damping, h, z - position, u - speed
        )
        return np.asarray(low - bound > MARGIN * (size + bound + np.abs(z)))


def _lowest(k_sign: int, d_sign: int, k: float, d: float, h: float, z: Array, u: Array) -> tuple[Array, Array]:
    """A lower bound, for all later times, of the solution of z'' + d z' + k z = h; and the size of its terms."""
    never = np.full(z.shape, -np.inf), np.abs(z)
    if k_sign > 0:
        free = np.hypot(z - h / k, u / np.sqrt(k))  # the energy does not grow
        return (h / k - free, np.abs(h / k) + free) if d_sign >= 0 else never
    if k_sign < 0:
        root = np.sqrt(d * d / 4 - k)
        a, b = -d / 2 + root, -d / 2 - root
        growing, fading = (u - b * (z - h / k)) / (a - b), (a * (z - h / k) - u) / (a - b)
        low = np.where(growing > 0, growing + np.minimum(fading, 0) + h / k, -np.inf)
        return low, np.abs(growing) + np.abs(fading) + np.abs(h / k)
    if d_sign == 0:
        deepest = z - np.where(u < 0, u * u / (2 * h) if h > 0 else np.inf, 0.0)
        return (deepest if h >= 0 else never[0]), np.abs(z) + np.abs(deepest)
    if d_sign > 0 and h >= 0:
        fading = (h / d - u) / d
        return z - fading + np.minimum(fading, 0), np.abs(z) + 2 * np.abs(fading)
    return never
