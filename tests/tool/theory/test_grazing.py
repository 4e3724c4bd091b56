"""The discontinuity mapping of a graze against true orbits of scipy: a series cut at h^N is off by the power N + 1."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

LINEAR = si.linear(2, "-0.2", "0.5", damping="0.3")
DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3 + 0.2*xdot**2", "cos(1.7*t)", "-0.4", "0.6")
BENT = si.ImpactOscillator("x + 0.1*xdot*x", "cos(2*t) + 0.4*sin(4*t)", "-0.3", "-0.8*v + 0.2*v**2 - 0.1*v**3")
SWAN = si.ImpactOscillator("x + 0.2*xdot", "cos(2*t)", -1, "0.5")


def flown(osc, at: float, depth: float):
    """x - c and x' at `at`, and depth and time of the lowest place, of the true motion."""
    f = [eval(f"lambda t, x, xdot: {text}", vars(np)) for text in (str(osc.force()), str(osc.forcing()))]
    rho = eval(f"lambda v: {osc.rho()}", vars(np))
    wall = float(osc.clearance.value)

    def fly(start, end, state, event=None):
        def slope(t, state):
            return state[1], f[1](t, *state) - f[0](t, *state)

        if event is not None:
            event.terminal = True
        return solve_ivp(slope, (start, end), state, method="DOP853", rtol=3e-14, atol=1e-16, events=event)

    back = fly(at, at - 2, (wall - depth, 0.0), lambda _, state: state[0] - wall)
    hit, before = float(back.t_events[0][0]), float(back.y_events[0][0][1])
    after = (wall, float(rho(before)))
    end = fly(hit, at, after).y[:, -1]
    lowest = fly(hit, hit - 2, after, lambda _, state: state[1])
    lost = (wall - float(lowest.y_events[0][0][0]), float(lowest.t_events[0][0]) - at)
    return np.array([end[0] - wall, end[1], *lost])


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize(("osc", "at"), [(LINEAR, "0.3"), (DUFFING, "-0.5"), (BENT, "0.25")])
def test_the_error_falls_like_the_next_power(osc, at: str, order: int) -> None:
    found = si.theory.grazing_map(order, model=osc, at=at)
    assert (found.j, float(found.leading_power)) == (0, 0.5)
    depths = np.array([1e-3, 1e-4]) if order < 3 else np.array([1e-2, 1e-3])  # roots of scipy are good to 1e-11
    h = found.h(depths)
    section = [sum(float(part[n]) * h**n for n in range(order + 1)) for part in (found.depth, found.time)]
    series = np.stack([*found(depths), *section])
    truth = np.stack([flown(osc, float(at), depth) for depth in depths], axis=1)
    off = np.abs(series - truth)
    slope = np.log(off[:, 0] / off[:, 1]) / np.log(h[0] / h[1])
    # a coefficient of x, of the depth or of the time may be small beside the next one
    assert (slope > order + 0.7).all()
    assert slope[1] < order + 1.4


def test_a_wrong_coefficient_has_a_lower_slope() -> None:
    found = si.theory.grazing_map(3, model=LINEAR, at="0.3")
    h = found.h(np.array([1e-3, 1e-4]))
    truth = [flown(LINEAR, 0.3, depth)[1] for depth in (1e-3, 1e-4)]
    wrong = sum(float(found.xdot[n]) * (1.01 if n == 2 else 1) * h**n for n in range(4))
    off = np.abs(wrong - truth)
    assert np.log(off[0] / off[1]) / np.log(h[0] / h[1]) < 2.3


def test_the_first_term_is_the_square_root_of_nordmark() -> None:
    import sympy

    a, r = sympy.symbols("a r")
    generic = si.theory.grazing_map(1)
    assert sympy.expand(generic.xdot[1] - (1 + r) * a) == 0
    assert sympy.expand(generic.time[1] + (1 + r)) == 0
    found = si.theory.grazing_map(1, model=LINEAR, at="0.3")
    push = float(LINEAR.acceleration(0.3))
    assert found([0.01])[1][0] == pytest.approx(1.5 * np.sqrt(2 * push * 0.01), rel=1e-14)


