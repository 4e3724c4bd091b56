"""Names and numbers of contact orders, and the digits that tangency points are asked for."""

from fractions import Fraction

import flint
import mpmath
import pytest

import singimpact as si
from singimpact.algebra import Zero, balls_at, parse
from singimpact.contact import MOST_DIGITS, Contact, contact_order, enclosed
from singimpact.contact.points import _beside
from singimpact.inputs import InputError
from singimpact.theory import generic_sheet


@pytest.mark.parametrize(
    ("name", "order"), [("generic", 0), ("regular", 0), ("tangency", 1), ("swan", 2), (0, 0), (3, 3), (12, 12)]
)
def test_a_contact_order_has_a_name_or_a_number(name, order):
    assert contact_order(name) == order


@pytest.mark.parametrize("wrong", [13, -1, True, 1.0, "swans"])
def test_any_other_is_refused(wrong):
    with pytest.raises(InputError, match=r"contact order 0\.\.12"):
        contact_order(wrong)


@pytest.mark.parametrize("digits", [True, 2.5, 0, -3, MOST_DIGITS + 1, "20"])
def test_digits_are_a_whole_number_in_a_range(digits):
    point = si.tangency_points(si.linear(2, "0.3", "0.5"))[0]
    with pytest.raises(InputError, match="digits"):
        point.certified(digits)


def test_one_digit_and_many_are_reached():
    point = si.tangency_points(si.linear(2, "0.3", "0.5"))[0]
    few, many = point.certified(1), point.certified(300)
    assert abs(few.value - many.value) <= few.radius + many.radius
    assert many.radius < 1e-299


def test_bits_are_enough_at_the_first_attempt():
    asked = []

    def ball(bits):
        asked.append(bits)
        with balls_at(bits):
            return flint.arb.pi()

    for digits in (1, 20, 300):
        asked.clear()
        assert abs(enclosed(ball, digits).value - mpmath.pi) < 10.0 ** (1 - digits) + 1e-15
        assert len(asked) == 1
        assert asked[0] < 4 * digits + 40


@pytest.mark.parametrize("j", range(4))
def test_generic_jets_are_those_that_the_sheet_contains(j):
    for order in range(j + 1, 7):
        v = generic_sheet(j, order)
        used = {str(name) for name in v.to_sympy(v.v).free_symbols} - {"sigma", "t"}
        assert set(Contact.generic(j, order).ring.names) == used


@pytest.mark.parametrize(
    ("text", "turn", "slope", "kinds"),
    [
        ("t*(2 - t)", 1, -1, ["gamma"]),  # the left end is a zero, and belongs to the piece; the right one does not
        ("t*(t - 2)", 1, 1, ["foliation"]),
        ("(2*t - 1)*(3 - 2*t)", 1, -1, ["gamma", "foliation"]),
        ("t**2 + 1", 1, 1, []),
    ],
)
def test_zeros_beside_an_extremum(text, turn, slope, kinds):
    function = parse(text, ["t"])
    found = _beside(function, Zero(Fraction(0), Fraction(2), 0), Fraction(turn), slope)
    assert [point.kind for point in found] == kinds
