"""The kernels bound to numbers: compiled for doubles, or as they stand over lists of floats, mpf or balls.

The kernels are ordinary modules.  Binding puts their functions into one namespace, where those that depend on the
flow (`IN_STEPS`, coefficients, restart and bounds) and the rebound law are those of the model at hand.  Only the
recurrence of f and g and an expression for rho are emitted as text.  Compiled kernels call both at an address, so that
they are compiled once for all models: those of linear ones, and those of models that are flown in Taylor steps.
"""

from __future__ import annotations  # and of the kernels, whose text is compiled here

import ast
import inspect
import math
import types
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

from singimpact.codegen import radii
from singimpact.codegen.over_lists import FUNCTIONS, nested
from singimpact.flights.kernels import (
    batch,
    batch_isolate,
    batch_refine,
    batch_response,
    chatter,
    double_double,
    entries,
    gamma,
    hits,
    layout,
    linear,
    orbits,
    recurrence,
    refine,
    roots,
    state,
    steps,
    tables,
    tabulated,
    taylor,
    variational,
    waves,
)
from singimpact.generated import completion

MODULES = (radii, state, double_double, waves, roots, linear, steps, taylor, tables, tabulated, variational,
           recurrence, refine, hits, orbits, gamma, completion, chatter, batch_isolate, batch_refine, batch_response,
           batch, layout, entries)  # fmt: skip
COMPILED = (batch_isolate, batch_refine, batch_response, batch, recurrence)
"""Modules that are never run over lists."""
IN_STEPS = {"step_size": "step_size_of_discs", "singular_part": "singular_part_of_discs",
            "next_hit": "next_hit_in_steps", "placed": "placed_in_steps", "quiet": "quiet_in_steps"}  # fmt: skip
"""Functions of linear models, and what stands in their places for models without a closed form."""
LAW, RECURRENCE = "law", "recurrence_entry"
"""What kernels call at an address."""
ADDRESSES = 8
"""Arguments of an entry: sizes, model, scratch, tau, v, w, out, status."""


@dataclass(frozen=True)
class Emitted:
    """The text that a model adds to the kernels; what is compiled together is one text, or kernels without any.

    Parameters
    ----------
    flow : of the recurrence of f and g, with its bounds; empty for a linear model.
    rho : of `law(velocity, w)`; empty for a constant restitution.
    steps : kernels alone, of models that are flown in Taylor steps.
    """

    flow: str = ""
    rho: str = ""
    steps: bool = False

    @property
    def texts(self) -> tuple[str, str, str]:
        """The texts that tell it from others."""
        return self.flow, self.rho, "steps" if self.steps else ""

    @property
    def entries(self) -> tuple[str, ...]:
        """The entries to compile, in this order."""
        if self.rho or self.flow:
            return (LAW,) if self.rho else (RECURRENCE,)
        return ("taylor_entry", "judge_entry") if self.steps else ("linear_entry", "batch_entry", "search_entry")


def functions_of(module: types.ModuleType) -> dict[str, Callable[..., Any]]:
    return {name: part for name, part in vars(module).items()
            if isinstance(part, types.FunctionType) and part.__module__ == module.__name__}  # fmt: skip


def constants() -> dict[str, Any]:
    """Named tuples and numbers of the kernel modules; one name has one meaning in all of them."""
    from cmath import sqrt as complex_sqrt

    found: dict[str, Any] = {"complex_sqrt": complex_sqrt, "inf": math.inf, "nan": math.nan, "Any": Any}
    for module in MODULES:
        for name, part in vars(module).items():
            if name.isupper() or (isinstance(part, type) and issubclass(part, tuple)):
                assert found.setdefault(name, part) is part or found[name] == part, name
    return found


@lru_cache(maxsize=64)
def over_lists(flow: str, rho: str = "", exact_restart: bool = True) -> Callable[[Any], dict[str, Any]]:
    """A function that gives the namespace of the kernels over lists, for a table of functions of one number.

    Parameters
    ----------
    flow, rho : see `Emitted`. exact_restart : a linear flow restarts from its closed form, which is for doubles only.

    Examples
    --------
    >>> space = over_lists("")({name: getattr(math, name) for name in FUNCTIONS})
    >>> space["first_root"]([2.0, -2.0], 1, 3.0, 0.0, 1e-16)[:2]
    (1, 1.0)
    """
    codes = [_nested_code(module) for module in MODULES if module not in COMPILED]
    emitted = [compile(nested(ast.parse(text)), "<emitted>", "exec") for text in (flow, rho) if text]

    def space(functions: dict[str, Any]) -> dict[str, Any]:
        namespace: dict[str, Any] = {**constants(), **functions}
        for code in codes:
            exec(code, namespace)
        for code in emitted:
            exec(code, namespace)
        if flow or not exact_restart:
            namespace |= {"restart": namespace["state_kept"], "quiet": namespace["quiet_in_steps"]}
        if flow:
            namespace |= {name: namespace[other] for name, other in IN_STEPS.items()}
        return namespace

    return space


@lru_cache(maxsize=1)
def floats_of() -> dict[str, Any]:
    """Functions of Python's floats that return inf and nan where compiled ones do, and raise nothing."""
    functions: dict[str, Any] = {name: getattr(math, name) for name in FUNCTIONS}
    functions["exp"] = lambda x: math.exp(x) if not x > 709.78 else math.inf
    functions["log"] = lambda x: math.log(x) if x > 0 else math.nan
    functions["log1p"] = lambda x: math.log1p(x) if x > -1 else math.nan
    functions["expm1"] = lambda x: math.expm1(x) if not x > 709.78 else math.inf
    functions["sinh"] = lambda x: math.sinh(x) if abs(x) < 710.47 else x * math.inf
    for name in ("sin", "cos", "tan"):
        functions[name] = partial(_circular, functions[name])
    return functions


def _circular(function: Callable[[float], float], x: float) -> float:
    return function(x) if -math.inf < x < math.inf else math.nan


def _power_of_floats(w: float, q: float) -> float:
    """`radii.real_power` of floats; Python raises where the power is too large for a double."""
    try:
        return float(radii.real_power(w, q))
    except OverflowError:
        return math.copysign(math.inf, w) if q % 2 == 1 else math.inf


@lru_cache(maxsize=64)
def over_mpmath(context: Any, flow: str = "", exact_restart: bool = True) -> dict[str, Any]:
    """The kernels over numbers of an mpmath context, at the precision of the context."""
    return over_lists(flow, "", exact_restart)(
        {name: getattr(context, {"log": "ln"}.get(name, name)) for name in FUNCTIONS}
    )


@lru_cache(maxsize=64)
def over_floats(flow: str = "", rho: str = "") -> dict[str, Any]:
    """The kernels on Python's floats and lists of lists, never compiled."""
    made = over_lists(flow, rho)(floats_of())
    made["real_power"] = _power_of_floats
    return made


@lru_cache(maxsize=64)
def _nested_code(module: types.ModuleType) -> Any:
    """The functions of a kernel module, with a[i][j] for a[i, j]: lists of lists are faster than arrays here."""
    tree = ast.parse(inspect.getsource(module))
    tree.body = [part for part in tree.body if isinstance(part, ast.FunctionDef) and not part.name.endswith("_entry")]
    return compile(nested(tree), str(module.__file__), "exec")
