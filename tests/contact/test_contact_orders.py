"""Names and numbers of contact orders, and the digits that tangency points are asked for."""

import pytest

import singimpact as si
from singimpact.contact.contact import contact_order
from singimpact.contact.points import MOST_DIGITS
from singimpact.inputs import InputError


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
