"""Parameters kept as letters: values put in afterwards give the numeric series; what cannot stay is refused."""

import pytest
import sympy

import singimpact as si
from singimpact.inputs import InputError

VALUES = {"d": "1/10", "k": "3/10"}
DUFFING = si.ImpactOscillator("x + d*xdot + k*x**3", "t + 1/3 + t**2/5 + 81/10000", "0.3", "5/16", parameters=VALUES)
SMOOTH = si.ImpactOscillator("x + d*xdot", "cos(w*t)", 1, "0.5", parameters={"w": 2, "d": "0.1"})
NUMBERS = {sympy.Symbol(name): sympy.Rational(value) for name, value in VALUES.items()}


@pytest.mark.parametrize("at", ["generic", "tangency", "swan"])
def test_sheet_with_letters_is_the_generic_one_with_the_jets_put_in(at):
    lettered = si.theory.v_c(6, at, DUFFING, keep=["d", "k"])
    assert {"d", "k"} <= set(map(str, lettered.free_symbols))
    plain = si.theory.v_c(6, at)
    c = sympy.Rational(3, 10)
    f = {"f_10": 1 + 3 * c**2 * NUMBERS[sympy.Symbol("k")], "f_01": NUMBERS[sympy.Symbol("d")],
         "f_20": 6 * c * NUMBERS[sympy.Symbol("k")], "f_30": 6 * NUMBERS[sympy.Symbol("k")]}  # fmt: skip
    jets = {s: f.get(str(s), 0) for s in plain.free_symbols if str(s).startswith("f_")}
    assert sympy.expand(plain.subs(jets) - lettered.subs(NUMBERS)) == 0


def test_numbers_put_in_afterwards():
    lettered = si.theory.v_c(5, "generic", SMOOTH, tau="1/2", keep=["w", "d"])
    numeric = si.theory.v_c(5, "generic", SMOOTH, tau="1/2")
    at = {sympy.Symbol("w"): 2, sympy.Symbol("d"): sympy.Rational(1, 10)}
    assert sympy.expand(lettered.subs(at) - numeric) == 0


def test_gamma_and_dynamics_with_letters():
    lambda_, w = sympy.symbols("lambda w")
    series = si.theory.gamma(4, "swan", SMOOTH, tau=0, keep=["w", "d"])
    assert sympy.cancel(series[3] + w**2 * (1 - lambda_) * (lambda_**2 + 2 * lambda_ + 3) / 24) == 0
    motion = si.theory.dynamics_on_gamma(2, "swan", SMOOTH, tau=0, keep=["w", "d"])
    assert sympy.cancel(motion[2] - lambda_ * (1 - lambda_) * sympy.Symbol("d") / 10) == 0


def test_completion_and_fibre_with_letters():
    r, d, w = sympy.symbols("lambda d w")
    model = SMOOTH.replace(clearance=2, restitution="-0.5*v + w*v**2")
    series = si.theory.chatter_limit(2, model, tau=0, keep=["w", "d"])
    assert sympy.cancel(series[1] - 2 / (1 - r)) == 0
    assert sympy.cancel(series[2] + sympy.Rational(2, 3) * (d - 3 * w / (1 + r)) / (1 - r) ** 2) == 0
    assert si.theory.fibre(2, model, keep=["d"])[1].free_symbols == {r, sympy.Symbol("a")}


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: si.theory.v_c(3, model=SMOOTH, keep=["q"]), "q"),
        (lambda: si.theory.v_c(3, model=SMOOTH, keep="w"), "a sequence of names"),
        (lambda: si.theory.v_c(3, keep=["w"]), "model = None"),
        (lambda: si.theory.v_c(3, "tangency", SMOOTH, tau=1, keep=["w"]), "not of contact order 1 for all values"),
        (lambda: si.theory.gamma(11, model=SMOOTH, keep=["w"]), "order = 11 is not accepted"),
        (
            lambda: si.theory.v_c(
                3, model=si.ImpactOscillator("a_d1*x", "cos(t)", 0, "0.5", parameters={"a_d1": 1}), keep=["a_d1"]
            ),
            "give it another name",
        ),
    ],
)
def test_refusals(ask, told):
    with pytest.raises(InputError, match=told):
        ask()
