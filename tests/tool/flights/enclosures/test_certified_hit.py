"""Certified flights of analytic models: the truth lies in the ball, with all digits, and what is refused says why."""

import sys
import threading
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from reference_states import states
from scipy.integrate import solve_ivp

from singimpact.algebra import Balls, balls_at, constant, exact
from singimpact.bench import PARAMETRIC, SMOOTH, STEEP, drawn_of
from singimpact.flights import Launch, NoHit, Refused, certified_hit
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.oscillator import Oscillator
from singimpact.status import Status

DUFFING = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(w*t)", "0.3", "0.6", {"w": "1.7"})
PENDULUM = ImpactOscillator("xdot/10 + sin(x)", "cos(1.7*t)", "-0.25", "0.8")
DOUBLE = Fraction(1, 2**52)


def hit(osc, tau, v, digits, horizon=60):
    return certified_hit(osc, Launch(constant("tau", tau), constant("v", v)), digits, Fraction(horizon))


def holds(certified, number, relative=DOUBLE):
    """Whether a number that is right to a relative error may lie within the radius."""
    off = abs(exact("value", certified.value) - number)
    return off <= exact("radius", certified.radius) + relative * abs(number)


def test_reference_states_are_certified_to_thirty_digits():
    for problem in states("duffing")[::12]:
        step = problem.model().impact_map(problem.tau, problem.v, digits=30)
        assert step.notes == {}, problem
        for name, truth in (("flight_time", problem.flight_time), ("v", problem.v_next)):
            found, number = getattr(step.certified, name), Fraction(truth)
            assert holds(found, number), problem
            assert not holds(found, number * (1 + 4 * DOUBLE)), problem  # a test that cannot fail is none
            assert found.radius <= abs(found.value) * mpmath.mpf(10) ** -30


@pytest.mark.parametrize(
    "family",
    [
        pytest.param(each, marks=pytest.mark.slow if i % 2 else (), id=each.name)
        for i, each in enumerate((*SMOOTH, PARAMETRIC[0]))
    ],
)
def test_twenty_digits_contain_forty(family):
    case = drawn_of(family, np.random.default_rng(3), 4)
    osc = case.oscillator()
    for tau, v in zip(case.tau.tolist(), case.v.tolist(), strict=True):
        try:
            rough, fine = hit(osc, tau, v, 20), hit(osc, tau, v, 40)
        except NoHit:
            continue
        with balls_at(300):
            assert all(a.contains(b.mid()) for a, b in zip(rough[:4], fine[:4], strict=True))
            assert all(b.rad() < abs(b.mid()) * 1e-40 for b in fine[:4])


@pytest.mark.parametrize("family", [*STEEP[::5], *PARAMETRIC[1:3]], ids=lambda family: family.name)
def test_steep_families_are_certified_too(family):
    case = drawn_of(family, np.random.default_rng(4), 1)
    tau, v = float(case.tau[0]), float(case.v[0])
    step = case.oscillator().first_hit(tau, v, digits=15, horizon=30)
    if step.certified is None:
        assert "proved" in step.notes[0]
        return
    finer = hit(case.oscillator(), tau, v, 30, 30)
    assert holds(step.certified.flight_time, Fraction(float(finer.flight_time)))


@pytest.mark.parametrize("off", [1e-3, 1e-9, 1e-15])
def test_next_to_a_graze_all_digits_are_there(off):
    """A flight that would touch at its time 1 exactly, launched a little slower or faster."""
    osc = ImpactOscillator("x**3", "6*t - 4 + (t*(t - 1)**2)**3", 0, "1/2")
    under = osc.impact_map(0, Fraction(1) - Fraction(off), digits=25)
    assert under.certified is not None
    assert abs(under.certified.flight_time.value - 1) < 2 * off**0.5
    over = osc.first_hit(0, Fraction(1) + Fraction(off), digits=25, horizon=2)
    assert over.status == Status.no_return
    assert over.certified is None
    assert over.notes[0] == "not certified: proved: no hit comes before 2"


def test_the_exact_graze_is_refused_with_its_reason():
    osc = Oscillator("x**3", "6*t - 4 + (t*(t - 1)**2)**3", 0, "1/2")
    with pytest.raises(Refused, match="x - c and x' both vanish"):
        hit(osc, 0, 1, 12, 2)


def test_what_is_not_certified_says_why():
    assert "at rest" in DUFFING.impact_map("0.9", 0, digits=20).notes[0]
    kink = ImpactOscillator("x", "sqrt((t - 2.5)**2) - 2", "-0.25", "0.8").impact_map(1, "3.2", digits=15)
    assert kink.certified is None
    assert "analytic" in kink.notes[0]
    gone = PENDULUM.impact_map(1.0, 4.0, digits=20, horizon=40)
    assert (gone.status, gone.certified) == (Status.no_return, None)
    assert gone.notes[0] == "not certified: proved: no hit comes before 40"


