"""V_c' beside a second wall: flights that meet it are left out, and the cut is where the impact map jumps."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError
from singimpact.surface import ImpactSurface

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "-0.3", "0.6", upper="0.4")
PAIR = si.linear("1.2", "-0.5", "0.8", upper=("0.5", "0.7"))
WINDOW = (-0.5, 4), (-4, 4)
MODELS = [(model, wall) for model in (DUFFING, PAIR) for wall in ("lower", "upper")]


def launches_on_the_cut(model, wall):
    curves = [curve for curve in ImpactSurface(model, *WINDOW, wall=wall).discontinuities if curve.name == "cut"]
    points = np.vstack([curve.points[2:-2] for curve in curves])
    return points[points[:, 1] > 1e-2]


@pytest.mark.parametrize(("model", "wall"), MODELS)
def test_the_impact_map_jumps_on_the_cut(model, wall):
    """Bisection in v between launches that meet the other wall and launches that do not."""
    points = launches_on_the_cut(model, wall)[::9]
    assert len(points) > 20
    low, high = points - np.array([0, 1e-5]), points + np.array([0, 1e-5])
    first, last = (model.impact_map(*ends.T, wall=wall) for ends in (low, high))
    assert ((first.wall != last.wall) | (np.abs(first.tau - last.tau) > 1e-4)).all()
    for _ in range(15):  # to 3e-10: nearer flights are decided in many digits
        middle = (low + high) / 2
        step = model.impact_map(*middle.T, wall=wall)
        near_first = (step.wall == first.wall) & (np.abs(step.tau - first.tau) < np.abs(step.tau - last.tau))
        near_first |= (step.wall == first.wall) & (first.wall != last.wall)
        low[near_first], high[~near_first] = middle[near_first], middle[~near_first]
    assert np.abs((low + high) / 2 - points).max() < 1e-9


def first_wall(tau, v, sign):
    """The wall that the Duffing model meets first, by an integrator of another make; sign -1 at the upper wall."""
    lower, upper = (-0.3, 0.4) if sign > 0 else (-0.4, 0.3)
    events = [lambda _, y: y[0] - lower, lambda _, y: y[0] - upper]
    for event, direction in zip(events, (-1, 1), strict=True):
        event.terminal, event.direction = True, direction
    flight = solve_ivp(
        lambda t, y: [y[1], sign * np.cos(1.7 * t) - y[0] - 0.1 * y[1] - 0.3 * y[0] ** 3],
        (tau, tau + 50), [lower, v], "DOP853", events=events, rtol=1e-10, atol=1e-12, max_step=0.02,
    )  # fmt: skip
    return int(bool(flight.t_events[1].size))


@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_launches_on_both_sides_of_the_cut_come_to_this_wall_and_to_the_other(wall):
    random = np.random.default_rng(7)
    curve = max(ImpactSurface(DUFFING, *WINDOW, wall=wall).cut, key=len)
    launches = launches_on_the_cut(DUFFING, wall)
    # those that land at this wall after the graze
    inside = launches[(launches[:, 0] > curve.points[:, 0].min()) & (launches[:, 0] < curve.points[:, 0].max())]
    sign = 1 if wall == "lower" else -1
    for tau, v in inside[random.integers(len(inside), size=12)].tolist():
        aside = random.uniform(1e-3, 1e-2)
        walls = [first_wall(tau, v + side, sign) for side in (-aside, aside)]
        assert walls == [0, 1]


@pytest.mark.parametrize(("model", "wall"), MODELS)
def test_curves_are_those_of_one_wall_where_the_other_is_not_met(model, wall):
    surface, alone = ImpactSurface(model, *WINDOW, wall=wall), ImpactSurface(model.one_wall(wall), *WINDOW)
    own = {tuple(point) for line in alone.lines for point in line.points[:, :2].tolist()}
    kept = {tuple(point) for line in surface.lines for point in line.points[:, :2].tolist()}
    assert kept <= own
    left_out = np.array(sorted(own - kept))
    assert len(left_out) if model is DUFFING else True
    seen = surface.model
    for tau, t in left_out[:: max(len(left_out) // 20, 1)]:
        x = seen.one_wall().flight(tau, 0.0, np.linspace(0, t, 2001)).x
        assert x.max() > float(seen.upper.value) - 1e-5
    for tau, t in sorted(kept)[:: max(len(kept) // 20, 1)]:
        x = seen.one_wall().flight(tau, 0.0, np.linspace(0, t, 2001)).x
        assert x.max() < float(seen.upper.value) + 1e-5


def test_lines_end_at_the_cut_and_a_closed_one_is_cut_open():
    surface = ImpactSurface(DUFFING, *WINDOW)
    ends = [line.points[mark.index, :2] for line in surface.lines for mark in line.marks if mark.name == "cut"]
    assert ends
    tips = np.vstack([curve.points[[0, -1]] for curve in surface.cut])
    assert min(np.hypot(*(tip - end)) for tip in tips for end in ends) < 0.05
    assert not any(line.closed for line in surface.lines)


def test_visible_points_are_first_hits_of_both_walls():
    surface = ImpactSurface(DUFFING, *WINDOW)
    for line, curve in zip(surface.lines, surface.horizon, strict=True):
        states = np.column_stack([line.points[:, :2].sum(axis=1), line.points[:, 2]])[curve.visible][5:-5:5]
        for (tau, v), t in zip(states, curve.points[curve.visible][5:-5:5, 1], strict=True):
            if v > 1e-2:
                step = DUFFING.impact_map(tau, v - 1e-9)
                later = DUFFING.impact_map(tau, v + 1e-9)
                assert min(abs(one.flight_time - t) for one in (step, later)) < 1e-3


def test_a_wall_that_the_model_does_not_have_is_refused():
    with pytest.raises(InputError, match="wall"):
        ImpactSurface(DUFFING.one_wall(), *WINDOW, wall="upper")
    with pytest.raises(InputError, match="wall"):
        ImpactSurface(DUFFING, *WINDOW, wall="left")


@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_singular_points_are_those_of_one_wall_whose_flights_do_not_meet_the_other(wall):
    found, alone = si.classify(DUFFING, wall=wall), si.classify(DUFFING.one_wall(wall))
    places, own = ({(point.name, point.maps, point.tau, point.t) for point in each.points} for each in (found, alone))
    assert places <= own
    assert {place for place in own if place[0] == "tangency"} <= places
    assert [swan.kind for swan in found.swans] == [swan.kind for swan in alone.swans]
    assert "the other wall" in found.notes[-1]
    assert any("cut" in line.bounds for line in found.folds)
    assert len(alone.points) > len(found.points) or wall == "upper"


def test_transitions_at_the_upper_wall_are_those_of_the_mirrored_model_over_its_height():
    uneven = si.ImpactOscillator("x + x**2/10", "cos(2*t)", "-2", "0.5", upper="0.5")
    found = si.transitions(uneven, "upper", ("0.2", "1.2"), wall="upper")
    alone = si.transitions(uneven.one_wall("upper"), "clearance", ("-1.2", "-0.2"))
    assert [(each.kind, each.tau, -each.value) for each in reversed(found)] == [
        (each.kind, each.tau, each.value) for each in alone
    ]
    assert [each.value for each in found] == sorted(each.value for each in found)
    assert len(found) > 1
    assert si.transitions(uneven, "upper_restitution", ("0.2", "0.5"), wall="upper") == ()


def test_an_event_whose_flight_meets_the_other_wall_is_not_visible():
    """x = -cos(2t)/3 is the motion without impact; it touches a wall at -1/3 and is cut by one at 1/4."""
    free, cut = (si.linear(2, "-0.5", "0.5", upper=upper) for upper in ("0.4", "0.25"))
    seen, hidden = (si.transitions(pair, between=("-0.4", "-0.2"), kinds="periodic graze") for pair in (free, cut))
    assert [each.visible for each in seen] == [True]
    assert [each.visible for each in hidden] == [False]
    assert [each.value for each in seen] == [each.value for each in hidden]
    assert "the other one" in hidden[0].effect
    assert seen.complete
    assert hidden.complete


@pytest.mark.parametrize(
    "options",
    [{"over": "upper"}, {"over": "clearance", "wall": "upper"}, {"orbits": 1}, {"between": (0, 1)}],
)
def test_transitions_of_two_walls_refuse_what_moves_no_outline(options):
    with pytest.raises(InputError, match=r"upper|clearance|one_wall"):
        si.transitions(PAIR, **{"between": (-0.6, -0.4)} | options)
