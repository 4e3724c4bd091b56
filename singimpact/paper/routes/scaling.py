"""Section 6: an unfolded swan to leading order, for every f and g: lengths are scaled, and one model is left.

Near a swan point a_c has one extremum, tau_m; sigma is measured from it, a'' is 24 kappa and a is 12 kappa e there,
so that two zeros exist where e < 0.  Hadamard's lemma writes what is left over with smooth functions, whose values are
letters here: a_c = 12 kappa (e + sigma^2) + sigma^3 alpha and f(c + x, x') - f(c, 0) = x phi_1 + x' phi_2.  An identity
in these letters holds to all orders.
"""

from typing import Any, NamedTuple

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.implicit import a_symbol, sigma as offset, t as delay, v_c
from singimpact.paper.routes.unfolding import kappa, launched_under, sigma, t

e, H, x, y, alpha, phi_1, phi_2 = sympy.symbols("e H x y alpha phi_1 phi_2")


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
    if weights.velocity != weights.height - weights.time:
        raise ArithmeticError("x' is not scaled like x by time")
    images = {
        sigma: H**weights.time * sigma,
        e: H**weights.unfolding * e,
        x: H**weights.height * x,
        y: H**weights.velocity * y,
    }
    unit = weights.height - 2 * weights.time
    acceleration = sympy.expand(pushed().subs(images, simultaneous=True) / H**unit)
    if not acceleration.is_polynomial(H):
        raise ArithmeticError("x'' does not stay finite as H -> 0")
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
    near = {a_symbol(0): 12 * kappa * e, a_symbol(1): sympy.Integer(0), a_symbol(2): 24 * kappa}
    images = near | {offset: H**weights.time * sigma, delay: H**weights.time * t}
    images |= {a_symbol(0): 12 * kappa * H**weights.unfolding * e}
    put = sympy.expand(v_c(3).subs(images, simultaneous=True))
    least = [sympy.expand(put).coeff(H, n) for n in range(weights.velocity + 1)]
    if any(least[:-1]):
        raise ArithmeticError("the launch velocity does not stay finite as H -> 0")
    substitution(At(v_c(3), images), H**weights.velocity * least[-1], order=weights.velocity, small=[H])
    return least[-1]
