"""Models, statuses, phases and states at the edges of the impact map."""

from __future__ import annotations

import numpy as np
import pytest
from witness import integrate

from singimpact.flights import first_hit
from singimpact.impact_oscillator import ImpactOscillator, linear, universal
from singimpact.inputs import InputError
from singimpact.status import Status

MODELS = {
    "under-damped": linear("1.3", "0.2", "0.7", damping="0.3"),
    "over-damped": linear("1.3", "-0.2", "0.7", damping=5),
    "critical": linear("1.3", "-0.2", "0.7", damping=2),
    "nearly critical": linear("1.3", "-0.2", "0.7", damping="2.0000000001"),
    "free": linear("1.3", "0.2", "0.7", stiffness=0),
    "damped free": linear("1.3", "0.2", "0.7", stiffness=0, damping=1),
    "resonant": linear(1, "0.2", "0.7"),
    "repelling": linear("1.3", "0.2", "0.7", stiffness="-0.5"),
    "two waves": ImpactOscillator("2*x + 0.1*xdot", "cos(t) + 0.4*sin(sqrt(2)*t + 1) - 0.5", "0.1", "0.8"),
    "polynomial": ImpactOscillator("x**3 - x", "cos(2*t)", "0.1", "0.8"),
    "pendulum": ImpactOscillator("sin(x) + 0.1*xdot*abs_", "cos(2*t)", "0.1", "0.8", {"abs_": 1}),
    "functions": ImpactOscillator(
        "tanh(x) + x*exp(-x**2) + atan(xdot)/3 + sqrt(4 + x**2) - 2",
        "tan(sin(t)/2) + log(2 + cos(t)) - 1",
        "0.1",
        "0.8",
    ),
    "powers": ImpactOscillator("x/(1 + x**2) + (1 + x**2)**(1/3) - 1", "cos(2*t)*sin(t) - 0.3", "0", "0.8"),
}


@pytest.mark.parametrize("name", MODELS)
def test_path_agrees_with_an_independent_integrator(name: str) -> None:
    times = np.linspace(0.1, 9.0, 6)
    place = MODELS[name].flight(0.4, 0.7, times)
    truth = integrate(MODELS[name], 0.4, 0.7, times)
    scale = 1 + np.abs(truth).max()
    assert np.abs(np.array(place) - truth).max() < 1e-10 * scale


@pytest.mark.parametrize("name", MODELS)
def test_first_hit_is_a_zero_and_the_first_one(name: str) -> None:
    hit = first_hit(MODELS[name], 0.4, [1e-9, 0.02, 0.7], horizon=60)
    for v, time, velocity, status in zip([1e-9, 0.02, 0.7], hit.flight_time, hit.velocity, hit.status, strict=True):
        assert status in (Status.hit, Status.no_return, Status.escaped)
        end = time if status == Status.hit else 60.0
        inside = MODELS[name].flight(0.4, v, end * np.linspace(0, 1, 400)[1:-1])
        clearance = MODELS[name].flight(0.4, v, 0.0).x
        assert np.all(inside.x > clearance)
        if status == Status.hit:
            place = MODELS[name].flight(0.4, v, time)
            assert abs(place.x - clearance) < 1e-12
            assert place.xdot == pytest.approx(velocity, rel=1e-9)


@pytest.mark.parametrize("name", ["under-damped", "resonant", "two waves", "polynomial", "functions"])
def test_doubles_agree_with_many_digits(name: str) -> None:
    for v in (1e-300, 0.3) if name == "functions" else (1e-300, 1e-8, 0.3, 4.0):
        few, many = (MODELS[name].impact_map(0.4, v, digits=digits, horizon=40) for digits in (None, 25))
        assert few.status == many.status
        if few.status == Status.hit:
            assert few.flight_time == pytest.approx(float(many.flight_time), rel=1e-13)
            assert few.v == pytest.approx(float(many.v), rel=1e-12)


