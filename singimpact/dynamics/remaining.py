"""The chatter left at a state with a short rest, summed up: the terms of tau_inf - tau in powers of v, in doubles.

The terms are frozen from the theory (`generated.completion`); the jets that a model fixes are computed once.

Where rho has powers of the speed that are not whole, as in Hertz's law w (1 - C w^q), w = -v, the terms are others.
With r = 1 and 0 < q < 1 the speeds fall like n^(-1/q) and their sum converges: chatter completes. The times of flight
under a constant acceleration are summed exactly, power by power; the first change of the acceleration and the damping
are added from the adiabatic invariant v^3/|a_c| of the elastic ball.
"""

from fractions import Fraction
from functools import lru_cache
from math import factorial
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import MINUS_ONE, Expression, evaluate, multiply, number, power, substitute
from singimpact.algebra.numbers import Array, as_float, compare
from singimpact.algebra.rings import DOUBLES
from singimpact.contact.contact import Contact
from singimpact.flights.flat_numbers import gap_of
from singimpact.generated.completion import chatter_terms
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration, at_wall

# Terms of the time left, where rho is smooth at rest
ORDER = 4
# Of the sum of speeds, where rho is not; each is smaller by about C w^q
TERMS = 8


def remaining(osc: Oscillator, tau: Array, v: Array, a: Array | None = None) -> tuple[Array, Array]:
    """The time left of a chatter from states with a_c < 0, and the size of the last term of its series.

    Parameters
    ----------
    osc : the model, with `chatter_completes`. tau, v : states. a : a_c there, when it is known.

    Examples
    --------
    >>> osc = Oscillator("0", "-2", 0, "1/2")
    >>> [part.tolist() for part in remaining(osc, np.array([0.0]), np.array([1.0]))]
    [[2.0], [0.0]]
    """
    forces, rebounds, slopes = _jets(osc)
    if osc.parametric:
        trees = force_trees(osc.force(), osc.clearance)
        forces = {name: evaluate(tree, {"t": tau}, DOUBLES) + 0.0 * tau for name, tree in trees.items()}
    push = acceleration(osc, tau) if a is None else a
    with np.errstate(all="ignore"):
        jets = {f"a_d{n}": evaluate(tree, {"t": tau}, DOUBLES) + 0.0 * tau for n, tree in enumerate(slopes, 1)}
        if not osc.smooth_at_rest:
            return left_of_chatter(osc, v, push, jets, forces)  # type: ignore[no-any-return]
        formula = {name: forces[name] for name in NAMES.values()}
        terms = chatter_terms(v=v, lambda_=as_float(osc.slope_at_rest()), a=push, **jets, **formula, **rebounds)
        first, *_, before, last = terms
        # a coefficient may happen to be small: the term before lets expect this one
        likely = np.abs(before) * np.abs(before / first) ** (1 / (ORDER - 2))
        if osc.parametric:  # f_01 moves by f_011 t: the terms from the third on lack that
            return terms[0] + terms[1], np.abs(terms[2]) + np.abs(forces["f_011"] * first) * first**2
    return sum(reversed(terms)), np.maximum(np.abs(last), likely)


# Derivatives of f by x and x' in the terms
NAMES = {(0, 1): "f_01", (0, 2): "f_02", (0, 3): "f_03", (1, 0): "f_10", (1, 1): "f_11"}


@lru_cache(maxsize=256)
def force_trees(force: Expression, clearance: Expression) -> dict[str, Expression]:
    """Derivatives of f at (c, 0, t) as trees in t and letters, and f_011, that of f_01 by t."""
    trees, at_rest = dict[str, Expression](), {"x": clearance, "xdot": number(0)}
    for (i, k), name in NAMES.items():
        tree = force
        for letter in ["x"] * i + ["xdot"] * k:
            tree = derivative(tree, letter)
        trees[name] = substitute(tree, at_rest)
    return trees | {"f_011": derivative(trees["f_01"], "t")}


@lru_cache(maxsize=256)
def _jets(osc: Oscillator) -> tuple[dict[str, float], dict[str, float], tuple[Expression, ...]]:
    """Derivatives of f at (c, 0), coefficients of rho, and the first derivatives of g as trees."""
    at = {} if osc.parametric else Contact.of(osc, 0.0, 0, ORDER, DOUBLES).f
    forces = {name: float(at.get(key, 0.0)) * factorial(key[0]) * factorial(key[1]) for key, name in NAMES.items()}
    rebounds = law_coefficients(osc)
    trees = []
    forcing = at_wall(osc).moving
    for _ in range(ORDER - 1):
        forcing = derivative(forcing, "t")
        trees.append(forcing)
    return forces, rebounds, tuple(trees)


