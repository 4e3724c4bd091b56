"""The homogeneous models x'' = s^j: the leading part of the theory at contact order j, in closed form.

With launch time sigma and landing time e, the launch velocity is homogeneous of degree j + 1.  On the invariant curve
e = lambda sigma, and invariance under v -> -r v fixes r as a rational function of the multiplier lambda.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import sympy

lambda_ = sympy.Symbol("lambda")


def launch_velocity(j: int, sigma: Any, e: Any) -> Any:
    """Launch velocity of the flight of x'' = s^j from sigma to e: ((j+2) sigma^(j+1) - h_(j+1))/((j+1)(j+2)).

    h_n is the complete homogeneous polynomial sum sigma^i e^(n-i).  The impact velocity is the same with sigma and e
    exchanged (the involution).
    """
    complete = sum(sigma**i * e ** (j + 1 - i) for i in range(j + 2))
    return ((j + 2) * sigma ** (j + 1) - complete) / ((j + 1) * (j + 2))


@lru_cache(maxsize=32)
def P(j: int) -> Any:
    """P_j(lambda) = sum (j+1-i) lambda^i: the launch velocity at (1, lambda) without its factor 1 - lambda."""
    ratio = sympy.cancel((j + 1) * (j + 2) * launch_velocity(j, sympy.Integer(1), lambda_) / (1 - lambda_))
    return sympy.Poly(ratio, lambda_).as_expr()


@lru_cache(maxsize=32)
def Q(j: int) -> Any:
    """Q_j(lambda): the reversal of P_j, which the involution makes of it."""
    ratio = sympy.cancel((j + 1) * (j + 2) * launch_velocity(j, lambda_, sympy.Integer(1)) / (lambda_ - 1))
    return sympy.Poly(ratio, lambda_).as_expr()


@lru_cache(maxsize=32)
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
    return lambda_ ** (j + 1) * sympy.factor(P(j)) / sympy.factor(Q(j))


@lru_cache(maxsize=32)
def mu_of_lambda(j: int) -> Any:
    """The transverse multiplier of the blown-up map at its fixed point: (P_j/Q_j)^2/lambda.

    Examples
    --------
    >>> mu_of_lambda(1)
    (lambda + 2)**2/(lambda*(2*lambda + 1)**2)
    """
    return sympy.factor((P(j) / Q(j)) ** 2 / lambda_)


@lru_cache(maxsize=32)
def leading_coefficient(j: int) -> Any:
    """gamma: v = a_j (1-lambda) P_j/((j+1)(j+2)) sigma^(j+1) + ..., a_j = a^(j)/j!; the factor beside a_j."""
    return sympy.factor((1 - lambda_) * P(j) / ((j + 1) * (j + 2)))


@lru_cache(maxsize=8)
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
    return ratio.applyfunc(sympy.cancel)


@lru_cache(maxsize=8)
def eigenvalues_on_gamma(j: int) -> tuple[Any, Any]:
    """(larger, smaller) eigenvalue of DG(w) as w tends to the contact point along gamma, in lambda."""
    matrix = DG_on_ray(j)
    trace, determinant = sympy.cancel(matrix.trace()), sympy.cancel(matrix.det())
    root = sympy.sqrt(sympy.factor(trace**2 - 4 * determinant))
    return (sympy.factor(trace) + root) / 2, (sympy.factor(trace) - root) / 2
