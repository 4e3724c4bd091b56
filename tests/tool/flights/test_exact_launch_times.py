"""Launch times that no double holds, beside closed forms at the exact time: text, integers, fractions, int64."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si

RNG = np.random.default_rng(53)


def closed_form(omega, clearance, tau, v, guess):
    """First-hit time and velocity of x'' + x = cos(omega t), by Newton's method on the closed form at 60 digits."""
    with mpmath.workdps(60):
        omega, clearance, v = mpmath.mpf(str(omega)), mpmath.mpf(str(clearance)), mpmath.mpf(v)
        tau = mpmath.mpf(tau.numerator) / tau.denominator
        size = 1 / (1 - omega**2)
        a = clearance - size * mpmath.cos(omega * tau)
        b = v + size * omega * mpmath.sin(omega * tau)

        def x(t):
            return a * mpmath.cos(t) + b * mpmath.sin(t) + size * mpmath.cos(omega * (tau + t)) - clearance

        time = mpmath.findroot(x, mpmath.mpf(guess))
        return float(time), float(mpmath.diff(x, time))


def late_times(count):
    """Times between 1e12 and 1e24 in forms that doubles do not hold."""
    for _ in range(count):
        whole = int(RNG.integers(2**53, 2**62))
        yield Fraction(whole), whole
        yield Fraction(whole), np.int64(whole)
        yield Fraction(whole, 3), Fraction(whole, 3)
        text = f"{int(10 ** RNG.uniform(12, 24))}.{int(RNG.integers(1, 999)):03d}"
        yield Fraction(text), text


@pytest.mark.parametrize("omega", ["2", "2.8", "0.37"])
def test_flights_from_late_launches_are_those_of_the_exact_time(omega):
    osc = si.linear(omega, "-0.3", "0.5")
    for exact, written in late_times(6):
        v = float(RNG.uniform(0.2, 2))
        hit = osc.first_hit(written, v)
        time, velocity = closed_form(omega, "-0.3", exact, v, hit.flight_time)
        assert abs(hit.flight_time / time - 1) <= 10 * hit.condition * 2.0**-52
        assert abs(hit.velocity / velocity - 1) <= 10 * hit.velocity_condition * 2.0**-52
        step = osc.impact_map(written, v)
        assert abs(Fraction(float(step.tau)) - exact - Fraction(time)) <= Fraction(float(np.spacing(step.tau)))
        for other in (osc.orbit(written, v, impacts=1).v[1], osc.iterate(written, v, 1).v,
                      osc.iterate(written, v, 1, keep=True).v[1], osc.launch("-0.3", v, written).v):  # fmt: skip
            assert other == pytest.approx(step.v, rel=1e-13)
        assert osc.acceleration(written) == pytest.approx(float(mpmath.cos(0)) * _force(omega, exact), abs=1e-14)


def _force(omega, tau):
    with mpmath.workdps(60):
        return float(mpmath.cos(mpmath.mpf(omega) * tau.numerator / tau.denominator) + mpmath.mpf("0.3"))


def test_taylor_flights_from_late_launches_are_those_of_the_exact_time():
    osc = si.ImpactOscillator("x + x**3/10", "cos(2*t)", "0.1", "0.5")
    for exact, written in late_times(2):
        with mpmath.workdps(60):
            tau = mpmath.mpf(exact.numerator) / exact.denominator
            phase = float(tau - mpmath.pi * mpmath.nint(tau / mpmath.pi))
        late, early = osc.first_hit(written, 0.7), osc.first_hit(phase, 0.7)
        assert late.flight_time == pytest.approx(early.flight_time, rel=1e-14)


def test_an_orbit_from_a_late_launch_goes_on_from_its_phase():
    osc = si.linear(2, "0.1", "0.8")
    late, early = osc.orbit("1e15", 1, impacts=6000), osc.orbit("1e15", 1, impacts=40)
    assert late.v[:41] == pytest.approx(early.v, rel=1e-9)
    with mpmath.workdps(60):
        phase = float(mpmath.mpf(10) ** 15 - mpmath.pi * mpmath.nint(mpmath.mpf(10) ** 15 / mpmath.pi))
    assert late.v[:30] == pytest.approx(osc.orbit(phase, 1, impacts=29).v, rel=1e-6)