def law_coefficients(osc: Oscillator) -> dict[str, float]:
    """rho_2, rho_3, ... of a law that is smooth at rest; zeros of one that is not, which has other terms."""
    coefficients = {f"rho_{n}": 0.0 for n in range(2, ORDER + 1)}
    if not osc.smooth_at_rest:
        return coefficients
    law = osc.rho_at_rest()
    if law is not None and (law.bound is None or law.bound > ORDER):
        terms = {int(exponent): as_float(value) for exponent, value in law.terms}
        return {f"rho_{n}": (-1) ** n * terms.get(n, 0.0) for n in range(2, ORDER + 1)}
    slope = osc.rho()
    for n in range(1, ORDER + 1):
        slope = derivative(slope, "v")
        if n > 1:
            coefficients[f"rho_{n}"] = as_float(substitute(slope, {"v": number(0)})) / factorial(n)
    return coefficients


# ---- rho with powers of the speed that are not whole


class Loss(NamedTuple):
    """rho(-w) = r w (1 - C w^q + ...) at rest.

    Parameters
    ----------
    r : the slope. C, q : of the first further term; C = 0 where there is none.
    """

    r: Expression
    C: Expression
    q: Fraction


@lru_cache(maxsize=256)
def loss_at_rest(osc: Oscillator) -> Loss:
    """The first two terms of rho at rest.

    Examples
    --------
    >>> loss = loss_at_rest(Oscillator("x", "cos(t)", 0, "-v - 0.3*(-v)**1.2"))
    >>> print(loss.r, loss.C, loss.q)
    1 0.3 1/5
    """
    law, r = osc.rho_at_rest(), osc.slope_at_rest()
    if law is None or len(law.terms) < 2:
        return Loss(r, number(0), Fraction(1))
    exponent, value = law.terms[1]
    return Loss(r, multiply(MINUS_ONE, value, power(r, MINUS_ONE)), exponent - 1)


@lru_cache(maxsize=256)
def chatter_completes(osc: Oscillator) -> bool:
    """Whether infinitely many impacts of a mass that is pressed to the wall take a finite time.

    They do for r < 1, and for r = 1 where the loss at low speed is C w^q with C > 0 and q < 1.

    Examples
    --------
    >>> [chatter_completes(Oscillator("x", "cos(t)", 0, rho)) for rho in ("0.5", 1, "-v - v**2/5", "-v - (-v)**1.2/5")]
    [True, False, False, True]
    """
    loss = loss_at_rest(osc)
    return compare(loss.r, 1) < 0 or (loss.q < 1 and compare(loss.C, 0) > 0)


def power_of_gamma(osc: Oscillator, order: int) -> float:
    """n where the velocity on gamma is proportional to the n-th power of the time to its end, of contact order j.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(t)", 0, "-v - 0.3*(-v)**1.2")
    >>> power_of_gamma(osc, 1), power_of_gamma(osc.replace(restitution="0.5"), 1)
    (2.5, 2.0)
    """
    loss = loss_at_rest(osc)
    return float((order + 1) / (1 - loss.q)) if compare(loss.r, 1) == 0 and loss.q < 1 else float(order + 1)


@lru_cache(maxsize=256)
def sum_of_speeds(osc: Oscillator) -> tuple[tuple[float, float], ...]:
    """Pairs (p, s) with v + rho(-v) + rho(-rho(-v)) + ... = sum of s v^p, p increasing.

    S(v) - S(rho(-v)) = v: a term s v^p on the left is s (1 - r^p) v^p, and where r = 1 it is s p C v^(p + q).

    Examples
    --------
    >>> [(p, round(s, 9)) for p, s in sum_of_speeds(Oscillator("x", "cos(t)", 0, "-v/2 + 0.1*(-v)**1.5"))][:2]
    [(1.0, 2.0), (1.5, 0.309383632)]
    """
    rho, loss = osc.rho_at_rest(), loss_at_rest(osc)
    assert rho is not None
    elastic, C, r = compare(loss.r, 1) == 0, as_float(loss.C), as_float(loss.r)
    bends = {e - 1: as_float(c) / r for e, c in rho.terms[1:]}
    left, terms = {Fraction(1): 1.0}, list[tuple[float, float]]()
    while left and len(terms) < TERMS:
        e = min(left)
        if rho.bound is not None and e >= rho.bound:
            break
        p = e - loss.q if elastic else e
        s = left.pop(e) / (float(p) * C if elastic else 1 - r ** float(p))
        terms.append((float(p), s))
        for further, c in _bent(bends, float(p)).items():
            if p + further != e:
                left[p + further] = left.get(p + further, 0.0) + s * r ** float(p) * c
    return tuple(terms)


