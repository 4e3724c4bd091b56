"""The emitted recurrence: same coefficients on doubles and on mpf, no constants inside, one text a structure."""

from __future__ import annotations

import re

import mpmath
import numpy as np
import pytest

from singimpact import store
from singimpact.algebra.parsing import parse
from singimpact.codegen.kernels import FUNCTIONS, compiled, filed, plain
from singimpact.codegen.recurrence import recurrence
from singimpact.flights.kernel import RADII, kernel_of, source
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
        text = "\n\n".join(["from math import inf, nan", made.source, *(source(part) for part in RADII)])
        space = plain(text, functions)
        from singimpact.algebra.numbers import as_mpf

        p = [mpmath.mpf("0.7"), *(as_mpf(tree, mpmath.mp) for tree in made.constants)]
        order, h = 24, mpmath.mpf("0.001")
        X, W = np.full(order + 1, mpmath.mpf(0)), np.full((made.rows, order + 1), mpmath.mpf(0))
        space["coefficients"]([mpmath.mpf("0.3")], 0, 0, mpmath.mpf("0.2"), 0, order, p, X, W)
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
    assert kernel_of(one).text == kernel_of(two).text


def test_the_cache_folder_is_the_named_one(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path / "here"))
    path = filed("x = 1\n")
    assert path.is_relative_to(tmp_path / "here")
    assert path.read_text() == "x = 1\n"
    path.write_text("damaged")
    assert filed("x = 1\n").read_text() == "x = 1\n"
    monkeypatch.setenv("SINGIMPACT_CACHE", "off")
    assert not store.cache_folder().is_relative_to(tmp_path)


def test_the_disk_cache_serves_a_new_process() -> None:
    import subprocess
    import sys

    script = (
        "from singimpact.codegen import interpreted\n"
        "interpreted.PATIENCE = interpreted.Patience(0, 0)\n"
        "from singimpact.impact_oscillator import linear\n"
        "print(linear(2, '0.3', '0.5').impact_map(0, 1).tau)\n"
        "from singimpact.codegen.kernels import compiled\n"
        "from singimpact.flights.kernel import kernel_of\n"
        "k = kernel_of(linear(2, 0, 1))\n"
        "print(sum(compiled(k.text, k.names)['stride_all'].stats.cache_hits.values()))\n"
    )
    runs = [subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True) for _ in "ab"]
    assert runs[0].stdout.split()[0] == runs[1].stdout.split()[0]
    assert runs[1].stdout.split()[1] == "1"


def test_compiled_text_is_the_plain_text() -> None:
    text = "def half(x):\n    return x / 2\n"
    assert compiled(text, ("half",))["half"](3.0) == plain(text, {})["half"](3.0) == 1.5
