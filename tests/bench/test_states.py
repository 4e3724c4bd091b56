"""Random states against the solver of 60 digits, and that solver against the reference states."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor

import flint
import numpy as np
import pytest
from reference_states import Reference, states as problems

from singimpact.bench import Cubic, Linear, first_hit, random_states


@pytest.mark.parametrize(("family", "made", "each"), [("linear", Linear, 50), ("duffing", Cubic, 70)])
def test_truth_gives_the_reference(family: str, made: type, each: int) -> None:
    def off(problem: Reference) -> float:
        found = first_hit(made(problem.omega, problem.clearance, problem.tau, problem.v), problem.v, 2000.0)
        assert found is not None
        return float(abs(found[0] / flint.arb(problem.flight_time) - 1))

    with flint.ctx.workprec(320):
        assert max(off(problem) for problem in problems(family)[::each]) < (1e-38 if family == "linear" else 1e-13)


def test_no_state_is_wrong() -> None:
    with ThreadPoolExecutor(1) as pool:
        rows = random_states.check(250, 7, pool)
    assert sum(row.states for row in rows) == 250
    assert {row.kind for row in rows} > {"linear generic", "linear low", "linear graze", "linear long"}
    for row in rows:
        assert row.wrong == row.unresolved == 0
        assert max(row.time_error, row.velocity_error) < (1 if row.kind.startswith("linear") else 8), row


def test_a_wrong_impact_is_seen() -> None:
    model = random_states.Model("linear", 2.0, 0.0)
    assert random_states._errors(model, 1.0, 0.5, [0.0, 1.2, 0.7, 0])[2] == 1
    assert random_states._errors(model, 1.0, 0.5, [3.0, np.inf, np.nan, 0])[2] == 1


@pytest.mark.parametrize("family", ["between-walls", "plastic"])
def test_no_state_of_another_family_is_wrong(family: str) -> None:
    with ThreadPoolExecutor(1) as pool:
        rows = random_states.check(300, 7, pool, family=family)
    assert {row.kind.split()[1] for row in rows} == set(random_states.FAMILIES[family][2])
    for row in rows:
        assert row.wrong == row.unresolved == 0
        assert max(row.time_error, row.velocity_error) < 1, row


def test_a_wrong_release_is_seen() -> None:
    model, hit = random_states.Model("linear", 2.0, 0.3), int(random_states.Status.hit)
    step = model.oscillator().replace(restitution=0).release_map(0.1)
    landing, later = float(step.landing), float(step.tau)
    with flint.ctx.workprec(320):
        assert random_states._release_errors(model, 0.1, landing, later, hit)[2] == 0
        assert random_states._release_errors(model, 0.1, landing + 1e-4, later, hit)[2] == 1
        assert random_states._release_errors(model, 0.1, landing, later + 1e-4, hit)[2] == 1
        assert random_states._release_errors(model, 0.1, landing, later + 1e-4, 1)[2] == 1


def test_an_impact_at_the_wrong_wall_is_seen() -> None:
    model = random_states.Model("linear", 2.0, 0.0, upper=0.3)
    osc = model.oscillator()
    step = osc.impact_map(1.0, 0.9)
    answer = [float(part) for part in (step.status, step.flight_time, step.v, step.wall)]
    assert answer[3] == 1
    assert random_states._errors(model, 1.0, 0.9, answer)[2] == 0
    assert random_states._errors(model, 1.0, 0.9, [*answer[:3], 0.0])[2] == 1
    alone = osc.one_wall().impact_map(1.0, 0.9)  # the flight through the upper wall
    assert random_states._errors(model, 1.0, 0.9, [0.0, float(alone.flight_time), float(alone.v), 0.0])[2] == 1


@pytest.mark.slow
def test_command(singimpact) -> None:
    told = singimpact("bench", "states", "--states", "25", "--workers", "1", "--seed", "3", "--json")
    assert told.exit_code == 0
    assert [row["wrong"] for row in json.loads(told.stdout)["states"]] == [0]
