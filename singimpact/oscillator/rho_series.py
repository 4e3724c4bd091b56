"""The Taylor coefficients of rho at rest over any ring; a rho that is not smooth there is refused by name."""

from typing import Any

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import sign_of
from singimpact.algebra.puiseux import NoExpansion, Puiseux, expansion
from singimpact.algebra.taylor import NotSmooth
from singimpact.oscillator.model import Oscillator, not_smooth, require_smooth_rho

TASK = "a power series"


def series_of_rho(osc: Oscillator, order: int, ring: Any) -> dict[int, Any]:
    """k -> coefficient of v^k in rho, for 1 <= k <= order, those that are not 0.

    Raises
    ------
    InputError : rho has powers of v that are not whole.
    ArithmeticError : a coefficient is not in the ring.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> series_of_rho(Oscillator("x", "cos(t)", 0, "-v*cos(sqrt(-v))"), 3, EXACT)
    {1: Fraction(-1, 1), 2: Fraction(-1, 2), 3: Fraction(-1, 24)}
    """
    require_smooth_rho(osc, TASK)
    space = JetSpace(("v",), order, ring)
    try:
        jet = space.evaluate(osc.rho(), {"v": space.generators()[0]})
        return {k: value for k in range(1, order + 1) if (value := jet.coefficient((k,))) != 0}
    except NotSmooth:  # a part of the formula is not smooth, although rho is: |v|, or cos(sqrt(-v))
        terms = {int(e): c for e, c in _to(osc, order).terms if e <= order and sign_of(c)}
        return {k: (-1) ** k * evaluate(value, {}, ring) for k, value in terms.items()}


def _to(osc: Oscillator, order: int) -> Puiseux:
    """rho(-w) up to w^order; parts of the formula have roots of w, so more terms of them are needed."""
    for more in (1, 2, 4):
        try:
            found = expansion(osc.rho(), "v", -1, more * (order + 2))
        except NoExpansion:
            break
        if found.whole and (found.bound is None or found.bound > order):
            return found
    raise not_smooth(osc, TASK)
