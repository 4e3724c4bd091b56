"""Long sums are the sums that sympy makes: the same arguments in the same order, equal, hashed and written alike."""

import pickle
import random
import re
from itertools import product

import pytest
import sympy

from singimpact.algebra import LongSum, Monomials, Products, SymbolRing, order_key
from singimpact.theory import generic_sheet

NAMES = ("a", "a_d1", "a_d10", "a_d2", "f_01", "f_10", "rho_2", "lambda")
RATIONALS = [sympy.Rational(p, q) for p, q in product((-7, -2, -1, 1, 2, 3, 120), (1, 2, 3, 5, 7))]


def step_by_step(terms, symbols):
    """The sum by sympy's own multiplication and addition."""
    parts = []
    for key, value in terms.items():
        term = value
        for symbol, exponent in zip(symbols, key, strict=True):
            term *= symbol**exponent
        parts.append(term)
    return sympy.Add(*parts)


@pytest.mark.parametrize("seed", range(20))
def test_random_sums_are_those_of_sympy(seed):
    rng = random.Random(seed)
    symbols = sympy.symbols(NAMES)
    keys = {tuple(rng.choice((0, 0, 0, 1, 1, 2, 3)) for _ in NAMES) for _ in range(rng.randrange(1, 60))}
    terms = {key: rng.choice(RATIONALS) for key in keys}
    made, plain = Monomials(symbols).summed(terms), step_by_step(terms, symbols)
    assert made == plain
    assert made.args == plain.args
    assert sympy.srepr(made) == sympy.srepr(plain)


@pytest.mark.parametrize("seed", range(20))
def test_random_products_are_those_of_sympy(seed):
    rng = random.Random(seed)
    a, b, x = sympy.symbols("a b lambda")
    bases = [a, b, x, x + 1, x - 1, x + 2, x**2 + x + 1, 2 * x**2 + x + 1, 3 * x**3 - x, sympy.Rational(1, 3) + x / 2]
    products, made, plain = Products(), [], {}
    for _ in range(rng.randrange(1, 25)):
        factors = [(base, rng.choice((-3, -2, -1, 1, 2))) for base in rng.sample(bases, rng.randrange(1, 5))]
        coefficient = rng.choice(RATIONALS)
        term = sympy.Mul(coefficient, *(base**exponent for base, exponent in factors))
        if frozenset(factors) not in plain:
            plain[frozenset(factors)] = term
            made.append(products.term(coefficient, factors))
            assert made[-1][1] == term
            assert made[-1][0] == order_key(term)
    assert products.summed(made).args == sympy.Add(*plain.values()).args


def sums():
    return [jet.to_sympy() for j, n in product((0, 1, 2), (3, 5, 7)) for jet in (generic_sheet(j, n).v,)]


def in_primes(text):
    """The formula with primes in place of a_{d1}, a_{d2}, ..."""
    braced = re.sub(r"(a_\{d(?:[4-9]|\d\d)\})(?=\^)", r"{\1}", text)
    return re.sub(r"a_\{d(\d+)\}", lambda d: "a" + "'" * int(d[1]) if int(d[1]) < 4 else f"a^{{({d[1]})}}", braced)


@pytest.mark.parametrize("plain", sums())
def test_a_long_sum_is_the_plain_one_to_sympy(plain):
    long = LongSum.of(plain)
    assert type(plain) is sympy.Add
    assert long == plain
    assert plain == long
    assert (long != plain) is False
    assert hash(long) == hash(plain)
    assert {plain: 1}[long] == 1
    assert str(long) == repr(long) == sympy.sstr(plain)
    assert sympy.srepr(long) == sympy.srepr(plain)
    assert sympy.latex(long) == in_primes(sympy.latex(plain))
    assert pickle.loads(pickle.dumps(long)) == plain


def test_what_is_computed_from_a_long_sum_is_plain():
    plain = generic_sheet(1, 5).v.to_sympy()
    long, x, sigma = LongSum.of(plain), sympy.Symbol("x"), sympy.Symbol("sigma")
    for compute in (
        lambda e: e + 1,
        lambda e: x * e,
        lambda e: x * e * (x + 1),
        lambda e: e / 2,
        lambda e: -e,
        lambda e: e**2,
        sympy.expand,
        lambda e: sympy.diff(e, sigma),
        lambda e: e.subs(sigma, 2),
        lambda e: e.xreplace({sigma: x}),
        lambda e: sympy.Poly(e, sigma),
        lambda e: sympy.collect(sympy.expand(e), sigma),
        sympy.cancel,
        lambda e: e.coeff(sigma, 1),
        lambda e: (e.func(*e.args), e.free_symbols, e.is_polynomial(sigma), e.as_ordered_terms()),
        lambda e: sympy.lambdify(sigma, e.subs(dict.fromkeys(e.free_symbols - {sigma}, 1)))(0.25),
    ):
        assert compute(long) == compute(plain)
        assert str(compute(long)) == str(compute(plain))
    assert type(long.func(*long.args)) is sympy.Add
    assert long != x
    assert (long == 3) is False
    assert sympy.simplify(long - plain) == 0


@pytest.mark.parametrize("text", [
    "x + 1/y + (x + 1)*y", "sqrt(x) + y*(x + 2)", "sin(x) + x*(y + x)", "x*(y + 1) + x*(z + 1)", "x*(y + z)**2 + y",
    "x*(y + 1)*(z + y) + 3", "2*x*(y + z/3) - 5", "x*(y - z) + y*(-x**2 - z)", "-x*y/2 - 3*z", "x*(y + 0.5) + z",
])  # fmt: skip
def test_the_text_of_other_sums_is_that_of_sympy(text):
    plain = sympy.sympify(text)
    assert str(LongSum.of(plain)) == sympy.sstr(plain)


def test_what_is_no_sum_stays_as_it_is():
    assert LongSum.of(sympy.Symbol("x")) is sympy.Symbol("x")
    ring = SymbolRing(("a",))
    assert ring.to_sympy(ring.rational(0)) == 0
    assert ring.to_sympy(ring.symbol("a")) is sympy.Symbol("a")
