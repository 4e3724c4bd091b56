"""The involution iota(sigma, t) = (sigma + t, -t): it exchanges launch and landing, and turns p into phi.

In the coordinates (s, e), launch time and landing time, iota is the exchange of s and e.
"""

from __future__ import annotations

from typing import Any

from singimpact.algebra.jets import Jet


def after_iota(v: Jet) -> Jet:
    """v o iota for a jet in (sigma, t): impact velocity from launch velocity."""
    sigma, t = v.space.generators()
    return v.compose(iota(sigma, t))


def iota(sigma: Any, t: Any) -> tuple[Any, Any]:
    """(sigma + t, -t), for numbers, jets or sympy objects alike.

    Examples
    --------
    >>> iota(*iota(2, 3))
    (2, 3)
    """
    return sigma + t, -t
