"""Numbers of a model that can move, also those that the model does not name."""

from collections.abc import Collection
from typing import Any

from singimpact.algebra.expressions import Call, Expression, Name, Product, Sum, add, multiply, names_in, number
from singimpact.algebra.numbers import as_float
from singimpact.inputs import InputError, unknown
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import common_period, moving_in_time

CLEARANCE, RESTITUTION = "clearance", "restitution"
# Numbers of the second wall
UPPER = ("upper", "upper_restitution")
# Numbers of `si.linear` that a model leaves out at these values
LINEAR = {"amplitude": 1, "damping": 0, "stiffness": 1, "phase": 0}


def with_number(osc: Oscillator, name: str) -> Oscillator:
    """A model that has a number among its fields and parameters.

    Parameters
    ----------
    name : "clearance", "restitution" (of two walls "upper", "upper_restitution" too), a parameter; "amplitude" (a
        factor of g) or "damping" (a term damping*xdot in f) of any model; "stiffness" or "phase" of one with the term x
        in f or the wave cos(rate*t) for g.

    Raises
    ------
    InputError : the model has no such number, or none can be put in.

    Examples
    --------
    >>> with_number(Oscillator("x", "cos(2*t)", 0, 1), "amplitude")
    Oscillator(f='x', g='amplitude*cos(2*t)', clearance='0', restitution='1', parameters={'amplitude': '1'})
    """
    if name == RESTITUTION and "v" in names_in(osc.restitution):
        raise InputError(
            "over = 'restitution': the restitution of this model is a law in v; give one of its parameters"
        )
    own = [CLEARANCE, RESTITUTION, *(UPPER if osc.upper is not None else ()), *osc.parameters]
    if name in own:
        return osc
    if name not in LINEAR:
        error = unknown("number of the model", str(name), [*own, *LINEAR])
        raise InputError(
            f"{error}; a number in f or g has a name if it is a parameter, cos({name}*t) with {{'{name}': 2}}"
        )
    letter, f, g = Name(name), osc.f, osc.g
    if name == "amplitude":
        g = multiply(letter, g)
    elif name == "damping":
        f = add(f, multiply(letter, Name("xdot")))
    elif name == "stiffness":
        f = add(f, multiply(add(letter, number(-1)), Name("x")))
    else:
        g = _shifted(g, letter)
    fields: dict[str, Any] = {**osc.to_dict(), "f": f, "g": g}
    return type(osc)(**{**fields, "parameters": {**osc.parameters, name: LINEAR[name]}})


def value_of(osc: Oscillator, name: str) -> float:
    """A number of a model as a double; nan where it has none of that name.

    Examples
    --------
    >>> value_of(Oscillator("w**2*x", "cos(t)", "0.3", 1, {"w": 2}), "w")
    2.0
    """
    fields = {CLEARANCE: osc.clearance, RESTITUTION: osc.restitution, **osc.parameters}
    if osc.upper is not None:
        fields |= dict(zip(UPPER, (osc.upper, osc.upper_restitution), strict=True))
    return as_float(fields[name]) if name in fields else float("nan")


def period_over(osc: Oscillator, names: Collection[str]) -> Expression | None:
    """The period of a model in which some numbers are letters; None where it is not known how it depends on them.

    Examples
    --------
    >>> print(period_over(Oscillator("x + sin(w*t)*x**2", "cos(2*w*t)", 0, 1, {"w": 3}), ["w"]))
    2*pi/w
    """
    moving = moving_in_time(osc.force(names), osc.forcing(names))
    if not any(names_in(tree).intersection(names) for tree in moving.values()):
        return osc.period
    return common_period(*moving.values())


def _shifted(g: Any, letter: Name) -> Any:
    """g with a phase added to the arguments of its waves."""
    match g:
        case Sum(parts):
            return add(*(_shifted(term, letter) for term in parts))
        case Product(parts):
            return multiply(*(_shifted(term, letter) for term in parts))
        case Call(function, argument) if "t" in names_in(argument):
            return Call(function, add(argument, letter))
    return g
