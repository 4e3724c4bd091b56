"""A periodic orbit that is proved to exist, alone in a box, with its multipliers, by Krawczyk's operator.

The unknowns are all states of the orbit: no box is carried from impact to impact, so unstable orbits need no care.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import Any

from singimpact.algebra.balls import BITS_A_DIGIT
from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.precision import balls_at
from singimpact.branches.ball_closing import BallClosing, return_slope
from singimpact.branches.krawczyk import Krawczyk, proved
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result


@dataclass(frozen=True)
class EnclosedOrbit(Result):
    """A periodic orbit that exists.

    Attributes
    ----------
    tau, v : `Certified` states just after its impacts. unique_within : no other orbit of so many impacts and periods
        has all its states within this distance, in tau and in v, of these.
    multipliers : two pairs (real part, imaginary part) of `Certified`; None where they may be equal.
    stable : whether both are proved to be below 1 in size; False where one is proved to be above; else None.
    oscillator, k : the model, and after how many periods the orbit closes.
    """

    tau: tuple[Certified, ...]
    v: tuple[Certified, ...]
    unique_within: Fraction
    multipliers: tuple[tuple[Certified, Certified], ...] | None
    stable: bool | None
    oscillator: Oscillator | None = field(default=None, repr=False)
    k: int = 1


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
    states = [Fraction(float(coordinate)) for pair in zip(times, speeds, strict=True) for coordinate in pair]
    bits = ceil(digits * BITS_A_DIGIT) + 64
    with balls_at(bits):
        return proved(lambda: _enclosed(BallClosing(osc, k, digits, bits), states, digits))  # type: ignore[no-any-return]


def _enclosed(orbit: BallClosing, states: list[Fraction], digits: int) -> EnclosedOrbit:
    operator = Krawczyk(orbit, states, Fraction(1, 10 ** (digits + 2)))
    states = operator.solved(states)
    step = operator.step(states)
    own = operator.own_radius(step)
    tight = operator.tight(states, step, own)
    orbit.first_hits(states, own)
    unique = operator.unique_within(states, step, own)
    numbers = [
        from_ball(orbit.balls.rational(x) + offset, digits) for x, offset in zip(states, tight.offsets, strict=True)
    ]
    multipliers, stable = _multipliers(return_slope(tight.slopes), digits)
    return EnclosedOrbit(
        tuple(numbers[::2]), tuple(numbers[1::2]), unique, multipliers, stable, orbit.osc, orbit.spans.k
    )


def _multipliers(total: Any, digits: int) -> tuple[Any, bool | None]:
    """Eigenvalues of the derivative of the return map, and whether they lie within the unit circle."""
    import flint

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
