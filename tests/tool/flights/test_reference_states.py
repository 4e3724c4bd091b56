"""Every reference state: nothing missed, nothing invented, full accuracy away from grazes."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from reference_states import Reference, states

from singimpact.status import Status

EPSILON = 2.0**-52


def errors(problem: Reference) -> tuple[int, float, float]:
    """The status, and the errors of flight time and v' in units of what their conditions allow."""
    model = problem.model()
    step = model.impact_map(problem.tau, problem.v)
    with mpmath.workdps(40):
        time, speed = mpmath.mpf(problem.flight_time), mpmath.mpf(problem.v_next)
        off = float(abs(step.flight_time / time - 1)), float(abs(step.v / speed - 1))
    tau, v = float(problem.tau), float(problem.v)
    row = np.abs(model.derivative(problem.tau, problem.v).matrix[1])
    moved = 1 + float(row[0] * max(abs(tau), float(step.flight_time)) + row[1] * v) / float(step.v)
    allowed = max(1e-14, 10 * float(step.condition) * EPSILON), max(1e-13, 10 * moved * EPSILON)
    return int(step.status), off[0] / allowed[0], off[1] / allowed[1]


@pytest.mark.parametrize("step", [4, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("family", ["linear", "duffing"])
def test_no_impact_is_wrong(family: str, step: int) -> None:
    for problem in states(family)[::step]:
        status, in_time, in_speed = errors(problem)
        assert status == Status.hit, problem
        assert in_time < 1, problem
        assert in_speed < 1, problem


def test_forty_digits() -> None:
    # every 40th state here; all 2000 take minutes
    for problem in states("linear")[::60]:
        step = problem.model().impact_map(problem.tau, problem.v, digits=40)
        with mpmath.workdps(45):
            truth = mpmath.mpf(problem.flight_time), mpmath.mpf(problem.v_next)
            # the table itself holds 40 digits less what v = 1e-12 took from its 60
            assert abs(step.flight_time / truth[0] - 1) < 1e-37
            assert abs(step.v / truth[1] - 1) < 1e-37


def test_forty_digits_hold_without_the_table() -> None:
    for problem in states("linear")[7::250]:
        model = problem.model()
        first = model.impact_map(problem.tau, problem.v, digits=40)
        more = model.impact_map(problem.tau, problem.v, digits=60)
        with mpmath.workdps(70):
            assert abs(first.flight_time / more.flight_time - 1) < mpmath.mpf(10) ** -40
            assert abs(first.v / more.v - 1) < mpmath.mpf(10) ** -40


def test_digits_of_a_nonlinear_model() -> None:
    for problem in states("duffing")[::70]:
        step = problem.model().impact_map(problem.tau, problem.v, digits=20)
        with mpmath.workdps(25):
            assert abs(step.flight_time / mpmath.mpf(problem.flight_time) - 1) < 3e-16


def test_arrays_give_what_scalars_give() -> None:
    problem = states("linear")[0]
    tau, v = np.linspace(0, 3, 7)[:, None], np.array([0.0, 1e-200, 1e-3, 2.0])
    grid = problem.model().impact_map(tau, v)
    assert grid.status.shape == (7, 4)
    assert grid.status.dtype == np.int8
    for index in np.ndindex(7, 4):
        one = problem.model().impact_map(tau[index[0], 0], v[index[1]])
        assert one.status == grid.status[index]
        assert np.array_equal([one.tau, one.v], [grid.tau[index], grid.v[index]], equal_nan=True)
