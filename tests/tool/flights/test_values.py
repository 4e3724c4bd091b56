"""The named values of the impact map, to their decimals."""

from __future__ import annotations

import re

import mpmath
import pytest

from singimpact.bench import values
from singimpact.impact_oscillator import ImpactOscillator, linear

DUFFING = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", "0.3", "0.6", {"omega": "1.7"})
LINEAR = linear(2, "0.3", "0.5")
PATTERN = re.compile(r"G\.(linear|duffing)[^.]*?(?:\[[^]]*\])?(\.flight_time)?\(([^,]+),([^)]+)\)(?:\.(tau|v))?$")
NAMES = [name for name in values() if name.startswith("G.")]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("digits", [None, 35])
def test_value(name: str, digits: int | None) -> None:
    found = PATTERN.match(name)
    assert found is not None
    family, flight_time, tau, v, component = found.groups()
    step = {"linear": LINEAR, "duffing": DUFFING}[family].impact_map(tau, v, digits=digits)
    value = getattr(step, "flight_time" if flight_time else component)
    with mpmath.workdps(45):
        truth = mpmath.mpf(values()[name])
        assert abs(value / truth - 1) < (2e-15 if digits is None else mpmath.mpf(10) ** -35)


def test_unfolded_swan_lands_by_the_root_sum_identity() -> None:
    # A = (-acos(c)/2, 0): the flight that lifts off at a tangency lands at 3 tau2; a little later a is positive there
    osc = linear(2, "0.99", "0.5")
    with mpmath.workdps(40):
        landing = mpmath.mpf(values()["negswan.C2.tau[w=2,c=0.99]"])
        start = -landing / 3 * (1 - mpmath.mpf(10) ** -25)
    step = osc.impact_map(start, 0, digits=20)
    assert abs(step.tau - landing) < 1e-15
    assert abs(step.v / -mpmath.mpf(values()["negswan.C2.v[w=2,c=0.99]"]) - 0.5) < 1e-15
