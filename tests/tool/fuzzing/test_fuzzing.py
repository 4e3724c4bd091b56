"""A small run of the fuzzer, and what it has found; `python tests/tool/fuzzing/run.py` is the long run."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from singimpact import InputError, Status, claims
from singimpact.algebra import float_array, parse
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator import fields_of
from singimpact.scenes import Scene
from singimpact.theory import swan

RUN = [sys.executable, str(Path(__file__).parent / "run.py"), "--workers", "1"]


@pytest.mark.parametrize("inputs", [20, pytest.param(2000, marks=pytest.mark.slow)])
def test_no_input_is_a_fault(inputs):
    found = subprocess.run([*RUN, "--inputs", str(inputs)], capture_output=True, text=True, timeout=600)
    assert found.returncode == 0, found.stdout + found.stderr


@pytest.mark.slow
def test_the_fuzzer_sees_execution_and_tracebacks():
    script = (
        f"import sys; sys.path[:0] = [{str(Path(__file__).parent)!r}]\n"
        "import trial\n"
        "one = trial.Trial()\n"
        "one._claim = lambda text, fly: eval(text)\n"
        "told = [one.fault('claim', text) for text in ('canary()', '1/0', 'bytearray(10**9)', 'sum(range(10**9))', 'exec(\"1\")')]\n"
        "print(told[0], told[1][:17], *told[2:], sep='\\n')\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=300)
    lines = found.stdout.splitlines()
    assert len(lines) == 5, found.stderr
    assert "exec of <string>" in lines[0]
    assert all(lines)


@pytest.mark.parametrize("text", ["1e4000", "10**1000", "1" * 400, "exp(1000)"])
def test_numbers_beyond_the_doubles_are_refused(text):
    with pytest.raises(InputError, match=r"1\.8e308"):
        float_array("tau", text)


@pytest.mark.parametrize("text", ["root(exp(u*1000)-2, -900, 900)", "root(tan(u)-u, 1, 4000)", "root(sin(u), 1, 1e9)"])
def test_a_root_that_is_dear_to_isolate_is_refused(text):
    with pytest.raises(InputError, match="give closer ends"):
        parse(text)


def test_an_unexpected_token_is_shown_short():
    with pytest.raises(InputError) as found:
        parse("1" + "a" * 5000)
    assert len(str(found.value)) < 300


def test_an_integer_of_many_digits_is_not_toml():
    with pytest.raises(InputError, match="is not TOML"):
        fields_of("f = " + "9" * 5000)


@pytest.mark.parametrize("layers", [[[1]], [{}], [1]])
def test_a_layer_that_is_no_name(layers):
    with pytest.raises(InputError, match="unknown layer"):
        Scene(linear(2, 0, 1), tuple(layers), v=(0, 1))


def test_a_forcing_that_hardly_moves_does_not_keep_a_flight_busy(work_of):
    def flown():
        assert linear("1e-12", 0, "0.9", damping="0.1").impact_map(0, "0.001").status == Status.no_return

    assert work_of(flown) < 20_000_000


def test_a_restitution_whose_roots_take_hours():
    with pytest.raises(InputError, match="1e-308 <= r < 1"):
        swan("/".join(["7"] * 1000))


@pytest.mark.parametrize("g", ["exp(exp(1000))", "exp(exp(1000))*cos(t)", "cos(t) + exp(exp(1000))"])
def test_a_number_beyond_the_balls_is_not_zero(g):
    """flint's ball around such a number has its middle at 0."""
    with pytest.raises(InputError, match=r"1\.8e308|no finite number"):
        ImpactOscillator("x", g, "1", "0.5").impact_map(0.3, [0.0, 0.1], horizon=2.0)


def test_rest_where_the_forcing_is_no_number():
    model = ImpactOscillator("x", "log(t)", "1", "0.5")
    with pytest.raises(InputError, match="a_c is no finite number at tau = -1"):
        model.impact_map(-1, 0)
    assert np.isnan(model.acceleration(-1))
    for g in ("log(t)", "sqrt(t)"):
        assert np.isnan(ImpactOscillator("x", g, "1", "0.5").acceleration(-1, 1))
    assert model.impact_map(-1, 0.1, horizon=2.0).status == Status.unresolved


def test_a_large_number_within_a_function():
    assert (
        linear(1, "atan(1e3000)", "1/2").impact_map(0, 0.1).status == linear(1, "pi/2", "1/2").impact_map(0, 0.1).status
    )


def test_a_refused_root_is_shown_short():
    with pytest.raises(InputError, match="is not one zero") as found:
        parse("root(u - 1, 0, 2e-3000)")
    assert len(str(found.value)) < 500


def test_a_period_beyond_the_doubles():
    assert linear("1e-300", "0.999999", "1/2").impact_map(1, 0.3).status in range(6)


def test_a_horizon_that_would_take_years():
    with pytest.raises(InputError, match=r"horizon = '20' is not accepted: give at most 0\.001"):
        linear("1e10", 3, 1).impact_map(0, 1, horizon="20")


def test_a_number_of_many_digits_is_written():
    assert str(parse("/".join(["7"] * 4900))).startswith("1/")


def test_a_sign_that_is_not_decided_is_told_short():
    with pytest.raises(InputError, match="is not decided") as found:
        ImpactOscillator("x", "cos(sqrt(sin(1e3000))*t)", "1", "1/2")
    assert len(str(found.value)) < 500


def test_a_claim_whose_name_is_a_number_of_many_digits():
    with pytest.raises(InputError, match="unknown claim") as found:
        claims["1" * 5000]
    assert len(str(found.value)) < 500
