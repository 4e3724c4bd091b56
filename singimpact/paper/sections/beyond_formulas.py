"""Beyond the paper: the formulas that its own steps give and that it does not state."""

from typing import Any

import sympy

from singimpact.paper.claims.beyond import hertz
from singimpact.paper.claims.beyond.every_order import j
from singimpact.paper.claims.beyond.foot import FORMULA
from singimpact.paper.claims.beyond.loops import inner, preimage, r
from singimpact.paper.routes import first_order, unfolding as swan
from singimpact.theory.notation import latex

NAMES = {
    first_order.first: sympy.Symbol("a_j"),
    first_order.second: sympy.Symbol("a_{j+1}"),
    first_order.damping: sympy.Symbol("f_{01}"),
    first_order.A2: sympy.Symbol("a''"),
    first_order.A3: sympy.Symbol("a'''"),
}


def beyond() -> dict[str, object]:
    """The formulas of the section, by their names in its template; those that its words write out are checked."""
    _check_hertz()
    _check_foot()
    return {
        "r": r,
        **_first_order(),
        "inner": inner(),
        "preimage": preimage(),
        "flight": _flight(),
    }


def _shown(expression: sympy.Expr) -> str:
    """LaTeX of an expression in the letters of this section."""
    return latex(expression).replace("{{", "{").replace("}}", "}").replace("chi", r"\chi")


def _first_order() -> dict[str, str]:
    change, moved = first_order.removal(), first_order.swan_removal()
    alpha = sympy.factor((change.time / first_order.s**2).subs(NAMES))
    shift = (first_order.damping + 2 * first_order.A3 / (3 * first_order.A2)).subs(NAMES)
    same = sympy.cancel(10 * moved.time / (first_order.s**2 - 1)).subs(NAMES)
    if sympy.cancel(same - shift) != 0:
        raise ArithmeticError("chi is not what the change of time says")
    return {"alpha": _shown(alpha), "chi": _shown(shift), "foot_shift": _shown(first_order.shift())}


def _check_hertz() -> None:
    q = hertz.q
    printed = (
        3 * (1 - q) / (2 * (3 + (2 + q) * j)),
        q * (3 + (2 + q) * j) * (3 + (1 + 2 * q) * j) / (3 * (1 - q) * (3 + 2 * j + 2 * j * q - j * q**2)),
    )
    if any(sympy.cancel(one - other) != 0 for one, other in zip((hertz.FACTOR, hertz.SECOND), printed, strict=True)):
        raise ArithmeticError("a constant of gamma is not the one that is printed")


def _check_foot() -> None:
    formula = FORMULA.subs(sympy.Symbol("w"), sympy.Symbol("u"))
    if sympy.expand(formula**7 - sympy.Rational(14, 3) ** 3 * sympy.Symbol("u") ** 3 / 144) != 0:
        raise ArithmeticError("the limit is not the one that is printed")


def _flight() -> Any:
    """The height of the hop from A at a negative swan, in s from the middle of A and B."""
    height = swan.height(swan.u).subs({swan.sigma: -1, swan.t: 4, swan.kappa: -sympy.Rational(1, 24)})
    return sympy.factor(height.subs(swan.u, swan.s + 1))
