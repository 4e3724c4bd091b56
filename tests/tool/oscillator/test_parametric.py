"""Models in whose f t occurs: flights, series, swans, orbits and enclosures against witnesses that share no code."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from second_program import refuses

import singimpact as si
from singimpact.inputs import InputError

MATHIEU_DUFFING = ("(1 + 0.3*cos(2*w*t))*x + 0.1*xdot + 0.2*x**3", "cos(w*t)", "-0.2", "0.7", {"w": "1.3"})
# every partial derivative of f at the wall moves with t
MOVING = "(1 + 0.3*cos(2*t))*x + 0.1*xdot*(1 + sin(t)) + 0.2*x**3*sin(t)"


@pytest.fixture(scope="module")
def osc():
    return si.ImpactOscillator(*MATHIEU_DUFFING)


def drawn_model(rng):
    """Python functions, numbers that their texts hold exactly, and the same equation for scipy."""
    a, b, d, e, s = np.round(rng.uniform(0.1, 1, 5), 3).tolist()
    w = float(rng.integers(1, 4))

    def f(x, xdot, t):
        return (1 + a * np.cos(w * t)) * x + d * xdot * (1 + b * np.sin(2 * w * t)) + e * x**3 * np.sin(w * t) ** 2

    model = si.ImpactOscillator(f, lambda t: np.cos(t) - s, 0.1 * a, 0.8)
    return model, lambda t, y: [y[1], np.cos(t) - s - f(y[0], y[1], t)]


@pytest.mark.parametrize("seed", range(4))
def test_first_hits_and_their_derivatives_are_those_of_an_integrator(seed):
    rng = np.random.default_rng(seed)
    model, field = drawn_model(rng)
    wall = float(model.clearance.value)
    tau, v = rng.uniform(-30, 30, 40), 10.0 ** rng.uniform(-4, 0.5, 40)
    hits = model.first_hit(tau, v)
    assert set(hits.status.tolist()) <= {si.Status.hit}
    for start, speed, time, velocity in zip(tau, v, hits.flight_time, hits.velocity, strict=True):
        way = solve_ivp(
            field, (start, start + time), [wall, speed], "DOP853", rtol=1e-12, atol=1e-14, max_step=time / 40
        )
        assert way.y[:, -1] == pytest.approx([wall, velocity], abs=1e-9)
        assert way.y[0, 1:-1].min() > wall - 1e-10
    step, small = model.derivative(tau[0], v[0]).matrix, 1e-6
    for column, (late, fast) in enumerate(((small, 0), (0, small))):
        ends = [model.impact_map(tau[0] + k * late, v[0] + k * fast) for k in (1, -1)]
        slopes = [(ends[0].tau - ends[1].tau) / 2 / small, (ends[0].v - ends[1].v) / 2 / small]
        assert step[:, column] == pytest.approx(slopes, rel=1e-4, abs=1e-7)


def test_many_digits_agree_with_mpmath_and_an_altered_force_does_not(osc):
    hit = osc.first_hit("0.3", "0.5", digits=30)
    mp = mpmath.mp.clone()
    ends = []
    for factor, mp.dps in (("0.3", 36), ("0.31", 15)):

        def field(t, y, factor=factor):
            stiffness = 1 + mp.mpf(factor) * mp.cos(mp.mpf("2.6") * t)
            return [y[1], mp.cos(mp.mpf("1.3") * t) - stiffness * y[0] - y[1] / 10 - y[0] ** 3 / 5]

        way = mp.odefun(field, mp.mpf("0.3"), [mp.mpf("-0.2"), mp.mpf("0.5")])
        ends.append(abs(way(mp.mpf("0.3") + hit.flight_time)[0] + mp.mpf("0.2")))
    assert ends[0] < mp.mpf(10) ** -29 < mp.mpf(10) ** -5 < ends[1]
    assert hit.certified is not None


@pytest.mark.parametrize("order", [3, 5, 7])
def test_the_sheet_has_the_order_of_its_series(order):
    model = si.ImpactOscillator(MOVING, "cos(t)", "0.2", "0.8")
    tau, series = si.tangency_points(model)[1].tau, si.theory.v_c(order=order, at="tangency", model=model)
    missed = []
    for scale in (0.1, 0.05):
        sigma, t = -1.2 * scale, 1.5 * scale
        v = float(series.subs({"sigma": sigma, "t": t}))
        missed.append(abs(float(model.flight(tau + sigma, v, t).x) - 0.2))
    # x - c at the landing misses by t times what the series leaves out, of degree order + 1
    assert np.log2(missed[0] / missed[1]) == pytest.approx(order + 2, abs=0.35)


def test_gamma_and_chatter_are_those_of_their_series():
    model = si.ImpactOscillator(MOVING, "cos(t)", "0.2", "0.8")
    tau = si.tangency_points(model)[1].tau
    gamma = si.theory.gamma(order=6, at="tangency", model=model)
    before = si.threshold(model, tau - 0.03).v
    assert before == pytest.approx(sum(float(gamma[n]) * (-0.03) ** n for n in range(2, 7)), rel=1e-9)
    limit = si.theory.chatter_limit(order=6, model=model, tau="2.5")
    for v in (0.001, 0.0005):
        found = model.chatter_limit(2.5, v)
        assert found.tau - 2.5 == pytest.approx(sum(float(limit[n]) * v**n for n in range(1, 7)), rel=1e-9)
        ball = model.chatter_limit("2.5", repr(v), digits=14).certified
        assert abs(float(ball.value) - found.tau) <= found.error + float(ball.radius)


def test_swans_of_a_moving_stiffness_are_exact():
    swans = si.swan_points("(1 + 0.3*cos(2*t))*x + 0.1*xdot", "cos(t)", between=(-3, 3))
    assert swans.complete
    assert [(swan.kind, swan.tau) for swan in swans] == [("negative", 0.0), ("positive", pytest.approx(np.pi))]
    for swan in swans:
        model = swan.oscillator("0.5")
        assert swan.clearance == pytest.approx(np.cos(swan.tau) / 1.3, abs=1e-15)  # where a_c = cos t - (1 + ...) c
        assert model.acceleration(swan.tau) == pytest.approx(0, abs=1e-15)
        assert model.acceleration(swan.tau, order=1) == pytest.approx(0, abs=1e-15)
        assert (model.acceleration(swan.tau, order=2) > 0) == (swan.kind == "positive")
    with pytest.raises(InputError, match="linear in x"):
        si.swan_points("cos(t)*x**2", "cos(t)")


def test_orbits_branches_and_their_certificates(osc):
    (orbit,) = osc.periodic(1, 1)
    branch = si.branch(orbit, over="clearance", between=(-0.6, 0.4))
    doubling = next(event for event in branch.events if event.kind == "period-doubling")
    there = doubling.orbit
    assert min(abs(np.array(there.multipliers) + 1)) < 1e-8
    # a multiplier -1 of the impact map by differences of true flights
    (tau,), (v,) = there.tau, there.v
    step, model = 1e-5, there.oscillator
    columns = []
    for late, fast in ((step, 0), (0, step)):
        one, two = (model.impact_map(tau + k * late, v + k * fast) for k in (1, -1))
        columns.append([(one.tau - two.tau) / 2 / step, (one.v - two.v) / 2 / step])
    assert min(abs(np.linalg.eigvals(np.array(columns).T) + 1)) < 1e-5
    for result in (orbit, osc.impact_map("0.3", "0.5", digits=20), osc.chatter_limit("2.5", "0.01", digits=12)):
        certificate = si.certify(result)
        assert certificate.check() is None
        model = certificate.content["model"]
        assert "0.3*cos" in model["f"]
        refuses(certificate.content | {"model": model | {"f": model["f"].replace("0.3*cos", "0.301*cos")}})


def test_a_nonlinear_spring_on_a_shaken_wall_is_the_motion_in_the_frame_at_rest():
    shaken = si.shaken_wall("x**3 + 0.1*xdot", "-1", "0.2*sin(2*t)", "0.7")
    wall, speed = (lambda t: 0.2 * np.sin(2 * t)), (lambda t: 0.4 * np.cos(2 * t))

    def falls(_t, y):
        return [y[1], -1 - 0.1 * y[1] - y[0] ** 3]

    def meets(t, y):
        return y[0] - wall(t)

    meets.terminal, meets.direction = True, -1
    place = shaken.relative(0.0, 0.5, 0.2)
    hit = shaken.oscillator.launch(place.x, place.xdot, 0.0)
    way = solve_ivp(falls, (0, 30), [0.5, 0.2], "DOP853", rtol=3e-14, atol=1e-15, events=meets, max_step=0.05)
    assert hit.tau == pytest.approx(way.t[-1], abs=1e-11)
    assert hit.v == pytest.approx(0.7 * (speed(way.t[-1]) - way.y[1, -1]), abs=1e-11)


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        (lambda osc: osc.certified_gamma(), "gamma is certified for f in x and xdot alone"),
        (lambda osc: si.theory.v_c(order=3, at="tangency", model=osc, keep=("w",)), "its series have numbers"),
        (lambda osc: osc.replace(period=1), "period = 1 is not a period of g"),
        (lambda osc: osc.replace(g="0", period=2), "period = 2 is not a period of f"),
    ],
)
def test_refusals_name_the_reason(osc, call, reason):
    with pytest.raises(InputError, match=reason):
        call(osc)


def test_the_period_is_common_to_force_and_forcing():
    assert str(si.ImpactOscillator("x*cos(3*t)", "cos(2*t)", 0, 1).period) == "2*pi"
    assert si.ImpactOscillator("x*cos(3*t)", "cos(sqrt(2)*t)", 0, 1).period is None
    assert str(si.ImpactOscillator("x*cos(3*t)", "1", 0, 1).period) == "(2/3)*pi"
    # a part of f in t alone is a forcing, and the model is linear
    moved, plain = si.ImpactOscillator("x - cos(2*t)", "0", 0, "0.8"), si.linear(2, 0, "0.8")
    assert moved.first_hit(0.3, 0.5).flight_time == plain.first_hit(0.3, 0.5).flight_time


def test_transitions_name_the_swans_of_a_stiffness_that_moves_beside_a_cube(osc):
    swans = [each for each in osc.transitions(over="clearance", between=(-1, 1)) if each.kind.startswith("swan")]
    # a_c = cos(w t) - (1 + 0.3 cos(2 w t)) c - 0.2 c^3 is even in t: one swan at t = 0, one half a period later
    level = np.roots([0.2, 0, 1.3, -1])
    level = float(level[np.isreal(level)].real[0])
    assert [each.value for each in swans] == [pytest.approx(-level, abs=1e-12), pytest.approx(level, abs=1e-12)]
    for swan in swans:
        model = osc.replace(clearance=swan.value)
        assert abs(model.acceleration(swan.tau)) < 1e-14
        assert abs(model.acceleration(swan.tau, order=1)) < 1e-14
