"""Certificates: what is true gets one, what is false none, and a damaged one is rejected."""

import json

import false_certificates as false
import pytest
import sympy
from false_certificates import accepts
from hypothesis import given, settings, strategies as st
from tampering import bumped, changed, leaves

from singimpact.algebra import (
    At,
    collected,
    definite,
    identical,
    left_behind,
    negative_on,
    positive_in,
    positive_on,
    sign_chain,
    substitution,
    value_at,
)
from singimpact.certificates import check_certificate
from singimpact.paper import phi_c
from singimpact.theory import generic_sheet

x, y, r = sympy.symbols("x y r")
HALF = sympy.Rational(1, 2)


QUOTIENT = false.identity([false.poly(-1, 0, 1), false.poly(-1, 1)], [false.poly(1, 1), false.const(1)])


def root_of_two():
    e, w = sympy.symbols("e w")
    moved = At((x + y) ** 2, {x: w, y: e})
    substitution(moved, 2 + 2 * w * e, order=1, small=[e], where=(w**2 - 2, w))


# what a change of these numbers makes is another statement, which happens to be true as well
STILL_TRUE = {
    "pole": ("numerator", "denominator"), "definite": ("form",), "far": ("numerator", "denominator"),
    "vanishing": ("numerator", "denominator"),
}  # fmt: skip


def made(call, *arguments):
    with collected() as found:
        call(*arguments)
    found = [certificate for certificate in found if certificate["kind"] != "motion" or certificate["landing"]][:1]
    return [{"says": check_certificate(certificate), **certificate} for certificate in json.loads(json.dumps(found))]


SHAPES = {
    "positive": (positive_on, (1 - x) * (x + 3) / (2 - x), x, 0, 1),
    "raised": (positive_on, x**2 - x + HALF, x, 0, 1),
    "half-line": (positive_on, x**2 - x + 1, x, 0, sympy.oo),
    "left": (negative_on, x**3 - 1, x, -sympy.oo, 0),
    "box": (positive_in, 2 - x - r * y / (1 + y), {x: (0, 1), y: (0, sympy.oo), r: (0, 1)}),
    "chain": (sign_chain, x**2 - r, x, ((-sympy.oo, 1), (0, -1), (1, 1)), {r: (0, 1)}),
    "value": (value_at, (x**2 - y**2) / (x - y), x, 3),
    "pole": (value_at, y / (x - 1), x, 1),
    "far": (value_at, (3 * x**2 - y) / (2 * x**2 + 1), x, sympy.oo),
    "vanishing": (value_at, x / (x**2 + y), x, -sympy.oo),
    "definite": (definite, -(6 * x**2) - 4 * x * y - y**2, x, y),
    "identity": (left_behind, QUOTIENT),
    "composed": (
        substitution,
        At(x**2 + y, {x: x / (1 + y), y: r}),
        (x**2 + r * (1 + y) ** 2) / (1 + y) ** 2,
    ),
    "to an order": (root_of_two,),
    "motion": (phi_c, 2),
    "flight": (generic_sheet, 1, 2),
    "root": (identical, sympy.sqrt(x / (1 + y)) ** 3, x / (1 + y) * sympy.sqrt(x / (1 + y))),
}


@pytest.mark.parametrize("name", SHAPES)
def test_each_change_of_a_number_is_rejected(name):
    call, *arguments = SHAPES[name]
    (certificate,) = made(call, *arguments)
    assert accepts(certificate)
    for path in leaves(certificate):
        if path[0] not in STILL_TRUE.get(name, ()):
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
    assert made(positive_on, expression, x, low, high) == []
    assert not positive_on(expression, x, low, high)


def test_nearly_zero_inside_needs_a_higher_degree():
    assert positive_on((x - HALF) ** 2 + sympy.Rational(1, 40), x, 0, 1)


def test_what_is_not_found_is_an_error_not_a_no():
    with pytest.raises(ArithmeticError, match="no certificate"):
        positive_on((x - HALF) ** 2 + sympy.Rational(1, 10**6), x, 0, 1)


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"kind": "none"},
        {"kind": "definite", "form": ["a"], "sign": 1},
        {"kind": "chain"},
        false.value([[[-1], 1]], false.const(1), "1", [false.const(1), false.const(1)]),
        false.value([[[1], 1], [[0, 1], 1]], false.const(1), "1", [false.const(1), false.const(1)]),
        false.definite([True, 0, True]),
    ],
)
def test_damaged_data_prove_nothing(data):
    assert not accepts(data)


def test_a_relation_that_is_no_root_is_refused():
    (certificate,) = made(identical, *SHAPES["root"][1:])
    assert not accepts(certificate | {"relation": [[[[0, 0, 0], 1]], [[[0, 0, 0], 1]], [[[0, 0, 0], 1]]]})


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-9, 9), min_size=1, max_size=6))
def test_a_yes_is_right_and_a_no_too(coefficients):
    """Against counts of roots: a positive polynomial is never refused, only left without a certificate."""
    poly = sympy.Poly(coefficients, x)
    ends_and_roots = 0 if poly.degree() < 1 else poly.count_roots(0, 1) - sum(poly.eval(end) == 0 for end in (0, 1))
    positive = ends_and_roots == 0 and poly.eval(HALF) > 0
    try:
        assert positive_on(poly.as_expr(), x, 0, 1) == positive
    except ArithmeticError:
        assert positive


def test_the_first_false_certificates():
    """1/x -> 1 at infinity; w/(w^2 - 2) = 2w/(w^2 - 2) where w^2 = 2."""
    over = [[[2], 1], [[0], -2]]
    for certificate in (
        false.value(false.const(1), false.poly(0, 1), "oo", [false.const(1), false.const(1)]),
        false.value(false.poly(0, 0, 1), false.poly(0, 1), "oo", [false.const(1), false.const(1)]),
        false.identity([false.poly(0, 1), over], [false.poly(0, 2), over],
                       [false.const(1), [[[3], -1], [[1], 2]], over]),
    ):  # fmt: skip
        assert not accepts(certificate)


@pytest.mark.parametrize("name", false.EVERY)
def test_each_condition_of_the_second_program_refuses_something(name):
    condition, instead, certificate = false.EVERY[name]
    assert not accepts(certificate)
    assert false.without(condition, instead)(certificate)


@pytest.mark.parametrize("name", SHAPES)
def test_the_sentence_is_that_of_the_data(name):
    call, *arguments = SHAPES[name]
    (certificate,) = made(call, *arguments)
    assert not accepts(certificate | {"says": certificate["says"] + " "})
    assert not accepts(certificate | {"variables": [*certificate["variables"], "z"]})


def test_sentences_read_as_they_should():
    told = {name: made(*SHAPES[name])[0]["says"] for name in SHAPES}
    assert told["half-line"] == "x**2 - x + 1 > 0 for 0 < x < oo"
    assert told["chain"].endswith("in each of (-oo, 0), (0, 1) and no other, for all 0 < r < 1")
    assert told["vanishing"] == "(x)/(x**2 + y) -> 0 as x -> -oo"
    assert told["pole"] == "(y)/(x - 1) is unbounded as x -> 1"
    assert told["root"].endswith("(x*w)/(y + 1) where -x + y*w**2 + w**2 = 0")
