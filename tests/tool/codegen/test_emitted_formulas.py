"""Emitted formulas: one text on every kind of number, regenerated and compared, each with its accuracy contract."""

import inspect
from fractions import Fraction
from functools import lru_cache

import flint
import mpmath
import numpy as np
import pytest
from emitted_module import module_of

from singimpact.codegen import module_source
from singimpact.contact import NAMED_ORDERS
from singimpact.theory import PLACES, generic_sheet, sheet_functions

EPSILON = 2.0**-52
ORDER = 6  # total degree: one digit of v_c per third of a decade in t
sheets = module_of(module_source("Sheets.", "a test", sheet_functions(ORDER)), "emitted_sheets")
FUNCTIONS = [f"{name}_{place}" for place in PLACES for name in ("v_c", "xdot_c")]

# name -> worst error in epsilons of the sum of the moduli of the terms, over the domain drawn below; what was
# measured there with a margin of a half
CONTRACT = {
    "v_c_generic": 4, "xdot_c_generic": 6, "v_c_tangency": 4, "xdot_c_tangency": 6, "v_c_swan": 4, "xdot_c_swan": 6,
}  # fmt: skip


def names_of(name):
    return list(inspect.signature(getattr(sheets, name)).parameters)


def drawn(name, count, size, seed=1):
    """Jets of size 1, |sigma| and |t| up to `size`."""
    random = np.random.default_rng(seed)
    values = {letter: random.uniform(-1, 1, count) for letter in names_of(name)}
    return {**values, "sigma": size * values["sigma"], "t": size * values["t"]}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_one_text_on_every_kind_of_number(name):
    values = {letter: Fraction(n + 1, 7 + n * n) for n, letter in enumerate(names_of(name))}
    function = getattr(sheets, name)
    exact = function(**values)
    made = generic_sheet(NAMED_ORDERS[name.rpartition("_")[2]], 6)
    jet = made.v if name.startswith("v_c") else made.xdot
    ring = made.contact.ring
    direct = Fraction(0)
    for (i, k), coefficient in jet.terms.items():
        for key, c in coefficient.to_dict().items():
            term = Fraction(int(c.p), int(c.q)) * values["sigma"] ** i * values["t"] ** k
            for letter, e in zip(ring.names, key, strict=True):
                term *= values[letter] ** int(e) if e else 1
            direct += term
    assert exact == direct
    with flint.ctx.workprec(200), mpmath.workdps(50):
        ball = function(**{k: flint.arb(flint.fmpq(v.numerator, v.denominator)) for k, v in values.items()})
        assert ball.contains(flint.fmpq(exact.numerator, exact.denominator))
        number = function(**{k: mpmath.mpf(v.numerator) / v.denominator for k, v in values.items()})
        assert abs(number - mpmath.mpf(exact.numerator) / exact.denominator) < 1e-45
    array = function(**{k: np.full(3, float(v)) for k, v in values.items()})
    assert array == pytest.approx(float(exact), rel=1e-12)


@pytest.mark.parametrize("size", [1e-6, 0.1])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_accuracy_contract(name, size):
    """Against exact fractions, judged by the sum of the moduli of the terms."""
    values = drawn(name, 200, size)
    function = getattr(sheets, name)
    found = function(**values)
    worst = 0.0
    for n in range(len(found)):
        point = {k: Fraction(float(v[n])) for k, v in values.items()}
        exact = function(**point)
        # (n + 1)!-free bound of the terms: the same text on moduli, its minus signs turned
        scale = abs(moduli(name)(**{k: abs(v) for k, v in point.items()}))
        worst = max(worst, float(abs(Fraction(float(found[n])) - exact) / scale) / EPSILON)
    assert worst < CONTRACT[name]


@lru_cache
def moduli(name):
    """The function with every minus sign turned: for positive arguments, the sum of the moduli of its terms."""
    source = inspect.getsource(getattr(sheets, name))
    scope = {"Any": object}
    exec(source.replace("- ", "+ ").replace("(-", "("), scope)
    return scope[name]
