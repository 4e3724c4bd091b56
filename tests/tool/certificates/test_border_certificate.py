"""Certificates of border orbits: accepted as made; other numbers, sides and impacts are refused."""

from __future__ import annotations

from fractions import Fraction

import pytest
from second_program import copied, dropped, is_read_back, no_number_may_change, refuses, renewed

import singimpact as si
from singimpact.certificates import check
from singimpact.inputs import InputError

pytestmark = pytest.mark.slow  # seconds together: .ci/check runs them


@pytest.fixture(scope="module")
def orbit():
    (found,) = si.border_orbits(si.linear("2.8", 0, "0.5"), between=("0.6", "0.61"), points=5, digits=16)
    return found


@pytest.fixture(scope="module")
def made(orbit):
    return si.certify(orbit)


def test_it_is_accepted_from_its_file(made, tmp_path):
    is_read_back(made, tmp_path / "border.json")
    assert repr(made).startswith("<certificate of a border orbit: clearance = 0.604603197697758")
    assert made.content["model"]["clearance"] == "clearance"
    no_number_may_change(made, 7)


def test_a_parameter_of_a_nonlinear_model_has_one():
    model = si.ImpactOscillator("x + 0.1*x**3", "A*cos(2.8*t)", "0.6", "0.5", {"A": "1"})
    (found,) = si.border_orbits(model, over="A", between=("1.03", "1.035"), points=3, digits=16)
    certificate = si.certify(found)
    certificate.check()
    assert certificate.content["model"]["parameters"]["A"] != certificate.content["over"]


def test_a_later_impact_and_a_double_beside_the_zero_say_the_same(made):
    for name, value in (("impacts", "4"), ("end", "4.158872105390695")):
        check(renewed(copied(made.content) | {name: value}))


def test_values_beside_it_are_refused(made):
    for radii in (-3, 3):
        moved = copied(made.content)
        number = moved["parameter"]
        number["value"] = str(float(Fraction(number["value"])) + radii * float(number["radius"]) * 10)
        refuses(moved, "at the ends of the radius")


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [("completes", "below", "at the ends"), ("completes", "beside", "is not above or below"),
     ("impacts", "0", "1 to 10000"),
     ("release", "2.0", "a_c is not shown to rise"), ("end", "4.1", "a_c is not shown to rise"),
     ("over", "restitution", "is not understood")],
)  # fmt: skip
def test_another_statement_is_refused(made, name, value, why):
    refuses(copied(made.content) | {name: value}, why)


def test_another_model_is_refused(made):
    for name, value in (("restitution", "501/1000"), ("g", "cos(2.801*t)"), ("f", "x + xdot/1000")):
        other = copied(made.content)
        other["model"][name] = value
        refuses(other)


def test_the_second_program_needs_both_ends(made, monkeypatch):
    other = copied(made.content)
    other["completes"] = "below"
    refuses(other)
    dropped(monkeypatch, "fates")  # the condition that refuses it
    check(renewed(other))


def test_what_is_not_certified_has_no_certificate(orbit):
    (plain,) = si.border_orbits(si.linear("2.8", 0, "0.5"), between=("0.6", "0.61"), points=5)
    with pytest.raises(InputError, match="the border orbit is not certified: ask for digits="):
        si.certify(plain)
    assert orbit.certified is not None
