"""Jets as one room: two engines give identical results, spaces and rings do not mix, maps are inverted and composed."""

from fractions import Fraction

import pytest
from fold_route import blow_up, divided, implicit, inverse_map
from hypothesis import given, settings, strategies as st
from sympy_ring import SympyExact

from singimpact.algebra import DOUBLES, EXACT, JetSpace, SymbolRing

ENGINES = [EXACT, SympyExact()]
rationals = st.fractions(-3, 3, max_denominator=7)
terms = st.dictionaries(st.tuples(st.integers(0, 3), st.integers(0, 3)), rationals, max_size=6)


def space(ring=EXACT, order=5, weights=()):
    return JetSpace(("x", "y"), order, ring, weights)


@settings(max_examples=30, deadline=None)
@given(terms, terms, st.fractions(1, 4, max_denominator=5))
def test_engines_give_identical_results(left, right, start):
    found = []
    for ring in ENGINES:
        one, other = space(ring).jet({**left, (0, 0): start}), space(ring).jet(right)
        x, y = space(ring).generators()
        moved = other.compose((x + y * y, y - x))
        results = [one * other, one - other, other / one, moved, one.derivative("x"), one.integral("y")]
        results += [blow_up(other)]
        found.append([dict(jet.terms) for jet in results])
    assert found[0] == found[1]


@settings(max_examples=20, deadline=None)
@given(terms, terms)
def test_inverse_map_is_the_inverse_from_both_sides(first, second):
    x, y = space().generators()
    higher = [{key: value for key, value in part.items() if sum(key) > 1} for part in (first, second)]
    images = (x + y.scaled(2) + space().jet(higher[0]), y - x + space().jet(higher[1]))
    back = inverse_map(images)
    for outer, inner in ((images, back), (back, images)):
        assert [dict(jet.compose(inner).terms) for jet in outer] == [dict(x.terms), dict(y.terms)]


def test_implicit_solution_solves():
    x, y = space(order=6).generators()
    equation = y + x - y * y * x + x * x
    found = implicit(equation, "y")
    assert not equation.compose((x, found)).terms
    assert all(key[1] == 0 for key in found.terms)


def test_quotient_times_divisor_over_doubles():
    x, y = space(DOUBLES).generators()
    divisor = x + y.scaled(0.5) + space(DOUBLES).constant(2.0)
    assert ((x / divisor) * divisor - x).terms == pytest.approx(dict.fromkeys(((x / divisor) * divisor).terms, 0.0))


def test_float_does_not_enter_an_exact_ring():
    symbols = SymbolRing(("a",))
    for ring in (EXACT, symbols, SympyExact()):
        with pytest.raises(TypeError):
            space(ring).constant(0.5)
        with pytest.raises(TypeError):
            space(ring).generators()[0].scaled(0.5)
    with pytest.raises(TypeError):
        space(symbols).constant(SymbolRing(("b",)).symbol("b"))


def test_rings_and_spaces_do_not_mix():
    for other in (space(DOUBLES), space(order=4), space(SympyExact())):
        with pytest.raises(TypeError, match="do not mix"):
            space().generators()[0] * other.generators()[0]


def test_loss_of_order_is_explicit():
    x, _ = space().generators()
    assert x.derivative("x").space.order == 4
    assert x.integral("x").space.order == 6
    assert divided(x * x, "x", 1).space.order == 4
    assert x.compose(space(order=3).generators()).space.order == 3
    with pytest.raises(TypeError, match="not known to order 6"):
        x.cut(6)
    with pytest.raises(TypeError, match="do not mix"):
        x + x.derivative("x")
    with pytest.raises(ValueError, match="not divisible"):
        divided(x, "x", 2)


def test_space_is_immutable():
    with pytest.raises(AttributeError):
        space().order = 3


def test_no_reciprocal_without_an_inverse():
    ring = SymbolRing(("a",))
    jets = space(ring)
    with pytest.raises(ArithmeticError):
        jets.constant(ring.symbol("a")).reciprocal()
    with pytest.raises(TypeError, match="weight 0"):
        space(weights=(1, 0)).rational(Fraction(1)).reciprocal()
    with pytest.raises(ValueError, match="no inverse"):
        inverse_map([space().generators()[0]] * 2)


def test_a_symbol_may_bear_the_name_of_a_variable():
    ring = SymbolRing(("x",))
    x, _ = space(ring).generators()
    assert (x * space(ring).constant(ring.symbol("x"))).derivative("x").coefficient((0, 0)) == ring.symbol("x")
