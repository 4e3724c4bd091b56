"""gamma of impacts that lose C w^q of a speed w, on true orbits before a contact point at tau = 0: by halving.

v = (K C b h^(j+1))^(1/(1-q)) (1 + G P) is expected at the distance h, b = |a_j|/j!. C is chosen so that flights last a
given part of h there, for impacts until a side is decided grow like its inverse.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import DOUBLES
from singimpact.contact import acceleration_jet
from singimpact.dynamics import rest_after
from singimpact.flights import orbit_segment
from singimpact.oscillator import Oscillator
from singimpact.paper import System

POWERS = tuple(Fraction(n, 10) for n in (1, 2, 3, 5))
FARTHEST = 0.01  # h of the first place; what an oscillator has beyond its leading term is of order h^2 here
HALF = Fraction(1, 2)
# v/(b h^(j+1)) at the two places: half the flight time over h.
FLIGHTS = {q: (1 / 60, 1 / 180) if q == HALF else (1 / 250, 1 / 750) for q in POWERS}
# Relative widths of the last brackets; half the width costs 2^(3s/(3 + (2+q) j)) times the impacts, s = N - (j+1).
NARROW = {Fraction(1, 10): 1e-6, Fraction(1, 5): 1e-6, Fraction(3, 10): 1e-5, HALF: 2e-3}
IMPACTS = 4_000_000  # of one velocity
BLOCK = 8192
SHORT = 1 / 8  # of 1/(j + 1), below the part 3/(3 + (2+q) j) of h that chatter on gamma would last under constant a_c


Start = System  # its a_c vanishes at tau = 0 to order j, with |a_j|/j! = 1
STARTS = (
    Start("x'' = t", "0", "t", order=1),
    Start("x'' + x = sin t, c = 0", "x", "sin(t)", order=1),
    Start("x'' = -t^2", "0", "-t**2", order=2),
    Start("x'' + x = (cos 2t - 1)/2, c = 0", "x", "(cos(2*t) - 1)/2", order=2),
)


@dataclass(frozen=True)
class Measured:
    """gamma at two distances.

    Attributes
    ----------
    loss : C. distances : h. speeds : v on gamma. widths : of the brackets of v, relative.
    """

    loss: float
    distances: tuple[float, float]
    speeds: tuple[float, float]
    widths: tuple[float, float]

    @property
    def exponent(self) -> float:
        """The slope of ln v against ln h."""
        return float(np.log(self.speeds[0] / self.speeds[1]) / np.log(self.distances[0] / self.distances[1]))


def constant(order: int, q: Fraction) -> Fraction:
    """K, from which the place is chosen where gamma is looked for; what is found does not depend on it."""
    return 3 * (1 - q) / (2 * (3 + (2 + q) * order))


@cache
def measured(start: Start, q: Fraction) -> Measured:
    """gamma of v (1 - C v^q) on one oscillator."""
    j = start.order
    s = (j + 1) * q / (1 - q)
    first = FLIGHTS[q][0] / FARTHEST ** float(s)  # v/(b h^(j+1)) is this times h^s
    loss = float(f"{first ** float(1 - q) / float(constant(j, q)):.3g}")
    osc = Oscillator(start.f, start.g, 0, f"-v*(1 - C*(-v)**({q}))", {"C": repr(loss)})
    distances, speeds, widths = [], [], []
    for count in FLIGHTS[q]:
        h = FARTHEST * (count / FLIGHTS[q][0]) ** float(1 / s)
        v, width = edge(osc, j, h, count * h ** (j + 1), NARROW[q])
        distances.append(h)
        speeds.append(v)
        widths.append(width)
    return Measured(loss, (distances[0], distances[1]), (speeds[0], speeds[1]), (widths[0], widths[1]))


def edge(osc: Oscillator, order: int, h: float, near: float, narrow: float) -> tuple[float, float]:
    """The velocity over tau = -h that separates complete chatter from lift-off, and its relative uncertainty.

    Raises
    ------
    ArithmeticError : it is not within a factor 2 of `near`, or a side is not decided.
    """
    low, high = near / 2, 2 * near
    if above(osc, order, h, low) or not above(osc, order, h, high):
        raise ArithmeticError(f"gamma of {osc} over tau = {-h} is not between {low} and {high}")
    while high - low > narrow * (high + low):
        middle = (low + high) / 2
        low, high = (low, middle) if above(osc, order, h, middle) else (middle, high)
    return (low + high) / 2, (high - low) / (high + low)


def above(osc: Oscillator, order: int, h: float, v: float) -> bool:
    """Whether an impact from (-h, v) comes after the contact point at 0; else chatter is short beside what is left."""
    tau, flown = -h, 0
    while flown < IMPACTS:
        segment = orbit_segment(osc, tau, v, BLOCK)
        if segment.status or np.any(segment.tau >= 0):
            return True
        left = rest_after(osc, segment.v[:-1], segment.acceleration[1:])
        if np.any(left < SHORT / (order + 1) * -segment.tau[:-1]):
            return False
        tau, v, flown = float(segment.tau[-1]), float(segment.v[-1]), flown + BLOCK
    raise ArithmeticError(f"{IMPACTS} impacts do not decide on which side of gamma v = {v} over tau = {-h} lies")


@pytest.mark.slow
def test_one_exponent_by_halving():
    q = Fraction(1, 5)
    found = measured(STARTS[0], q)
    assert found.exponent == pytest.approx(2.5, abs=1e-3)
    w = (float(constant(1, q)) * found.loss) ** 1.25
    assert found.speeds[1] / (w * found.distances[1] ** 2.5) == pytest.approx(1, abs=1e-3)


@pytest.mark.slow
def test_sides_and_refusals():
    osc = Oscillator("0", "t", 0, "-v*(1 - 3*(-v)**(1/5))")
    v, width = edge(osc, 1, 0.01, float(constant(1, Fraction(1, 5)) * 3) ** 1.25 * 1e-5, 1e-3)
    assert width < 1e-3
    assert above(osc, 1, 0.01, 1.01 * v)
    assert not above(osc, 1, 0.01, 0.99 * v)
    with pytest.raises(ArithmeticError, match="is not between"):
        edge(osc, 1, 0.01, 10 * v, 1e-3)


def test_the_starts_have_their_contact_orders():
    assert (Fraction(1, 10), Fraction(1, 5), Fraction(3, 10), Fraction(1, 2)) == POWERS
    for start in STARTS:
        sizes = acceleration_jet(Oscillator(start.f, start.g, 0, "1/2"), 0.0, start.order + 1, DOUBLES)
        wanted = [0.0] * start.order + [1.0, 0.0]
        assert [abs(float(size)) for size in sizes] == pytest.approx(wanted, abs=1e-15)


def law(order, q):
    """(N, K, G): v = w h^N (1 + G P) on gamma, w^(1-q) = K C, P = v/h^(j+1)."""
    n, k = (order + 1) / (1 - q), 3 * (1 - q) / (2 * (3 + (2 + q) * order))
    g = q * (3 + (2 + q) * order) * (3 + (1 + 2 * q) * order) / (3 * (1 - q) * (3 + 2 * order * (1 + q) - order * q**2))
    return n, k, g


def keeps(start, power, law):
    """Whether both terms hold at both distances; what is left out has the part P <= 1/60 of the second, times 5."""
    curve, q, (n, k, g) = measured(start, power), float(power), law
    w = (k * curve.loss) ** (1 / (1 - q))
    return all(
        abs(v / (w * h**n) - 1 - g * v / h ** (start.order + 1)) < 0.15 * abs(g) * v / h ** (start.order + 1) + 2 * wide
        for h, v, wide in zip(curve.distances, curve.speeds, curve.widths, strict=True)
    )


@pytest.mark.slow
@pytest.mark.parametrize("power", POWERS, ids=str)
@pytest.mark.parametrize("start", STARTS, ids=[start.name for start in STARTS])
def test_gamma_of_true_orbits_has_both_terms(start, power):
    n, k, g = law(start.order, float(power))
    assert keeps(start, power, (n, k, g))
    wrong = [(start.order + 1, k, g), (n + float(power) / 10, k, g), (n, k, 0.0), (n, k, 2 * g)]
    assert not any(keeps(start, power, other) for other in wrong)


@pytest.mark.slow
@pytest.mark.parametrize("power", POWERS[:3], ids=str)
@pytest.mark.parametrize("start", STARTS[:2], ids=[start.name for start in STARTS[:2]])
def test_the_threshold_is_the_place_that_halving_finds(start, power):
    curve = measured(start, power)
    osc = si.ImpactOscillator(start.f, start.g, 0, f"-v*(1 - C*(-v)**({power}))", {"C": repr(curve.loss)})
    for h, v, wide in zip(curve.distances, curve.speeds, curve.widths, strict=True):
        found = si.threshold(osc, -h)
        assert abs(found.v - v) <= 2 * wide * v + found.error
