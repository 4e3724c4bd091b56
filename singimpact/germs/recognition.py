"""The singularity that a map (u, t) -> (u, w(u, t)) has at 0, read off the derivatives of w by real signs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from singimpact.algebra.jets import Jet

KINDS = ("regular", "fold", "cusp", "lips", "beaks", "swallowtail", "degenerate")


def sign(value: Any) -> int:
    """-1, 0 or 1; a ball that holds zero and more has no sign.

    Raises
    ------
    ArithmeticError : the sign is not decided.
    """
    if value > 0 or value < 0:
        return 1 if value > 0 else -1
    if value == 0:
        return 0
    raise ArithmeticError(f"the sign of {value} is not decided: more bits are needed")


def recognised(w: Jet, sign_of: Callable[[Any], int] = sign) -> str:
    """The kind of the germ of (u, w) at 0, for a jet in (u, t) known to order 4.

    Parameters
    ----------
    w : the jet. sign_of : decides signs of the ring's elements.

    Notes
    -----
    The singular set is w_t = 0.  It is smooth at fold, cusp (w = t^3 + u t) and swallowtail (t^4 + u t); at lips
    (t^3 + u^2 t) it is an isolated point, at beaks (t^3 - u^2 t) it crosses itself.

    Examples
    --------
    >>> from singimpact.algebra.jets import JetSpace
    >>> from singimpact.algebra.rings import EXACT
    >>> u, t = JetSpace(("u", "t"), 4, EXACT).generators()
    >>> [recognised(w) for w in (t * t, t**3 + u * t, t**3 + u * u * t, t**3 - u * u * t, t**4 + u * t)]
    ['fold', 'cusp', 'lips', 'beaks', 'swallowtail']
    """
    if w.space.order < 4:
        raise TypeError("a jet of order 4 is needed: the swallowtail shows there")

    def at(i: int, k: int) -> int:
        return sign_of(w.coefficient((i, k)))

    if at(0, 1):
        return "regular"
    if at(0, 2):
        return "fold"
    if at(1, 1):
        return "cusp" if at(0, 3) else "swallowtail" if at(0, 4) else "degenerate"
    return _beaks_or_lips(w, sign_of) if at(0, 3) else "degenerate"


def _beaks_or_lips(w: Jet, sign_of: Callable[[Any], int]) -> str:
    """By the Hessian of w_t, whose half is 3 w_03 t^2 + 2 w_12 u t + w_21 u^2."""
    third, mixed, slope = (w.coefficient(key) for key in ((0, 3), (1, 2), (2, 1)))
    definite = sign_of(third * slope * 3 - mixed * mixed)
    return "lips" if definite > 0 else "beaks" if definite < 0 else "degenerate"
