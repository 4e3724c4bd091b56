"""The source that `generated/` holds: formulas in the jets of a contact, free of any model."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from singimpact.algebra.jets import Jet
from singimpact.codegen.formulas import function_source, module_source
from singimpact.contact.contact import NAMED_ORDERS
from singimpact.theory.sheet import generic_sheet

ORDER = 6  # total degree of what is frozen: one digit of v_c per third of a decade in t, and a file that can be read
PLACES = ("generic", "tangency", "swan")
COMMAND = "python derivations/freeze.py"


def velocity_source(name: str, jet: Jet, names: tuple[str, ...], says: str) -> str:
    """The source of a jet in (sigma, t) over symbols or rationals; parameters that do not occur are left out."""
    terms = {key: _coefficient(value) for key, value in jet.terms.items()}
    used = [n for n in range(len(names)) if any(key[n] for part in terms.values() for key in part)]
    short = {
        key: {tuple(exponents[n] for n in used): value for exponents, value in part.items()}
        for key, part in terms.items()
    }
    return function_source(name, ("sigma", "t"), [names[n] for n in used], short, says)


def _coefficient(value: Any) -> dict[tuple[int, ...], Fraction]:
    if isinstance(value, Fraction):
        return {(): value}
    return {tuple(map(int, key)): Fraction(int(c.p), int(c.q)) for key, c in value.to_dict().items()}


def sheet_module(order: int = ORDER) -> str:
    """v_c and the impact velocity at a regular point, a tangency and a swan, as one file."""
    functions = []
    for place in PLACES:
        made = generic_sheet(NAMED_ORDERS[place], order)
        names = made.contact.ring.names
        for name, jet, what in (("v_c", made.v, "Launch"), ("xdot_c", made.xdot, "Impact")):
            says = f"{what} velocity at a {place} point, to total degree {order} in (sigma, t)."
            functions.append(velocity_source(f"{name}_{place}", jet, names, says))
    return module_source("v_c and the impact velocity as functions of (sigma, t) and the jets.", COMMAND, functions)
