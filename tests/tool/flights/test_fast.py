"""Fast variants against the plain one: strides, lanes, chains, and the same source without the compiler."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from reference_states import states

from singimpact.flights import iterate, orbit_segment
from singimpact.flights.impact_map import impact_map
from singimpact.impact_oscillator import ImpactOscillator, linear

UNCOMPILED = """
import numpy as np
from reference_states import states
for family in ("linear", "duffing"):
    for p in states(family)[::{step}]:
        step = p.model().impact_map(p.tau, p.v)
        print(p.regime, int(step.status), float(step.flight_time).hex(), float(step.v).hex())
"""


TWO_WAVES = ImpactOscillator("2*x", "cos(t) + 0.4*sin(sqrt(2)*t)", 0, "-0.9*v + v**2/40")
MODELS = [linear("2.8", "-0.3", "0.8"), linear("1.3", "0.1", "0.6", damping="0.3"), TWO_WAVES]


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS)
def test_lanes_and_chains_follow_the_map(model: ImpactOscillator) -> None:
    tau, v = (part.ravel() for part in np.meshgrid(np.linspace(0, 3, 9), np.geomspace(1e-6, 2, 7)))
    ends, step = iterate(model, tau, v, 1), model.impact_map(tau, v)
    hit = step.status == 0
    assert np.array_equal(ends.status == 0, hit)
    # one flight from near the tangency comes back at a graze: its v' keeps half of the digits of the launch
    hit &= (step.condition < 1e5) & (step.v > 1e-3 * np.abs(step.flight_time))
    # rounding of the launch is the only difference, and the flight answers to it by its condition
    assert ends.tau[hit] == pytest.approx(step.tau[hit], rel=1e-12)
    assert ends.v[hit] == pytest.approx(step.v[hit], rel=1e-9)
    for index in np.flatnonzero(hit)[::13]:
        found = orbit_segment(model, tau[index], v[index], 1)
        assert found.tau[0] == pytest.approx(step.tau[index], rel=1e-14)


def test_inverse_undoes_the_map() -> None:
    osc = linear("2.8", "0.1", "0.8")
    tau, v = np.linspace(0, 2, 9)[:, None], np.geomspace(1e-3, 2, 5)
    step = osc.impact_map(tau, v)
    good = step.status == 0
    before = osc.inverse_map(step.tau[good], step.v[good])
    assert before.tau == pytest.approx(np.broadcast_to(tau, good.shape)[good], rel=1e-9, abs=1e-12)
    assert before.v == pytest.approx(np.broadcast_to(v, good.shape)[good], rel=1e-8)


def test_the_source_runs_without_the_compiler(clone) -> None:
    step = 97
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": f"{clone}{os.pathsep}{clone / 'tests'}"}
    command = [sys.executable, "-c", UNCOMPILED.format(step=step)]
    told = subprocess.run(command, cwd=clone, env=environment, capture_output=True, text=True, check=True).stdout
    chosen = [p for family in ("linear", "duffing") for p in states(family)[::step]]
    assert len(chosen) > 20
    for problem, line in zip(chosen, told.splitlines(), strict=True):
        regime, status, time, v = line.split()
        found = impact_map(problem.model(), problem.tau, problem.v)
        assert (regime, int(status)) == (problem.regime, found.status)
        # a compiler has its own exp and log, which choose the steps of a flight without a closed form
        late, dull = (0, 0) if problem.family == "linear" else (
            found.time_error * found.flight_time, found.velocity_error * found.v)  # fmt: skip
        assert abs(found.flight_time - float.fromhex(time)) <= max(4 * np.spacing(found.flight_time), late), problem
        assert abs(found.v - float.fromhex(v)) <= max(4 * np.spacing(found.v), dull), problem


def test_a_sweep_compiles_once() -> None:
    """Models that differ in parameters, c or r share one kernel, linear or not."""
    from numba.core import event

    force = "x + d*xdot + b*x**3"
    for cubic in ("0.3", "0"):  # with b = 0 the model is linear
        values = {"d": "0.1", "b": cubic, "omega": "1.7"}
        ImpactOscillator(force, "cos(omega*t)", "0.3", "0.6", values).impact_map(0.9, [0.1, 1e-6])
        with event.install_recorder("numba:compile") as seen:
            for change in ({"omega": "1.9"}, {"d": "0.2", "omega": "0.7"}):
                ImpactOscillator(force, "cos(omega*t)", "0.1", "0.6", values | change).impact_map(0.9, [0.1, 1e-6])
            ImpactOscillator(force, "cos(omega*t)", "-0.2", "0.9", values).impact_map(0.9, [0.1, 1e-6])
        assert not seen.buffer
