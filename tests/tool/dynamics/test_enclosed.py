"""Enclosed chatter limits and thresholds: they contain what other routes give in more digits, and nothing else."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from singimpact.algebra import Certified, as_rational, balls_at, exact
from singimpact.bench import values
from singimpact.dynamics import chatter, enclosed
from singimpact.dynamics.threshold import threshold
from singimpact.flights import AnalyticFlow, States
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.inputs import InputError
from singimpact.status import Status

STATES = {
    "irrational": (linear("2.8", 0, "0.8"), "pi/3.5", "sqrt(2)/200"),
    "damped": (linear("2", "0.3", "0.6", damping="0.3", phase="1/7"), "1.1", "0.01"),
    "stiff, driven": (linear("1.3", "-0.2", "0.5", damping="-0.1", stiffness=3, amplitude="0.5"), "1.9", "0.05"),
    "two waves": (ImpactOscillator("x", "cos(2*t) + sin(6*t)/9", "0.4", "0.5"), "1.2", "0.02"),
    "from rest": (linear("2", "0.99", "0.5"), "0", "0"),
    "bouncing ball": (ImpactOscillator("0", "-9.81", 0, "0.9"), "sqrt(2/9.81)", "0.9*sqrt(2*9.81)"),
}


@pytest.mark.parametrize("name", STATES)
def test_chatter_limit_contains_what_mpmath_and_the_completion_map_give(name):
    osc, tau, v = STATES[name]
    states = States.of(osc, tau, v)
    found = enclosed.chatter_limit(osc, states, 15)
    rough = chatter.chatter_limit(osc, tau, v)
    assert (rough.status == Status.lifts_off) == found.lost
    other = chatter._precise(osc, states, rough, 22).tau
    with mpmath.workdps(60):
        assert found.tau.radius <= mpmath.mpf(10) ** -15 * abs(found.tau.value)
        known = Certified(found.tau.value, found.tau.radius + mpmath.mpf(10) ** -21 * abs(other), 15)
        assert known.contains(other)
        for wrong in (other + 3 * known.radius, other - 3 * known.radius, other * (1 + mpmath.mpf(10) ** -12)):
            assert not known.contains(wrong)


@pytest.mark.parametrize("r", ["0.5", "0.9"])
def test_chatter_limit_contains_the_reference(r):
    found = linear(2, "0.3", r).chatter_limit("1.2", "0.01", digits=30)
    truth = Fraction(values()[f"chatter.tau_inf.linear[w=2,c=0.3,r={r}](1.2,0.01)"])
    assert found.certified.contains(truth)
    assert not found.certified.contains(truth + Fraction(1, 10**28))


def test_foot_of_the_stable_manifold_through_A_contains_the_reference():
    """From rest at the tangency point A itself: tau_* is a root, so the flight's first two coefficients are zero."""
    found = linear(2, "0.99", "0.5").chatter_limit("root(cos(2*u) - 0.99, -0.1, -0.05)", 0, digits=36).certified
    truth = Fraction(values()["negswan.X[w=2,c=0.99,r=0.5]"])
    assert found.contains(truth)
    assert not found.contains(truth + Fraction(1, 10**34))


def test_chatter_from_afar_contains_the_reference():
    """202 impacts; the value is that of the issue, 30 digits."""
    found = linear("2.8", 0, "0.8").chatter_limit("0.9", "0.005", digits=28)
    assert found.certified.contains(Fraction("0.959359234422082626031840228653"))
    assert not found.certified.contains(Fraction("0.959359234422082626031840229"))


def test_more_digits_stay_within():
    osc = linear(2, "0.3", "0.5")
    many = osc.chatter_limit("1.2", "0.01", digits=300).certified
    for digits in (5, 20, 60):
        assert osc.chatter_limit("1.2", "0.01", digits=digits).certified.contains(many.value)


