"""The unfolded swan in its universal form x'' = 12 kappa (s^2 - 1), c = 0: the curves of section 6 are algebraic.

Time is measured from the swan in half the distance of the two zeros A, B of a; kappa > 0 is a positive swan, < 0 a
negative one.  A flight from sigma lands after t; nothing is cut, the model has no higher terms.
"""

from math import factorial
from typing import Any, NamedTuple

import sympy

from singimpact.algebra.derivations import At, motion, substitution
from singimpact.inputs import need
from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.implicit import a_symbol, sigma as offset, t as delay, v_c

sigma, t, s, kappa, r = sympy.symbols("sigma t s kappa r")
u = sympy.Symbol("u")  # time since the launch
x, y, w, _velocity = sympy.symbols("x y w v")  # in certificates: distances from a point, a root, a launch velocity


@equation("s6-model")
def acceleration() -> Any:
    """a(sigma) = 12 kappa (sigma^2 - 1)."""
    return 12 * kappa * (sigma**2 - 1)


@equation("s6-model-slope")
def slope_of_acceleration(time: Any) -> Any:
    """a' at a time."""
    found = sympy.diff(acceleration(), sigma).subs(sigma, time)
    start = acceleration().subs(sigma, time)
    substitution(At(acceleration(), {sigma: time + x}), start + found * x, order=1, small=[x])
    return found


@equation("s6-launch")
def launch_velocity() -> Any:
    """v(sigma, t): the velocity with which a flight leaves sigma to be back after t, from x'' = a by two integrations.

    Examples
    --------
    >>> sympy.factor(launch_velocity())
    -kappa*t*(6*sigma**2 + 4*sigma*t + t**2 - 6)
    """
    return launched_under(acceleration(), _velocity)


def launched_under(push: sympy.Expr, letter: sympy.Expr) -> Any:
    """The velocity with which a flight leaves sigma to be back after t, of x'' = push(sigma), a polynomial.

    Parameters
    ----------
    letter : of the velocity, in the certificate of the motion.
    """
    poly = sympy.Poly(push.subs(sigma, sigma + s), s)
    displaced = sum(value * s ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in poly.terms())
    velocity = sympy.expand(sympy.cancel(-displaced.subs(s, t) / t))
    pushed = reversed(sympy.Poly(push, sigma).all_coeffs())
    motion((sigma, letter, t), letter * t + sympy.expand(displaced.subs(s, t)), tuple(pushed), {}, launch=velocity)
    return velocity


@equation("s6-impact")
def impact_velocity() -> Any:
    """x-dot at the landing: the launch velocity after the involution."""
    found = sympy.expand(launch_velocity().subs({sigma: sigma + t, t: -t}, simultaneous=True))
    substitution(At(launch_velocity(), {sigma: sigma + t, t: -t}), found)
    return found


@equation("s6-horizon")
def horizon() -> Any:
    """The conic on which x-dot = 0 at the landing, t != 0: a polynomial in (sigma, t)."""
    found = sympy.expand(sympy.cancel(impact_velocity() / (kappa * t)))
    substitution(At(kappa * t * x, {x: found}), impact_velocity())
    return found


@equation("s6-zero-set")
def zero_set() -> Any:
    """The conic on which v = 0, t != 0."""
    found = sympy.expand(sympy.cancel(-launch_velocity() / (kappa * t)))
    substitution(At(-kappa * t * x, {x: found}), launch_velocity())
    return found


def project(point: tuple[sympy.Expr, sympy.Expr]) -> tuple[sympy.Expr, sympy.Expr]:
    """p(sigma, t) = (sigma, v)."""
    return point[0], value_at_point(launch_velocity(), point)


def reset(point: tuple[sympy.Expr, sympy.Expr]) -> tuple[sympy.Expr, sympy.Expr]:
    """phi(sigma, t) = (sigma + t, x-dot)."""
    return sympy.expand(point[0] + point[1]), value_at_point(impact_velocity(), point)


