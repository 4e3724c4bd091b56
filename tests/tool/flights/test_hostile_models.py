"""Long, deep and overflowing expressions: what a first flight may cost, and what it gives where doubles overflow."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest

from singimpact.algebra import DOUBLES, evaluate, parse
from singimpact.flights import (
    SEARCH,
    CompiledModel,
    Machine,
    counted,
    fastest_kept,
    floats_of,
    never_turns,
    over_floats,
    steps_of,
)
from singimpact.flights.compiled_model import compiled_model
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.status import Cause, Status


def drawn_numbers(seed: int) -> list[float]:
    random = Random(seed)
    sizes = [random.choice([-1, 1]) * 10 ** random.uniform(-300, 300) for _ in range(40)]
    return [*sizes, *(random.uniform(-800, 800) for _ in range(40)), math.inf, -math.inf, math.nan, 0.0, -1.0, 710.3]


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "exp", "log", "tanh", "atan", "expm1", "log1p", "sinh"])
def test_functions_of_floats_raise_nothing(name):
    """sin(inf) raised, and the flight waited for a compiler."""
    numbers = drawn_numbers(1)
    with np.errstate(all="ignore"):
        expected = getattr(np, {"atan": "arctan"}.get(name, name))(np.array(numbers))
    found = [floats_of()[name](value) for value in numbers]
    usual = np.isfinite(expected)
    assert np.allclose(np.array(found)[usual], expected[usual], rtol=1e-13)
    if name not in ("log", "log1p"):  # log(0) is nan in kernels: log has no Taylor series there
        assert np.array_equal(np.array(found)[~usual], expected[~usual], equal_nan=True)


@pytest.mark.parametrize("seed", range(5))
def test_powers_of_floats_raise_nothing(seed):
    random = Random(seed)
    power = over_floats()["real_power"]
    for w in drawn_numbers(seed):
        q = random.choice([0.5, -0.997, 499.5, -7.0, 3.0, 1000.0, -1000.0])
        value = power(w, q)
        with np.errstate(all="ignore"):
            expected = np.power(w, q) if w else math.nan if q < 0 else 0.0
        assert value == pytest.approx(expected, rel=1e-13, nan_ok=True)


@pytest.mark.parametrize("text", ["x**3", "x**(-3)", "(1/x)**9", "(-x)**7", "1/x + 1"])
@pytest.mark.parametrize("x", [1e300, -1e300, 0.0, 1e-300])
def test_powers_of_doubles_raise_nothing(text, x):
    found = evaluate(parse(text, ["x"]), {"x": x}, DOUBLES)
    with np.errstate(all="ignore"):
        expected = evaluate(parse(text, ["x"]), {"x": np.array([x])}, DOUBLES)[0]
    assert abs(found) == pytest.approx(abs(expected), rel=1e-13)


@pytest.mark.parametrize("f", ["(x + 2)**(-997/1000) + (x*1e150)**(999/2)", "sin(x**1000)", "cos((xdot*1e200)**(5/2))"])
def test_an_overflow_compiles_nothing(f, monkeypatch):
    monkeypatch.setattr(Machine, "compile_here", lambda *_: pytest.fail("compiled"))
    monkeypatch.setattr(Machine, "entry", lambda *_: None)
    assert ImpactOscillator(f, "cos(t)", "0.1", "0.5").impact_map(0.3, 1e3).status in range(6)


@pytest.mark.parametrize(
    ("osc", "v"),
    [(ImpactOscillator("x + x**3/2 + 0.2*tanh(5*xdot)", "cos(2*t)/10", "-2", "0.6"), 0.5),
     (linear(2, "-3", "0.5", damping="0.3"), 0.1)],
)  # fmt: skip
def test_a_flight_left_open_is_flown_once(osc, v):
    """The call for two floats was repeated for arrays when it ended in no plain hit."""
    for call in (osc.impact_map, osc.first_hit):
        with counted() as count:
            found = call(0.3, v)
        assert found.status != Status.hit
        assert count.flights == 1
        again = call(np.array([0.3]), np.array([v]))
        assert again.status[0] == found.status


def test_steps_follow_the_price_of_a_step():
    texts = ["x**3", "x + x**3 + 0.2*tanh(5*xdot)", "+".join(f"x**{k}/{k}" for k in range(2, 100))]
    steps = [steps_of(ImpactOscillator(f, "cos(2*t)", 0, "0.5")) for f in texts]
    assert steps[0] == 16_000
    assert steps[1] == 16_000
    assert 600 < steps[2] < 800
    model = ImpactOscillator(texts[2], "cos(2*t)", 0, "0.5")
    assert compiled_model(model).allowance.steps == steps[2]
    assert isinstance(compiled_model(model), CompiledModel)


@pytest.mark.parametrize("seed", range(4))
def test_a_search_of_barriers_ends(seed, work_of):
    random = Random(seed)
    terms = "+".join(f"{random.choice(['sin', 'tanh', 'atan'])}({random.uniform(-1, 1):.3f}*x)/9" for _ in range(40))
    model = ImpactOscillator(f"{terms} + {random.randrange(3, 9)}*xdot + xdot**3", "3 + cos(t)/9", "-2", "0.5")
    assert work_of(lambda: fastest_kept(model)) < 12 * SEARCH.operations


@pytest.mark.parametrize("f", ["(x + xdot)**1000", "((x/1000)**100 + xdot)**100", "x**40*xdot**40"])
def test_a_polynomial_of_a_high_degree_proves_nothing(f, work_of):
    model = ImpactOscillator(f"-({f})", "cos(t)", 0, 1)
    place = np.array([5.0])

    def proof():
        assert not never_turns(model, place, place)[0]

    assert work_of(proof) < 10_000


@pytest.mark.parametrize("seed", range(40))
def test_a_force_that_is_nearly_zero(seed):
    """Steps that vanish beside the time moved nothing, and the flight did not end."""
    random = Random(seed)
    force, v = 10 ** random.uniform(-70, -1), 10 ** random.uniform(-5, 3)
    found = ImpactOscillator(repr(force), "0", 0, "0.7").first_hit(0.4, v)
    if found.status == Status.hit:
        assert found.flight_time == pytest.approx(2 * v / force, rel=1e-12)
    else:
        assert (found.status, found.cause) == (Status.unresolved, Cause.overflow)
        assert v / force > 1e14