def _bent(bends: dict[Fraction, float], p: float) -> dict[Fraction, float]:
    """(1 + u)^p - 1 for u = sum of bends, to the power TERMS of u."""
    total, power_of_u, factor = dict[Fraction, float](), {Fraction(0): 1.0}, 1.0
    for k in range(1, TERMS + 1):
        raised: dict[Fraction, float] = {}
        for e, c in power_of_u.items():
            for f, d in bends.items():
                raised[e + f] = raised.get(e + f, 0.0) + c * d
        power_of_u = {e: raised[e] for e in sorted(raised)[: 2 * TERMS]}
        factor *= (p - k + 1) / k
        for e, c in power_of_u.items():
            total[e] = total.get(e, 0.0) + factor * c
    return total


def rest_after(osc: Oscillator, v: Array, a: Array) -> Array:
    """The time left of chatters where a_c = a presses, for a constant acceleration; inf where chatter never ends.

    Examples
    --------
    >>> rest_after(Oscillator("0", "-2", 0, "1/2"), np.array([1.0]), np.array([-2.0])).tolist()
    [2.0]
    """
    with np.errstate(all="ignore"):
        if osc.smooth_at_rest or not chatter_completes(osc):
            return np.asarray(-2 * v / (a * (1 - as_float(osc.slope_at_rest()))))
        # terms of both signs: their sum is too small where v is beyond the reach of the series
        return np.asarray(-2 / a * sum(abs(s) * v**p for p, s in sum_of_speeds(osc)))


def stays_below(osc: Oscillator, v: Array | float, a: Array | float) -> Array:
    """Whether flights of chatter where a_c = a presses do not come to another wall, even if |a| falls to a half.

    Examples
    --------
    >>> stays_below(Oscillator("0", "-2", 0, "1/2", upper=1), np.array([1.0, 2.0]), np.array([-2.0, -2.0])).tolist()
    [True, False]
    """
    with np.errstate(invalid="ignore"):  # without one the distance is inf, and a may be 0
        return np.asarray(v * v < -a * gap_of(osc)[0])


def left_of_chatter(osc: Oscillator, v: Array, a: Array, jets: dict[str, Any], forces: dict[str, float]) -> Any:
    """The time left of chatters with a_c < 0, and an estimate of what the formula leaves out.

    Parameters
    ----------
    osc : a model whose rho is not smooth at rest, with `chatter_completes`. v : velocities. a : a_c there.
    jets : "a_d1", "a_d2", derivatives of a_c. forces : "f_01", "f_10", derivatives of f at (c, 0).

    Notes
    -----
    Left out are the change of the sum of flight times beyond the first order in the time left, the product of both
    corrections, and the powers of v after the last.
    """
    loss, terms = loss_at_rest(osc), sum_of_speeds(osc)
    # for r < 1 the correction is that of the smooth law, which is the limit q -> 0 of the other
    q = float(loss.q) if compare(loss.r, 1) == 0 else 0.0
    with np.errstate(all="ignore"):
        parts = [-2 / a * s * v**p for p, s in terms]
        pure, steep = sum(reversed(parts)), jets["a_d1"] / a
        first = -((q + 2) / 6 * steep + (1 - q) / 6 * forces["f_01"]) * pure**2
        rate = np.abs(steep) + np.sqrt(np.abs(jets["a_d2"] / a)) + abs(forces["f_01"]) + np.sqrt(abs(forces["f_10"]))
        rate = rate + np.sqrt(np.abs(forces.get("f_011", 0.0)))
        cross = rate * pure**2 * abs(as_float(loss.C)) * v ** float(loss.q)
        last = np.abs(parts[-1]) if len(parts) > 1 else 0 * pure
        return pure + first, last + cross + rate**2 * np.abs(pure) ** 3
