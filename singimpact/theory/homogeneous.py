"""The homogeneous models x'' = s^j: the leading part of the theory at contact order j, in closed form.

With launch time sigma and landing time e, the launch velocity is homogeneous of degree j + 1.  On the invariant curve
e = lambda sigma, and invariance under v -> -r v fixes r as a rational function of the multiplier lambda.
"""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.algebra.derivations import At, motion, substitution
from singimpact.algebra.gathering import remembered

lambda_ = sympy.Symbol("lambda")
_s, _e, _v, _t, _X, _Y = sympy.symbols("s e v t X Y")  # in certificates; _e is the landing time


def launch_velocity(j: int, sigma: Any, e: Any) -> Any:
    """Launch velocity of the flight of x'' = s^j from sigma to e: ((j+2) sigma^(j+1) - h_(j+1))/((j+1)(j+2)).

    h_n is the complete homogeneous polynomial sum sigma^i e^(n-i).  The impact velocity is the same with sigma and e
    exchanged (the involution).
    """
    complete = sum(sigma**i * e ** (j + 1 - i) for i in range(j + 2))
    return ((j + 2) * sigma ** (j + 1) - complete) / ((j + 1) * (j + 2))


@remembered
def P(j: int) -> Any:
    """P_j(lambda) = sum (j+1-i) lambda^i: the launch velocity at (1, lambda) without its factor 1 - lambda."""
    ratio = sympy.cancel((j + 1) * (j + 2) * launch_velocity(j, sympy.Integer(1), lambda_) / (1 - lambda_))
    found = sympy.Poly(ratio, lambda_).as_expr()
    at_one = At((j + 1) * (j + 2) * _launched(j), {_s: sympy.Integer(1), _e: lambda_})
    substitution(At((1 - lambda_) * _X, {_X: found}), at_one)
    return found


@remembered
def _launched(j: int) -> Any:
    """The launch velocity as a polynomial in s and e, with the motion that it belongs to."""
    found = sympy.expand(launch_velocity(j, _s, _e))
    poly = sympy.Poly((_s + _t) ** j, _t)
    height = _v * _t + sum(value * _t ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in poly.terms())
    back = sympy.expand(found.subs(_e, _s + _t))
    motion((_s, _v, _t), sympy.expand(height), [sympy.Integer(int(n == j)) for n in range(j + 1)], {}, launch=back)
    substitution(At(found, {_e: _s + _t}), back)
    return found


@remembered
def Q(j: int) -> Any:
    """Q_j(lambda): the reversal of P_j, which the involution makes of it."""
    ratio = sympy.cancel((j + 1) * (j + 2) * launch_velocity(j, lambda_, sympy.Integer(1)) / (lambda_ - 1))
    found = sympy.Poly(ratio, lambda_).as_expr()
    at_one = At((j + 1) * (j + 2) * _launched(j), {_s: lambda_, _e: sympy.Integer(1)})
    substitution(At((lambda_ - 1) * _X, {_X: found}), at_one)
    return found


@remembered
def r_of_lambda(j: int) -> Any:
    """The restitution whose invariant curve has multiplier lambda: r = lambda^(j+1) P_j/Q_j.

    Parameters
    ----------
    j : contact order, 1 at a tangency, 2 at a swan.

    Examples
    --------
    >>> r_of_lambda(1)
    lambda**2*(lambda + 2)/(2*lambda + 1)
    """
    ratio = lambda_ ** (j + 1) * sympy.factor(P(j)) / sympy.factor(Q(j))
    again = At(lambda_ ** (j + 1) * _launched(j), {_s: sympy.Integer(1), _e: lambda_})
    landed = _launched(j).subs({_s: _e, _e: _s}, simultaneous=True)  # the involution
    substitution(At(-_X * landed, {_X: ratio, _s: sympy.Integer(1), _e: lambda_}), again)
    return ratio


@remembered
def mu_of_lambda(j: int) -> Any:
    """The transverse multiplier of the blown-up map at its fixed point: (P_j/Q_j)^2/lambda.

    Examples
    --------
    >>> mu_of_lambda(1)
    (lambda + 2)**2/(lambda*(2*lambda + 1)**2)
    """
    ratio = sympy.factor((P(j) / Q(j)) ** 2 / lambda_)
    y = sympy.Symbol("y")  # a flight from 1 to lambda + y is followed by one to (lambda + y)(lambda + mu y)
    landing = lambda_ + y
    landed = _launched(j).subs({_s: _e, _e: _s}, simultaneous=True)
    again = At(_launched(j), {_s: landing, _e: landing * (lambda_ + ratio * y)})
    reset = At(-_X * landed, {_X: r_of_lambda(j), _s: sympy.Integer(1), _e: landing})
    substitution(again, reset, order=1, small=[y])
    return ratio


@remembered
def leading_coefficient(j: int) -> Any:
    """gamma: v = a_j (1-lambda) P_j/((j+1)(j+2)) sigma^(j+1) + ..., a_j = a^(j)/j!; the factor beside a_j."""
    found = sympy.factor((1 - lambda_) * P(j) / ((j + 1) * (j + 2)))
    substitution(At(_launched(j), {_s: sympy.Integer(1), _e: lambda_}), At(_X, {_X: found}))
    return found


@remembered
def DG_on_ray(j: int) -> Any:
    """DG of the homogeneous model at sigma = 1 on its invariant ray, in (tau, v), as a function of lambda.

    G takes (s, nu(s, e)) to (e, -r nu(e, s)).  At the point sigma of the ray the entries scale with powers of sigma
    that leave trace and determinant alone, so the eigenvalues are the same all along gamma to leading order.

    Examples
    --------
    >>> sympy.factor(DG_on_ray(1).det())
    lambda**2*(lambda + 2)**2/(2*lambda + 1)**2
    """
    s, e = sympy.symbols("s e")
    launch, impact = launch_velocity(j, s, e), -r_of_lambda(j) * launch_velocity(j, e, s)
    before = sympy.Matrix([s, launch]).jacobian([s, e])
    after = sympy.Matrix([e, impact]).jacobian([s, e])
    ratio = (after * before.inv()).subs({s: 1, e: lambda_})
    matrix = ratio.applyfunc(sympy.cancel)
    x, y = sympy.symbols("x y")  # G takes (s, nu(s, e)) to (e, -r nu(e, s)): so it does to first order at (1, lambda)
    moved = {_s: 1 + x, _e: lambda_ + y}
    before = [_s - 1, _launched(j) - leading_coefficient(j)]
    landed = _launched(j).subs({_s: _e, _e: _s}, simultaneous=True)
    after = [_e - lambda_, -r_of_lambda(j) * (landed - landed.subs({_s: 1, _e: lambda_}))]
    for row, entry in zip(matrix.tolist(), after, strict=True):
        linear = At(row[0] * before[0] + row[1] * before[1], moved)
        substitution(linear, At(entry, moved), order=1, small=[x, y])
    return matrix


@remembered
def eigenvalues_on_gamma(j: int) -> tuple[Any, Any]:
    """(larger, smaller) eigenvalue of DG(w) as w tends to the contact point along gamma, in lambda."""
    matrix = DG_on_ray(j)
    trace, determinant = sympy.cancel(matrix.trace()), sympy.cancel(matrix.det())
    root = sympy.sqrt(sympy.factor(trace**2 - 4 * determinant))
    return (sympy.factor(trace) + root) / 2, (sympy.factor(trace) - root) / 2
