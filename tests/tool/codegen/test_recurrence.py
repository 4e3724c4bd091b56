"""The emitted recurrence: same coefficients on doubles and on mpf, no constants inside, one text a structure."""

from __future__ import annotations

import re
from random import Random
from typing import Any

import mpmath
import pytest

from singimpact.algebra import parse
from singimpact.codegen import FUNCTIONS, recurrence
from singimpact.flights import Work, over_lists
from singimpact.flights.compiled_model import compiled_model
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.inputs import InputError


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
        from singimpact.algebra import as_mpf

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
    assert compiled_model(one).recurrences[0].machine is compiled_model(two).recurrences[0].machine


def powers(least: int, most: int) -> str:
    return "+".join(f"x**{power}" for power in range(least, most))


def test_products_of_one_pair_are_computed_once() -> None:
    """A polynomial of degree 99 had 893 rows with its derivatives."""
    text = "+".join(f"x**{power}/{power}" for power in range(2, 100))
    assert recurrence(parse(text, ["x"]), parse("0")).rows <= 300


@pytest.mark.parametrize(
    "force",
    [powers(2, 900), "*".join(["x"] * 2400), "*".join(f"(x + {k})" for k in range(500)),
     "+".join(f"sin({k}*x)" for k in range(1, 500)), "*".join(f"tanh({k}*x)" for k in range(1, 300))],
)  # fmt: skip
def test_a_recurrence_of_too_many_rows_is_refused(force: str, work_of: Any) -> None:
    tree = parse(force, ["x", "xdot"])

    def refused() -> None:
        with pytest.raises(InputError, match=r"f = .* is not accepted: give an expression with at most 600 products"):
            recurrence(tree, parse("cos(t)", ["t"]))

    assert work_of(refused) < 3_000_000


@pytest.mark.parametrize("seed", range(20))
def test_the_text_of_drawn_products_is_a_program(seed: int) -> None:
    """A product of 250 factors had 250 brackets inside each other, of which Python takes 200."""
    random = Random(seed)
    parts = ["x", "xdot", "(x + 1)", "sin(x)"]
    force = "*".join(random.choice(parts[: 1 + seed % 2]) for _ in range(random.randrange(2, 30 if seed % 2 else 280)))
    compile(recurrence(parse(force, ["x", "xdot"]), parse("t", ["t"])).source, "<emitted>", "exec")


def test_deep_trees_are_written_soon(work_of: Any) -> None:
    """Each level asked all levels below it for their names and their hashes."""
    tree = parse("(1+" * 58 + "x" + ")**2*xdot" * 58, ["x", "xdot"])
    assert work_of(lambda: recurrence(tree, parse("0"))) < 1_000_000