def value_at_point(expression: sympy.Expr, point: tuple[sympy.Expr, sympy.Expr]) -> Any:
    """A polynomial in (sigma, t) at a point with rational coordinates, or with one square root in them."""
    found = sympy.expand(expression.subs({sigma: point[0], t: point[1]}, simultaneous=True))
    _certified(expression, dict(zip((sigma, t), point, strict=True)), found)
    return found


def _certified(expression: sympy.Expr, images: dict[Any, Any], result: sympy.Expr, order: int | None = None) -> None:
    """Leave the certificate of a substitution; a square root in the images is w."""
    radicands = {
        power.base
        for image in images.values()
        for power in sympy.sympify(image).atoms(sympy.Pow)
        if power.exp == sympy.Rational(1, 2)
    }
    (radicand,) = radicands or {None}
    if radicand is not None:
        root = sympy.sqrt(radicand)
        images, result = {name: image.subs(root, w) for name, image in images.items()}, result.subs(root, w)
    relation = None if radicand is None else (w**2 - radicand, w)
    substitution(At(expression, images), result, order=order, small=[x, y] if order else [], where=relation)


A, B = (sympy.Integer(-1), sympy.Integer(0)), (sympy.Integer(1), sympy.Integer(0))
C, D = (sympy.Integer(-1), sympy.Integer(4)), (sympy.Integer(-3), sympy.Integer(4))
E = (-sympy.sqrt(3), 2 * sympy.sqrt(3))


def cusp_conditions(point: tuple[sympy.Expr, sympy.Expr]) -> tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]:
    """(v_t, v_tt, v_ttt, v_sigma t) at a point: p has a cusp where the first two vanish and the others do not."""
    v = launch_velocity()
    at = {sigma: point[0], t: point[1]}
    derivatives = {
        (i, k): sympy.expand(sympy.diff(v, (sigma, i), (t, k)).subs(at, simultaneous=True))
        for i in range(4)
        for k in range(4 - i)
    }
    taylor = sum(value * x**i * y**k / (factorial(i) * factorial(k)) for (i, k), value in derivatives.items())
    _certified(v, {sigma: point[0] + x, t: point[1] + y}, sympy.expand(taylor), order=3)
    return derivatives[0, 1], derivatives[0, 2], derivatives[0, 3], derivatives[1, 1]


@equation("s6-shadow")
def shadow() -> Any:
    """t_1 of the next hit behind a graze (sigma, t_0): x - c has the roots 0, t_0, t_0, t_1, whose sum is known."""
    quartic = sympy.Poly(sympy.expand(height(u)), u)
    total = -sympy.cancel(quartic.nth(3) / quartic.nth(4))  # of the roots 0, t_0, t_0, t_1
    found = sympy.expand(total - 2 * t)
    factored = At(kappa * u * (u - t) ** 2 * (u - x), {x: found})
    substitution(factored, height(u), where=(horizon(), t))  # on the horizon, where x - c touches 0 at t_0
    return found


@equation("s6-cofactor")
def cofactor() -> Any:
    """q(u) with x - c = kappa u (u - t) q(u) on the flight (sigma, t): where q > 0 on (0, t) nothing is hit before t.

    Examples
    --------
    >>> cofactor()
    6*sigma**2 + 4*sigma*t + 4*sigma*u + t**2 + t*u + u**2 - 6
    """
    quotient = sympy.expand(sympy.cancel(height(u) / (kappa * u * (u - t))))
    substitution(At(kappa * u * (u - t) * x, {x: quotient}), height(u))
    return quotient


def height(u: sympy.Expr) -> Any:
    """x - c at u of the flight (sigma, t)."""
    v = launch_velocity()
    poly = sympy.Poly(acceleration().subs(sigma, sigma + s), s)
    found = v * u + sum(value * u ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in poly.terms())
    pushed = reversed(sympy.Poly(acceleration(), sigma).all_coeffs())
    motion((sigma, _velocity, u), sympy.expand(found - v * u + _velocity * u), tuple(pushed), {})
    return found