def test_a_taylor_flow_of_a_linear_model_agrees_with_the_closed_form() -> None:
    disguised = ImpactOscillator("x + 0*x**2 + x**3/10**30", "cos(2.8*t)", "0.1", "0.8")
    plain = linear("2.8", "0.1", "0.8")
    v = np.geomspace(1e-300, 1e3, 40)
    few, truth = disguised.impact_map(0.3, v), plain.impact_map(0.3, v)
    assert np.array_equal(few.status, truth.status)
    assert np.allclose(few.flight_time, truth.flight_time, rtol=1e-12, atol=0)


@pytest.mark.parametrize("omega", ["1", "1.000000000001", "0.999999999999"])
def test_resonance_is_an_ordinary_point(omega: str) -> None:
    few = linear(omega, "-0.4", "0.8").impact_map(0.3, [0.1, 1.0, 30.0])
    many = linear(omega, "-0.4", "0.8").impact_map(0.3, [0.1, 1.0, 30.0], digits=20)
    assert np.allclose(few.flight_time, many.flight_time.astype(float), rtol=1e-13, atol=0)


@pytest.mark.parametrize("tau", [1e5, 1e15, 1e22, 1e300])
def test_any_size_of_tau(tau: float) -> None:
    for osc in (linear("2.8", "0.1", "0.8"), ImpactOscillator("x + x**3", "cos(2.8*t)", "0.1", "0.8")):
        few, many = osc.first_hit(tau, 0.2), osc.first_hit(tau, 0.2, digits=20)
        assert few.flight_time == pytest.approx(float(many.flight_time), rel=1e-13)


def test_rest_follows_the_first_derivative_that_is_not_zero() -> None:
    # a = sin(t), -sin(t), 1 - cos(t), cos(t) - 1, t^3 at their zeros
    for g, status in (("sin(t)", 0), ("-sin(t)", 2), ("1 - cos(t)", 0), ("cos(t) - 1", 2), ("-cos(t)*t**3", 2)):
        assert ImpactOscillator("x", g, 0, 1).first_hit(0, 0).status == status
    assert linear(2, 0, "0.5").first_hit("3*pi/4", 0).status == Status.hit
    assert linear(2, 0, "0.5").first_hit("pi/4", 0).status == Status.sticks


def test_lift_off_of_the_negative_swan_is_exact() -> None:
    step = universal(-1, "0.25").impact_map([-1, -1], [0, 1e-300])
    assert step.tau.tolist() == pytest.approx([3.0, 3.0], rel=1e-15)
    assert step.v.tolist() == pytest.approx([16.0, 16.0], rel=1e-14)


def test_no_return_and_horizon() -> None:
    away = ImpactOscillator("x**3", "2 + t", 0, 1).impact_map(0, [0, 1], horizon=3)
    assert away.status.tolist() == [Status.no_return] * 2
    assert np.all(np.isinf(away.flight_time))
    assert np.all(np.isnan(away.v))
    high = ImpactOscillator("0", "-2", 0, 1)
    assert high.first_hit(0, 5, horizon=4.9).status == Status.no_return
    assert high.first_hit(0, 5, horizon=5.1).status == Status.hit


ESCAPES = {
    "lifted": ("0", "1 + 3*cos(2*t)", 0, 20.0),
    "damped, lifted": ("0.2*xdot", "1 + cos(t)", 0, 30.0),
    "damped to a place above": ("x + 0.2*xdot", "0.1*cos(2*t)", -1, 0.1),
    "repelled": ("-x", "0.1*cos(t)", 1, 0.1),
    "repelled beyond the range of doubles": ("-x", "2", 1, 0.1),
    "drifting": ("0", "cos(t)/9", 0, 9.0),
}


