"""Limit cycles of models without a clock, against an integrator and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import singimpact as si
from singimpact.inputs import InputError

VAN_DER_POL = ("x - mu*(1 - x**2)*xdot", "0", "-1.5", "0.8", {"mu": 1})


def returned(force, wall, r, v):
    """Time and velocity of the next impact, by scipy."""

    def meets(_t, y):
        return y[0] - wall

    meets.terminal, meets.direction = True, -1
    way = solve_ivp(
        lambda _t, y: [y[1], -force(y[0], y[1])],
        (0, 60),
        [wall + 1e-300, v],
        "DOP853",
        rtol=1e-12,
        atol=1e-14,
        events=meets,
        max_step=0.05,
    )
    return (way.t_events[0][0], -r * way.y_events[0][0, 1]) if way.t_events[0].size else (np.nan, np.nan)


@pytest.fixture(scope="module")
def osc():
    return si.ImpactOscillator(*VAN_DER_POL)


def test_the_cycle_of_van_der_pol_with_a_wall(osc):
    (cycle,) = osc.periodic(1)
    assert (cycle.period, cycle.v[0]) == (pytest.approx(4.81893846, abs=5e-9), pytest.approx(1.68586826, abs=5e-9))

    def force(x, xdot):
        return x - (1 - x**2) * xdot

    v = brentq(lambda speed: returned(force, -1.5, 0.8, speed)[1] - speed, 1, 2.5, xtol=1e-12)
    assert cycle.v[0] == pytest.approx(v, abs=1e-9)
    assert cycle.period == pytest.approx(returned(force, -1.5, 0.8, v)[0], abs=1e-9)
    slope = (returned(force, -1.5, 0.8, v + 1e-4)[1] - returned(force, -1.5, 0.8, v - 1e-4)[1]) / 2e-4
    assert cycle.multipliers == pytest.approx([slope], rel=1e-3)  # without the trivial 1
    orbit = osc.orbit(0, 1.0, impacts=40)
    assert np.diff(orbit.tau)[-1] == pytest.approx(cycle.period, rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_cycles_of_drawn_models_are_fixed_points_of_an_integrator(seed):
    rng = np.random.default_rng(seed)
    a, b, d = np.round(rng.uniform(0.2, 1.5, 3), 2).tolist()
    wall, r = -float(np.round(rng.uniform(0.2, 1.2), 2)), 0.7
    model = si.ImpactOscillator(lambda x, xdot: a * x + b * x**3 - d * (1 - x**2) * xdot, "0", wall, "0.7")
    cycles = model.periodic(1)
    assert cycles
    for cycle in cycles:
        time, v = returned(lambda x, xdot: a * x + b * x**3 - d * (1 - x**2) * xdot, wall, r, float(cycle.v[0]))
        assert (time, v) == (pytest.approx(cycle.period, abs=1e-8), pytest.approx(cycle.v[0], abs=1e-8))


def test_the_multiplier_is_that_of_liouville(osc):
    for wall in ("-1.5", "-0.4", "0.3"):
        for cycle in osc.replace(clearance=wall).periodic(1):
            way = solve_ivp(
                lambda _t, y: [y[1], (1 - y[0] ** 2) * y[1] - y[0], 1 - y[0] ** 2],
                (0, cycle.period),
                [float(wall), float(cycle.v[0]), 0],
                "DOP853",
                rtol=1e-12,
                atol=1e-13,
            )
            assert cycle.multipliers == pytest.approx([0.64 * np.exp(way.y[2, -1])], rel=1e-8)


def test_a_linear_model_that_gains_energy_has_its_closed_form():
    # x'' - 2 b x' + x = 0, x >= -c: the flight that leaves with v returns with v/r, two equations in v and T
    b, c, r = 0.1, 1.0, 0.6
    w = np.sqrt(1 - b * b)

    def state(v, t):
        decay = np.exp(b * t)
        x = decay * (-c * np.cos(w * t) + (v + b * c) / w * np.sin(w * t))
        return x + c, b * x + decay * (c * w * np.sin(w * t) + (v + b * c) * np.cos(w * t))

    (cycle,) = si.ImpactOscillator("x - 0.2*xdot", "0", "-1", "0.6").periodic(1)
    place, speed = state(cycle.v[0], cycle.period)
    assert place == pytest.approx(0, abs=1e-12)
    assert -r * speed == pytest.approx(cycle.v[0], abs=1e-12)


def test_the_branch_ends_at_the_graze_of_the_cycle_without_impact(osc):
    (cycle,) = osc.periodic(1)
    branch = si.branch(cycle, over="clearance", between=(-2.2, 0.5))
    (graze,) = [event for event in branch.events if event.kind == "graze"]
    # amplitude and period of van der Pol's oscillator at mu = 1
    assert graze.parameter == pytest.approx(-2.00861986087484, abs=1e-10)
    assert graze.orbit.period == pytest.approx(6.66328686, abs=1e-7)
    assert len(branch.events) == 1  # det J(mu) vanishes there for every mu: that is neither fold nor doubling
    assert graze.others() == []
    for index in (40, 120):
        row = branch.orbit(index)
        assert (row.period, row.v[0]) == (pytest.approx(branch.period[index]), pytest.approx(branch.v[index, 0]))
    seen = branch.visible
    model = osc.replace(clearance=float(branch.parameter[seen][5]))
    assert [orbit.period for orbit in model.periodic(1)] == [pytest.approx(branch.period[seen][5], rel=1e-9)]
    assert "period" in branch.table()


def test_two_cycles_meet_at_a_fold(osc):
    slow, fast = osc.replace(clearance="0.3").periodic(1)
    assert (slow.stable, fast.stable) == (False, True)
    branch = si.branch(fast, over="clearance", between=(0.1, 1.5))
    (fold,) = branch.events
    assert fold.kind == "fold"
    assert fold.orbit.multipliers == pytest.approx([1], abs=1e-6)
    before, after = (osc.replace(clearance=fold.parameter + shift).periodic(1) for shift in (-1e-4, 1e-4))
    assert (len(before), len(after)) == (2, 0)
    curve = si.event_curve(fold, over=("clearance", "mu"))
    for mu, clearance in zip(curve.parameters[:, 1][::20], curve.parameters[:, 0][::20], strict=True):
        near = osc.replace(mu=float(mu))
        assert len(near.replace(clearance=float(clearance) - 1e-3).periodic(1)) == 2
        assert len(near.replace(clearance=float(clearance) + 1e-3).periodic(1)) == 0


def test_arguments_that_mean_nothing_without_a_clock_are_refused(osc):
    for arguments, name in (({"k": 1}, "k"), ({"digits": 20}, "digits"), ({"v": (0.1, 1)}, "v")):
        with pytest.raises(InputError, match=rf"{name} = .* is not accepted"):
            osc.periodic(1, **arguments)
    for n in (0, np.inf):
        with pytest.raises(InputError, match="a cycle is listed with its impacts"):
            osc.periodic(n)
    with pytest.raises(InputError, match=r"limit cycle of 1 impact, .* is not certified"):
        osc.periodic(1)[0].certified()
    with pytest.raises(InputError, match="f and g free of t"):
        osc.replace(g="cos(t) + cos(sqrt(2)*t)").periodic(1, 1)


@pytest.mark.parametrize(("force", "most"), [("x", 2), ("x + x**3", 2), ("sin(x)", 1), ("1", 2)])
def test_without_losses_a_continuum_is_named_and_no_orbit_is_listed(force, most):
    for n in range(1, most + 1):
        cycles = si.ImpactOscillator(force, "0", "-0.3", 1).periodic(n)
        assert len(cycles) == 0
        assert "a continuum of orbits" in cycles.notes[0]
    assert "a continuum" not in si.ImpactOscillator(force, "0", "-0.3", "0.999").periodic(1).notes[0]


def test_a_constant_acceleration_at_the_wall_is_named(osc):
    points = si.tangency_points(osc)
    assert len(points) == 0
    assert points.notes == ("a_c = 1.5 at all times: it has no zeros",)


def test_a_diagram_shows_the_stable_cycles(osc):
    diagram = osc.bifurcation(over="clearance", between=("-1.9", "0.3"), points=9, start=(0, 2))
    assert diagram.settled.all()
    for clearance, events in zip(diagram.values, diagram.events, strict=True):
        stable = [cycle for cycle in osc.replace(clearance=float(clearance)).periodic(1) if cycle.stable]
        span, v, ended = events[-1]
        assert ended == 0
        assert any(np.allclose([span, v], [cycle.period, cycle.v[0]], atol=1e-8) for cycle in stable)


def test_the_exponents_of_a_cycle_are_0_and_that_of_its_multiplier(osc):
    (cycle,) = osc.periodic(1)
    first, second = si.lyapunov(osc, 0, 1.0, impacts=500).exponents
    assert first == pytest.approx(0, abs=1e-12)
    assert second == pytest.approx(np.log(cycle.multipliers[0]) / cycle.period, rel=1e-9)


def test_the_command_follows_cycles_and_takes_no_start(singimpact, tmp_path):
    file = tmp_path / "clockless.toml"
    file.write_text('f = "x - (1 - x**2)*xdot"\ng = "0"\nclearance = "0.3"\nrestitution = "0.8"\n')
    told = singimpact("branch", "--model", str(file), "--from", "0.1", "--to", "1")
    assert "fold   0.6658118065" in told.output
    for option in (("--start", "0", "1"), ("--orbit", "1", "2")):
        refused = singimpact("branch", "--model", str(file), *option)
        assert refused.exit_code == 2
        assert "for a model in which t does not occur" in refused.output
