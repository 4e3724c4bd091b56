"""Laws every flight obeys, on models and states that hypothesis draws: more of them with --slow."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings, strategies as st

from singimpact.flights.derivative import derivative
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.status import Status

MANY = [pytest.param(12, id="some"), pytest.param(400, id="many", marks=pytest.mark.slow)]
EPSILON = 2.0**-52
OMEGAS = st.one_of(st.floats(0.3, 3.5), st.sampled_from([1.0, 1 + 1e-12, 1 - 1e-12, 2.0]))
CLEARANCES = st.one_of(st.floats(-3, 1.5), st.sampled_from([0.0, 1 - 1e-9, 1 + 1e-9, -1 + 1e-9, -1 - 1e-9]))
RESTITUTIONS = st.one_of(st.floats(0.05, 1), st.sampled_from([1.0, 1e-12]))
SPEEDS = st.one_of(st.floats(0.01, 5), st.floats(-12, -2).map(lambda power: 10**power), st.just(1e-300))
FORCES = st.sampled_from(["x", "x + xdot/10", "x + xdot/10 + 3*x**3/10"])
STATES = st.tuples(st.floats(0, 1), SPEEDS)


def model(force: str, omega: float, clearance: float, restitution: float) -> ImpactOscillator:
    return ImpactOscillator(force, "cos(omega*t)", clearance, restitution, {"omega": omega})


def hit(osc: ImpactOscillator, tau: float, v: float):
    """The step, its T and v' and what 20 roundings of the state and of the flight do to them."""
    step = osc.impact_map(tau, v, horizon=60)
    assume(step.status == Status.hit)
    matrix = derivative(osc, tau, v, horizon=60).matrix
    # the flight's own rounding answers like one of x, of the size of what x moved through
    moved = abs(float(step.flight_time)) * (1 + abs(tau)) + 1
    by_time = (1 + abs(matrix[0, 0])) * moved + abs(matrix[0, 1]) * (v + moved)
    by_speed = abs(matrix[1, 0]) * moved + abs(matrix[1, 1]) * (v + moved) + abs(float(step.v))
    assume(np.isfinite(by_time) and by_time < 1e6)
    return step, 20 * EPSILON * by_time, 20 * EPSILON * by_speed


def errors(step):
    """The errors that a flight states, of its time and of v'."""
    return step.time_error * step.flight_time, step.velocity_error * step.v


def cases(many: int):
    return settings(max_examples=many, deadline=None, derandomize=True,
                    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])  # fmt: skip


@pytest.mark.parametrize("many", MANY)
def test_translation_by_the_period(many: int) -> None:
    @cases(many)
    @given(FORCES, OMEGAS, CLEARANCES, STATES, st.integers(1, 40))
    def law(force: str, omega: float, clearance: float, state: tuple[float, float], turns: int) -> None:
        osc, tau = model(force, omega, clearance, 0.8), state[0] * 2 * np.pi / omega
        later = tau + turns * 2 * np.pi / omega
        one, slack, slack_v = hit(osc, tau, state[1])
        other = osc.impact_map(later, state[1], horizon=60)
        # the later phase is rounded in units of itself
        size = (1 + later) / (1 + tau)
        assert other.status == one.status
        assert abs(other.flight_time - one.flight_time) <= slack * size
        assert abs(other.v - one.v) <= slack_v * size

    law()


@pytest.mark.parametrize("many", MANY)
def test_the_map_commutes_with_a_shift_of_time(many: int) -> None:
    @cases(many)
    @given(OMEGAS, CLEARANCES, STATES, st.floats(-9, 9))
    def law(omega: float, clearance: float, state: tuple[float, float], shift: float) -> None:
        tau, v = state[0] * 2 * np.pi / omega, state[1]
        osc = linear(omega, clearance, 0.8)
        one, slack, slack_v = hit(osc, tau, v)
        moved = linear(omega, clearance, 0.8, phase=-omega * shift).impact_map(tau + shift, v, horizon=60)
        size = 1 + abs(shift) + abs(omega * shift)
        assert moved.status == one.status
        assert abs(moved.flight_time - one.flight_time) <= slack * size
        assert abs(moved.v - one.v) <= slack_v * size

    law()