@pytest.mark.parametrize(
    ("osc", "state"),
    [
        (linear(2, "1", "0.5"), ("-0.3", "0.00569544108120008432191940558473226")),
        (linear("2.8", 0, "0.8"), ("0.9", "0.005")),
        pytest.param(ImpactOscillator("x + x**3", "cos(2*t)", "0.3", "0.5"), ("1", "0.02"), marks=pytest.mark.slow),
    ],
)
def test_impacts_are_not_flown_when_their_digits_are_lost(osc, state, monkeypatch):
    """Next to gamma the flights lose digits: 200 000 impacts were flown at a precision that could not decide."""
    flown = []

    class Counted(AnalyticFlow):
        def first_hit(self, *given, **more):
            flown.append(self.balls.bits)
            return super().first_hit(*given, **more)

    monkeypatch.setattr(enclosed, "AnalyticFlow", Counted)
    for digits in (16, 20, 22, 24, 32):
        flown.clear()
        found = chatter.chatter_limit(osc, *state, digits=digits)
        assert found.certified.digits == digits
        assert len(flown) <= (len(set(flown)) + 1) * (found.impacts + 1)


def test_contact_that_is_lost_is_enclosed_too():
    osc = linear("2.8", 0, "0.8")
    found = osc.chatter_limit(1.2, 0.3, digits=20)
    assert found.status == Status.lifts_off
    assert abs(float(found.certified.value) - float(osc.chatter_limit(1.2, 0.3).tau)) < 1e-12


def test_models_whose_restitution_is_no_number_below_one_have_none():
    bent = ImpactOscillator("x", "cos(2*t)", "0.3", "-0.6*v + v**2/9")
    assert not enclosed.enclosable(bent)
    assert not enclosed.enclosable(linear(2, "0.3", 1))
    assert bent.chatter_limit("1.2", "0.0001", digits=5).certified is None


def test_rest_bounds_contain_the_bouncing_ball_and_open_when_they_must():
    import flint

    with flint.ctx.workprec(200):
        ball = AnalyticFlow(ImpactOscillator("0", "-2", 0, "0.5"), 200)
        left = enclosed.remaining(ball, ball.number(Fraction(0)), ball.number(Fraction(1)))
        assert left.contains(2)
        assert not left.contains(flint.arb("2.001"))
        fast = AnalyticFlow(linear("2.8", 0, "0.8"), 200)
        assert enclosed.remaining(fast, fast.number(Fraction(9, 10)), fast.number(Fraction(1, 2))) is None


@pytest.mark.parametrize("state", [(1.2, 1e-3), (0.0, 1.0), (2.9, 0.5), (1.2, 1e-30), (0.64, 1e-3)])
def test_first_hit_contains_the_kernels(state):
    import flint

    osc = linear(2, "0.3", "0.5")
    step = osc.first_hit(*state, digits=50)
    with flint.ctx.workprec(140):
        flow = AnalyticFlow(osc, 140)
        hit = flow.first_hit(*(flow.number(Fraction(part)) for part in state))
        for ball, truth in ((hit.time, step.flight_time), (hit.velocity, step.velocity)):
            near = flint.arb(mpmath.nstr(truth, 50), abs(float(truth)) * 1e-37)
            assert ball.overlaps(near)
            assert not ball.overlaps(near * (1 + flint.arb("1e-20")))


def test_a_graze_is_not_decided():
    """From where a first touch is a double root the balls give no hit, rather than one of two."""
    import flint

    # x = t^3 (1 - t)^2/10 has no linear model; x'' + x = cos 2t touches c = -1/3 at rest after pi, from rest at 0
    with flint.ctx.workprec(100):
        flow = AnalyticFlow(linear(2, "-1/3", "0.5"), 100)
        assert flow.first_hit(flow.number(Fraction(0)), flow.number(Fraction(0)), removed=2) is None


def test_threshold_contains_the_reference():
    found = threshold(linear("2.8", 0, "0.5"), "pi/2.8", digits=21)
    truth = Fraction("0.1008699912692559258909")
    assert found.certified.contains(truth)
    assert not found.certified.contains(truth + Fraction(1, 10**20))
    with mpmath.workdps(30):
        assert abs(found.v - mpmath.mpf("0.1008699912692559258909")) <= found.error


