"""Events of a swan: P and Pi_0 as the preimage of one curve of flights, and the events of that curve over c.

R(t; s) is the flight at rest at the wall at s, Y(t, s) its variation with Y = 0, Y' = 1 at s, a the acceleration at the
wall.  psi takes a launch (tau, v) to its flight, told by (x, x') at one time.
"""

from collections.abc import Mapping
from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every, identity

tau, v, t, c, k = sympy.symbols("tau v t c k")
a, a_1, a_2, a_d1, Y, Y_d, R_c, R_dc = sympy.symbols("a a_1 a_2 a_d1 Y Yd R_c Rd_c")
C, S, A_1, A_2 = sympy.symbols("C S A_1 A_2")
p, q, r, s = sympy.symbols("p q r s")


def composed(outer: sympy.Expr, images: Mapping[Any, Any], right: sympy.Expr, where: Any = None) -> bool:
    """Whether an outer function of some images is the right side, with its certificate."""
    gap = sympy.together(sympy.sympify(outer).subs(images, simultaneous=True) - right)
    if where is not None:
        gap = sympy.rem(sympy.Poly(sympy.fraction(sympy.cancel(gap))[0], where[1]), sympy.Poly(*where)).as_expr()
    if sympy.cancel(gap) != 0:
        return False
    substitution(At(outer, images), right, where=where)
    return True


def _derivatives() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]:
    """x and x' of the flight from (tau, v), derived by tau and by v at the time tau, where order 3 drops out."""
    push = sympy.Function("A")(tau, v)  # g - f at the launch
    height = c + v * (t - tau) + push * (t - tau) ** 2 / 2
    parts = [sympy.diff(part, name) for part in (height, sympy.diff(height, t)) for name in (tau, v)]
    return tuple(sympy.cancel(part.subs(t, tau).subs(push, a)) for part in parts)


def _front(stated: tuple[Any, ...]) -> Check:
    """(dR, dR') by s at s; det D psi; kernel on v = 0; det derived once and twice along it on v = 0."""
    x_tau, x_v, y_tau, y_v = _derivatives()
    at_rest = x_tau.subs(v, 0), y_tau.subs(v, 0)  # the flight at rest at s, moved in s
    determinant = sympy.expand(x_tau * y_v - x_v * y_tau)
    kernel = sympy.Integer(1), sympy.cancel(-at_rest[1] / y_v)  # (x_v, y_v) = (0, 1): the second row decides
    push = sympy.Function("a")(tau)

    def along(function: sympy.Expr) -> Any:
        return sympy.diff(function, tau) + push * sympy.diff(function, v)

    once = along(determinant)
    twice = along(once).subs(sympy.diff(push, tau), a_d1).subs(push, a)
    derived = (*at_rest, determinant, *kernel, once.subs(push, a), twice)
    sound = composed(p * s - q * r, {p: x_tau, q: x_v, r: y_tau, s: y_v}, stated[2])
    flat = x_tau.subs(v, 0) * kernel[0] + x_v * kernel[1] == 0 and at_rest[1] * kernel[0] + y_v * kernel[1] == 0
    return every(
        [
            (f"at t = tau D psi has the rows {(x_tau, x_v)}, {(y_tau, y_v)}", sound),
            ("on v = 0 it takes (1, a) to 0", flat),
            identity(lambda: derived)(stated),
        ],
        witness=lambda: {"derived": str(derived)},
    )


def _critical(stated: sympy.Expr) -> Check:
    """The component of c of the tangent of {x = c, x' = 0 at s + d} in (s_1, s_2, c)."""
    rows = ((-a_1 * Y, sympy.Integer(0), R_c), (-a_1 * Y_d, a_2, R_dc))  # x'(s_2) = 0, x''(s_2) = a_2
    (m, n, _), (o, u, _) = rows
    determinant = sympy.expand(m * u - n * o)
    tangent = tuple(sympy.expand(component) for component in sympy.Matrix(rows[0]).cross(sympy.Matrix(rows[1])))
    tangent_vanishes = all(sympy.expand(sum(x * y for x, y in zip(row, tangent, strict=True))) == 0 for row in rows)
    exact = composed(p * s - q * r, {p: m, q: n, r: o, s: u}, stated)
    return every(
        [
            (f"the tangent is {tangent}, in (s_1, s_2, c), where its parts do not all vanish", tangent_vanishes),
            (f"its component of c is {determinant}", exact and tangent[2] == determinant),
        ],
        witness=lambda: {"derived": str(determinant), "stated": str(stated)},
    )


def _eliminated(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(F, c) of a linear model: E1 = A_1 + c(C - 1) and E2 = A_2 - c k S vanish together where F = 0, c as stated."""
    F, clearance = stated
    one, two = A_1 + c * (C - 1), A_2 - c * k * S
    size = (C - 1) ** 2 + (k * S) ** 2
    first = composed(k * S * p + (C - 1) * q, {p: one, q: two}, F)
    second = composed((C - 1) * p - k * S * q, {p: one, q: two}, size * (c - clearance))
    turned = sympy.expand(sympy.Matrix([[k * S, C - 1], [C - 1, -k * S]]).det() + size)
    return every(
        [
            ("k S E1 + (C - 1) E2 = F", first),
            ("(C - 1) E1 - k S E2 = ((C - 1)^2 + k^2 S^2)(c - this)", second),
            ("these combinations are independent where (C - 1)^2 + k^2 S^2 is not 0", turned == 0),
        ]
    )


FRONT = (sympy.Integer(0), -a, -v, sympy.Integer(1), a, -a, -a_d1)


def _with(index: int, other: sympy.Expr) -> tuple[Any, ...]:
    return (*FRONT[:index], other, *FRONT[index + 1 :])


CLAIMS = {
    "b:events-front": Encoding(
        FRONT, _front, (_with(1, a), _with(2, v), _with(4, -a), _with(5, a), _with(6, sympy.Integer(0)))
    ),
    "b:events-critical": Encoding(-a_1 * a_2 * Y, _critical, (-a_1 * Y, -a_1 * a_2 * Y_d, a_1 * a_2 * Y, -a_1 * a_2)),
    "b:events-eliminated": Encoding(
        (A_1 * k * S + A_2 * (C - 1), (A_2 * k * S - A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
        _eliminated,
        (
            (A_1 * k * S - A_2 * (C - 1), (A_2 * k * S - A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
            (A_1 * k * S + A_2 * (C - 1), (A_2 * k * S + A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
            (A_1 * S + A_2 * (C - 1), (A_2 * k * S - A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
        ),
    ),
}
