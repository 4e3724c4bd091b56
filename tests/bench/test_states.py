"""Random states against the solver of 60 digits, and that solver against the reference states."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import flint
import numpy as np
import pytest
from reference_states import Reference, states as problems

from singimpact.bench import Cubic, Linear, Trial, first_hit, hit_trial, random_states, release_trial
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.status import Status


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
        states = random_states.check(250, 7, pool)
    rows = states.rows()
    assert sum(row.states for row in rows) == 250
    assert {row.kind for row in rows} > {"linear generic", "linear low", "linear graze", "linear long"}
    for row in rows:
        assert row.wrong == row.unresolved == row.undecided == 0
        assert 0 < row.worst < (1 if row.kind.startswith("linear") else 8), row
    assert states.listed() == {"wrong": [], "unresolved": [], "undecided": []}


MODEL = random_states.Model("linear", 2.0, 0.0, tau=1.0, v=0.5)


def verdict(trial: Trial) -> tuple[bool, bool, bool]:
    """Whether a state is wrong, unresolved and undecided."""
    return random_states.judged(trial)[:3]


def test_a_wrong_impact_is_seen(monkeypatch) -> None:
    with flint.ctx.workprec(MODEL.bits):
        step = MODEL.model.impact_map(1.0, 0.5)
        time, velocity = float(step.flight_time), float(step.velocity)
        assert verdict(hit_trial(MODEL, 0, time, velocity)) == (False, False, False)
        for end in ((0, 1.2, -0.7), (0, time * (1 + 1e-11), velocity), (0, time, velocity * (1 + 1e-11)),
                    (int(Status.no_return), np.inf, np.nan)):  # fmt: skip
            assert verdict(hit_trial(MODEL, *end)) == (True, False, False)
        assert verdict(hit_trial(MODEL, int(Status.unresolved), np.nan, np.nan)) == (False, True, False)

    def late(osc, *at, **named):
        step = honest(osc, *at, **named)
        return replace(step, flight_time=step.flight_time * (1 + 1e-9))

    honest = ImpactOscillator.impact_map
    monkeypatch.setattr(ImpactOscillator, "impact_map", late)
    with ThreadPoolExecutor(1) as pool:
        states = random_states.check(25, 8, pool)
    assert states.rows()[0].wrong > 20
    assert len(states.listed()["wrong"]) == 1


def test_what_the_truth_does_not_decide_is_not_wrong() -> None:
    assert verdict(Trial("", status=(int(Status.hit), int(Status.graze)))) == (False, False, True)
    assert verdict(Trial("", status=(int(Status.graze), int(Status.hit)))) == (True, False, False)


@pytest.mark.parametrize("family", ["between-walls", "plastic"])
def test_no_state_of_another_family_is_wrong(family: str) -> None:
    with ThreadPoolExecutor(1) as pool:
        rows = random_states.check(300, 7, pool, family=family).rows()
    assert {row.kind.split()[1] for row in rows} == set(random_states.FAMILIES[family][2])
    for row in rows:
        assert row.wrong == row.unresolved == row.undecided == 0
        assert 0 < row.worst < 1, row


def test_a_wrong_release_is_seen() -> None:
    model, hit = random_states.Model("linear", 2.0, 0.3, tau=0.1, v=0.0), int(Status.hit)
    step = model.model.replace(restitution=0).release_map(0.1)
    landing, later = float(step.landing), float(step.tau)
    with flint.ctx.workprec(320):
        for end, is_wrong in (
            ((hit, landing, later), False),
            ((hit, landing + 1e-4, later), True),
            ((hit, landing, later + 1e-4), True),
            ((int(Status.no_return), np.inf, np.nan), True),
        ):
            assert verdict(release_trial(model, *end)) == (is_wrong, False, False)


def test_an_impact_at_the_wrong_wall_is_seen(monkeypatch) -> None:
    model = random_states.Model("linear", 2.0, 0.0, upper=0.3, tau=1.0, v=0.9)
    step = model.model.impact_map(1.0, 0.9)
    assert step.wall == 1
    assert verdict(random_states.impacts([model])[0]) == (False, False, False)
    with flint.ctx.workprec(model.bits):
        alone = model.model.one_wall().impact_map(1.0, 0.9)  # the flight through the upper wall
        assert verdict(hit_trial(model, 0, float(alone.flight_time), float(alone.velocity)))[0]

    def below(osc, *at, **named):
        step = honest(osc, *at, **named)
        return replace(step, wall=np.zeros_like(step.wall))

    honest = ImpactOscillator.impact_map
    monkeypatch.setattr(ImpactOscillator, "impact_map", below)
    assert verdict(random_states.impacts([model])[0])[0]


@pytest.mark.slow
def test_command(singimpact) -> None:
    told = singimpact("bench", "states", "--states", "25", "--workers", "1", "--seed", "3", "--json")
    assert told.exit_code == 0
    data = json.loads(told.stdout)["states"]
    assert [row["wrong"] for row in data["rows"]] == [0]
    assert data["listed"]["wrong"] == []


@pytest.mark.parametrize("bad", [0, 1])
def test_the_command_fails_where_a_state_is_wrong(singimpact, monkeypatch, bad: int) -> None:
    columns = {name: np.zeros(1) for name in random_states.COLUMNS} | {"wrong": np.full(1, bad)}
    planted = random_states.RandomStates(columns, lambda _: "linear", lambda *_: "omega = 2")
    monkeypatch.setattr(random_states, "check", lambda *_: planted)
    told = singimpact("bench", "states", "--workers", "1")
    assert told.exit_code == bad
    assert ("wrong, for example:\n  omega = 2" in told.stdout) == bad
