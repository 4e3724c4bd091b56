"""First hits of any model by the fixed steps of `graded_steps`: its acceleration as a plain compiled function.

The layers of a model are not known here, so the steps are graded by the rate of the motion alone.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, evaluate, names_in, subtract
from singimpact.algebra.numbers import as_float
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import EVERYWHERE, Motion
from singimpact.oscillator.model import Oscillator

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "atan", "tanh", "log1p")


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
    gap = math.inf if osc.upper is None else as_float(subtract(osc.upper, osc.clearance))
    wall = -as_float(osc.upper) if above and osc.upper is not None else as_float(osc.clearance)
    layers = np.array([[EVERYWHERE, 0.0, 1 / rate, 0.0, 0.0]])
    acceleration = python_function("acceleration", text(osc, above))
    return Motion(graded_steps.compiled(acceleration), np.zeros(1), layers, wall, gap)


def text(osc: Oscillator, above: bool = False) -> str:
    """The source of g - f in doubles; or with `above` that of (-x)''.

    Examples
    --------
    >>> print(text(Oscillator("x/2", "1", 0, "1/2")), end="")
    def acceleration(t, x, xdot, p):
        return 1.0 - ((0.5) * (x))
    """
    f, g = source(osc.force()), source(osc.forcing())
    # from the upper wall x and x' change their signs, and so does the acceleration
    turned, result = ("    x, xdot = -x, -xdot\n", f"{f} - ({g})") if above else ("", f"{g} - ({f})")
    return f"def acceleration(t, x, xdot, p):\n{turned}    return {result}\n"


def rebound(osc: Oscillator) -> Callable[[float], float]:
    """rho of the lower wall as a plain Python function of the velocity before the impact.

    Examples
    --------
    >>> rebound(Oscillator("x", "cos(t)", 0, "-v/2"))(-0.75)
    0.375
    """
    return python_function("rho", f"def rho(v):\n    return {source(osc.rho())}\n")


def python_function(name: str, text: str) -> Callable[..., float]:
    """The function that a Python text defines; the names of `FUNCTIONS` in it are those of `math`."""
    space: dict[str, Any] = {function: getattr(math, function) for function in FUNCTIONS}
    exec(compile(text, f"<{name}>", "exec"), space)
    return space[name]  # type: ignore[no-any-return]


def source(tree: Expression) -> str:
    """The Python text of an expression in doubles, with the functions of `math`.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> source(parse("x**(-1/2) + tanh(2*x)/3", ["x"]))
    '(x) ** -0.5 + (0.3333333333333333) * (tanh((2.0) * (x)))'
    """
    written: str = evaluate(tree, {name: _Text(name) for name in names_in(tree)}, _Texts()).text
    return written


@dataclass(frozen=True)
class _Text:
    """A sum as Python text; its terms need no brackets."""

    text: str

    def __add__(self, other: "_Text") -> "_Text":
        return _Text(f"{self.text} + {other.text}")

    def __mul__(self, other: "_Text") -> "_Text":
        return _Text(f"({self.text}) * ({other.text})")


class _Texts:
    """The ring of such texts."""

    def rational(self, value: Fraction) -> _Text:
        return _Text(repr(float(value)))

    def pi(self) -> _Text:
        return _Text(repr(math.pi))

    def power(self, base: _Text, exponent: Fraction) -> _Text:
        return _Text(f"({base.text}) ** {exponent if exponent.denominator == 1 else float(exponent)}")

    def call(self, function: str, argument: _Text) -> _Text:
        return _Text(f"{function}({argument.text})")

    def root(self, tree: Expression) -> _Text:
        raise TypeError(f"the root {tree} has no text in doubles")
