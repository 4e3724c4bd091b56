"""What a user reads: results in words and numbers, and what is said where something else was meant."""

from __future__ import annotations

import numpy as np
import pytest

import singimpact as si

OSC = si.linear(2, "0.3", "0.5")

RESULTS = [
    lambda: OSC.impact_map(0.1, 0.2),
    lambda: OSC.impact_map([0.1, 1], [0.2, 0.3]),
    lambda: OSC.derivative(0.1, 0.2),
    lambda: OSC.flight(0.1, 0.2, 0.1),
    lambda: OSC.iterate([0.1, 1], [0.2, 0.3], 3),
    lambda: OSC.launch(1, 0, 0),
    lambda: OSC.chatter_limit(1.2, 0.01),
    lambda: OSC.chatter_limit(np.linspace(1, 1.2, 30), 0.01),
    lambda: si.threshold(OSC, 1.2),
    lambda: si.tangency_points(OSC),
    lambda: si.swan_points("x", "cos(2*t)"),
    lambda: si.fixed_points.tangency("1/2"),
    lambda: OSC.orbit(0.1, 0.2, impacts=1000),
    lambda: OSC.periodic(1, 1),
    lambda: si.lyapunov(OSC, 0.1, 0.3, 100),
    lambda: si.linear(2, 0.3, 0.5),
]


@pytest.mark.parametrize("result", RESULTS)
def test_a_result_prints_words_and_numbers_in_three_lines_at_most(result) -> None:
    text = repr(result())
    assert not [typed for typed in ("np.", "mpf(", "int8", "Fraction(", "Number(", "None") if typed in text]
    assert text.count("\n") < 3
    assert len(text) < 800


def test_a_status_prints_its_name() -> None:
    assert repr(OSC.impact_map(0.1, 0.2)).endswith("status=hit)")
    assert "2 hit" in repr(OSC.iterate([0.1, 1], [0.2, 0.3], 3))
    assert "status=complete" in repr(OSC.chatter_limit(1.2, 0.01))
    exhausted = repr(OSC.chatter_limit(1.2, 0.01, impacts=1))
    assert "status=unresolved" in exhausted
    assert "cause=impacts_exhausted" in exhausted


def test_a_model_of_floats_prints_floats_and_is_the_same_when_it_is_typed_again() -> None:
    osc = si.linear(2.1, 0.3, "0.3")
    assert "clearance=0.3, restitution='0.3'" in repr(osc)
    assert eval(repr(osc), {"ImpactOscillator": si.ImpactOscillator}) == osc


MEANT = [
    (lambda: si.linear(omega=2, c=0.3, restitution="0.5"), "no argument 'c': give clearance"),
    (lambda: si.linear(omega=2, clearance=0.3, r="0.5"), "no argument 'r': give restitution"),
    (lambda: si.ImpactOscillator(lambda x, _: x if x > 0 else 0, "cos(t)", 0, 1), "needs the value of a number"),
    (lambda: si.ImpactOscillator("x + 0.1*x'", "cos(t)", 0, 1), "the velocity x' is written xdot"),
    (lambda: si.ImpactOscillator("x + 0.1*v", "cos(t)", 0, 1), "did you mean xdot?"),
    (lambda: si.ImpactOscillator("2x", "cos(t)", 0, 1), "a product is written with its *, 2*x"),
    (lambda: si.ImpactOscillator("x", "2 cos(t)", 0, 1), "a product is written with its *, 2*cos"),
    (lambda: si.ImpactOscillator("abs(x - 1)", "cos(t)", 0, 1).impact_map(0, 1), "in place of abs(u)"),
    (lambda: si.claims["eq:1"], "unknown claim 'eq:1': none is near; there are b:border-order, b:cascade"),
    (lambda: si.claims["t:t11"], "the nearest known are t:t1"),
]


@pytest.mark.parametrize(("call", "told"), MEANT)
def test_what_was_meant_is_told(call, told: str) -> None:
    with pytest.raises(si.InputError) as found:
        call()
    assert told in str(found.value)


def test_counts_may_be_whole_floats() -> None:
    assert OSC.orbit(0.1, 0.2, impacts=1e2).tau.size == 101
    with pytest.raises(si.InputError, match="a whole number"):
        OSC.orbit(0.1, 0.2, impacts=20.5)


def test_a_name_that_is_near_none_is_told_where_the_names_are() -> None:
    with pytest.raises(AttributeError, match=r"dir\(singimpact\)"):
        _ = si.qqqqq


def test_dir_is_what_one_can_do() -> None:
    assert all(not name.startswith("_") for name in [*dir(si), *dir(si.theory)])
    assert all(
        callable(getattr(si, name)) or name in ("claims", "fixed_points", "models", "theory") for name in dir(si)
    )
    assert all(callable(getattr(si.theory, name)) for name in dir(si.theory))


LINEAR = ["--omega", "2", "--clearance", "0.3", "--restitution", "0.5"]
TYPED = [
    (("map", "--omega", "2", "--r", "0.5"), "no option --r: give --restitution"),
    (("map", "--omga", "2"), "no option --omga: give --omega"),
    (("orbit", *LINEAR, "--tau", "1", "--v", "1", "--impacts", "20.5"), "--impacts = 20.5 is not accepted"),
    (("basins", *LINEAR, "--tau", "0", "-o", "b.png"), "-o was read as a value of the option before it"),
]


@pytest.mark.parametrize(("words", "told"), TYPED)
def test_what_was_meant_on_the_command_line_is_told(singimpact, words, told: str) -> None:
    result = singimpact(*words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"singimpact: {told}")
    assert result.stderr.count("\n") == 1


def test_release_gives_when_a_mass_at_rest_lifts_off() -> None:
    (_, gamma) = si.tangency_points(OSC)
    assert OSC.release(1.2) == pytest.approx(gamma.tau, rel=1e-15)
    assert OSC.release(0.1) == 0.1
    assert si.linear(2, 2, "0.5").release(0.1) == np.inf
