"""Complete chatter: when what is left of it is below resolution, it is summed up instead of flown."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import as_float, compare
from singimpact.algebra.rings import DOUBLES
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator

STEADY = 1 / 64
"""a_c may change by this part of itself over what is left of the chatter; then its sign is beyond doubt."""


def remaining(osc: Oscillator, tau: float, v: float, resolution: float) -> float | None:
    """The time that is left of a complete chatter after an impact at (tau, v); None: it must be flown.

        tau_inf - tau = 2 w/(1 - r) - (2/3) w^2 (2 a'/a + f_v)/(1 - r)^2 + O(w^3),   w = -v/a

    Parameters
    ----------
    osc : the model. tau, v : the state just after an impact.
    resolution : the second term must be below it; it is then both used and the order of what is left out at most.

    Examples
    --------
    >>> remaining(Oscillator("0", "-2", 0, "1/2"), 0.0, 1e-3, 1e-16)
    0.002
    """
    if compare(osc.restitution, 1) == 0:
        return None
    lost = 1 - as_float(osc.restitution)
    place = np.array([tau])
    a, slope = float(acceleration(osc, place)[0]), float(acceleration(osc, place, 1)[0])
    if not a < 0:
        return None
    w = -v / a
    first = 2 * w / lost
    second = -2 / 3 * w * w * (2 * slope / a + damping_at_rest(osc)) / (lost * lost)
    if abs(second) > resolution or abs(slope) * first > STEADY * -a:
        return None
    return first + second


@lru_cache(maxsize=256)
def damping_at_rest(osc: Oscillator) -> float:
    """df/dx' at (c, 0)."""
    space = JetSpace(("u",), 1, DOUBLES)
    place = {"x": space.constant(as_float(osc.clearance)), "xdot": space.generators()[0]}
    return float(space.evaluate(osc.force(), place).coefficient((1,)))