def test_a_graze_of_higher_order_has_the_power_of_its_contact_order() -> None:
    found = si.theory.grazing_map(5, model=SWAN, at="pi/2")
    assert found.j == 2
    assert found.leading_power == si.theory.grazing_map(3, at="swan").leading_power
    assert float(found.leading_power) == 0.75
    depths = np.array([1e-4, 1e-5, 1e-6])
    truth = np.array([flown(SWAN, np.pi / 2, depth)[:2] for depth in depths])
    power = np.log(truth[1, 1] / truth[2, 1]) / np.log(10)
    assert power == pytest.approx(0.75, abs=0.02)
    off = np.abs(np.stack(found(depths), axis=1) - truth)
    h = found.h(depths)
    assert np.log(off[0] / off[1])[1] / np.log(h[0] / h[1]) == pytest.approx(6, abs=0.6)
    assert found.depth is None


@pytest.mark.parametrize("osc", [LINEAR, DUFFING, BENT])
def test_the_formula_for_all_grazes_is_the_series_of_each(osc) -> None:
    space: dict = {}
    generic = si.theory.grazing_map(4)
    exec(generic.source(), space)
    from math import factorial

    from singimpact.algebra import DOUBLES
    from singimpact.contact import Contact

    jets = Contact.of(osc, 0.25, 0, 4, DOUBLES)
    given = {("a" if not k else f"a_d{k}"): float(v) * factorial(k) for k, v in jets.a.items()}
    given |= {f"f_{i}{k}": float(v) * factorial(i) * factorial(k) for (i, k), v in jets.f.items()}
    slope = float(osc.slope_at_rest().value)
    law = (
        {"rho_2": 0.2, "rho_3": -0.1, "rho_4": 0.0} if osc is BENT else dict.fromkeys(("rho_2", "rho_3", "rho_4"), 0.0)
    )
    names = space["grazing_map"].__code__.co_varnames[1 : space["grazing_map"].__code__.co_argcount]
    values = {name: (given | law | {"r": slope}).get(name, 0.0) for name in names}
    found = si.theory.grazing_map(4, model=osc, at="0.25")
    depths = np.array([1e-2, 1e-3])
    np.testing.assert_allclose(space["grazing_map"](depths, **values), found(depths), rtol=1e-12)
    own: dict = {}
    exec(found.source("here"), own)
    np.testing.assert_allclose(own["here"](depths), found(depths), rtol=1e-12)
    assert "h" in generic.xdot._repr_latex_()


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"order": 0}, "order = 0"),
        ({"at": 3}, "an even contact order"),
        ({"model": LINEAR}, "the time of the graze"),
        ({"model": LINEAR, "at": "1.6"}, "the mass is pressed"),
        ({"model": SWAN, "at": "pi/2", "order": 2}, "a whole number from 3"),
    ],
)
def test_bad_input(given, told: str) -> None:
    with pytest.raises(InputError, match=told):
        si.theory.grazing_map(**given)
    with pytest.raises(InputError, match="give model= and at="):
        si.theory.grazing_map(1)([0.1])
    with pytest.raises(InputError, match="depths below the wall >= 0"):
        si.theory.grazing_map(1, model=LINEAR, at="0.3")([-0.1])


def test_the_events_of_a_branch_say_where_they_graze() -> None:
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    branch = si.branch(osc.periodic(3, 3)[0], "clearance", (-0.1, 0.2))
    grazes = [event for event in branch.events if event.kind in ("graze", "hidden impact")]
    assert grazes
    for event in grazes:
        model, at = event.orbit.oscillator, event.graze_time
        assert model.acceleration(at) > 0
        assert si.theory.grazing_map(2, model=model, at=at).leading_power == 0.5
        if event.kind == "hidden impact":
            index = np.searchsorted(event.orbit.tau, at) - 1
            launch = float(event.orbit.tau[index])
            place = model.flight(launch, float(event.orbit.v[index]), at - launch)
            assert abs(float(place.x) - float(model.clearance.value)) < 1e-9
            assert abs(float(place.xdot)) < 1e-6
    other = next(event for event in branch.events if event.kind == "fold")
    with pytest.raises(InputError, match="a graze or a hidden impact"):
        _ = other.graze_time