def test_from_rest():
    """The mass leaves the wall at a phase with a_c > 0."""
    tau = 1.0
    step = PENDULUM.impact_map(tau, 0, digits=30)

    def fall(t, y):
        return [y[1], np.cos(1.7 * t) - y[1] / 10 - np.sin(y[0])]

    end = tau + float(step.flight_time)
    flown = solve_ivp(fall, (tau, end), [-0.25, 0.0], rtol=1e-12, atol=1e-14).y[:, -1]
    assert abs(flown[0] + 0.25) < 1e-12
    assert abs(flown[1] - float(step.certified.velocity.value)) < 1e-11


@pytest.mark.parametrize("damping", ["0", "0.002"])
def test_long_linear_flights(damping):
    osc = linear("1.001", -20, "0.8", damping=damping)
    step = osc.impact_map("0.9", "0.005", digits=30)
    more = osc.impact_map("0.9", "0.005", digits=60)
    assert step.flight_time > 60  # radians: more than one expansion reaches
    for name in ("flight_time", "velocity", "tau", "v"):
        found = getattr(step.certified, name)
        assert found.contains(getattr(more.certified, name).value)
        assert found.radius < abs(found.value) * mpmath.mpf(10) ** -30


def test_far_from_time_zero_no_digits_are_lost():
    near = DUFFING.impact_map("1.4", "0.6", digits=30).certified
    far = DUFFING.impact_map("1.4 + 2000000*pi/1.7", "0.6", digits=30).certified
    with mpmath.workdps(50):
        assert abs(near.v.value - far.v.value) <= near.v.radius + far.v.radius


@pytest.mark.parametrize("tau", ["1.4", "101.4"])
@pytest.mark.parametrize(("name", "text"), [("w", "cos(w*t)"), ("A", "A*cos(1.7*t)")])
def test_the_derivative_by_a_number_far_from_time_zero(tau, name, text):
    """Of a launch time far from 0 whole periods are taken off only where the number does not move the period."""
    osc = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", text, "0.3", "0.6", {name: "1.7"})
    found = osc.enclosed_impact(tau, "0.6", radii={name: "1e-8"}, digits=12)
    ends = [osc.replace(**{name: 1.7 + s}).impact_map(float(tau), 0.6) for s in (-1e-6, 1e-6)]
    for part, row in zip(("tau", "v"), found.derivative, strict=True):
        difference = (getattr(ends[1], part) - getattr(ends[0], part)) / 2e-6
        assert float(row[2].value) == pytest.approx(difference, rel=1e-5)


def test_arrays_have_a_certificate_for_each_state():
    step = DUFFING.impact_map([[1.4, 1.2]], [[0.6], [0.0]], digits=20)
    assert step.certified.shape == (2, 2)
    assert all(part is not None for part in step.certified[0])
    one = DUFFING.impact_map(1.2, 0.6, digits=20)
    assert step.certified[0, 1] == one.certified
    assert DUFFING.impact_map([1.4, 1.2], 0.6).certified is None


def test_threads_fly_at_their_own_precision():
    wanted = {digits: DUFFING.impact_map("1.4", "0.6", digits=digits).certified.v for digits in (15, 30, 60)}
    found: dict[tuple[int, int], object] = {}

    def fly(place, digits):
        with balls_at(40 + place):
            Balls(40 + place).pi()
        found[place, digits] = DUFFING.impact_map("1.4", "0.6", digits=digits).certified.v

    threads = [threading.Thread(target=fly, args=(place, digits)) for place in range(4) for digits in wanted]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert len(found) == 12
    assert all(value == wanted[digits] for (_, digits), value in found.items())


def test_certified_and_plain_answers_agree():
    for problem in states("linear")[::150]:
        osc = problem.model()
        step, plain = (osc.impact_map(problem.tau, problem.v, **given) for given in ({"digits": 20}, {}))
        assert step.certified is not None, problem
        assert abs(float(step.certified.flight_time.value) / plain.flight_time - 1) < 1e-9


def test_a_ball_that_is_too_wide_for_any_step_is_refused_and_not_halved_for_ever():
    """A fast launch of a stiff van der Pol oscillator: next to the hit the ball of the state is wider than x - c.

    The end of the step was drawn in without end, in search of a sign that the ball cannot have.
    """
    osc = Oscillator("x - mu*(1 - x**2)*xdot", "A*cos(omega*t)", 0.1135627060726424, "1/2",
                     {"mu": 3, "A": "1.5", "omega": 0.911900093013525})  # fmt: skip
    launch = Launch(constant("tau", 17.926628581506485), constant("v", 6))
    tried = []
    module = sys.modules[certified_hit.__module__]
    honest = module.first_root

    def counted(*given):
        tried.append(given)
        assert len(tried) < 1000
        return honest(*given)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "first_root", counted)
        hit = certified_hit(osc, launch, 20, Fraction(30), expected=(6.193177174171359, 1.0))
    assert float(hit.flight_time) == pytest.approx(6.193177174171359, rel=1e-12)
    assert hit.flight_time.rel_accuracy_bits() > 66
