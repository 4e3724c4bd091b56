"""The model a user holds: texts, files, copies, and what it costs to import it."""

from __future__ import annotations

import pickle
import subprocess
import sys

import numpy as np
import pytest

from singimpact.impact_oscillator import ImpactOscillator, linear, read_model, universal
from singimpact.inputs import InputError


def test_round_trips(tmp_path) -> None:
    waves = linear("2.8", 0, "0.8", damping="1/3", stiffness=2, amplitude="0.5", phase="pi/4")
    for osc in (waves, universal(-1, "0.5")):
        path = tmp_path / "model.toml"
        path.write_text(osc.to_toml())
        again = read_model(path)
        assert again == osc
        assert type(again) is ImpactOscillator
        assert pickle.loads(pickle.dumps(osc)) == osc
        assert eval(repr(osc)) == osc


def test_defaults_are_left_out() -> None:
    assert str(linear("2.8", 0, "0.8").f) == "x"
    assert str(linear("2.8", 0, "0.8").g) == "cos(omega*t)"


def test_replace_keeps_the_type() -> None:
    osc = linear(2, 0, "0.5").replace(omega=3)
    assert isinstance(osc, ImpactOscillator)
    assert osc.impact_map(0, 1).tau == linear(3, 0, "0.5").impact_map(0, 1).tau


def test_terms_of_the_linear_family() -> None:
    osc = linear("1.3", "0.1", "0.5", damping="0.2", stiffness=3, amplitude=2, phase="0.4")
    same = ImpactOscillator("0.2*xdot + 3*x", "2*cos(1.3*t + 0.4)", "0.1", "0.5")
    assert osc.impact_map(0.2, 0.7).tau == pytest.approx(same.impact_map(0.2, 0.7).tau, rel=1e-15)


@pytest.mark.parametrize(
    "make",
    [
        lambda: linear(0, 0, 1),
        lambda: linear(-1, 0, 1),
        lambda: linear(2, 0, 2),
        lambda: linear(2, "nan", 1),
        lambda: linear(2, 0, 1, damping="x"),
        lambda: universal(0, 1),
        lambda: read_model("/nowhere/at/all.toml"),
        lambda: linear(2, 0, 1).acceleration(0, order=-1),
        lambda: linear(2, 0, 1).acceleration(np.nan),
        lambda: linear(2, 0, 1).flight([0, 1], 1, 0),
        lambda: linear(2, 0, 1).flight(0, 1, np.nan),
    ],
)
def test_bad_input(make) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert "\n" not in str(caught.value)


def test_import_loads_numpy_alone() -> None:
    script = (
        "import sys, singimpact.impact_oscillator\n"
        "heavy = {'sympy', 'scipy', 'numba', 'mpmath', 'flint', 'matplotlib', 'click', 'rich'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


SESSION = """
import sys
import singimpact as si

osc = si.ImpactOscillator("x + xdot/10", "cos(2*t)", 0, "0.8")
pair = osc.replace(upper="0.5")
osc.first_hit(0.1, 0.5), osc.iterate([0.1], [0.5], 9), osc.orbit(0.1, 0.5), osc.chatter_limit(0.5, 0.01)
osc.lyapunov(0.1, 0.5, 100), osc.periodic(1, 1)[0].branch("restitution", points=9)
pair.orbit(0.1, 0.5), pair.periodic("lu", 1)
print(*{"flint", "sympy"} & set(sys.modules))
"""


def test_a_session_in_doubles_loads_neither_flint_nor_sympy() -> None:
    loaded = subprocess.run([sys.executable, "-c", SESSION], capture_output=True, text=True, check=True).stdout
    assert loaded == "\n"