def _fate(osc, v, end):
    """By the kernels in many digits: -1 chatter completes before the end, 1 a flight passes it."""
    tau = mpmath.pi / mpmath.mpf("2.8")
    for _ in range(200):
        a = float(osc.acceleration(float(tau)))
        if a < 0 and -2 * v / a / 0.5 < (end - tau) / 50:
            return -1
        step = osc.impact_map(tau, v, digits=45)
        if not float(step.tau) < end:
            return 1
        tau, v = step.tau, step.v
    return 0


def test_the_ends_of_a_threshold_go_two_ways():
    osc = linear("2.8", 0, "0.5")
    found = threshold(osc, "pi/2.8", digits=12).certified
    with mpmath.workdps(45):
        end = 3 * mpmath.pi / mpmath.mpf("5.6")
        ends = [_fate(osc, found.value + sign * found.radius, end) for sign in (-1, 1)]
    assert ends == [-1, 1]


@pytest.mark.parametrize("r", ["0.2", "0.7"])
def test_threshold_agrees_with_doubles(r):
    osc = linear("2.8", 0, r)
    many, few = threshold(osc, "pi/2.8", digits=18), threshold(osc, "pi/2.8")
    assert abs(float(many.certified.value) - few.v) <= few.error


def test_digits_are_checked():
    with pytest.raises(InputError, match="digits"):
        linear(2, "0.3", "0.5").chatter_limit("1.2", "0.01", digits=0)
    assert np.isfinite(float(linear(2, "0.3", "0.5").chatter_limit("1.2", "0.01", digits=1).tau))


ANALYTIC = {
    "cubic, damped": (ImpactOscillator("x + x**3/10 + xdot/20", "cos(2.8*t)", 0, "0.8"), "0.9", "0.005"),
    "pendulum": (ImpactOscillator("sin(x)", "cos(2.8*t)", "0.1", "0.5"), "1.0", "0.02"),
    "van der Pol": (ImpactOscillator("x - (1 - x**2)*xdot/2", "cos(2*t)", "0.2", "0.6"), "0.9", "0.01"),
}


@pytest.mark.parametrize("name", ANALYTIC)
def test_chatter_limit_of_an_analytic_model_contains_more_digits_and_the_completion_map(name):
    osc, tau, v = ANALYTIC[name]
    found = osc.chatter_limit(tau, v, digits=20).certified
    assert found.radius <= abs(found.value) * mpmath.mpf(10) ** -20
    more = osc.chatter_limit(tau, v, digits=30).certified
    assert found.contains(more.value)
    assert not found.contains(more.value + 3 * found.radius)
    # the series of the completion map shares nothing with the bounds of what is left
    states = States.of(osc, tau, v)
    other = chatter._precise(osc, states, chatter.chatter_limit(osc, tau, v), 15).tau
    assert abs(other - found.value) < mpmath.mpf(10) ** -14


@pytest.mark.slow
def test_what_is_left_of_a_chatter_lies_between_its_bounds():
    """The lemma of the tail: the sum of later flights of a model whose force varies on the way."""
    osc = ANALYTIC["cubic, damped"][0]
    end = osc.chatter_limit("0.9", "0.0005", digits=25).certified
    with balls_at(200):
        flow = AnalyticFlow(osc, 200)
        left = enclosed.remaining(flow, flow.number(Fraction(9, 10)), flow.number(Fraction(1, 2000)))
        assert left is not None
        low, high = (as_rational(part) for part in (left.lower(), left.upper()))
    true = exact("end", end.value) - Fraction(9, 10)
    assert low < true < high
    assert high - low < true / 2


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param("cubic, damped", marks=pytest.mark.slow), "pendulum"])
def test_threshold_of_an_analytic_model_is_certified(name):
    osc = ANALYTIC[name][0]
    found, plain = threshold(osc, 1.0, digits=15), threshold(osc, 1.0)
    assert found.certified.radius < abs(found.v) * mpmath.mpf(10) ** -15
    assert abs(float(found.v) - plain.v) < max(10 * plain.error, 1e-11 * plain.v)
    # chatter completes below it and not above, in doubles
    ends = [osc.chatter_limit(1.0, float(found.v) * factor) for factor in (1 - 1e-6, 1 + 1e-6)]
    assert ends[0].status == Status.complete
    assert not (ends[1].status == Status.complete and abs(ends[1].tau - ends[0].tau) < 1e-2)
