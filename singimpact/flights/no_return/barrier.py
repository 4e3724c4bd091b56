"""Flights that strong damping keeps above the obstacle: two straight barriers in the plane of z = x - c and x'.

On x' = -lambda z the motion points upwards, and on x' = kappa (Z - z) downwards, if for all z in [0, Z] and all times

    g - f(c + z, -lambda z) - lambda^2 z > 0,        g - f(c + z, kappa (Z - z)) + kappa^2 (Z - z) < 0 .

A launch with 0 < v <= kappa Z begins between them and stays there, so z >= z_0 e^(-lambda t) > 0: it never returns.
The slopes are looked for in doubles on a grid; the inequalities are then proved in balls on pieces of [0, Z].
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Name, add, evaluate, multiply, number, substitute, walk
from singimpact.algebra.numbers import Array, as_float
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
    fastest = fastest_kept(osc)
    return np.asarray((v > 0) & (v <= fastest))


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