# An unfolded swan to leading order, for every f and g: lengths are scaled, and this model is left.
#
# Near a swan point a_c has one extremum, tau_m; sigma is measured from it, a'' is 24 kappa and a is 12 kappa e there,
# so that two zeros exist where e < 0.  Hadamard's lemma writes what is left over with smooth functions, whose values
# are letters here: a_c = 12 kappa (e + sigma^2) + sigma^3 alpha, f(c + x, x') - f(c, 0) = x phi_1 + x' phi_2.  An
# identity in these letters holds to all orders.


e, H, alpha, phi_1, phi_2 = sympy.symbols("e H alpha phi_1 phi_2")


class Weights(NamedTuple):
    """The powers of a length H by which sigma and t, e, x - c and x' are scaled."""

    time: int
    unfolding: int
    height: int
    velocity: int


WEIGHTS = Weights(1, 2, 4, 3)


def pushed() -> Any:
    """x'' = a_c - (f(c + x, x') - f(c, 0)), x and y = x' being those of the flight and x measured from the wall."""
    return 12 * kappa * (e + sigma**2) + sigma**3 * alpha - x * phi_1 - y * phi_2


@equation("s6-scaled")
def scaled(weights: Weights) -> tuple[Any, Any]:
    """(limit, rest): x'' in scaled lengths is limit + H rest, where both are polynomials in H and the letters.

    Raises
    ------
    ArithmeticError : the velocity is not scaled like height by time, or x'' does not stay finite as H -> 0.

    Examples
    --------
    >>> scaled(WEIGHTS)[0]
    12*kappa*(e + sigma**2)
    """
    need(weights.velocity == weights.height - weights.time, ArithmeticError("x' is not scaled like x by time"))
    images = {
        sigma: H**weights.time * sigma,
        e: H**weights.unfolding * e,
        x: H**weights.height * x,
        y: H**weights.velocity * y,
    }
    unit = weights.height - 2 * weights.time
    acceleration = sympy.expand(pushed().subs(images, simultaneous=True) / H**unit)
    need(acceleration.is_polynomial(H), ArithmeticError("x'' does not stay finite as H -> 0"))
    limit = sympy.factor(acceleration.subs(H, 0))
    rest = sympy.expand((acceleration - sympy.expand(limit)) / H)
    substitution(At(pushed(), images), H**unit * (limit + H * rest))
    return limit, rest


@equation("s6-scaling")
def limit_acceleration() -> Any:
    """12 kappa (sigma^2 + e), to which the acceleration at rest tends; e = -1 where A and B are at the distance 2."""
    return scaled(WEIGHTS)[0]


@equation("s6-limit-launch")
def limit_launch() -> Any:
    """v(sigma, t), to which the launch velocity in scaled lengths tends, by two integrations.

    Examples
    --------
    >>> sympy.factor(limit_launch())
    -kappa*t*(6*e + 6*sigma**2 + 4*sigma*t + t**2)
    """
    return launched_under(limit_acceleration(), y)


@equation("s6-leading")
def leading_launch(weights: Weights) -> Any:
    """The launch velocity of any oscillator in scaled lengths at H = 0, from its Taylor polynomial of degree 3.

    Terms of v_c of degree n in (sigma, t) have the factor H^n at least, so those beyond the third do not reach it.

    Raises
    ------
    ArithmeticError : it does not stay finite as H -> 0.
    """
    images = {
        a_symbol(0): 12 * kappa * H**weights.unfolding * e,
        a_symbol(1): sympy.Integer(0),
        a_symbol(2): 24 * kappa,
        offset: H**weights.time * sigma,
        delay: H**weights.time * t,
    }
    put = sympy.expand(v_c(3).subs(images, simultaneous=True))
    least = [sympy.expand(put).coeff(H, n) for n in range(weights.velocity + 1)]
    need(not any(least[:-1]), ArithmeticError("the launch velocity does not stay finite as H -> 0"))
    substitution(At(v_c(3), images), H**weights.velocity * least[-1], order=weights.velocity, small=[H])
    return least[-1]
