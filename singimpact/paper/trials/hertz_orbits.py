"""gamma of impacts that lose C w^q of a speed w, on true orbits before a contact point at tau = 0: by halving.

`b:hertz` predicts v = (K C b h^(j+1))^(1/(1-q)) at the distance h, b = |a_j|/j!.  C is chosen so that flights last a
given part of h there, for impacts until a side is decided grow like its inverse.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import numpy as np

from singimpact.algebra.solving import halved
from singimpact.dynamics.remaining import rest_after
from singimpact.flights.orbits import orbit_segment
from singimpact.oscillator.model import Oscillator
from singimpact.paper.trials.true_orbits import System

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
    low, high = halved(lambda v: not above(osc, order, h, v), low, high, narrow)
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
