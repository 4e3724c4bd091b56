"""The series of the theory as text, for generic symbols or for a model: sympy, or numpy source that runs by itself."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from singimpact.codegen.formulas import Coefficient, Exponents, function_source, module_source
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.theory import chatter_limit, dynamics_on_gamma, gamma, v_c
from singimpact.theory.frozen import sheet_module

FORMS = ("sympy", "numpy")


def series_text(order: int, form: str, model: Oscillator | None = None) -> str:
    """v_c, gamma, the motion on it and tau_inf to an order, one assignment or one function each.

    Parameters
    ----------
    order : int >= 2. form : "sympy" or "numpy". model : without one, symbols stand for the jets.

    Examples
    --------
    >>> print(series_text(2, "sympy").splitlines()[1])
    v_c_tangency = -a_d1*sigma*t/2 - a_d1*t**2/6
    """
    if form == "sympy":
        return "".join(f"{name} = {value}\n" for name, value in _expressions(order, model).items())
    if model is None:
        return sheet_module(order)
    return module_source(f"Series of {model!r}.", "singimpact derive", _functions(order, model))


def _expressions(order: int, model: Oscillator | None) -> dict[str, Any]:
    if model is None:
        shown = {f"v_c_{name}": v_c(order, name) for name in ("generic", "tangency", "swan")}
        return {**shown, "gamma": gamma(order).as_expr(), "chatter_limit": chatter_limit(min(order, 6)).as_expr()}
    shown = {"v_c_tangency": v_c(order, "tangency", model), "gamma": gamma(order, model=model).as_expr()}
    return {**shown, "dynamics_on_gamma": dynamics_on_gamma(order, model=model).as_expr()}


def _functions(order: int, model: Oscillator) -> list[str]:
    import sympy

    sigma, t = sympy.symbols("sigma t")
    made = []
    for name, value in _expressions(order, model).items():
        letters = (sigma, t) if name.startswith("v_c") else (sigma,)
        terms: dict[Exponents, Coefficient] = {
            tuple(map(int, key)): {(): _ratio(c)} for key, c in sympy.Poly(value, *letters).terms()
        }
        says = f"{name} to order {order}; coefficients to 30 digits or exact."
        made.append(function_source(name, [str(letter) for letter in letters], (), terms, says))
    return made


def _ratio(value: Any) -> Fraction:
    """A coefficient as a rational: a decimal of its digits when it is not one."""
    import sympy

    if value.free_symbols:
        raise InputError("numpy source needs numbers: a coefficient of this series has symbols")
    if value.is_Rational:
        return Fraction(int(value.p), int(value.q))
    return Fraction(str(sympy.N(value, 30)))
