"""The paper's own steps for sections 2 and 3, in sympy: y_c from the equation of motion, v_c by the implicit function.

A second route to the sheet that shares no solver with `sheet`: here the initial value problem is expanded in t,
divided by t, and y_c = 0 is solved for v.  Symbols: sigma, t, v; a, a_d1, a_d2, ... (derivatives of a_c at tau_*);
f_10, f_01, ... (derivatives of f at (c, 0)); r.
"""

from collections.abc import Callable
from math import comb, factorial
from typing import Any

import sympy
from sympy.polys.rings import ring

from singimpact.algebra.derivations import At, motion, substitution
from singimpact.contact.contact import derivative_name
from singimpact.paper.routes.equations import equation

sigma, t, v, r = sympy.symbols("sigma t v r")
X, Y = sympy.symbols("X Y")  # the first and the second component of what a map is applied to, in certificates


def a_symbol(order: int) -> sympy.Expr:
    """The symbol of the order-th derivative of a_c at tau_*."""
    return sympy.Symbol(derivative_name(order))


def f_symbol(i: int, k: int) -> sympy.Expr:
    """The symbol of the derivative of f, i times by x and k times by x', at (c, 0)."""
    return sympy.Symbol(f"f_{i}{k}")


def _field_jets(order: int) -> tuple[list[Any], dict[tuple[int, int], Any]]:
    a = [a_symbol(k) / factorial(k) for k in range(order)]
    f = {
        (i, k): f_symbol(i, k) / (factorial(i) * factorial(k))
        for i in range(order)
        for k in range(order)
        if i + k and 2 * i + k + 1 <= order
    }
    return a, f


@equation("e:yeq")
def y_c(order: int = 3) -> Any:
    """y_c(tau_* + sigma, v; t) with x_c = c + t y_c, to total degree `order` in (sigma, v, t) [e:yeq].

    The coefficients x_n of x_c = c + v t + x_2 t^2 + ... come one after the other from x'' = g - f.

    Examples
    --------
    >>> y_c(1)
    a*t/2 + v
    """
    a, f = _field_jets(order)
    names = sorted({str(s) for s in [*a, *f.values()] for s in s.free_symbols})
    domain, *gens = ring(["sigma", "v", *names], sympy.QQ)
    S, V = gens[:2]

    forcing = [
        sum((comb(n + k, n) * domain.from_expr(a[n + k]) * S**k for k in range(order - n)), domain.zero)
        for n in range(order)
    ]
    x = [domain.zero, V]
    for n in range(order):
        pushed = forcing[n] - sum(
            (domain.from_expr(value) * _power_coefficient(x, i, k, n, domain) for (i, k), value in f.items()),
            domain.zero,
        )
        x.append(_short(pushed, domain, order - n - 1) / ((n + 1) * (n + 2)))
    quotient = sympy.expand(sum(poly.as_expr() * t ** (n - 1) for n, poly in enumerate(x) if n))
    motion((sigma, v, t), sympy.expand(t * quotient), a, f, order=order)
    return quotient


def _short(poly: Any, domain: Any, degree: int) -> Any:
    """The part of total degree <= `degree` in the first two variables."""
    return domain.from_dict({key: value for key, value in poly.items() if key[0] + key[1] <= degree})


def _power_coefficient(x: list[Any], i: int, k: int, n: int, domain: Any) -> Any:
    """The coefficient of t^n in X^i X'^k, where X = sum x_m t^m."""
    slope = [m * term for m, term in enumerate(x)][1:]
    total = [domain.one] + [domain.zero] * n
    for factor in [x] * i + [slope] * k:
        total = [
            sum((factor[m] * total[size - m] for m in range(min(size + 1, len(factor)))), domain.zero)
            for size in range(n + 1)
        ]
    return total[n]


@equation("e:imp")
def v_c(order: int = 3) -> Any:
    """v_c(tau_* + sigma, t), the solution of y_c(tau, v_c; t) = 0, to total degree `order` in (sigma, t) [e:imp].

    Examples
    --------
    >>> v_c(1)
    -a*t/2
    """
    rest = sympy.expand(v - y_c(order))  # dy_c/dv = 1 on Pi_0, so v = rest(v) gains one degree a turn
    solution: Any = sympy.Integer(0)
    for degree in range(1, order + 1):
        solution = composed(rest, solution, degree)
    motion((sigma, v, t), sympy.expand(t * y_c(order)), *_field_jets(order), order=order, launch=solution)
    return solution


def composed(expression: sympy.Expr, velocity: sympy.Expr, order: int) -> Any:
    """A polynomial in (sigma, t, v) with v replaced, cut after total degree `order` in (sigma, t)."""
    names = sorted((expression.free_symbols | velocity.free_symbols) - {sigma, t, v}, key=str)
    domain = ring([sigma, t, *names], sympy.QQ)[0]
    inner, value = domain.from_expr(velocity), domain.zero
    for part in sympy.Poly(expression, v).all_coeffs():
        value = _short(value * inner + domain.from_expr(part), domain, order)
    return value.as_expr()


