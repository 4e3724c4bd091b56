"""Certificates: what is true gets one, what is false none, and a damaged one is rejected."""

import json

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from tampering import bumped, changed, leaves

from singimpact.algebra import certificates
from singimpact.algebra.checking import accepts

x, y, r = sympy.symbols("x y r")
HALF = sympy.Rational(1, 2)


# what a change of these numbers makes is another statement, which happens to be true as well
STILL_TRUE = {"pole": ("numerator", "denominator"), "definite": ("form",)}


def made(call, *arguments):
    with certificates.collected() as found:
        call(*arguments)
    return json.loads(json.dumps(found))


SHAPES = {
    "positive": (certificates.positive_on, (1 - x) * (x + 3) / (2 - x), x, 0, 1),
    "raised": (certificates.positive_on, x**2 - x + HALF, x, 0, 1),
    "half-line": (certificates.positive_on, x**2 - x + 1, x, 0, sympy.oo),
    "left": (certificates.negative_on, x**3 - 1, x, -sympy.oo, 0),
    "box": (certificates.positive_in, 2 - x - r * y / (1 + y), {x: (0, 1), y: (0, sympy.oo), r: (0, 1)}),
    "chain": (certificates.sign_chain, x**2 - r, x, ((-sympy.oo, 1), (0, -1), (1, 1)), {r: (0, 1)}),
    "value": (certificates.value_at, (x**2 - y**2) / (x - y), x, 3),
    "pole": (certificates.value_at, y / (x - 1), x, 1),
    "definite": (certificates.definite, -(6 * x**2) - 4 * x * y - y**2, x, y),
    "identity": (certificates.identical, (x + y) ** 2, x**2 + 2 * x * y + y**2),
    "root": (certificates.identical, sympy.sqrt(x / (1 + y)) ** 3, x / (1 + y) * sympy.sqrt(x / (1 + y))),
}


@pytest.mark.parametrize("name", SHAPES)
def test_each_change_of_a_number_is_rejected(name):
    call, *arguments = SHAPES[name]
    (certificate,) = made(call, *arguments)
    assert accepts(certificate)
    for path in leaves(certificate):
        if path[0] not in STILL_TRUE.get(name, ()):
            assert not accepts(changed(certificate, path, bumped)), path


def test_a_sturm_chain_is_rejected_when_changed():
    (certificate,) = made(certificates.roots_inside, x**5 - 4 * x + 1, x, -2, 1)
    assert certificate["roots"] == 2
    for path in leaves(certificate):
        if path[0] not in ("low", "high"):  # with another end the count may still be right
            assert not accepts(changed(certificate, path, bumped)), path


@pytest.mark.parametrize(
    ("expression", "low", "high"),
    [
        (x - HALF, 0, 1),
        ((x - HALF) ** 2, 0, 1),
        (x - sympy.Rational(1, 10**9), 0, 1),
        (-x, 0, sympy.oo),
        (sympy.Integer(0), 0, 1),
        (1 / x, -1, 0),
    ],
)
def test_what_is_not_positive_gets_none(expression, low, high):
    assert made(certificates.positive_on, expression, x, low, high) == []
    assert not certificates.positive_on(expression, x, low, high)


def test_nearly_zero_inside_needs_a_higher_degree():
    assert certificates.positive_on((x - HALF) ** 2 + sympy.Rational(1, 40), x, 0, 1)


def test_what_is_not_found_is_an_error_not_a_no():
    with pytest.raises(ArithmeticError, match="no certificate"):
        certificates.positive_on((x - HALF) ** 2 + sympy.Rational(1, 10**6), x, 0, 1)
    with pytest.raises(ArithmeticError, match="multiple root"):
        certificates.roots_inside((x - HALF) ** 2, x, 0, 1)


@pytest.mark.parametrize(
    "data", [{}, {"kind": "none"}, {"kind": "definite", "form": ["a"], "sign": 1}, {"kind": "chain"}]
)
def test_damaged_data_prove_nothing(data):
    assert not accepts(data)


def test_a_relation_that_is_no_root_is_refused():
    (certificate,) = made(certificates.identical, *SHAPES["root"][1:])
    assert not accepts(certificate | {"relation": [[[[0, 0, 0], 1]], [[[0, 0, 0], 1]], [[[0, 0, 0], 1]]]})


def test_nothing_is_shared_between_maker_and_checker(clone):
    for name in ("checking.py", "plain.py"):
        text = (clone / "singimpact" / "algebra" / name).read_text()
        assert "sympy" not in text
        assert "flint" not in text
        assert text.count("\n") < 170
        assert "import certificates" not in text


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-9, 9), min_size=1, max_size=6))
def test_a_yes_is_right_and_a_no_too(coefficients):
    """Against counts of roots: a positive polynomial is never refused, only left without a certificate."""
    poly = sympy.Poly(coefficients, x)
    ends_and_roots = 0 if poly.degree() < 1 else poly.count_roots(0, 1) - sum(poly.eval(end) == 0 for end in (0, 1))
    positive = ends_and_roots == 0 and poly.eval(HALF) > 0
    try:
        assert certificates.positive_on(poly.as_expr(), x, 0, 1) == positive
    except ArithmeticError:
        assert positive
