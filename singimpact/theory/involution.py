"""The involution iota(sigma, t) = (sigma + t, -t): it exchanges launch and landing, and turns p into phi.

In the coordinates (s, e), launch time and landing time, iota is the exchange of s and e.
"""

from __future__ import annotations

from typing import Any

from singimpact.algebra.jets import Jet, JetSpace


def exchanged(nu: Jet) -> Jet:
    """A jet in (s, e) with its two variables exchanged: impact velocity from launch velocity."""
    return Jet(nu.space, {(key[1], key[0]): value for key, value in nu.terms.items()})


def in_flight_time(nu: Jet, order: int) -> Jet:
    """A jet in (s, e) rewritten in (sigma, t), where s = sigma and e = sigma + t."""
    space = JetSpace(("sigma", "t"), order, nu.space.ring)
    sigma, t = space.generators()
    return nu.compose((sigma, sigma + t))


def iota(sigma: Any, t: Any) -> tuple[Any, Any]:
    """(sigma + t, -t), for numbers or sympy objects alike.

    Examples
    --------
    >>> iota(*iota(2, 3))
    (2, 3)
    """
    return sigma + t, -t
