"""Models of Python functions: the tree, its values against the function itself, and what has no tree."""

import math
from decimal import Decimal
from fractions import Fraction
from math import atan, cos as cosine

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.algebra import DEFINITIONS, DOUBLES, evaluate, parse
from singimpact.inputs import InputError

RATE = 1.7


def helped(x):
    """A function that the functions of the test call."""
    return x * Fraction(1, 3) + 0 * math.sin(x)


def grown(x):
    """A formula that doubles sixty times."""
    for _ in range(60):
        x = x + x * x
    return x


SAME = {
    "x + 0.1*xdot + 0.3*x**3": lambda x, xdot: x + 0.1 * xdot + 0.3 * x**3,
    "sin(x) + tanh(5*xdot)/5": lambda x, xdot: np.sin(x) + np.tanh(5 * xdot) / 5,
    "x*exp(-xdot**2) - 2": lambda x, v: math.exp(-(v**2)) * x - 2,
    "sqrt(1 + x**2) + atan(x)": lambda x, xdot: np.sqrt(np.square(x) + 1) + atan(x),
    "(x - 1)/(2 + x**2) + abs(xdot)": lambda x, xdot: (x - 1) / (2 + math.pow(x, 2)) + abs(xdot),
    "x + b*xdot": lambda x, xdot, b: x + b * xdot,
    "x": lambda x: +x,
    "x/3 + cos(xdot)": lambda x, xdot: helped(x) + cosine(xdot),
    "-2": lambda x, xdot: -2,
    "sinh(x) + log1p(xdot**2)": lambda x, xdot: math.sinh(x) + np.log1p(xdot**2),
}


@pytest.mark.parametrize("text", SAME)
def test_a_function_is_the_model_of_its_text(text):
    numbers = {"b": "1/5"} if "b*" in text else {}
    written = si.ImpactOscillator(text, "cos(1.7*t)", "0.3", "0.6", numbers)
    traced = si.ImpactOscillator(SAME[text], lambda t: cosine(RATE * t), "0.3", lambda v: -0.6 * v, numbers)
    assert traced.g == written.g
    random = np.random.default_rng(5)
    for x, xdot in random.uniform(-2, 2, (20, 2)):
        there = {"x": x, "xdot": xdot, "b": 0.2}
        assert evaluate(traced.f, there, DOUBLES) == pytest.approx(evaluate(written.f, there, DOUBLES), rel=1e-14)


def test_a_flight_of_a_function_is_that_of_scipy():
    def force(x, xdot):
        return x + 0.2 * np.tanh(3 * xdot) + 0.3 * x**3

    def forcing(t):
        return np.cos(1.7 * t) + 0.2

    osc = si.ImpactOscillator(force, forcing, 0.3, 0.6)
    hit = osc.first_hit(0.4, 0.9)
    times = solve_ivp(
        lambda t, y: [y[1], forcing(t) - force(*y)], (0.4, 20), [0.3, 0.9], "DOP853", rtol=1e-12, atol=1e-12,
        events=lambda t, y: y[0] - 0.3 if t > 0.5 else 1.0, dense_output=True,
    ).t_events[0]  # fmt: skip
    assert hit.flight_time == pytest.approx(times[0] - 0.4, abs=1e-9)


@pytest.mark.parametrize("name", DEFINITIONS)
def test_a_defined_function_is_that_of_numpy(name):
    """Of sec, csc and cot, which numpy lacks, the values are 1/cos, 1/sin and 1/tan."""
    others = {"sec": lambda w: 1 / np.cos(w), "csc": lambda w: 1 / np.sin(w), "cot": lambda w: 1 / np.tan(w)}
    spelled = f"arc{name[1:]}" if name.startswith("a") else name
    for w in (2.5, 1.25) if name == "acosh" else (0.125, 0.75):
        found = evaluate(parse(f"{name}(x)", ["x"]), {"x": w}, DOUBLES)
        assert found == pytest.approx(others.get(name, getattr(np, spelled, None))(w), rel=4e-15)


@pytest.mark.parametrize(
    ("function", "why"),
    [
        (lambda x, xdot: x if x > 0 else 2 * x, "line .* x if x > 0 else 2 .* needs the value"),
        (lambda x, xdot: x + np.sign(xdot), "np.sign"),
        (lambda x, xdot: x + math.floor(x), "math.floor"),
        (lambda x, xdot: max(x, 0), "needs the value"),
        (lambda x, xdot: float(x), "needs the value"),
        (lambda x, xdot: x.gamma(), "unknown function 'gamma'"),
        (lambda x, xdot: [x, xdot], "has no meaning here"),
        (lambda x, xdot: None, "the symbol 'None' has no value"),
        (lambda x, xdot: x / 0, "divides by zero"),
        (lambda x, xdot: x + missing, "missing"),  # noqa: F821
        (lambda x, xdot, t, other: x, "a function of x, xdot, t, or of some of them"),
        (lambda *x: x[0], "a function of x, xdot, t"),
        (lambda x, xdot: grown(x), "formula has more than 10000 parts"),
        (lambda x, xdot: x + float("inf"), "inf"),
        (max, "signature"),
    ],
)
def test_what_has_no_tree_is_refused_with_its_line(function, why):
    with pytest.raises(InputError, match=why) as refusal:
        si.ImpactOscillator(function, "cos(t)", 0, "1/2")
    assert "\n" not in str(refusal.value)
    assert str(refusal.value).startswith("f ")


def test_functions_of_numpy_and_math_themselves():
    for cosine_of in (np.cos, math.cos):
        assert str(si.ImpactOscillator("x", cosine_of, 0, "1/2").g) == "cos(t)"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("sinh(" * 30 + "x" + ")" * 30, "the argument of sinh has 500 parts or more"),
        ("x + Decimal(1)", "unknown function 'Decimal'"),
    ],
)
def test_what_grows_when_it_is_written_out_is_refused_at_once(text, why):
    with pytest.raises(InputError, match=why):
        si.ImpactOscillator(text, "0", 0, "1/2")


def test_a_long_decimal_is_refused_at_once():
    with pytest.raises(InputError, match="4000 digits"):
        si.ImpactOscillator("x", "0", Decimal("1e1000000000"), "1/2")


def test_the_function_stays_as_it_is():
    """Its globals are not changed, and it is called once."""
    calls = []

    def force(x, xdot, k=0.25):
        calls.append(x)
        return x + k * math.sin(xdot)

    osc = si.ImpactOscillator(force, "cos(t)", 0, "1/2")
    assert str(osc.f) == "x + 0.25*sin(xdot)"
    assert len(calls) == 1
    assert math.sin(1.0) == np.sin(1.0)
