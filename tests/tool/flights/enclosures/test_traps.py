"""Where an enclosure of a flight is easily false: each trap is set, and what checks the enclosure falls into it."""

from contextlib import nullcontext
from fractions import Fraction

import flint
import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from singimpact.algebra import analytic, balls_at, constant, series_of_any_length
from singimpact.flights import Column, Equation, Refused, coefficients, programs_of, step
from singimpact.flights.enclosures import certified_hit, taylor_step
from singimpact.oscillator import Oscillator


def hit(osc, tau, v, digits, horizon=60):
    launch = certified_hit.Launch(constant("tau", tau), constant("v", v))
    return certified_hit.certified_hit(osc, launch, digits, Fraction(horizon))


# -- the second derivatives in the equation of a column


def missed_column():
    """By how much a column leaves its polynomial, over the bound; f bends, and P does not see what drives z."""
    osc = Oscillator("3*x**2", "100*t**11", 0, 1)
    with series_of_any_length(), balls_at(60):
        launch = flint.arb(0), flint.arb(0), flint.arb("0.01")
        by_v = Column((flint.arb(0), flint.arb(1)), -1)
        found = step(Equation(programs_of(osc, ()), {}), launch, [by_v], 1)
        h, degree = float(found.length), len(found.coefficients) - 1
        assert degree == 12  # z departs with s^13
        psi = float(flint.arb_poly(found.columns[0])(found.length))
        bound = float(found.column_bounds[0]) * h ** (degree + 1) / (degree + 1)

    def motion(s, y):
        return [y[1], 100 * s**11 - 3 * y[0] ** 2, y[3], -6 * y[0] * y[2]]

    true = solve_ivp(motion, (0, h), [0, 0.01, 0, 1], rtol=1e-13, atol=1e-30, method="DOP853").y[2, -1]
    return abs(true - psi) / bound


def test_a_column_stays_within_its_bound():
    assert missed_column() <= 1


def test_without_the_second_derivatives_it_does_not(monkeypatch):
    monkeypatch.setattr(taylor_step, "_bend", lambda *_: flint.arb(0))
    assert missed_column() > 1


# -- series that flint cuts after ten terms


def pendulum_series(t, x, v, count):
    """Taylor coefficients of x'' = cos(1.7 t) - x'/10 - sin x, one by one, in mpmath numbers."""
    X, S, C = [x, v], [mpmath.sin(x)], [mpmath.cos(x)]
    for k in range(count - 1):
        drive = mpmath.mpf("1.7") ** k * mpmath.cos(mpmath.mpf("1.7") * t + k * mpmath.pi / 2) / mpmath.factorial(k)
        X.append((drive - (k + 1) * X[k + 1] / 10 - S[k]) / ((k + 1) * (k + 2)))
        S.append(sum((j + 1) * X[j + 1] * C[k - j] for j in range(k + 1)) / (k + 1))
        C.append(-sum((j + 1) * X[j + 1] * S[k - j] for j in range(k + 1)) / (k + 1))
    return X


@pytest.mark.parametrize("uncut", [True, False])
def test_coefficient_forty_is_that_of_a_plain_recurrence(uncut):
    osc = Oscillator("xdot/10 + sin(x)", "cos(1.7*t)", 0, 1)
    with series_of_any_length() if uncut else nullcontext(), balls_at(200):
        found = coefficients(Equation(programs_of(osc, ()), {}), (flint.arb(1), flint.arb(0), flint.arb(2)), 45)[40]
        with mpmath.workdps(60):
            true = pendulum_series(mpmath.mpf(1), mpmath.mpf(0), mpmath.mpf(2), 45)[40]
            near = flint.arb(mpmath.nstr(true, 50), "1e-54")
        assert found.overlaps(near) == uncut


def test_a_flight_whose_series_were_cut_is_found_wrong(monkeypatch):
    osc = Oscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")
    true = hit(osc, "1.4", "0.6", 40)
    with balls_at(200):
        assert hit(osc, "1.4", "0.6", 20).v.contains(true.v.mid())
    monkeypatch.setattr(certified_hit, "series_of_any_length", nullcontext)
    try:
        cut = hit(osc, "1.4", "0.6", 20)
    except Refused:
        return
    with balls_at(200):
        assert not cut.v.contains(true.v.mid())


# -- branch cuts, on which balls stay finite

KINKS = {"root": "sqrt((t - 2.5)**2) - 2", "absolute value": "abs(t - 2.5) - 2", "cubed": "((t - 2.5)**2)**(3/2) - 2"}


