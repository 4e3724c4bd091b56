"""A model as JavaScript: the kernels that fly it in a browser, its recurrence, and its numbers.

The kernels are those of `flights`, translated; every model is flown by its Taylor recurrence there, linear ones too.
"""

from __future__ import annotations

import inspect
import json
from typing import Any

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, names_in, negate, number, substitute
from singimpact.algebra.numbers import as_float
from singimpact.codegen import radii
from singimpact.codegen.javascript import formula, translated
from singimpact.codegen.scalar import scalar
from singimpact.flights.horizons import horizon_of, reach_of
from singimpact.flights.kernels import roots, steps, taylor
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import numbers_of_flow, recurrence_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.rebound import rho_of

KERNELS = (radii, roots, steps, taylor)
BOUND = {
    "step_size": "step_size_of_discs",
    "singular_part": "singular_part_of_discs",
    "restart": "state_kept",
    "quiet": "quiet_in_steps",
}
"""What `flights.bind` puts in the places of functions of linear models."""
GIVEN = "given"
USED = ("coefficients", "taylor_flight", "follow", "rebound", "constants_of", "law_of")
"""The entry points that the page calls."""


def model_in_javascript(osc: Oscillator) -> str:
    """The kernels, the recurrence of f and g, the rebound law and `MODEL`, the numbers, as one text.

    Examples
    --------
    >>> text = model_in_javascript(Oscillator("x", "cos(w*t)", 0, "1/2", {"w": 2}))
    >>> [line for line in text.splitlines() if line.startswith("const constants_of")]
    ['const constants_of = (given) => [given["w"], (-1 * given["w"]), 1];']
    """
    flow = recurrence_of(osc)
    functions: dict[str, str] = {}
    for module in KERNELS:
        functions |= translated(inspect.getsource(module))
    functions |= translated(flow.source, ("coefficients", "disc"))
    text, law = _rebound(osc)
    values = {name: as_float(value) for name, value in osc.parameters.items()}
    model = {
        "parameters": values,
        "numbers": numbers_of_flow(osc, flow).tolist(),
        "rows": flow.rows,
        "order": degree_for(2.0**-52),
        "safety": LIMITS.safety,
        "budget": LIMITS.steps,
        "horizon": horizon_of(osc, None),
        "reach": reach_of(osc),
        "period": None if osc.period is None else as_float(osc.period),
        "clearance": as_float(osc.clearance),
        "r": as_float(osc.slope_at_rest()),
        "r_moves": not names_in(osc.restitution),
    }
    # in a scope of their own: the page has functions of the same names
    return "\n".join(
        [
            f"const {{ {', '.join(USED)} }} = (() => {{",
            *functions.values(),
            text,
            *(f"const {name} = {other};" for name, other in BOUND.items()),
            f"const constants_of = ({GIVEN}) => [{_formulas(flow.constants)}];",
            law,
            f"return {{ {', '.join(USED)} }};",
            "})();",
            as_script("MODEL", model),
        ]
    )


def _rebound(osc: Oscillator) -> tuple[str, str]:
    """The function `rebound`, and its constants with r = -rho'(0) for parameters and for r of the slider."""
    if not names_in(osc.restitution):
        text = "function rebound(velocity, w) {\n  return Math.abs(w[0] * velocity);\n}"
        return text, f"const law_of = ({GIVEN}, r) => ({{ w: [r], r }});"
    source, trees = scalar(rho_of(osc.restitution), "v", "rebound")
    slope = formula(negate(substitute(derivative(osc.restitution, "v"), {"v": number(0)})), GIVEN)
    return translated(source)["rebound"], f"const law_of = ({GIVEN}) => ({{ w: [{_formulas(trees)}], r: {slope} }});"


def _formulas(trees: tuple[Expression, ...]) -> str:
    return ", ".join(formula(tree, GIVEN) for tree in trees)


def as_script(name: str, value: Any) -> str:
    """A constant of the page; no text of a model ends the script early."""
    return f"const {name} = {json.dumps(value, separators=(',', ':'))};".replace("</", "<\\/")
