"""Every linear impact oscillator as a ball under gravity that varies with time, exactly, and the series that follows.

X'' + 2 b X' + (b^2 + w) X = a_c(t) for X = x - c.  With C = cos(sqrt(w) t), S = sin(sqrt(w) t)/sqrt(w), E = e^(b t) the
change s = S/C, y = X E/C makes it y'' = A(s), A = E C^3 a_c; the wall is y = 0 and the restitution the same.  For w < 0
the functions are hyperbolic, for w = 0 they are 1 and t.
"""

from fractions import Fraction
from math import comb, factorial
from typing import Any

import sympy

from singimpact.algebra import At, Exact, Jet, JetSpace, substitution
from singimpact.contact.contact import Contact
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every, same
from singimpact.theory.impact_sheet import generic_sheet, sheet

X, V, E, C, S, a, b, w = sympy.symbols("X V E C S a b w")
RATIONALS = Exact()
ORDER = 12  # to which the two routes to v_c are compared
MODELS = {  # (b, w): damping 2 b, stiffness b^2 + w
    "underdamped": (Fraction(1, 5), Fraction(3, 2)),
    "overdamped": (Fraction(2, 3), Fraction(-1, 4)),
    "critical": (Fraction(1, 2), Fraction(0)),
}


def _rate(expression: sympy.Expr) -> Any:
    """d/dt of an expression in X, V = X', E, C, S along the motion."""
    rates = {X: V, V: a - 2 * b * V - (b**2 + w) * X, E: b * E, C: -w * S, S: C}
    return sum((sympy.diff(expression, letter) * rate for letter, rate in rates.items()), sympy.Integer(0))


def _ball(stated: tuple[int, int]) -> Check:
    """(p, q): A = E^q C^p a_c, as an identity of the motion and as the series of v_c for three linear models."""
    power, exponent = stated
    # d^2 y/ds^2 for y = X E/C, as d/ds = C^2 d/dt: ds/dt = (C^2 + w S^2)/C^2 and C^2 + w S^2 = 1
    first = sympy.cancel(C**2 * _rate(X * E / C))
    second = sympy.Poly(sympy.expand(sympy.cancel(C**2 * _rate(first))), S)
    derived = sympy.expand(sympy.rem(second, sympy.Poly(w * S**2 + C**2 - 1, S)).as_expr())
    gravity = E**exponent * C**power * a
    exact = same(derived, gravity)
    if exact:
        substitution(At(E * C**3 * X, {X: a}), derived)
    compared = {name: exact and _routes_agree(*numbers) for name, numbers in MODELS.items()}
    return every(
        {
            f"d^2 y/ds^2 = {derived}; stated: {gravity}": exact,
            f"v_c by this closed form and by the boundary value problem: equal rationals to order {ORDER} for "
            f"{', '.join(compared)} models": all(compared.values()),
        },
        witness=lambda: {"d^2 y/ds^2": str(derived), "stated": str(gravity)},
    )


def _routes_agree(damping: Fraction, square: Fraction) -> bool:
    """Whether v_c of a linear model is the closed form of the ball, for one jet of a_c of contact order 1."""
    jet = {k: Fraction((-1) ** k * (k + 2), k + 1) for k in range(1, ORDER)}
    linear: dict[tuple[int, ...], Any] = {(1, 0): damping**2 + square, (0, 1): 2 * damping}
    direct = sheet(Contact(1, RATIONALS, jet, linear), ORDER).v
    return all(value == 0 for value in (direct - _of_the_ball(jet, damping, square)).terms.values())


def _of_the_ball(jet: dict[int, Fraction], damping: Fraction, square: Fraction) -> Jet:
    """v_c = y'/(E C) with y' = sum A_k ((k+2) s^(k+1) - h_(k+1)(s, e))/((k+1)(k+2)), h_n the sum of s^i e^(n-i)."""
    line = JetSpace(("u",), ORDER, RATIONALS)
    series: dict[str, dict[tuple[int, ...], Fraction]] = {
        "C": {(2 * n,): (-square) ** n / factorial(2 * n) for n in range(ORDER // 2 + 1)},
        "S": {(2 * n + 1,): (-square) ** n / factorial(2 * n + 1) for n in range((ORDER + 1) // 2)},
        "E": {(n,): damping**n / factorial(n) for n in range(ORDER + 1)},
        "back": {(2 * n + 1,): (-square) ** n / (2 * n + 1) for n in range((ORDER + 1) // 2)},  # t as a function of s
        "a": {(k,): value for k, value in jet.items()},
    }
    cosine, sine, growth, back, pressed = (line.jet(terms) for terms in series.values())
    gravity = (growth * cosine**3 * pressed).compose([back])
    time, scale = sine / cosine, growth * cosine
    plane = JetSpace(("sigma", "t"), ORDER, RATIONALS)
    sigma, t = plane.generators()
    start, end = (time.compose([point]) for point in (sigma, sigma + t))
    powers = [[plane.constant(Fraction(1))], [plane.constant(Fraction(1))]]
    for row, point in zip(powers, (start, end), strict=True):
        for _ in range(ORDER):
            row.append(row[-1] * point)
    total = plane.constant(Fraction(0))
    for k in range(1, ORDER):
        complete = sum((powers[0][i] * powers[1][k + 1 - i] for i in range(k + 2)), plane.constant(Fraction(0)))
        weight = gravity.coefficient((k,)) / (2 * comb(k + 2, 2))
        total = total + (powers[0][k + 1].scaled(Fraction(k + 2)) - complete).scaled(weight)
    return total / scale.compose([sigma])


def _entry(stated: tuple[int, ...]) -> Check:
    """By how many degrees the lowest term of v_c with a second derivative of f exceeds the leading one, j = 0, 1, 2."""
    entries = []
    for j in range(3):
        bent = generic_sheet(j, 2 * j + 3)
        degrees = [
            sum(sympy.Poly(term, *sympy.symbols("sigma t")).monoms()[0])
            for term in sympy.expand(bent.to_sympy(bent.v)).as_ordered_terms()
            if {str(name) for name in term.free_symbols} & {"f_20", "f_11", "f_02"}
        ]
        entries.append(min(degrees) - (j + 1))
    return every(
        {f"second derivatives of f enter v_c {entries} degrees above its leading part": tuple(entries) == stated}
    )


CLAIMS = {
    "b:gauge": Encoding((3, 1), _ball, ((2, 1), (3, 0), (3, -1))),
    "b:gauge-nonlinear": Encoding((2, 3, 4), _entry, ((1, 2, 3), (2, 2, 2))),
}