def test_without_a_period_the_error_says_what_the_double_lost():
    osc = si.ImpactOscillator("x", "cos(t) + cos(sqrt(2)*t)/2", "0.2", "0.5")
    for _ in range(6):
        written = int(RNG.integers(2**53, 2**60)) | 1
        hit, exact = osc.first_hit(written, 1), osc.first_hit(written, 1, digits=25)
        assert abs(hit.flight_time / float(exact.flight_time) - 1) <= hit.error or hit.error > 0.1
        assert hit.error > 1e-10


CONDITIONED = [
    (si.linear("2.8", "0.1", "0.7"), 2.8),
    (si.linear("0.9", 0, "0.7", damping="0.2"), 0.9),
    (si.ImpactOscillator("x + x**3/10", "cos(2*t)", "0.1", "0.5"), 2.0),
]


@pytest.mark.parametrize(("model", "omega"), CONDITIONED)
def test_condition_is_the_number_that_the_page_on_trust_defines(model, omega):
    """kappa = 1 + (|dT/dtau| max(|tau_P|, T) + |dT/dv| v)/T, derivatives by differences of flights of 30 digits."""
    period = 2 * np.pi / omega
    for _ in range(6):
        tau, v = float(RNG.uniform(-40, 40)), float(RNG.uniform(0.2, 2))
        hit = model.first_hit(tau, v)
        if hit.status != si.Status.hit or hit.condition > 1e6:
            continue
        step = Fraction(1, 10**9)
        by_tau = _slope(model, Fraction(tau), Fraction(v), step, 0)
        by_v = _slope(model, Fraction(tau), Fraction(v), step, step)
        phase = tau if abs(tau) <= period else tau - period * round(tau / period)
        reach, time = max(abs(phase), hit.flight_time), hit.flight_time
        kappa = 1 + (abs(by_tau[0]) * reach + abs(by_v[0]) * v) / time
        moved = 1 + (abs(by_tau[1]) * reach + abs(by_v[1]) * v) / abs(hit.velocity)
        assert hit.condition == pytest.approx(kappa, rel=1e-5)
        assert hit.velocity_condition == pytest.approx(moved, rel=1e-5)


def _slope(model, tau, v, step, along_v):
    ends = [model.first_hit(tau if along_v else tau + side * step, v + side * along_v, digits=30) for side in (-1, 1)]
    twice = 2 * mpmath.mpf(step.numerator) / step.denominator
    return [float((getattr(ends[1], name) - getattr(ends[0], name)) / twice) for name in ("flight_time", "velocity")]


def test_masked_numbers_are_refused():
    masked = np.ma.array([0.1, 0.2, 0.3], mask=[False, True, False])
    osc = si.linear(2, 0, "0.5")
    for ask in (lambda: osc.first_hit(masked, 1), lambda: osc.iterate(0.1, masked), lambda: osc.acceleration(masked)):
        with pytest.raises(si.InputError, match="masked"):
            ask()
    assert osc.first_hit(np.ma.array([0.1, 0.2]), 1).status.shape == (2,)


@pytest.mark.parametrize("tau", [2**53 + 1, "1000000000000000.3", Fraction(10**17 + 1, 3)])
def test_the_acceleration_at_an_exact_time_without_a_period(tau):
    """Against 50 digits: no double is near enough to these times."""
    model = si.ImpactOscillator("0", "cos(t) + cos(sqrt(2)*t)", 0, "1/2")
    exact = Fraction(tau)
    with mpmath.workdps(50):
        t, root = mpmath.mpf(exact.numerator) / exact.denominator, mpmath.sqrt(2)
        value = float(mpmath.cos(t) + mpmath.cos(root * t))
        slope = float(-mpmath.sin(t) - root * mpmath.sin(root * t))
    assert model.acceleration(tau) == pytest.approx(value, abs=1e-15)
    assert model.acceleration([tau, 0.5], order=1)[0] == pytest.approx(slope, abs=1e-15)


def test_a_lift_off_after_an_exact_time_is_that_of_its_phase():
    model = si.linear("2.3", "0.3", "0.6")
    assert model.release(2**53 + 1) == 2.0**53  # at once: the double next to it
    for tau in (10**9 + 1, "1000000001.25"):
        with mpmath.workdps(40):
            period = 2 * mpmath.pi / mpmath.mpf("2.3")
            time = mpmath.mpf(Fraction(tau).numerator) / Fraction(tau).denominator
            turns = mpmath.floor(time / period)
            phase, begun = float(time - turns * period), float(turns * period)
        assert model.release(tau) - begun == pytest.approx(model.release(phase), abs=1e-6)
    with pytest.raises(si.InputError, match="give one number"):
        model.release([1, 2])
