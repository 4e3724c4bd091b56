"""Emitted curves: regenerated and compared, one text on every kind of number, accuracy to the ends of lambda."""

import inspect
from fractions import Fraction
from functools import lru_cache

import flint
import mpmath
import numpy as np
import pytest
import sympy
from emitted_module import module_of

import singimpact as si
from singimpact.codegen import module_source
from singimpact.generated import chatter_terms, linear_chatter_terms
from singimpact.theory import CURVED, MOVED, completion_module, curve_functions

EPSILON = 2.0**-52
curves = module_of(module_source("Curves of the theory.", "a test", curve_functions()), "emitted_curves")
NAMES = [*CURVED, *MOVED, "chatter_limit", "outline_tangency"]

# name -> worst error in epsilons of the size of the sum (`scale` below), for lambda in [1e-9, 1 - 1e-9], jets of size
# 1, the leading one in [1/2, 2], and the variable up to 0.1; what was measured there with a margin of a half
CONTRACT = {
    "fibre": 2, "gamma_tangency": 5, "gamma_swan": 7, "motion_tangency": 6, "motion_swan": 6, "chatter_limit": 3,
    "outline_tangency": 2,
}  # fmt: skip


def names_of(name):
    return list(inspect.signature(getattr(curves, name)).parameters)


def drawn(name, count, seed=3):
    random = np.random.default_rng(seed)
    values = {letter: random.uniform(-1, 1, count) for letter in names_of(name)}
    variable, *rest = names_of(name)
    leading = rest[1] if rest[0] == "lambda_" else rest[0]
    values[variable] *= 0.1
    values[leading] = 2 ** random.uniform(-1, 1, count)
    if rest[0] == "lambda_":
        ends = 10 ** random.uniform(-9, -0.3, count)
        values["lambda_"] = np.where(random.random(count) < 0.5, ends, 1 - ends)
        if name == "chatter_limit":  # powers of 1/(1 - r): v stays where the series makes sense
            values[variable] *= (1 - values["lambda_"]) ** 2
    return values


def symbolic(name):
    """The same series by the public function, as an expression."""
    theory = si.theory
    if name in CURVED:
        j, top = CURVED[name]
        series = theory.gamma(top, at=j) if j else theory.fibre(top)
    elif name in MOVED:
        series = theory.dynamics_on_gamma(MOVED[name][1], at=MOVED[name][0])
    elif name == "chatter_limit":
        series = theory.chatter_limit(4)
    else:
        return theory.normal_form(6).outline_of_p
    return series.as_expr()


def test_source_is_what_the_theory_writes(clone):
    assert (clone / "singimpact" / "generated" / "completion.py").read_text() == completion_module()


def test_the_terms_of_a_linear_model_are_those_without_the_other_jets():
    letters = list(inspect.signature(linear_chatter_terms).parameters)
    values = {letter: Fraction(n + 2, 9 + n * n) for n, letter in enumerate(letters)}
    absent = {letter: Fraction(0) for letter in names_of("chatter_terms") if letter not in letters}
    assert len(absent) == 6
    assert linear_chatter_terms(**values) == chatter_terms(**values, **absent)


@pytest.mark.parametrize("name", NAMES)
def test_one_text_on_every_kind_of_number(name):
    values = {letter: Fraction(n + 2, 9 + n * n) for n, letter in enumerate(names_of(name))}
    function = getattr(curves, name)
    exact = function(**values)
    at = {sympy.Symbol(letter.rstrip("_")): sympy.Rational(v.numerator, v.denominator) for letter, v in values.items()}
    shown = symbolic(name).subs(at, simultaneous=True)
    assert shown == sympy.Rational(exact.numerator, exact.denominator)
    with flint.ctx.workprec(200), mpmath.workdps(50):
        ball = function(**{k: flint.arb(flint.fmpq(v.numerator, v.denominator)) for k, v in values.items()})
        assert ball.contains(flint.fmpq(exact.numerator, exact.denominator))
        number = function(**{k: mpmath.mpf(v.numerator) / v.denominator for k, v in values.items()})
        assert abs(number - mpmath.mpf(exact.numerator) / exact.denominator) < 1e-44
    array = function(**{k: np.full(3, float(v)) for k, v in values.items()})
    assert array == pytest.approx(float(exact), rel=1e-12)


def worst_error(name, function, count=200):
    """In epsilons of the sum of the moduli of the terms of the coefficients, found by the same text on moduli."""
    values = drawn(name, count)
    found = function(**values)
    worst = 0.0
    for n in range(count):
        point = {k: Fraction(float(v[n])) for k, v in values.items()}
        exact = getattr(curves, name)(**point)
        worst = max(worst, float(abs(Fraction(float(found[n])) - exact) / scale(name, point)) / EPSILON)
    return worst


def turn(line):
    """Every sign of a line of the formula as plus."""
    return line.replace("- ", "+ ").replace("-", "") if line.startswith(("    c_", "    q_")) else line


def scale(name, point):
    """The sum with every sign between terms turned to plus and every argument positive; factors in lambda are kept."""
    return abs(turned(name)(**{k: abs(v) for k, v in point.items()}))


@lru_cache
def turned(name):
    """The function with the signs of all its lines turned but those that hold 1 - lambda."""
    lines = inspect.getsource(getattr(curves, name)).splitlines()
    scope = {"Any": object}
    exec("\n".join(line if "1 - lambda_)" in line else turn(line) for line in lines), scope)
    return scope[name]


@pytest.mark.parametrize("name", NAMES)
def test_accuracy_contract(name):
    assert worst_error(name, getattr(curves, name)) < CONTRACT[name]


def test_a_formula_off_in_its_last_term_breaks_its_contract():
    def bent(**values):
        return curves.gamma_tangency(**values) * (1 + 16 * EPSILON)

    assert worst_error("gamma_tangency", bent) > CONTRACT["gamma_tangency"]
