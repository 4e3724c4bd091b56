"""Attracting responses to a forcing that never repeats, against an integrator and Lyapunov exponents."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

WAVES = "cos(2.8*t) + cos(2.8*sqrt(2)*t)/{}"
ONE = si.ImpactOscillator("x", "cos(2*t) + cos(2*sqrt(2)*t)/2", "0.3", "0.7")
SEVERAL = si.ImpactOscillator("x", WAVES.format(50), "0.1", "0.8")
CHAOTIC = si.ImpactOscillator("x", WAVES.format(2), "-0.2", "0.9")
DUFFING = si.ImpactOscillator("x + x**3/10 + xdot/5", "cos(2*t) + cos(2*sqrt(2)*t)/2", "0.1", "0.7")


def followed(push, state, wall, r, until):
    """x and x' at a time, by scipy."""
    t, v = state
    x, u = wall + 1e-13, v

    def meets(_t, y):
        return y[0] - wall

    meets.terminal, meets.direction = True, -1
    while t < until:
        way = solve_ivp(
            lambda t, y: [y[1], push(t, *y)],
            (t, until),
            [x, u],
            "DOP853",
            events=meets,
            rtol=1e-10,
            atol=1e-12,
            max_step=0.1,
        )
        t, (x, u) = way.t[-1], way.y[:, -1]
        if way.status == 1:
            x, u = wall + 1e-13, -r * u
    return np.array([x, u])


def drive(omega, second):
    return lambda t: np.cos(omega * t) + second * np.cos(omega * np.sqrt(2) * t)


def late_states(found, push, wall, r, until, picks):
    """The classes of some states of a grid, and where an integrator has them at one late time."""
    codes = [int(found.codes[i, j]) for i, j in picks]
    ends = [followed(push, (found.tau[j], found.v[i]), wall, r, until) for i, j in picks]
    return codes, ends


def test_states_of_one_response_meet():
    found = si.basins(ONE, size=8)
    assert [(each.kind, each.name) for each in found.attractors] == [("quasi-periodic", "quasi-periodic")]
    g = drive(2, 0.5)
    _, ends = late_states(found, lambda t, x, _: g(t) - x, 0.3, 0.7, 150, [(0, 0), (4, 5), (7, 2)])
    for end in ends[1:]:
        assert end == pytest.approx(ends[0], abs=1e-5)
    assert si.lyapunov(ONE, 0, 1.0, impacts=1000).exponents[0] < -0.05


def test_states_of_a_damped_nonlinear_model_meet():
    found = si.basins(DUFFING, size=6)
    assert [each.kind for each in found.attractors] == ["quasi-periodic"]
    g = drive(2, 0.5)
    push = lambda t, x, u: g(t) - x - x**3 / 10 - u / 5  # noqa: E731
    _, ends = late_states(found, push, 0.1, 0.7, 80, [(0, 0), (5, 3)])
    assert ends[1] == pytest.approx(ends[0], abs=1e-5)


def test_states_of_several_responses_meet_within_their_classes_alone():
    found = si.basins(SEVERAL, size=12)
    assert {each.kind for each in found.attractors} == {"quasi-periodic"}
    names = [name for _, name, _ in found.classes]
    assert len(names) == len(set(names)) == 4
    picks = [tuple(np.argwhere(found.codes == code)[k].tolist()) for code in range(4) for k in (0, -1)]
    g = drive(2.8, 1 / 50)
    codes, ends = late_states(found, lambda t, x, _: g(t) - x, 0.1, 0.8, 400, picks)
    for code, end in zip(codes, ends, strict=True):
        for other, place in zip(codes, ends, strict=True):
            assert (np.abs(place - end).max() < 1e-3) == (other == code)


def test_a_positive_exponent_is_called_chaotic():
    found = si.basins(CHAOTIC, size=4, impacts=1000)
    largest = max(found.classes, key=lambda row: row[2])
    assert found.attractors[largest[0]].kind == "chaotic"
    exponents = si.lyapunov(CHAOTIC, 0, 1.0, impacts=4000)
    assert exponents.exponents[0] > 3 * exponents.error[0] > 0


def test_without_losses_nothing_is_decided():
    still = si.ImpactOscillator("x", "(cos(sqrt(2)*t) + cos(sqrt(3)*t))/100", 0, 1)
    found = si.basins(still, ((0, 2), (1, 2)), 3, impacts=400)
    assert {each.kind for each in found.attractors} <= {"not decided", "chaotic"}
    assert "not decided" in {each.kind for each in found.attractors}


def test_a_wall_that_the_forcing_never_leaves_is_a_rest_for_ever():
    found = si.basins(ONE.replace(clearance=2), size=4)
    assert [each.name for each in found.attractors] == ["rest for ever"]
    assert found.first_chatter_completes.all()


def test_pools_and_stored_cases_give_the_same_classes(tmp_path):
    window = ((0, 3), (0, 1))
    found = si.basins(SEVERAL, window, 40)
    with ThreadPoolExecutor(1) as pool:
        assert np.array_equal(si.basins(SEVERAL, window, 40, executor=pool).codes, found.codes)
    for _ in range(2):
        assert np.array_equal(si.basins(SEVERAL, window, 40, output=tmp_path / "basins.zarr").codes, found.codes)


@pytest.mark.parametrize("direction", [None, "up"])
def test_a_diagram_says_where_neighbours_meet(direction):
    model = si.ImpactOscillator("x", WAVES.format(2), "0.3", "0.9")
    diagram = si.bifurcation(model, "clearance", (-0.2, 0.7), 4, impacts=100, kept=5, settle=2000, direction=direction)
    assert {each.kind for each in diagram.attractors} == {"quasi-periodic", "chaotic"}
    for value, settled, attractor in zip(diagram.values, diagram.settled, diagram.attractors, strict=True):
        assert settled == (attractor.kind == "quasi-periodic")
        found = si.lyapunov(model.replace(clearance=float(value)), 0, 0.1, impacts=4000, transient=2000)
        assert (found.exponents[0] < 0) == settled
    assert np.isfinite(diagram.events).all()


def test_a_forcing_that_is_no_sum_of_waves_is_refused():
    swan = si.universal(-1, "0.5")
    for study in (lambda: si.basins(swan), lambda: si.bifurcation(swan, "clearance", (0, 1), 2)):
        with pytest.raises(InputError, match="one with a period, without t, or with sums of waves in t"):
            study()
