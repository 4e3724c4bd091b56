"""Thresholds in many digits: the guided search against the one that needs no series, and the number of flights."""

from fractions import Fraction

import pytest

import singimpact as si
from singimpact.algebra import constant
from singimpact.contact import next_zero
from singimpact.dynamics import enclosed, guided, newton
from singimpact.flights import AnalyticFlow
from singimpact.status import Status

MODELS = {
    "plain": (si.linear("2.8", 0, "0.5"), "pi/2.8"),
    "r = 0.8": (si.linear("2.8", 0, "0.8"), "1.05"),
    "damped": (si.linear(2, "0.3", "0.6", damping="0.3"), "1.2"),
    "two waves": (si.ImpactOscillator("x", "cos(2*t) + sin(6*t)/9", "0.4", "0.5"), "1.6"),
    "swan": (si.linear("2.8", 1, "0.5"), "-0.2"),
    "far": (si.linear("2.8", 0, "0.5"), "3000.3*2*pi/2.8"),
}


@pytest.mark.parametrize("name", MODELS)
def test_the_guided_search_finds_what_the_secants_find(name, monkeypatch):
    osc, tau = MODELS[name]
    found = si.threshold(osc, tau, digits=18)
    assert found.status == Status.complete
    monkeypatch.setattr(enclosed, "guided", lambda *_: None)
    other = si.threshold(osc, tau, digits=22)
    assert found.certified.contains(other.certified.value)
    low, high = (Fraction(str(found.certified.value)) + sign * Fraction(3, 10**19) for sign in (-1, 1))
    assert low < Fraction(str(other.certified.value)) < high


@pytest.mark.parametrize("name", ["plain", "r = 0.8"])
def test_thirty_digits_take_few_flights_and_one_precision(name, monkeypatch):
    """What a threshold costs: some thirty flights three times for v, and two orbits that leave gamma."""
    osc, tau = MODELS[name]
    flown, fly = [], AnalyticFlow.first_hit
    monkeypatch.setattr(AnalyticFlow, "first_hit", lambda self, *given: flown.append(self.balls.bits) or fly(
        self, *given))  # fmt: skip
    found = si.threshold(osc, tau, digits=30)
    assert found.certified.radius < found.v * 10**-30
    assert len(flown) < (400 if name == "plain" else 900)
    assert len(set(flown)) == 2


def test_a_velocity_beside_gamma_is_not_certified(monkeypatch):
    """The search proves nothing: where it is wrong in the last digits, no enclosure comes out."""
    osc, tau = MODELS["plain"]
    right = newton
    monkeypatch.setattr(enclosed, "newton", lambda *given: right(*given) * (1 + Fraction(1, 10**24)))
    place = constant("tau", tau)
    rough, end = si.threshold(osc, tau), next_zero(osc, place).zero
    assert enclosed.threshold(osc, place, rough.v, end, 30) is None
    assert enclosed.threshold(osc, place, rough.v, end, 20) is not None


def test_a_rough_velocity_away_from_gamma_is_not_followed():
    osc, tau = MODELS["plain"]
    place = constant("tau", tau)
    end = next_zero(osc, place).zero
    assert guided(osc, place, 0.11, end, 30) is None
    assert guided(osc, place, 0.10086999126925593, end, 30).impacts < 40
