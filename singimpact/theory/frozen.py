"""Source of formulas in the jets of a contact, free of any model: for `generated/`, and for users."""

from collections.abc import Mapping
from fractions import Fraction
from math import factorial
from typing import Any

from singimpact.algebra.jets import Jet
from singimpact.algebra.polynomials import Exponents
from singimpact.codegen.polynomial_source import (
    Factored,
    RationalSeries,
    Unit,
    function_source,
    module_source,
    rational_series_source,
)
from singimpact.contact.contact import NAMED_ORDERS, Contact, derivative_name
from singimpact.germs import normal_form
from singimpact.theory.completion import length_weight, symbolic_completion, symbolic_curve
from singimpact.theory.impact_sheet import generic_sheet, sheet

PLACES = ("generic", "tangency", "swan")
CURVED = {"fibre": (0, 4), "gamma_tangency": (1, 5), "gamma_swan": (2, 6)}  # contact order, last power of sigma
MOVED = {"motion_tangency": (1, 4), "motion_swan": (2, 4)}
COMPLETED, OUTLINED = 4, 6
LINEAR = ("f_01", "f_10")  # the jets of f that a linear model has: damping and stiffness
HIGHEST, HIGHEST_COMPLETION = 10, 8  # of a curve with symbols: a minute
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


def sheet_functions(order: int) -> list[str]:
    """The source of both velocities at each place, to total degree `order`."""
    functions = []
    for place in PLACES:
        made = generic_sheet(NAMED_ORDERS[place], order)
        names = made.contact.ring.names
        for name, jet, what in (("v_c", made.v, "Launch"), ("xdot_c", made.xdot, "Impact")):
            says = f"{what} velocity at a {place} point, to total degree {order} in (sigma, t)."
            functions.append(velocity_source(f"{name}_{place}", jet, names, says))
    return functions


def completion_module() -> str:
    """The terms of tau_inf, of any model and of a linear one with a number for restitution: what the package runs."""
    title = "The chatter that is left, term by term."
    return module_source(title, COMMAND, [_completion(COMPLETED, apart=True, linear=part) for part in (False, True)])


def curve_functions(order: int | None = None) -> list[str]:
    """The source of each curve, to the orders that are frozen, or to `order` where symbols reach it."""
    return [
        *(_curve(name, j, _to(order, top, HIGHEST), "graph") for name, (j, top) in CURVED.items()),
        *(_curve(name, j, _to(order, top, HIGHEST - j), "motion") for name, (j, top) in MOVED.items()),
        _completion(_to(order, COMPLETED, HIGHEST_COMPLETION)),
        _completion(_to(order, COMPLETED, HIGHEST_COMPLETION), apart=True),
        _outline(_to(order, OUTLINED, HIGHEST)),
    ]


def _to(order: int | None, frozen: int, highest: int) -> int:
    return frozen if order is None else min(order, highest)


def _curve(name: str, j: int, top: int, part: str) -> str:
    symbolic = symbolic_curve(j, top if part == "graph" else top + j)
    known = getattr(symbolic, part)
    coefficients = {n: _factored(known[n].terms) for n in known if n <= top}
    what = "v on" if part == "graph" else "The next sigma on"
    says = f"{what} the {'fibre' if not j else 'curve gamma'} at contact order {j}, to sigma^{top}; r by lambda."
    series = RationalSeries("sigma", symbolic.names, coefficients, _unit(j, symbolic.names), int(part == "graph"))
    return rational_series_source(name, series, says)


def _completion(top: int, apart: bool = False, linear: bool = False) -> str:
    numerators = symbolic_completion(top)
    coefficients = {n: _factored(value.terms) for n, value in numerators.coefficients.items()}
    if linear:
        absent = [n for n, name in enumerate(numerators.names) if not name.startswith("a_") and name not in LINEAR]
        coefficients = {
            n: {key: value for key, value in terms.items() if not any(key[i] for i in absent)}
            for n, terms in coefficients.items()
        }
    series = RationalSeries("v", numerators.names, coefficients, _unit(0, numerators.names), argument=1, apart=apart)
    name, what = ("chatter_terms", "The terms of") if apart else ("chatter_limit", "")
    name, kind = (f"linear_{name}", " of a linear model") if linear else (name, "")
    says = f"{what} tau_inf - tau{kind} to v^{top}; lambda is the restitution r.".strip()
    return rational_series_source(name, series, says)


def _outline(top: int) -> str:
    contact = Contact.generic(1, top, unit=True)
    names = contact.ring.names
    offset = normal_form(sheet(contact, top).v, 2).offset
    coefficients = {
        key[0]: {exponents: Factored(content) for exponents, content in _coefficient(value).items()}
        for key, value in offset.terms.items()
    }
    series = RationalSeries("sigma", names, coefficients, _unit(1, names), 1)
    return rational_series_source("outline_tangency", series, f"v on the outline of p at a tangency, to sigma^{top}.")


def _unit(j: int, names: tuple[str, ...]) -> Unit:
    return Unit(derivative_name(j), factorial(j), {name: length_weight(name) for name in names})


def _factored(terms: Mapping[Exponents, tuple[Any, Any]]) -> dict[Exponents, Factored]:
    """Numerator over denominator, each an fmpq_poly in lambda, by factors that begin with a positive number."""
    products = {}
    for key, (above, below) in terms.items():
        content, factors = Fraction(1), {}
        for poly, sign in ((above, 1), (below, -1)):
            constant, parts = poly.factor()
            content *= Fraction(int(constant.p), int(constant.q)) ** sign
            for factor, power in parts:
                whole = tuple(int(c.p) for c in factor.coeffs())
                if whole[0] < 0:
                    whole, content = tuple(-c for c in whole), content * (-1) ** power
                factors[whole] = sign * int(power)
        products[tuple(map(int, key))] = Factored(content, factors)
    return products
