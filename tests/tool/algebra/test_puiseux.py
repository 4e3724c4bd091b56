"""Expansions in rational powers at 0: exact terms against high-precision values, cancellation, and what has none."""

from fractions import Fraction

import mpmath
import pytest

from singimpact.algebra import Multiprecision, NoExpansion, evaluate, expansion, parse

SUMS = {
    "-v*(1 - 0.3*(-v)**(1/5))": 6,
    "-v*(1 - 0.3*sqrt(-v))": 6,
    "-0.8*v - 0.1*(-v)**(3/2)*exp(v)": 6,
    "-v*(1 - 0.3*(-v)**0.1)": 6,
    "-v/(1 + (-v)**0.2)": 6,
    "-v*exp(-0.3*sqrt(-v))": 6,
    "-v*(1 - 0.1*(-v)**0.1 - 0.2*(-v)**1.5*cos(v))": 6,
    "abs(v)*(1 - 0.2*abs(v)**(6/5))": 6,
    "-tanh(v/2) - (-v)**(5/3)/9": 6,
    "-tan(sqrt(4*v**2)) + 3*sin(-v) + log(1 - v)": 6,
    "-v*atan(1 - sqrt(-v))": 6,
    "v**2/sqrt(-v) - v*cos(1 + v)": 5,
    "-v*(8 - v)**(1/3)": 6,
    "-sin(v) + tanh(v) - v**3": 6,
}


@pytest.mark.parametrize("text", SUMS)
def test_the_remainder_has_the_order_that_is_stated(text):
    tree, count = parse(text, ["v"]), SUMS[text]
    found = expansion(tree, "v", -1, count)
    exponents = [exponent for exponent, _ in found.terms]
    assert exponents == sorted(set(exponents))
    mp = mpmath.mp.clone()
    mp.dps = 220
    ring, rests = Multiprecision(mp), []
    for w in (mp.mpf(10) ** -20, mp.mpf(10) ** -22):
        total = sum(evaluate(c, {}, ring) * w ** ring.rational(e) for e, c in found.terms)
        rests.append(abs(evaluate(tree, {"v": -w}, ring) - total))
        assert rests[-1] <= 100 * w ** ring.rational(found.bound if found.bound is not None else Fraction(5))
    if found.bound is None:
        assert max(rests) < mp.mpf(10) ** -200
    else:
        order = mp.log(rests[0] / rests[1]) / mp.log(100)
        assert order > float(found.bound) - 1e-3


def test_terms_are_exact():
    terms = dict(expansion(parse("-v*exp(-0.3*sqrt(-v))", ["v"]), "v", -1).terms)
    assert str(terms[Fraction(3, 2)]) == "-0.3"
    assert str(terms[Fraction(2)]) == "0.045"
    assert str(dict(expansion(parse("sqrt(2*v)", ["v"]), "v").terms)[Fraction(1, 2)]) == "2**(0.5)"


def test_smooth_functions_of_roots_are_whole():
    assert expansion(parse("-v*cos(sqrt(-v))", ["v"]), "v", -1).whole
    assert expansion(parse("sqrt(v**2)", ["v"]), "v", -1).whole
    assert not expansion(parse("-v + (-v)**(6/5)", ["v"]), "v", -1).whole


@pytest.mark.parametrize(
    "text",
    ["log(-v)", "sqrt(v)", "v**v", "sin(1/v)", "v*log(v)", "(-v)**sqrt(2)", "exp(1/v)", "sin(v)**2 + cos(v)**2 - 1"],
)
def test_what_has_no_expansion(text):
    """In rational powers with real coefficients, from v < 0; or every term that is looked at cancels."""
    with pytest.raises(NoExpansion):
        assert expansion(parse(text, ["v"]), "v", -1).lead
