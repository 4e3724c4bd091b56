"""A change of time and height that removes the first correction to a homogeneous model, and to the unfolded swan.

S = s + h S_1(s) and Y = (1 + h M_1(s)) x keep the wall x = 0 and multiply both velocities of an impact by one factor,
so the restitution stays what it is.  Both sides are compared to first order in h.
"""

from typing import Any, NamedTuple

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.routes.equations import equation

s, x, y, h = sympy.symbols("s x y h")  # time, height, velocity, and the small length by which lengths are scaled
j, L = sympy.symbols("j L")  # L stands for s^j, so that an identity in L and j holds for every contact order
first, second, damping = sympy.symbols("a_j a_j1 f_v")  # a_j, a_(j+1), f_01
alpha, beta = sympy.symbols("alpha beta")
A2, A3 = sympy.symbols("A2 A3")  # a'' and a''' at the swan point


class Change(NamedTuple):
    """S = s + h time(s) and Y = (1 + h height(s)) x, to first order in h."""

    time: Any
    height: Any


def _rate(expression: sympy.Expr, acceleration: sympy.Expr) -> Any:
    """d/ds along the motion; L stands for s^j, so dL/ds = j L/s."""
    parts = {s: 1, L: j * L / s, x: y, y: acceleration}
    return sum((sympy.diff(expression, letter) * rate for letter, rate in parts.items()), sympy.Integer(0))


def transformed(change: Change, acceleration: sympy.Expr) -> Any:
    """d^2 Y/dS^2 along x'' = acceleration, as a rational function of h.

    Examples
    --------
    >>> transformed(Change(sympy.Integer(0), sympy.Integer(0)), L)
    L
    """
    tempo = 1 + h * sympy.diff(change.time, s)
    speed = _rate((1 + h * change.height) * x, acceleration) / tempo
    return sympy.cancel(_rate(speed, acceleration) / tempo)


def truncated(expression: sympy.Expr) -> Any:
    """The part of degree 0 and 1 in h of a rational function of h that is finite at h = 0."""
    rate = sympy.diff(expression, h).subs(h, 0)
    return sympy.expand(sympy.cancel(expression.subs(h, 0)) + h * sympy.cancel(rate))


@equation("b-first-motion")
def acceleration() -> Any:
    """a_j s^j + h (a_(j+1) s^(j+1) - f_v x'): the motion near a contact point in lengths scaled by h."""
    return first * L + h * (second * L * s - damping * y)


@equation("b-first-order")
def removal() -> Change:
    """alpha s^2 and beta s with which Y'' = a_j S^j + O(h^2), for every j.

    Examples
    --------
    >>> sympy.factor(removal().time)
    s**2*(a_j*f_v + 2*a_j1)/(2*a_j*(j + 3))
    """
    tried = Change(alpha * s**2, beta * s)
    goal = first * L * (1 + j * h * alpha * s)  # a_j S^j to first order
    return _solved(tried, acceleration(), goal)


@equation("b-first-swan-motion")
def swan_acceleration() -> Any:
    """(s^2 - 1)(1 + h a'''/(3 a'') s) - h f_v x': an unfolded swan in half distances h of A and B, to first order.

    a_c has the zeros -h and h, so it is (s^2 - h^2)(p + q s + ...), a'' = 2p and a''' = 6q at h = 0; heights are in
    units of p h^4.
    """
    return (s**2 - 1) * (1 + h * A3 / (3 * A2) * s) - h * damping * y


@equation("b-first-swan")
def swan_removal() -> Change:
    """alpha (s^2 - 1) and beta s with which Y'' = S^2 - 1 + O(h^2); A and B stay at -1 and 1.

    Examples
    --------
    >>> sympy.factor(swan_removal().time)
    (s - 1)*(s + 1)*(3*A2*f_v + 2*A3)/(30*A2)
    """
    tried = Change(alpha * (s**2 - 1), beta * s)
    goal = s**2 - 1 + 2 * h * s * alpha * (s**2 - 1)  # S^2 - 1 to first order
    return _solved(tried, swan_acceleration(), goal)


def _solved(tried: Change, motion: sympy.Expr, goal: sympy.Expr) -> Change:
    """The change with the alpha and beta that make the transformed motion the goal to first order in h.

    Raises
    ------
    ArithmeticError : there are none.
    """
    outer = transformed(tried, motion)
    rest = sympy.Poly(sympy.expand(sympy.cancel(truncated(outer - goal) * s / h)), s, L, x, y)
    solutions = list(sympy.linsolve(rest.coeffs(), [alpha, beta]))
    if len(solutions) != 1 or {alpha, beta} & set().union(*(value.free_symbols for value in solutions[0])):
        raise ArithmeticError("no alpha and beta remove the term of first order")
    images = {name: sympy.factor(value) for name, value in zip((alpha, beta), solutions[0], strict=True)}
    substitution(At(outer, images), At(goal, images), order=1, small=[h])
    return Change(*(sympy.factor(trial.subs(images)) for trial in tried))


def shift() -> Any:
    """-alpha (X^2 - 1), the change of first order in h of the foot X of an unfolded swan, with chi for its jets.

    Examples
    --------
    >>> sympy.factor(shift())
    -chi*(X - 1)*(X + 1)/10
    """
    foot, chi = sympy.symbols("X chi")
    third = sympy.Rational(3, 2) * A2 * (chi - damping)  # chi = f_v + 2 a'''/(3 a'')
    return sympy.factor(-swan_removal().time.subs(A3, third).subs(s, foot))
