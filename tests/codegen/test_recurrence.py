"""The emitted recurrence: same coefficients on doubles and on mpf, no constants inside, one text a structure."""

from __future__ import annotations

import re

import mpmath
import pytest

from singimpact.algebra.parsing import parse
from singimpact.codegen.over_lists import FUNCTIONS
from singimpact.codegen.recurrence import recurrence
from singimpact.flights.bind import over_lists
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.kernels.state import Work
from singimpact.impact_oscillator import ImpactOscillator


@pytest.mark.parametrize(
    "force",
    ["x**5", "x**(-2)", "(2 + x)**(1/3)", "exp(x)*xdot", "sin(x**2)", "cos(x)", "tan(x)", "tanh(x*xdot)", "log(x + 3)",
     "atan(x)", "sqrt(x + 2)", "x**xdot"],
)  # fmt: skip
def test_coefficients_solve_the_equation(force: str) -> None:
    """x'' + f = g at small times, with x from the coefficients and f from its definition."""
    made = recurrence(parse(force, ["x", "xdot"]), parse("sin(2*t) + t**2", ["t"]))
    with mpmath.workdps(60):
        functions = {name: getattr(mpmath, {"log": "ln"}.get(name, name)) for name in FUNCTIONS}
        space = over_lists(made.source)(functions)
        from singimpact.algebra.numbers import as_mpf

        p = [mpmath.mpf("0.7"), *(as_mpf(tree, mpmath.mp) for tree in made.constants)]
        order, h = 24, mpmath.mpf("0.001")
        zero = mpmath.mpf(0)
        X, W = [zero] * (order + 1), [[zero] * (order + 1) for _ in range(made.rows)]
        space["coefficients"]([mpmath.mpf("0.3")], 0, 0, mpmath.mpf("0.2"), 0, order, p, Work(X, W, []))
        x, xdot, xddot = (sum(X[k] * mpmath.ff(k, d) * h ** (k - d) for k in range(d, order + 1)) for d in range(3))
        t = mpmath.mpf("0.3") + h
        names = {**functions, "sqrt": mpmath.sqrt, "mpf": mpmath.mpf, "x": x, "xdot": xdot}
        pull = eval(force.replace("1/3", "mpf(1)/3"), names)
        assert abs(xddot + pull - mpmath.sin(2 * t) - t**2) < mpmath.mpf(10) ** -50


def test_the_text_holds_no_broken_constant() -> None:
    made = recurrence(parse("x/3 + 0.1*xdot + 0.3*x**3", ["x", "xdot"]), parse("cos(1.7*t)", ["t"]))
    assert set(re.findall(r"\d+\.\d+", made.source)) <= {"0.0", "1.0"}


def test_models_of_one_structure_share_a_text() -> None:
    one, two = (
        ImpactOscillator("x + k*x**3", "cos(w*t)", c, r, {"k": k, "w": w})
        for c, r, k, w in ((0, 1, 0.3, 1), (0.2, 0.5, 7, "sqrt(2)"))
    )
    assert compiled_model(one).recurrence.machine is compiled_model(two).recurrence.machine
