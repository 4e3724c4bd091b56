"""Flights kept above the obstacle by strong damping, and launches too fast for a bounded, oscillating force.

Strong damping: two straight barriers in the plane of z = x - c and x'.

On x' = -lambda z the motion points upwards, and on x' = kappa (Z - z) downwards, if for all z in [0, Z] and all times

    g - f(c + z, -lambda z) - lambda^2 z > 0,        g - f(c + z, kappa (Z - z)) + kappa^2 (Z - z) < 0 .

A launch with 0 < v <= kappa Z begins between them and stays there, so z >= z_0 e^(-lambda t) > 0: it never returns.
The slopes are looked for in doubles on a grid; the inequalities are then proved in balls on pieces of [0, Z].

Fast launches, of rotating pendulums: let f(x) = V'(x) with |V| bounded and g(t) = m + G'(t) with |G| bounded and m >= 0
(constant parts of f in m).  Then y = x' - G(t) + V(x)/x' has y' = m - V x''/x'^2, so with |x''| <= B and the launch
velocity u, as long as x' >= u/2,

    x' >= u - 2 sup|G| - 4 sup|V|/u - 4 t sup|V| B/u^2 .
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Product,
    Sum,
    add,
    evaluate,
    multiply,
    names_in,
    negate,
    number,
    substitute,
    walk,
)
from singimpact.algebra.numbers import Array, as_float, sign_of
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.no_return.polynomial import extremes_of_forcing, least_on_a_grid
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class BarrierSettings:
    """Where barriers are searched.

    Attributes
    ----------
    slopes, heights : powers of two tried for lambda and kappa, and for Z.
    grid : points of [0, Z] in doubles, denser towards 0. pieces : of [0, Z] at most, in balls. shortest : part of
        [0, Z] that is not halved any more; without it a proof that fails at one point took all pieces.
    operations : nodes of f that are evaluated in one search, 2 us each; what is not proved then is not proved. Searches
        of ordinary models take 1000 to 40 000.
    """

    slopes: range = range(-6, 15)
    heights: range = range(-4, 12)
    grid: int = 200
    pieces: int = 2000
    bits: int = 96
    shortest: Fraction = Fraction(1, 2**60)
    operations: int = 300_000


SEARCH = BarrierSettings()


def kept_up(osc: Oscillator, v: Array) -> Array:
    """Whether flights launched with velocities v > 0 are proved never to return.

    Examples
    --------
    >>> kept_up(Oscillator("x + x**3/10 + 1000*xdot", "cos(t)", -1, 1), np.array([0.0, 1.0])).tolist()
    [False, True]
    """
    return np.asarray((v > 0) & (v <= fastest_kept(osc)))


@lru_cache(maxsize=256)
def fastest_kept(osc: Oscillator) -> float:
    """The largest launch velocity between proved barriers; 0 without any."""
    if osc.parametric:
        return 0.0
    clearance, left = as_float(osc.clearance), Operations(osc)

    def force(z: Array, speed: Array) -> Array:
        with np.errstate(all="ignore"):
            return np.asarray(evaluate(osc.force(), {"x": clearance + z, "xdot": speed}, DOUBLES) + 0 * z)

    nothing = np.zeros(1)
    at_rest = force(nothing, nothing)[0]
    if not least_on_a_grid(osc) - at_rest > 0:  # the obstacle must push the mass off at all times; no balls are needed
        return 0.0
    extremes = extremes_of_forcing(osc)
    if extremes is None:
        return 0.0
    low, high = (float(extreme.mid()) for extreme in extremes)
    if not low - at_rest > 0:
        return 0.0
    grid = np.linspace(0, 1, SEARCH.grid) ** 2
    for height in (2.0**k for k in SEARCH.heights):
        z = height * grid
        if not high - force(z[-1:], nothing)[0] < 0:
            continue
        below = [s for s in _slopes() if left.spend() and np.all(low - force(z, -s * z) - s * s * z > 0)]
        rest = height - z
        above = [s for s in _slopes() if left.spend() and np.all(high - force(z, s * rest) + s * s * rest < 0)]
        for steep in reversed(above):
            for flat in below:
                if _proved(osc, extremes, (height, flat, steep), left):
                    return steep * height
    return 0.0


class Operations:
    """The number of evaluations that a search has left."""

    def __init__(self, osc: Oscillator) -> None:
        self.price = sum(1 for _ in walk(osc.force()))
        self.left = SEARCH.operations

    def spend(self) -> bool:
        """Whether f may be evaluated once more."""
        self.left -= self.price
        return self.left >= 0


def _slopes() -> list[float]:
    return [2.0**k for k in SEARCH.slopes]


def _proved(osc: Oscillator, extremes: tuple[Any, Any], barriers: tuple[float, float, float], left: Operations) -> bool:
    """Both inequalities on [0, height], in balls.

    Parameters
    ----------
    barriers : the height, and the slopes of the lower and the upper barrier.
    """
    balls = Balls(SEARCH.bits)
    z = Name("z")
    top, slope, bar = (number(Fraction(value)) for value in barriers)
    rest = add(top, multiply(number(-1), z))
    position = add(osc.clearance, z)
    lower = add(
        multiply(number(-1), substitute(osc.force(), {"x": position, "xdot": multiply(number(-1), slope, z)})),
        multiply(number(-1), slope, slope, z),
    )
    upper = add(
        multiply(number(-1), substitute(osc.force(), {"x": position, "xdot": multiply(bar, rest)})),
        multiply(bar, bar, rest),
    )

    def holds(piece: Any) -> bool:
        first, second = (balls.evaluate(tree, {"z": piece}) for tree in (lower, upper))
        return bool(extremes[0] + first > 0) and bool(extremes[1] + second < 0)

    with balls_at(SEARCH.bits):
        return _on_pieces(holds, balls, barriers[0], left)


def _on_pieces(holds: Callable[[Any], bool], balls: Balls, height: float, left: Operations) -> bool:
    """Whether something holds on pieces that cover [0, height]."""
    stack = [(Fraction(0), Fraction(height))]
    for _ in range(SEARCH.pieces):
        if not stack:
            return True
        low, high = stack.pop()
        if high - low < SEARCH.shortest * Fraction(height) or not left.spend():
            return False
        if not holds(balls.rational(low).union(balls.rational(high))):
            middle = (low + high) / 2
            stack += [(middle, high), (low, middle)]
    return False


# ---- fast launches

MARGIN = 1e-9  # of every sum here, which is a few roundings


@dataclass(frozen=True)
class Bounds:
    """sup|V|, sup|G| and B of the bound for fast launches."""

    potential: float
    impulse: float
    force: float


def stays_up(osc: Oscillator, v: Array, horizon: Any) -> Array:
    """Whether flights launched with velocities v are proved not to return before the horizon.

    Examples
    --------
    >>> stays_up(Oscillator("sin(x)", "cos(t)", 0, 1), np.array([10.0, 100.0]), 6000.0).tolist()
    [False, True]
    """
    bounds = bounds_of(osc)
    if bounds is None:
        return np.zeros(v.shape, dtype=bool)
    with np.errstate(all="ignore"):
        left = v / 2 - 2 * bounds.impulse - 4 * bounds.potential / v
        lost = 4 * horizon * bounds.potential * bounds.force / v**2
        return np.asarray((v > 0) & (left > lost + MARGIN * v))


@lru_cache(maxsize=256)
def bounds_of(osc: Oscillator) -> Bounds | None:
    """The bounds of a model whose f and g are sums of sines and cosines; None for any other."""
    force, forcing = _waves(osc.force(), "x"), _waves(osc.forcing(), "t")
    if force is None or forcing is None or sign_of(add(forcing[0], negate(force[0]))) < 0:
        return None
    sizes = [(abs(as_float(size)), abs(as_float(rate))) for part in (force, forcing) for size, rate in part[1]]
    count, mean = len(force[1]), abs(as_float(add(forcing[0], negate(force[0]))))
    turned = [size / rate for size, rate in sizes]
    return Bounds(sum(turned[:count]), sum(turned[count:]), sum(size for size, _ in sizes) + mean)


def _waves(tree: Expression, variable: str) -> tuple[Expression, list[tuple[Expression, Expression]]] | None:
    """A tree as a constant and waves (amplitude, rate), sin or cos of linear arguments; None for any other."""
    constant: Expression = number(0)
    waves = []
    for term in tree.terms if isinstance(tree, Sum) else (tree,):
        if not names_in(term):
            constant = add(constant, term)
            continue
        factors = term.factors if isinstance(term, Product) else (term,)
        moving = [factor for factor in factors if names_in(factor)]
        if len(moving) != 1 or not isinstance(moving[0], Call) or moving[0].function not in ("sin", "cos"):
            return None
        rate = derivative(moving[0].argument, variable)
        if names_in(rate) or names_in(moving[0].argument) != {variable} or sign_of(rate) == 0:
            return None
        waves.append((multiply(number(1), *(factor for factor in factors if not names_in(factor))), rate))
    return constant, waves
