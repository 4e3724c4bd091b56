"""A periodic orbit that is proved to exist, alone in a box, with its multipliers, by Krawczyk's operator.

The unknowns are all states x_i of the orbit, and F_i(x) = G(x_i) - x_(i+1), with k periods taken off where it closes.
No box is carried from impact to impact, so unstable orbits need no care.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any

from singimpact.algebra.balls import BITS_A_DIGIT, Balls
from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.expressions import evaluate, number
from singimpact.algebra.precision import balls_at
from singimpact.branches.krawczyk import KRAWCZYK, Krawczyk, proved, upper
from singimpact.flights.enclosures.certified_hit import Launch, ProvedImpact, certified_hit
from singimpact.flights.model_numbers import horizon_of
from singimpact.oscillator.model import Oscillator


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
        return proved(lambda: _enclosed(_Closing(osc, len(states) // 2, k, digits, bits), states, digits))  # type: ignore[no-any-return]


POINT = (Fraction(0), Fraction(0))


class EnclosedMap:
    """G and D G of a model in balls of one precision.

    Parameters
    ----------
    osc : the model. digits : of the image of a point. bits : of the balls.
    """

    def __init__(self, osc: Oscillator, digits: int, bits: int) -> None:
        assert osc.period is not None
        self.osc, self.digits, self.balls = osc, digits, Balls(bits)
        self.period = evaluate(osc.period, {}, self.balls)
        self.horizon = Fraction(horizon_of(osc, None))

    def __call__(
        self, state: Sequence[Fraction], radii: Sequence[Fraction] = (Fraction(0), Fraction(0))
    ) -> ProvedImpact:
        """The image of a box, with D G unless it is a point; `Refused` where a member is not shown to hit."""
        box = any(radii)
        launch = Launch(number(state[0]), number(state[1]), 1, {"tau": radii[0], "v": radii[1]} if box else {})
        return certified_hit(self.osc, launch, self.digits + 6, self.horizon, derivative=box)


class _Closing:
    """F and D F of the closing conditions of n impacts in balls."""

    def __init__(self, osc: Oscillator, n: int, k: int, digits: int, bits: int) -> None:
        self.map, self.n = EnclosedMap(osc, digits, bits), n
        self.balls, self.span = self.map.balls, self.map.period * k

    def miss(self, states: list[Fraction]) -> Any:
        """F at a point, as a column."""
        import flint

        rows, n = [], self.n
        for i in range(n):
            hit = self.map(states[2 * i : 2 * i + 2])
            last = i == n - 1
            after = [self.balls.rational(part) for part in states[2 * ((i + 1) % n) : 2 * ((i + 1) % n) + 2]]
            rows += [[hit.tau - after[0] - (self.span if last else 0)], [hit.v - after[1]]]
        return flint.arb_mat(rows)

    def radii(self, distance: Fraction) -> list[Fraction]:
        """The box of every state is as wide."""
        return [distance] * (2 * self.n)

    def slopes(self, states: list[Fraction], radii: Sequence[Fraction]) -> list[list[list[Any]]]:
        """D G over the box round each state."""
        return [self.map(states[2 * i : 2 * i + 2], radii[2 * i : 2 * i + 2]).derivative for i in range(self.n)]

    def matrix(self, slopes: list[list[list[Any]]]) -> Any:
        """D F from the D G: blocks beside the diagonal, less the identity."""
        import flint

        size = 2 * self.n
        rows = [[flint.arb(0)] * size for _ in range(size)]
        for i, block in enumerate(slopes):
            for p in (0, 1):
                for q in (0, 1):
                    rows[2 * i + p][2 * i + q] += block[p][q]
                rows[2 * i + p][(2 * i + 2 + p) % size] -= 1
        return flint.arb_mat(rows)


def _enclosed(orbit: _Closing, start: list[Fraction], digits: int) -> EnclosedOrbit:
    operator, small = Krawczyk(orbit, start), Fraction(1, 10 ** (digits + 3))
    states = operator.centre(start, digits)
    step = operator.step(states)
    own = max(KRAWCZYK.margin * max(map(upper, step)), small)
    tight = operator.tight(states, step, orbit.radii(own))
    unique = operator.unique_within(states, step, own)
    numbers = [from_ball(orbit.balls.rational(x) + part, digits) for x, part in zip(states, tight.offsets, strict=True)]
    multipliers, stable = _multipliers(tight.slopes, digits)
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