@pytest.mark.parametrize("name", ESCAPES)
@pytest.mark.parametrize("digits", [None, 20])
def test_escape_is_proved_for_linear_models(name: str, digits: int | None) -> None:
    force, forcing, clearance, v = ESCAPES[name]
    step = ImpactOscillator(force, forcing, clearance, 1).impact_map(0, v, digits=digits, horizon=1000)
    assert step.status == Status.escaped
    assert float(step.flight_time) == np.inf
    assert np.isnan(float(step.v))


def test_escape_is_not_claimed_where_the_mass_comes_back() -> None:
    for force, forcing, v in (
        ("0", "-0.01", 3.0),
        ("x", "cos(2.8*t)", 1.0),
        ("-x", "-2", 0.5),
        ("0.1*xdot", "-1", 9.0),
    ):
        osc = ImpactOscillator(force, forcing, 0 if force != "-x" else 1, 1)
        short, long = osc.first_hit(0, v, horizon=0.1), osc.first_hit(0, v, horizon=1e4)
        assert short.status == Status.no_return
        assert long.status == Status.hit


def test_a_rebound_that_is_not_positive_is_a_status() -> None:
    osc = ImpactOscillator("0", "-2", 0, "-v/2 - v**2/8")
    for digits in (None, 20):
        step = osc.impact_map([0, 0], [1, 5], digits=digits)
        assert step.status.tolist() == [Status.hit, Status.no_rebound]
        assert float(step.v[0]) == 0.375
        assert np.isnan(float(step.v[1]))
        assert float(step.tau[1]) == 5.0


def test_restitution_by_expression_is_the_number_where_it_is_one() -> None:
    told, plain = ImpactOscillator("x", "cos(2*t)", 0, "-k*v", {"k": "0.7"}), linear(2, 0, "0.7")
    v = np.geomspace(1e-12, 3, 20)
    assert np.allclose(told.impact_map(0.4, v).v, plain.impact_map(0.4, v).v, rtol=4e-16, atol=0)
    assert told == ImpactOscillator(**told.to_dict())


@pytest.mark.parametrize("gap", [1e-4, 1e-9, 1e-13])
def test_both_sides_of_a_graze(gap: float) -> None:
    """x'' = 12 (s^2 - 1) from the bitangent start of the unfolded positive swan: v = 0 after 2 sqrt 3 for v = 0."""
    osc = universal(1, "0.5")
    many = osc.first_hit(-2.5, 2.8125 * (1 + gap), digits=20), osc.first_hit(-2.5, 2.8125 * (1 - gap), digits=20)
    few = osc.first_hit(-2.5, 2.8125 * (1 + gap)), osc.first_hit(-2.5, 2.8125 * (1 - gap))
    for a, b in zip(few, many, strict=True):
        assert a.status == b.status
        if a.status == Status.hit:
            assert a.flight_time == pytest.approx(float(b.flight_time), rel=1e-6)


def test_an_exact_touch_is_a_graze() -> None:
    # x - c = s ((s - 3)^2 + ...) for x'' = 6 s - 12 from rest height: x = s^3 - 6 s^2 + 9 s = s (s - 3)^2
    osc = ImpactOscillator("0", "6*t - 12", 0, "0.5")
    touch = osc.first_hit(0, 9)
    assert touch.status == Status.graze
    assert touch.flight_time == pytest.approx(3.0, rel=1e-7)
    assert touch.velocity == 0
    assert abs(touch.depth) <= 10 * touch.bound
    assert osc.first_hit(0, np.nextafter(9.0, 0)).status == Status.hit
    assert osc.first_hit(0, np.nextafter(9.0, 10)).status in (Status.no_return, Status.escaped)