@pytest.mark.parametrize("g", KINKS.values(), ids=KINKS)
def test_a_kink_is_never_stepped_over(g):
    with pytest.raises(Refused, match="analytic"):
        hit(Oscillator("x", g, "-0.25", "0.8"), 1, "3.2", 12)


def kinked_truth():
    """x'' + x = |t - 2.5| - 2 from (1, 3.2), in two pieces."""
    first = solve_ivp(lambda t, y: [y[1], 2.5 - t - 2 - y[0]], (1, 2.5), [-0.25, 3.2], rtol=1e-12, atol=1e-14)

    def wall(_, y):
        return y[0] + 0.25

    wall.terminal = True
    later = solve_ivp(lambda t, y: [y[1], t - 2.5 - 2 - y[0]], (2.5, 9), first.y[:, -1], rtol=1e-12, atol=1e-14,
                      events=wall)  # fmt: skip
    return later.t_events[0][0] - 1


@pytest.mark.parametrize(("guard", "g"), [("off_the_cut", KINKS["root"]), ("_of_one_sign", KINKS["absolute value"])])
def test_without_its_guard_the_flight_is_wrong(monkeypatch, guard, g):
    def finite(*given):
        u = given[-1]
        if guard == "off_the_cut":
            return u
        middle = (
            u.real.mid() if isinstance(u, flint.acb) else u[0].mid() if isinstance(u, flint.arb_series) else u.mid()
        )
        sign = 1 if middle > 0 else -1
        return flint.arb(sign) if given[0] == "sign" else u * sign

    monkeypatch.setattr(analytic, guard, finite)
    found = hit(Oscillator("x", g, "-0.25", "0.8"), 1, "3.2", 12)
    assert abs(float(found.flight_time) - kinked_truth()) > 1e-2 * found.flight_time.rad() + 1e-6


@pytest.mark.parametrize(
    ("function", "box"),
    [("log", (-2, 0, 0, 1)), ("sqrt", (-2, 1, 0, 1)), ("sqrt", (0, 1, 0, 1)), ("atan", (0, "0.5", 2, "0.5")),
     ("atan", (0, "0.5", -2, "0.5")), ("abs", (0, 1, 0, 1)), ("sign", (0, 1, 0, 1)), ("tan", (0, 2, 0, 1)),
     ("tanh", (0, 1, 0, 2)), ("inverse", (0, 1, 0, 1))],
)  # fmt: skip
def test_functions_are_nan_on_boxes_that_meet_a_singularity(function, box):
    a, b, c, d = map(flint.arb, box)
    assert not flint.acb(analytic.call(function, flint.acb(flint.arb(a, b), flint.arb(c, d)))).is_finite()


@pytest.mark.parametrize("function", ["log", "sqrt", "atan", "abs", "tan", "tanh", "inverse", "exp", "sin", "cos"])
def test_functions_are_finite_where_they_are_analytic(function):
    small = flint.acb(flint.arb("0.7", "0.1"), flint.arb(0, "0.1"))
    assert analytic.call(function, small).is_finite()


def test_program_and_its_derivatives_are_those_of_mpmath():
    from singimpact.algebra import parse

    recorder = analytic.Recorder()
    text = "x**3*tanh(x) + sqrt(2 + x)*y**5 + (1 + x**2)**(-3/2) + abs(y)*atan(x*y) + 2**x/tan(x) + exp(-x)*log(3 + y)"
    f = recorder.record(parse(text, ["x", "y"]))
    places = [recorder.derivative(f, "x"), recorder.derivative(recorder.derivative(f, "x"), "y")]
    with balls_at(200):
        found = recorder.program([f, *places])({"x": flint.arb("0.3"), "y": flint.arb("-1.2")})
    with mpmath.workdps(40):

        def plain(x, y):
            m = mpmath
            return (x**3 * m.tanh(x) + m.sqrt(2 + x) * y**5 + (1 + x**2) ** m.mpf(-1.5) - y * m.atan(x * y)
                    + 2**x / m.tan(x) + m.exp(-x) * m.log(3 + y))  # fmt: skip

        at = mpmath.mpf("0.3"), mpmath.mpf("-1.2")
        true = plain(*at), mpmath.diff(plain, at, (1, 0)), mpmath.diff(plain, at, (1, 1))
    for ball, value in zip(found, true, strict=True):
        assert abs(float(ball.mid()) - float(value)) < 1e-12 * abs(float(value))
        assert np.isfinite(float(ball.rad()))
