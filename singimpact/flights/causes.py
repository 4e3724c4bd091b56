"""Why a flight is not decided: the codes of the kernels as causes, and where the flight came to, in words."""

from math import log2
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Call, Expression, Number, Power, evaluate, substitute
from singimpact.algebra.numbers import Array, as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.kernels.state import ACROSS
from singimpact.flights.model_numbers import recurrence_of
from singimpact.oscillator.model import Oscillator
from singimpact.status import Cause, Status

# The codes of `march` that are no statuses
ENDED = {5: Cause.near_graze, 21: Cause.step_budget, 22: Cause.domain_left, 23: Cause.overflow}


def decoded(codes: Array) -> tuple[Array, Array]:
    """Statuses and causes of the codes that a kernel returns, at either wall.

    Examples
    --------
    >>> [part.tolist() for part in decoded(np.array([0, 3, 5, 22]))]
    [[0, 3, 5, 5], [0, 0, 1, 3]]
    """
    codes = np.where(codes >= ACROSS, codes - ACROSS, codes)
    status, cause = codes.astype(np.int8), np.zeros(codes.shape, dtype=np.int8)
    for code, name in ENDED.items():
        cause[codes == code] = name
    status[codes > 20] = Status.unresolved
    return status, cause


def where(osc: Oscillator, tau: float, numbers: Array) -> str:
    """Where a flight came to: time since the launch, phase, x and x'.

    Parameters
    ----------
    numbers : time, x', x - c at the end of the flight, as `march` returns them.
    """
    time, speed, height = (float(value) for value in numbers[:3])
    at = tau + time
    phase, x = "", as_float(osc.clearance) + height
    if osc.period is not None:
        phase = f", phase {at % as_float(osc.period):.12g} of {as_float(osc.period):.6g}"
    return f"t = {at:.12g} ({time:.6g} after the launch{phase}), x = {x:.6g}, x' = {speed:.6g}"


def explained(osc: Oscillator, tau: float, numbers: Array, cause: Cause, path: Any) -> tuple[Cause, str]:
    """The cause of an undecided flight in finer classes, and a clause that names the time that the flight reached.

    Parameters
    ----------
    tau : of the launch. numbers : time, x', x - c, and which part of f or g is singular next to that, as `march`
        returns them. path : gives (x, x') at an array of times since the launch.
    """
    clock = where(osc, tau, numbers)
    if cause != Cause.domain_left:
        return cause, f"the flight came to {clock}"
    suspects = recurrence_of(osc).suspects
    index = int(numbers[3])
    if not 1 <= index <= len(suspects):
        return cause, f"x' grows beyond every bound near {clock}"
    operation = suspects[index - 1]
    crossed = _crossed(osc, operation, tau, float(numbers[0]), path)
    if crossed == "touches":
        return Cause.kink, f"{operation} has a kink at {clock}"
    if crossed == "steep":
        return Cause.kink, f"{operation} changes within less than a rounding of time at {clock}"
    return cause, f"{operation} is singular at {clock}"


def _crossed(osc: Oscillator, operation: Expression, tau: float, time: float, path: Any) -> str:
    """The way in which the argument of a root, power or logarithm meets 0: "touches", "crosses"; else "steep"."""
    match operation:
        case Power(base, _):
            argument: Expression = base
        case Call(name, inner) if name in ("sqrt", "log"):
            argument = inner
        case Call("tan", _):
            return "crosses"
        case _:
            return "steep"
    if not _is_root(operation) or time == 0:
        return "crosses"
    before = 1e-5 * min(time, 1.0) * np.array([1.0, 2.0])
    x, xdot = path(time - before)
    tree = substitute(argument, osc.parameters)
    with np.errstate(all="ignore"):
        sizes = np.abs(evaluate(tree, {"x": x, "xdot": xdot, "t": tau + time - before}, DOUBLES) + 0 * x)
    # a simple zero falls by half where the distance does, a double one by three quarters
    return "touches" if bool(sizes[0] > 0) and log2(sizes[1] / sizes[0]) > 1.5 else "crosses"


def _is_root(part: Expression) -> bool:
    match part:
        case Power(_, Number(exponent)):
            return exponent > 0
        case Call("sqrt", _):
            return True
    return False