def at_launch(expression: sympy.Expr, order: int) -> Any:
    """A polynomial in (sigma, t, v) on the sheet v = v_c, to total degree `order`."""
    return composed(expression, v_c(order), order)


@equation("e:acc")
def slope_at_rest() -> Any:
    """dv_c/dt at t = 0 for any tau, as a function of a = a_c(tau) [e:acc]."""
    found = sympy.diff(v_c(1), t).subs({t: 0, sigma: 0})
    substitution(At(v_c(2), {sigma: sympy.Integer(0)}), found * t, order=1, small=[t])
    return found


@equation("e:proj")
def p_c(order: int = 3) -> tuple[sympy.Expr, sympy.Expr]:
    """p_c: (sigma, t) -> (sigma, v_c) [e:proj]."""
    return sigma, v_c(order)


@equation("e:phi")
def phi_c(order: int = 3) -> tuple[sympy.Expr, sympy.Expr]:
    """phi_c: (sigma, t) -> (sigma + t, xdot_c at t) [e:phi].

    The impact velocity is found the long way, by differentiating x_c = c + t y_c and putting v = v_c.
    """
    landing = at_launch(sympy.diff(t * y_c(order), t), order)
    height = sympy.expand(t * y_c(order))
    motion((sigma, v, t), height, *_field_jets(order), order=order, launch=v_c(order), landing=landing)
    substitution(At(v_c(order), {sigma: sigma + t, t: -t}), landing)
    return sigma + t, landing


@equation("s3-Dp")
def Dp() -> Any:
    """The derivative of p_c at a point of Pi_0, as a matrix in (sigma, t)."""
    return _jacobian(p_c)


@equation("s3-Dphi")
def Dphi() -> Any:
    """The derivative of phi_c at a point of Pi_0, as a matrix in (sigma, t)."""
    return _jacobian(phi_c)


def _jacobian(images: Callable[[int], tuple[Any, Any]]) -> Any:
    """The matrix of the linear part at the origin; what a map to second order is to first order certifies it."""
    matrix = sympy.Matrix(images(1)).jacobian([sigma, t]).subs({sigma: 0, t: 0})
    for found, row in zip(images(2), matrix.tolist(), strict=True):
        substitution(At(found), At(X * row[0] + Y * row[1], {X: sigma, Y: t}), order=1, small=[sigma, t])
    return matrix


@equation("s3-DG")
def DG() -> Any:
    """DG(w_*) = DR Dphi Dp^{-1} at a regular point, from G o p = R o phi."""
    restitution = sympy.Matrix([[1, 0], [0, -r]])
    matrix = (restitution * Dphi() * Dp().inv()).applyfunc(sympy.cancel)
    before, after = (part * sympy.Matrix([sigma, t]) for part in (Dp(), Dphi()))
    for n, row in enumerate(matrix.tolist()):  # DG Dp = DR Dphi
        reset = At(restitution[n, n] * X, {X: after[n]})
        substitution(At(row[0] * X + row[1] * Y, {X: before[0], Y: before[1]}), reset)
    return matrix


@equation("s3-eigenvectors")
def eigenvectors() -> tuple[tuple[Any, Any], ...]:
    """(eigenvalue, eigenvector) of DG(w_*), the vectors cleared of denominators."""
    matrix = DG()
    found = []
    for value in (matrix[0, 0], matrix[1, 1]):  # triangular: the eigenvalues stand on the diagonal
        x, y = -(matrix - value * sympy.eye(2))[0, 1], (matrix - value * sympy.eye(2))[0, 0]
        vector = sympy.Matrix([1, 0]) if y == 0 else sympy.Matrix([x, y]) * a_symbol(0)
        found.append((value, vector.applyfunc(sympy.cancel)))
        is_eigenvector(matrix, *found[-1])
    return tuple(found)


def is_eigenvector(matrix: Any, value: Any, vector: Any) -> None:
    """Leave the certificates that matrix vector = value vector.

    Raises
    ------
    ArithmeticError : it is not so.
    """
    for row, part in zip(matrix.tolist(), vector, strict=True):
        substitution(At(row[0] * X + row[1] * Y, {X: vector[0], Y: vector[1]}), At(value * X, {X: part}))


def at_contact(expression: Any, j: int) -> Any:
    """An expression at a point where a and its first j - 1 derivatives vanish."""
    zeros = {a_symbol(k): sympy.Integer(0) for k in range(j)}
    found = expression.subs(zeros)
    if found != expression:
        substitution(At(expression, zeros), found)
    return found


@equation("e:degen")
def v_c_tangency(order: int = 2) -> Any:
    """v_c at a tangency point [e:degen]."""
    return at_contact(v_c(order), 1)


@equation("e:swan")
def v_c_swan(order: int = 3) -> Any:
    """v_c at a swan point [e:swan]."""
    return at_contact(v_c(order), 2)
