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
    found = random_states._errors("linear", 2.0, 0.0, 1.0, 0.5, [0.0, 1.2, 0.7])
    assert found[2] == 1
    assert random_states._errors("linear", 2.0, 0.0, 1.0, 0.5, [3.0, np.inf, np.nan])[2] == 1


@pytest.mark.slow
def test_command(singimpact) -> None:
    told = singimpact("bench", "states", "--states", "25", "--workers", "1", "--seed", "3", "--json")
    assert told.exit_code == 0
    assert [row["wrong"] for row in json.loads(told.stdout)["states"]] == [0]
