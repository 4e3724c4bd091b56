"""First hits of any model by the fixed steps of `graded_steps`: its acceleration as a plain compiled function.

The layers of a model are not known here, so the steps are graded by the rate of the motion alone.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, subtract
from singimpact.algebra.numbers import as_float
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import EVERYWHERE, Motion
from singimpact.bench.truth.programs import Program
from singimpact.oscillator.model import Oscillator

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "atan", "tanh")


@lru_cache(maxsize=8)
def motion(osc: Oscillator, rate: float, above: bool = False) -> Motion:
    """The model as `graded_steps.first_hit` flies it.

    Parameters
    ----------
    rate : 1/time; a step is at most fineness/rate. above : from the upper wall, in -x.

    Raises
    ------
    TypeError : f or g holds an algebraic number that is given as a root.

    Examples
    --------
    >>> falling = motion(Oscillator("0", "-2", 0, "1/2"), 1.0)
    >>> round(graded_steps.first_hit(falling, 0.0, 3.0, 30.0).flight_time, 12)
    3.0
    """
    space: dict[str, Any] = {name: getattr(math, name) for name in FUNCTIONS}
    exec(compile(text(osc, above), "<acceleration>", "exec"), space)
    gap = math.inf if osc.upper is None else as_float(subtract(osc.upper, osc.clearance))
    wall = -as_float(osc.upper) if above and osc.upper is not None else as_float(osc.clearance)
    layers = np.array([[EVERYWHERE, 0.0, 1 / rate, 0.0, 0.0]])
    return Motion(graded_steps.compiled(space["acceleration"]), np.zeros(1), layers, wall, gap)


def text(osc: Oscillator, above: bool = False) -> str:
    """The source of g - f in doubles, one operation a line; or with `above` that of (-x)''.

    Examples
    --------
    >>> print(text(Oscillator("x/2", "1", 0, "1/2")), end="")
    def acceleration(t, x, xdot, p):
        s0 = 1.0
        s1 = 0.5
        s2 = x
        s3 = s1 * s2
        return s0 - s3
    """
    lines, (g, f) = _written([osc.forcing(), osc.force()])
    turned, ends = (["    x, xdot = -x, -xdot"], (f, g)) if above else ([], (g, f))
    return "\n".join(["def acceleration(t, x, xdot, p):", *turned, *lines, f"    return s{ends[0]} - s{ends[1]}", ""])


def rebound(osc: Oscillator) -> Callable[[float], float]:
    """rho of the lower wall as a plain Python function of the velocity before the impact.

    Examples
    --------
    >>> rebound(Oscillator("x", "cos(t)", 0, "-v/2"))(-0.75)
    0.375
    """
    lines, (result,) = _written([osc.rho()])
    space: dict[str, Any] = {name: getattr(math, name) for name in FUNCTIONS}
    source = "\n".join(["def rho(v):", *lines, f"    return s{result}", ""])
    exec(compile(source, "<rebound>", "exec"), space)
    return space["rho"]  # type: ignore[no-any-return]


def _written(trees: Sequence[Expression]) -> tuple[list[str], tuple[int, ...]]:
    """Assignments s0 = ..., s1 = ..., and the places of the results."""
    program = Program.of(trees)
    lines = [f"    s{place} = {_operation(kind, parts)}" for place, (kind, parts) in enumerate(program.operations)]
    return lines, program.results


def _operation(kind: str, parts: tuple[Any, ...]) -> str:
    if kind in ("+", "*"):
        return f"s{parts[0]} {kind} s{parts[1]}"
    if kind == "name":
        return str(parts[0])
    if kind == "number":
        return repr(math.pi if parts[0] is None else float(parts[0]))
    return _power(f"s{parts[0]}", parts[1]) if kind == "power" else f"{kind}(s{parts[0]})"


def _power(base: str, exponent: Fraction) -> str:
    if exponent.denominator > 1:
        return f"{base} ** {float(exponent)!r}"
    product = " * ".join([base] * abs(exponent.numerator)) if abs(exponent.numerator) <= 8 else f"{base} ** {exponent}"
    return f"1 / ({product})" if exponent < 0 and abs(exponent.numerator) <= 8 else product
