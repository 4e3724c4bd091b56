"""Impacts that lose C v^q of a low speed, 0 < q < 1, as in Hertz's law: gamma is flatter than sigma^(j+1).

h is the time to the contact point, a_c = -b h^j there, and a flight from h lands at h (1 - e).  Velocities are in units
of b h^(j+1): v = P e/((j+1)(j+2)) and U = Q e/((j+1)(j+2)), with P and Q of `every_order` at l = 1 - e.

The balances of powers here are exact to the orders named, and formal: rho'(0) = -1, so (0, lambda) has the multiplier 1
and no theorem on stable manifolds applies; that gamma exists, and a bound of the remainder, are not shown.
"""

from typing import Any

import sympy

from singimpact.algebra import At, positive_in, substitution
from singimpact.paper.claims.beyond.every_order import CLOSED_P, CLOSED_Q, L, closed_forms, ell, j
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every, same, sample

q, e, rate, exponent = sympy.symbols("q e x N")

EXPONENT = (j + 1) / (1 - q)
FACTOR = 3 * (1 - q) / (2 * (3 + (2 + q) * j))
REPELLED = 1 + (2 + q) * j / 3
SECOND = q * (3 + (2 + q) * j) * (3 + (1 + 2 * q) * j) / (3 * (1 - q) * (3 + 2 * j + 2 * j * q - j * q**2))


def _binomial(base: sympy.Expr, power: sympy.Expr, order: int) -> Any:
    return sum((sympy.ff(power, k) / sympy.factorial(k) * base**k for k in range(order + 1)), sympy.Integer(0))


def _vanishes(expression: sympy.Expr, images: dict[Any, Any], small: sympy.Expr, order: int) -> bool:
    """Whether a polynomial in the images is zero up to an order in a small letter; it leaves a certificate then."""
    full = sympy.Poly(expression.subs(images, simultaneous=True), small)
    holds = all(sympy.cancel(value) == 0 for (power,), value in full.terms() if power <= order)
    if holds:
        substitution(At(expression, images), sympy.Integer(0), order=order, small=[small])
    return holds


LAUNCH = sympy.Rational(1, 2) - j * e / 6 + j * (j - 1) * e**2 / 24  # v/e
LANDING = sympy.Rational(1, 2) - j * e / 3 + j * (j - 1) * e**2 / 8  # U/e


def _expanded() -> list[tuple[str, bool]]:
    landed, units = {ell: 1 - e, L: _binomial(-e, j, 4)}, (j + 1) * (j + 2) * e**2
    pairs = (CLOSED_P, LAUNCH), (CLOSED_Q, LANDING)
    holds = all(_vanishes(closed - units * form, landed, e, 4) for closed, form in pairs)
    return [*closed_forms(), ("v/e = 1/2 - j e/6 + ..., U/e = 1/2 - j e/3 + ... at l = 1 - e, for every j", holds)]


def _adiabatic(power: int) -> Check:
    """v^power/|a_c| is the same before and after an elastic flight, but for the third order of e."""
    a_c = sympy.Symbol("a_c")  # of the landing, over that of the launch
    kept = _vanishes(LANDING**power - a_c * LAUNCH**power, {a_c: _binomial(-e, j, 2)}, e, 2)
    return every(
        [*_expanded(), (f"U^{power} = v^{power} (1 - e)^j (1 + O(e^3)): v^{power}/|a_c| is kept", kept)],
        witness=lambda: {"U^p/(l^j v^p) - 1": f"{sympy.factor((1 - sympy.Rational(power, 3)) * j)} e"},
    )