@pytest.mark.parametrize("many", MANY)
def test_the_flight_ends_where_the_flow_says(many: int) -> None:
    """phi_c = p_c o iota: the flow from the launch at the flight time, and back from the hit, give both ends."""

    @cases(many)
    @given(FORCES, OMEGAS, CLEARANCES, STATES)
    def law(force: str, omega: float, clearance: float, state: tuple[float, float]) -> None:
        osc, tau = model(force, omega, clearance, 1), state[0] * 2 * np.pi / omega
        step, _, slack_v = hit(osc, tau, state[1])
        place = osc.flight(tau, state[1], step.flight_time)
        size = 1 + abs(clearance) + state[1] + abs(step.v)
        assert abs(place.x - clearance) <= 1e-12 * size * (1 + float(step.flight_time))
        assert abs(place.xdot + step.v) <= slack_v + 1e-12 * size * (1 + float(step.flight_time))

    law()


@pytest.mark.parametrize("many", MANY)
def test_energy_without_forcing(many: int) -> None:
    @cases(many)
    @given(CLEARANCES, st.floats(1e-12, 5))
    def law(clearance: float, v: float) -> None:
        step = ImpactOscillator("x + x**3", "0", clearance, 1).impact_map(0, v, horizon=60)
        assume(step.status == Status.hit)
        assert abs(step.v - v) <= max(1e-12 * v, 1e-15 * (1 + abs(clearance)), errors(step)[1])

    law()


@pytest.mark.parametrize("many", MANY)
def test_forward_then_backward(many: int) -> None:
    @cases(many)
    @given(FORCES, OMEGAS, CLEARANCES, RESTITUTIONS, STATES)
    def law(force: str, omega: float, clearance: float, r: float, state: tuple[float, float]) -> None:
        osc, tau = model(force, omega, clearance, r), state[0] * 2 * np.pi / omega
        step, slack, slack_v = hit(osc, tau, state[1])
        matrix = derivative(osc, tau, state[1], horizon=60).matrix
        assume(np.all(np.isfinite(matrix)) and np.linalg.cond(matrix) < 1e12)
        inverse = np.linalg.inv(matrix)
        assume(np.abs(inverse).max() < 1e6)
        before = osc.inverse_map(step.tau, step.v, horizon=60)
        answer = np.abs(inverse) @ [slack, slack_v + EPSILON * float(step.v)]
        assert before.status == Status.hit
        assert abs(before.tau - tau) <= 4 * answer[0] + 20 * EPSILON * (1 + tau + float(step.tau))
        assert abs(before.v - state[1]) <= 4 * answer[1] + 20 * EPSILON * (1 + state[1])

    law()


@pytest.mark.parametrize("many", MANY)
def test_every_status_is_whole(many: int) -> None:
    """nan only beside a status that says so; v = 0 with a of either sign; touches to 1e-15."""

    @cases(many)
    @given(FORCES, OMEGAS, CLEARANCES, RESTITUTIONS, st.floats(0, 1), st.one_of(st.just(0.0), SPEEDS))
    def law(force: str, omega: float, clearance: float, r: float, part: float, v: float) -> None:
        osc, tau = model(force, omega, clearance, r), part * 2 * np.pi / omega
        step = osc.impact_map(tau, v, horizon=60)
        status = Status(int(step.status))
        whole = {Status.hit: step.flight_time > 0 and step.v > 0, Status.graze: step.flight_time > 0 and step.v == 0,
                 Status.sticks: v == 0 and step.flight_time == 0 and osc.acceleration(tau) <= 0,
                 Status.no_return: np.isinf(step.flight_time), Status.escaped: np.isinf(step.flight_time),
                 Status.unresolved: abs(step.depth) <= 10 * step.bound}  # fmt: skip
        assert whole[status], status
        assert np.isnan(step.flight_time) == (status == Status.unresolved)

    law()