@pytest.mark.parametrize(
    ("arguments", "options", "part"),
    [
        ((np.nan, 1), {}, "tau"),
        ((0, np.inf), {}, "v"),
        ((0, -1e-9), {}, "v = -1e-09"),
        (([0, 1], [1, 2, 3]), {}, "broadcast"),
        (("two", 1), {}, "two"),
        ((0, 1), {"digits": 0}, "digits = 0"),
        ((0, 1), {"digits": 2.5}, "digits = 2.5"),
        ((0, 1), {"digits": True}, "digits = True"),
        ((0, 1), {"horizon": 0}, "horizon"),
        ((0, 1), {"tolerance": 0}, "tolerance"),
        ((0, 1), {"tolerance": "1e-30"}, "tolerance"),
        ((None, 1), {}, "tau"),
        ((0, 1j), {}, "v"),
    ],
)
def test_bad_input_ends_in_one_line(arguments: tuple, options: dict, part: str) -> None:
    with pytest.raises(InputError) as caught:
        linear(2, "0.3", "0.5").impact_map(*arguments, **options)
    assert part in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_model_with_a_corner_is_refused() -> None:
    with pytest.raises(InputError, match="smooth"):
        ImpactOscillator("x + abs(xdot)", "cos(t)", 0, 1).first_hit(0, 1)


def test_tolerance_makes_a_shorter_kernel_that_is_as_good_as_it_says() -> None:
    osc = MODELS["polynomial"]
    rough, fine = osc.first_hit(0.4, 0.7, tolerance=1e-6), osc.first_hit(0.4, 0.7)
    assert rough.flight_time != fine.flight_time
    assert rough.flight_time == pytest.approx(fine.flight_time, rel=1e-4)


def test_what_is_left_open_shows_how_near_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import replace

    from singimpact.flights import undecided

    monkeypatch.setattr(undecided, "LIMITS", replace(undecided.LIMITS, settled=0))
    step = ImpactOscillator("0", "6*t - 12", 0, "0.5").impact_map(0, [9.0, 1.0])
    assert step.status.tolist() == [Status.unresolved, Status.hit]
    assert np.isnan([step.flight_time[0], step.velocity[0], step.tau[0], step.v[0]]).all()
    assert abs(step.depth[0]) <= 10 * step.bound[0] < 1e-12


@pytest.mark.parametrize("seed", range(3))
def test_two_flows_that_share_no_restart_agree_on_random_models(seed: int) -> None:
    rng = np.random.default_rng(seed)
    omega, clearance = float(rng.choice([1.0, 2.8, 1 + 1e-12, 0.3])), float(rng.choice([0, 1, -1, 0.999, 1.001, 0.3]))
    damping, stiffness = float(rng.choice([0, 0.1, 2])), float(rng.choice([0, 1, 3]))
    closed = linear(omega, clearance, "0.5", damping=damping, stiffness=stiffness)
    values = {"k": stiffness, "d": damping, "w": omega, "q": 0}
    series = ImpactOscillator("k*x + d*xdot + q*x**3", "cos(w*t)", clearance, "0.5", values)
    tau = rng.uniform(-10, 10, 400)
    v = np.concatenate([10 ** rng.uniform(-300, -3, 200), 10 ** rng.uniform(-4, 1, 200)])
    one, two = (osc.first_hit(tau, v, horizon=200) for osc in (closed, series))
    assert np.array_equal(one.status, two.status)
    hit = one.status == Status.hit
    assert np.allclose(one.flight_time[hit], two.flight_time[hit], rtol=1e-9, atol=0)


def test_escape_of_a_polynomial_model_is_proved() -> None:
    for force, forcing, status in (
        ("-x**3", "2 + cos(t)", Status.escaped),
        ("-x**3 + x**2", "3", Status.escaped),
        ("-exp(x)", "0", Status.unresolved),
    ):
        step = ImpactOscillator(force, forcing, 0, "0.5").first_hit(0.1, 3.0)
        assert step.status == status
        assert np.isnan(step.depth)


def test_condition_is_told_with_digits_too() -> None:
    for osc in (linear("2.8", "0.1", "0.8"), MODELS["polynomial"]):
        few, many = osc.impact_map(0.3, 0.4), osc.impact_map(0.3, 0.4, digits=20)
        assert many.condition == pytest.approx(few.condition, rel=1e-9)