def _balanced(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(N, K): v = (K C b h^(j+1))^(1/(1-q)) = w h^N is kept by an impact to first order in the flight time."""
    stated_n, factor = stated
    balance = _vanishes(LANDING * (1 - rate * e) - LAUNCH * (1 - exponent * e), {rate: exponent - j / 3}, e, 1)
    exponent_ = 1 / (2 * (stated_n - j / 3))
    power = j * (q + 2) / 3 + 1  # I^(1-q) is the integral of (1-q) C/2 |a|^((q+2)/3), |a| = b h^j
    averaged = (1 - q) / 2 / power
    return every(
        [
            *_expanded(),
            ("U (1 - x e) = v (1 - e)^N for x = N - j/3 alone, and x e is the loss C v^q", balance),
            ("C v^q = 2x v/(b h^(j+1)) is solved by v = w h^N for N (1 - q) = j + 1", same(stated_n * (1 - q), j + 1)),
            (f"v^(1-q) = K C b h^(j+1) with K = 1/(2N - 2j/3) = {sympy.factor(exponent_)}", same(factor, exponent_)),
            (
                "the invariant I = v/|a_c|^(1/3) falls by (C/2) I^q |a_c|^((q+2)/3) a time: this integral gives K too",
                same(power + j * (1 - q) / 3, j + 1) and same(factor, averaged),
            ),
        ],
        "formal",
        witness=lambda: sample(factor, exponent_) if same(stated_n * (1 - q), j + 1) else sample(stated_n, EXPONENT),
    )


def _repelled(stated: sympy.Expr) -> Check:
    """The relative distance of v/h^N from its value on gamma grows like h^(-p)."""
    rate_ = sympy.factor((1 - q) * (EXPONENT - j / 3))
    return every(
        {
            "on gamma the loss is x e, and over e it falls like (v/h^N)^(q-1), as q < 1": _balanced(
                (EXPONENT, FACTOR)
            ).holds,
            f"an impact multiplies distances by 1 + p e, h by 1 - e: p = (1 - q) x = {rate_}": same(stated, rate_),
            "p > 1 for every j > 0 and q in (0, 1)": positive_in(stated - 1, {j: (0, sympy.oo), q: (0, 1)}),
        },
        "formal",
        witness=lambda: sample(stated, rate_),
    )


def _second(stated: sympy.Expr) -> Check:
    """v/(b h^(j+1)) = P + G P^2 + O(P^3), P in proportion to h^s with s = N - (j+1)."""
    v, speed, first, s, second = sympy.symbols("v U P s G")
    length = 2 * v + 4 * j * v**2 / 3 + 2 * j * (5 * j + 3) * v**3 / 9
    landed = v - 2 * j * v**2 / 3 - 2 * j * (j + 3) * v**3 / 9
    flown = [
        _vanishes(e * LAUNCH - v, {e: length}, v, 3),
        _vanishes(e * LANDING - speed, {e: length, speed: landed}, v, 3),
    ]
    curve = first + second * first**2
    images = {e: _cut(length.subs(v, curve), first), speed: _cut(landed.subs(v, curve), first)}
    moved = first * _binomial(-e, s, 2)  # P at the landing
    # C U^q = 2x P (U/P)^q, where U/P = 1 + (G - 2j/3) P
    lost = 2 * rate * first * (1 + q * (second - 2 * j / 3) * first)
    invariance = (moved + second * moved**2) * _binomial(-e, j + 1, 2) - speed * (1 - lost)
    full = sympy.Poly(sympy.expand(invariance.subs(images, simultaneous=True)), first)
    orders = [full.coeff_monomial(first**n) for n in (1, 2, 3)]
    substitution(At(invariance, images), orders[1] * first**2 + orders[2] * first**3, order=3, small=[first])
    values = {s: EXPONENT - (j + 1), rate: EXPONENT - j / 3}
    linear = sympy.Poly(orders[2], second)
    coefficient = sympy.cancel((-linear.coeff_monomial(1) / linear.coeff_monomial(second)).subs(values))
    return every(
        [
            *_expanded(),
            (f"v = e/2 - ... is solved by e = {length}, and then U = {landed}", all(flown)),
            (
                "U (1 - C U^q) is v at the landing to the orders P and P^2 on gamma of the first term",
                orders[0] == 0 and sympy.cancel(orders[1].subs(values)) == 0,
            ),
            (
                f"and to the order P^3 for G = {sympy.factor(coefficient)}",
                linear.degree() == 1 and same(stated, coefficient),
            ),
        ],
        "formal",
        witness=lambda: sample(stated, coefficient),
    )


def _cut(expression: sympy.Expr, small: sympy.Expr) -> Any:
    full = sympy.Poly(expression, small)
    return sum((sympy.factor(value) * small**n for (n,), value in full.terms() if n <= 3), sympy.Integer(0))


def _left(stated: sympy.Expr) -> Check:
    """The time left of a chatter under a_c < 0: j = 0, where h is the time to the end."""
    ratio = sympy.cancel(1 / FACTOR.subs(j, 0))
    return every(
        {
            f"at j = 0 gamma is the line of one end, and h = v^(1-q)/(K C b) with 1/K = {ratio}": same(stated, ratio),
            "it is positive and finite for 0 < q < 1: chatter ends although r = 1": positive_in(stated, {q: (0, 1)}),
        },
        "formal",
        witness=lambda: sample(stated, ratio),
    )


CLAIMS = {
    "b:hertz-adiabatic": Encoding(3, _adiabatic, (2, 4, 1)),
    "b:hertz": Encoding(
        (EXPONENT, FACTOR),
        _balanced,
        (
            (j + 1, FACTOR),
            ((j + 1) / (1 + q), FACTOR),
            (EXPONENT, FACTOR * 2),
            (EXPONENT, 3 * (1 - q) / (2 * (3 + 2 * j))),
            (EXPONENT, 3 / (2 * (3 + (2 + q) * j))),
            (EXPONENT, 3 * (1 - q) / (2 * (5 + q))),
        ),
    ),
    "b:hertz-sides": Encoding(REPELLED, _repelled, (REPELLED - 1, 1 + (2 - q) * j / 3, sympy.Integer(1), -REPELLED)),
    "b:hertz-next": Encoding(SECOND, _second, (sympy.Integer(0), -SECOND, SECOND / q, 2 * SECOND, SECOND.subs(j, 1))),
    "b:hertz-chatter": Encoding(2 / (1 - q), _left, (sympy.Integer(2), 2 / q, 1 / (1 - q))),
}
