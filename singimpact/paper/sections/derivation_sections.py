"""The derivations by name.

`SECTIONS` names them in the paper's order, then what is beyond it, `OTHER_NAMES` by number and by subject; `NOTATION`
follows them.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import sympy

from singimpact.documents.document_steps import Section
from singimpact.inputs import need, unknown
from singimpact.paper.claims.beyond.order_three import HOP, RESTED
from singimpact.paper.claims.sections.section6_loops import inner, preimage, r
from singimpact.paper.routes import first_order, unfolding as swan
from singimpact.paper.sections import NOTATION
from singimpact.paper.sections.section_formulas import section2, section3, section4, section5, section6, section7
from singimpact.paper.sections.section_templates import section_of
from singimpact.theory.notation import latex

NAMES = {
    first_order.first: sympy.Symbol("a_j"),
    first_order.second: sympy.Symbol("a_{j+1}"),
    first_order.damping: sympy.Symbol("f_{01}"),
    first_order.A2: sympy.Symbol("a''"),
    first_order.A3: sympy.Symbol("a'''"),
}


def beyond() -> dict[str, object]:
    """The formulas of the section, by their names in its template; tests check those that its words write out."""
    return {"r": r, **_first_order(), "inner": inner(), "preimage": preimage(), "flight": _flight(), **_border_orbit()}


def _shown(expression: sympy.Expr) -> str:
    """LaTeX of an expression in the letters of this section."""
    return latex(expression).replace("{{", "{").replace("}}", "}").replace("chi", r"\chi")


def _first_order() -> dict[str, str]:
    change, moved = first_order.removal(), first_order.swan_removal()
    alpha = sympy.factor((change.time / first_order.s**2).subs(NAMES))
    shift = (first_order.damping + 2 * first_order.A3 / (3 * first_order.A2)).subs(NAMES)
    same = sympy.cancel(10 * moved.time / (first_order.s**2 - 1)).subs(NAMES)
    need(sympy.cancel(same - shift) == 0, ArithmeticError("chi is not what the change of time says"))
    return {"alpha": _shown(alpha), "chi": _shown(shift), "foot_shift": _shown(first_order.shift())}


def _border_orbit() -> dict[str, object]:
    """The hop, and the first terms of kappa as factors of -1, -sqrt(r) and -r."""
    return {"hop": HOP, "rested": [latex(-value) for value in RESTED]}


def _flight() -> Any:
    """The height of the hop from A at a negative swan, in s from the middle of A and B."""
    height = swan.height(swan.u).subs({swan.sigma: -1, swan.t: 4, swan.kappa: -sympy.Rational(1, 24)})
    return sympy.factor(height.subs(swan.u, swan.s + 1))


FORMULAS = (section2, section3, section4, section5, section6, section7, beyond)
SECTIONS: dict[str, Callable[[], Section]] = {
    formulas.__name__: partial(section_of, formulas.__name__, formulas) for formulas in FORMULAS
}
OTHER_NAMES = {
    "2": "section2",
    "3": "section3",
    "4": "section4",
    "5": "section5",
    "6": "section6",
    "7": "section7",
    "surface": "section2",
    "regular": "section3",
    "tangency": "section4",
    "swan": "section5",
    "unfolding": "section6",
    "loops": "section7",
}


def sections(names: Sequence[str] = ()) -> list[Section]:
    """The sections named, or all, in the paper's order, and the notation last.

    Parameters
    ----------
    names : names, numbers or subjects: ``section4``, ``4`` and ``tangency`` are one; ``notation`` stands alone.

    Raises
    ------
    InputError : an unknown name; the nearest known ones are named.
    """
    wanted = [OTHER_NAMES.get(name, name) for name in names]
    for name, name_ in zip(wanted, names, strict=True):
        if name not in (*SECTIONS, NOTATION.name):
            raise unknown("section", name_, [*SECTIONS, NOTATION.name, *OTHER_NAMES])
    return [*(build() for name, build in SECTIONS.items() if not wanted or name in wanted), NOTATION]
