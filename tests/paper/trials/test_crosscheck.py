"""Truncation and gamma on true orbits, by DOP853 and in many digits."""

import pytest

from singimpact.contact import Contact
from singimpact.paper import gamma_cases, scipy_flow
from singimpact.paper.trials import true_sheet
from singimpact.theory import Sheet, sheet

CASES = [(0, 3), (0, 4), (1, 2), (1, 3), (1, 5), (2, 3), (2, 4)]


@pytest.mark.parametrize(("j", "order"), CASES)
def test_remainder_has_the_degree_of_the_first_omitted_term(j, order):
    for case in true_sheet.remainders(j, order):
        assert case.agrees, case.line()


def test_parity_raises_the_degree():
    """At the swan of the linear oscillator the terms of degree 4 vanish exactly."""
    expected = {case.name: case.expected for case in true_sheet.remainders(2, 3) if case.quantity == "v_c"}
    assert expected["linear, omega 2, DOP853"] == 5
    assert expected["damped Duffing, omega 1.7, DOP853"] == 4


def test_a_wrong_term_shows():
    place = true_sheet.setting("linear, omega 2", 1)
    right = sheet(Contact.of(place.model, place.tau, 1, 3, true_sheet.DOUBLES), 3)
    wrong = Sheet(right.contact, 3, right.v.scaled(1.01))
    flow = scipy_flow(place.model, float(place.tau))
    assert true_sheet.measured(right, flow, "v_c", list(true_sheet.REMAINDER_STEPS)) > 3.8
    assert true_sheet.measured(wrong, flow, "v_c", list(true_sheet.REMAINDER_STEPS)) < 2.2


@pytest.mark.parametrize("j", [1, 2])
def test_leading_coefficient_of_gamma(j):
    cases = gamma_cases(j)
    assert len(cases) == 3
    for case in cases:
        assert case.error < (1e-10 if "40 digits" in case.name else 1e-3), case.line()
        assert abs(case.ratio / case.multiplier - 1) < 1e-3


def test_gamma_against_the_reference(reference):
    found = {case.name: case.found for case in gamma_cases(1)}
    linear = float(reference["gamma.C2[linear w=2,c=0.3,r=0.5]"])
    duffing = float(reference["gamma.C2[duffing w=1.7,c=0.3,r=0.6,d=0.1,k3=0.3]"])
    assert found["linear, omega 2, tangency, DOP853"] == pytest.approx(linear, rel=1e-8)
    assert found["damped Duffing, omega 1.7, tangency, DOP853"] == pytest.approx(duffing, rel=1e-8)
