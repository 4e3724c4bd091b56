"""A periodic orbit that is proved to exist, alone in a box, with its multipliers, by Krawczyk's operator.

The unknowns are all states x_i of the orbit, and F_i(x) = G(x_i) - x_(i+1), with k periods taken off where it closes. Y
is about the inverse of D F at the centre. If, for a box X round the centre x,

    x - Y F(x) + (1 - Y D F(X)) (X - x)   lies inside X,

there is one zero of F in X and no other. No box is carried from impact to impact, so unstable orbits need no care.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any

from singimpact.algebra.balls import BITS_A_DIGIT, Balls, as_rational
from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.expressions import evaluate, number
from singimpact.algebra.precision import balls_at
from singimpact.flights.enclosures.certified_hit import Launch, certified_hit
from singimpact.flights.enclosures.equation import Refused
from singimpact.flights.model_numbers import horizon_of
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class KrawczykSettings:
    """Boxes that are tried.

    Parameters
    ----------
    first : radius, of times and velocities, of the boxes over which Y is computed.
    widest, narrowest, shrink : of the boxes in which the orbit is shown to be the only one.
    rounds : of Newton's method, each of which gains about as many digits as `first` has.
    margin : of the last box, over the step that Newton's method would still take.
    """

    first: Fraction = Fraction(1, 10**10)
    widest: Fraction = Fraction(1, 10**3)
    narrowest: Fraction = Fraction(1, 10**9)
    shrink: int = 4
    rounds: int = 40
    margin: int = 4


KRAWCZYK = KrawczykSettings()


@dataclass(frozen=True)
class EnclosedOrbit:
    """A periodic orbit that exists.

    Attributes
    ----------
    tau, v : `Certified` states just after its impacts. unique_within : no other orbit of so many impacts and periods
        has all its states within this distance, in tau and in v, of these.
    multipliers : two pairs (real part, imaginary part) of `Certified`; None where they may be equal.
    stable : whether both are proved to be below 1 in size; False where one is proved to be above; else None.
    """

    tau: tuple[Certified, ...]
    v: tuple[Certified, ...]
    unique_within: Fraction
    multipliers: tuple[tuple[Certified, Certified], ...] | None
    stable: bool | None


def enclosed_orbit(osc: Oscillator, times: Any, speeds: Any, k: int, digits: int) -> EnclosedOrbit | str:
    """The orbit next to some states, proved; or the reason why it is not.

    Parameters
    ----------
    osc : the model. times, speeds : of n impacts, about. k : periods of the forcing. digits : of the states.

    Examples
    --------
    >>> found = enclosed_orbit(Oscillator("x + x**3/10", "cos(4*t)", 0, "1/2"), [1.087], [0.497], 2, 25)
    >>> print(found.v[0], found.stable)
    0.4968833769630701986638762 True
    """
    states = [Fraction(float(part)) for pair in zip(times, speeds, strict=True) for part in pair]
    bits = ceil(digits * BITS_A_DIGIT) + 64
    with balls_at(bits):
        try:
            orbit = _Closing(osc, k, digits, bits)
            return _proved(orbit, states, digits)
        except (Refused, ZeroDivisionError) as reason:
            return str(reason)


class _Closing:
    """F and D F of the closing conditions of n impacts in balls."""

    def __init__(self, osc: Oscillator, k: int, digits: int, bits: int) -> None:
        self.osc, self.digits, self.balls = osc, digits, Balls(bits)
        assert osc.period is not None
        self.span = evaluate(osc.period, {}, self.balls) * k
        self.horizon = Fraction(horizon_of(osc, None))

    def _flown(self, state: list[Fraction], radius: Fraction) -> Any:
        radii = {"tau": radius, "v": radius} if radius else {}
        launch = Launch(number(state[0]), number(state[1]), 1, radii)
        return certified_hit(self.osc, launch, self.digits + 6, self.horizon, derivative=bool(radius))

    def miss(self, states: list[Fraction]) -> Any:
        """F at a point, as a column."""
        import flint

        rows, n = [], len(states) // 2
        for i in range(n):
            hit = self._flown(states[2 * i : 2 * i + 2], Fraction(0))
            last = i == n - 1
            after = [self.balls.rational(part) for part in states[2 * ((i + 1) % n) : 2 * ((i + 1) % n) + 2]]
            rows += [[hit.tau - after[0] - (self.span if last else 0)], [hit.v - after[1]]]
        return flint.arb_mat(rows)

    def slopes(self, states: list[Fraction], radius: Fraction) -> list[list[list[Any]]]:
        """D G over the box round each state."""
        return [self._flown(states[2 * i : 2 * i + 2], radius).derivative for i in range(len(states) // 2)]


def _matrix(slopes: list[list[list[Any]]]) -> Any:
    """D F from the D G: blocks beside the diagonal, less the identity."""
    import flint

    size = 2 * len(slopes)
    rows = [[flint.arb(0)] * size for _ in range(size)]
    for i, block in enumerate(slopes):
        for p in (0, 1):
            for q in (0, 1):
                rows[2 * i + p][2 * i + q] += block[p][q]
            rows[2 * i + p][(2 * i + 2 + p) % size] -= 1
    return flint.arb_mat(rows)


def _middles(matrix: Any) -> Any:
    import flint

    return flint.arb_mat([[flint.arb(part.mid()) for part in row] for row in matrix.table()])


def _proved(orbit: _Closing, states: list[Fraction], digits: int) -> EnclosedOrbit | str:
    import flint

    Y = _middles(_middles(_matrix(orbit.slopes(states, KRAWCZYK.first))).inv())
    small = Fraction(1, 10 ** (digits + 2))
    for _ in range(KRAWCZYK.rounds):
        move = (Y * orbit.miss(states)).entries()
        states = [as_rational(orbit.balls.rational(x) - part) for x, part in zip(states, move, strict=True)]
        if all(abs(part) < orbit.balls.rational(small) for part in move):
            break
    else:
        return "Newton's method does not come to the digits"
    step = Y * orbit.miss(states)
    left = max(as_rational(flint.arb(abs(part).upper())) for part in step.entries())
    own = max(KRAWCZYK.margin * left, small / 10)

    def image(radius: Fraction) -> tuple[list[Any], Any] | None:
        try:
            slopes = orbit.slopes(states, radius)
        except Refused:
            return None
        size, r = len(states), orbit.balls.rational(radius)
        rest = flint.arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)]) - Y * _matrix(slopes)
        off = [-s + sum((part * flint.arb(0, r.upper()) for part in row), flint.arb(0))
               for s, row in zip(step.entries(), rest.table(), strict=True)]  # fmt: skip
        return (off, slopes) if all(part.is_finite() and abs(part) < r for part in off) else None

    tight = image(own)
    if tight is None:
        return "Krawczyk's operator does not map the box into itself: the orbit may be double, or graze"
    unique, radius = own, KRAWCZYK.widest
    while radius > max(KRAWCZYK.narrowest, own):
        if image(radius) is not None:
            unique = radius
            break
        radius /= KRAWCZYK.shrink
    numbers = [from_ball(orbit.balls.rational(x) + part, digits) for x, part in zip(states, tight[0], strict=True)]
    multipliers, stable = _multipliers(tight[1], digits)
    return EnclosedOrbit(tuple(numbers[::2]), tuple(numbers[1::2]), unique, multipliers, stable)


def _multipliers(slopes: list[list[list[Any]]], digits: int) -> tuple[Any, bool | None]:
    """Eigenvalues of the product, and whether they lie within the unit circle."""
    import flint

    total = flint.arb_mat([[1, 0], [0, 1]])
    for block in slopes:
        total = flint.arb_mat([row[:2] for row in block]) * total
    half, determinant = (total[0, 0] + total[1, 1]) / 2, total.det()
    under = half * half - determinant
    if under > 0:
        far = half + under.sqrt() if half > 0 else half - under.sqrt()
        pairs = [(far, flint.arb(0)), (determinant / far, flint.arb(0))]
    elif under < 0:
        pairs = [(half, (-under).sqrt()), (half, -(-under).sqrt())]
    else:
        return None, None
    sizes = [(a * a + b * b) for a, b in pairs]
    stable = True if all(size < 1 for size in sizes) else False if any(size > 1 for size in sizes) else None
    return tuple((from_ball(a, digits), from_ball(b, digits)) for a, b in pairs), stable
