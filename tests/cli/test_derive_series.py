"""`singimpact derive --order`: series as text that runs by itself."""

import numpy as np
import pytest
from click.testing import CliRunner

import singimpact as si
from singimpact.cli.derive import command
from singimpact.inputs import InputError


def told(*arguments):
    return CliRunner().invoke(command, list(arguments), catch_exceptions=False).output


@pytest.fixture
def model_file(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text(si.linear(2, "0.3", "0.5").to_toml())
    return str(path)


def test_sympy_for_symbols():
    assert "gamma = -a_d1*sigma**2*(lambda - 1)*(lambda + 2)/6" in told("--format", "sympy", "--order", "2")


def test_numpy_text_runs_by_itself(model_file):
    scope = {}
    exec(told("--format", "numpy", "--order", "4", "--model", model_file), scope)
    sigma = np.array([-0.1, -0.01])
    series = si.theory.gamma(order=4, model=si.linear(2, "0.3", "0.5"))
    assert scope["gamma"](sigma) == pytest.approx([float(series(s)) for s in sigma], rel=1e-14)
    assert scope["v_c_tangency"](-0.1, 0.05) > 0


def test_numpy_for_symbols_and_a_file(tmp_path):
    assert "def v_c_swan(sigma: Any, t: Any, a_d2" in told("--format", "numpy", "--order", "4")
    told("--format", "sympy", "--order", "2", "-o", str(tmp_path / "out"))
    assert (tmp_path / "out" / "series_sympy.py").read_text().startswith("v_c_generic = ")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--order", "3"], "belong to --format sympy"),
        (["--format", "sympy", "--order", "0"], "order = 0 is not accepted"),
    ],
)
def test_refusals(arguments, sentence):
    with pytest.raises(InputError, match=sentence):
        told(*arguments)
