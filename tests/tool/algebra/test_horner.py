"""The matrix of coefficients: exact to a few units in the last place near contact, and quick."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import EXACT, Horner
from singimpact.contact import Contact
from singimpact.theory import sheet

EPSILON = 2.0**-52


def duffing_sheet(order=8):
    a = {k: Fraction((-1) ** k * (k + 2), 3 + k * k) for k in range(order)}
    f = {(1, 0): Fraction(9, 7), (0, 1): Fraction(1, 10), (2, 0): Fraction(2, 7), (3, 0): Fraction(3, 10)}
    return sheet(Contact(0, EXACT, a, f), order)


def test_relative_error_near_contact():
    """Within 4 epsilon at t = 1e-6 wherever v_c is at least a tenth of the sum of the moduli of its terms."""
    terms = duffing_sheet().v.terms
    sigma = np.linspace(-0.3, 0.3, 301)
    found = Horner(terms)(sigma, 1e-6)
    checked, worst = 0, Fraction(0)
    for n, s in enumerate(sigma.tolist()):
        parts = [c * Fraction(s) ** i * Fraction(1e-6) ** k for (i, k), c in terms.items()]
        value, size = sum(parts), sum(map(abs, parts))
        if abs(value) >= size / 10:
            checked += 1
            worst = max(worst, abs(Fraction(float(found[n])) / value - 1))
    assert checked > 200
    assert worst < 4 * 2.0**-52


@pytest.mark.parametrize("size", [0.3, pytest.param(1e-6, marks=pytest.mark.slow)])
def test_compensated_next_to_z(size):
    """At doubles next to roots of v_c/t plain Horner keeps no digit; with two doubles all but a few units are kept."""
    terms = duffing_sheet().v.terms
    plain, careful = Horner(terms), Horner(terms, compensated=True)
    worst, lost = 0.0, 0.0
    for t in np.linspace(size / 2, size, 25):
        start = -0.15
        for _ in range(60):  # the secant of v_c/t in sigma, in doubles: ends at a double next to the root
            value = careful(start, t) / t
            slope = (careful(start + 1e-7, t) / t - value) / 1e-7
            start -= float(value / slope)
        for sigma in (start, np.nextafter(start, 1), start + 3e-15):
            exact = sum(c * Fraction(float(sigma)) ** i * Fraction(float(t)) ** k for (i, k), c in terms.items())
            size_of_terms = sum(
                abs(c) * abs(Fraction(float(sigma))) ** i * Fraction(float(t)) ** k for (i, k), c in terms.items()
            )
            allowed = 2 * EPSILON + 8 * EPSILON**2 * float(size_of_terms / abs(exact))
            worst = max(worst, abs(float(Fraction(float(careful(sigma, t))) / exact - 1)) / allowed)
            lost = max(lost, abs(float(Fraction(float(plain(sigma, t))) / exact - 1)))
    assert worst < 1
    assert lost > 1e-3


def test_compensated_sheet_of_a_model_against_true_flights():
    """Next to Z, at a tangency in t = 0: the flight launched with v returns after t."""
    model = si.ImpactOscillator("x + xdot/3 + x**2", "t**2 - t", 0, "0.5")
    careful = si.theory.v_c_on_arrays(12, "tangency", model, 0, compensated=True)
    sigma, low, high = -1e-3, 2.5e-3, 3.5e-3
    for _ in range(40):  # v > 0 beyond the root
        middle = (low + high) / 2
        low, high = (low, middle) if careful(sigma, middle) > 0 else (middle, high)
    t, v = high, float(careful(sigma, high))
    assert 0 < v < 1e-16
    with mpmath.workdps(40):
        back = model.first_hit(sigma, v, digits=35).flight_time
        slope = float(si.theory.v_c_on_arrays(12, "tangency", model, 0)(sigma, t + 1e-9) - v) / 1e-9
        assert abs((back - mpmath.mpf(t)) * slope / v) < 4 * EPSILON
