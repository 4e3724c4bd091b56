"""Random states of steep families: each family's two texts, the fixed-step truth, the judge, the command."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi

import mpmath
import numpy as np
import pytest
import steep_balls
from steep_balls import AGREE, APART, COLUMNS, MORE, OPEN, Flown, enclosed, summary

from singimpact.algebra import DOUBLES, Certified, evaluate
from singimpact.bench import (
    FAMILIES,
    HIT,
    MISS,
    NAMES,
    PARAMETRIC,
    PHASE,
    POSITION,
    STEEP,
    UNDECIDED,
    VELOCITY,
    Family,
    Motion,
    steep_states,
)
from singimpact.bench.truth import graded_steps
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.status import Status

EVERY = pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
NO_NUMBERS = np.zeros(0)


@EVERY
def test_plain_function_is_the_text(family: Family) -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        case = steep_states.drawn_of(family, rng, 1)
        osc, n = case.oscillator(), case.numbers
        # on a layer as well as beside it, and where functions of K (x - a) do not overflow
        near = rng.normal() / n["K"]
        x, u = rng.choice([n["a"] + near, case.clearance]), rng.choice([near, n["w"] + near, case.v[0]])
        t = rng.choice([2 * pi + near, pi / 2 + near, case.tau[0]]) / n["omega"]
        plain = family.acceleration(t, x, u, [n[name] for name in NAMES])
        f, g = (evaluate(tree, {"x": x, "xdot": u, "t": t}, DOUBLES) for tree in (osc.force(), osc.forcing()))
        # K^2 (cos - 1) loses digits in the text, which the plain function keeps
        assert plain == pytest.approx(g - f, rel=1e-9, abs=1e-9 + 1e-15 * n["K"] ** 2)


@EVERY
def test_models_of_a_family_share_one_text(family: Family) -> None:
    rng = np.random.default_rng(1)
    first, second = (steep_states.drawn_of(family, rng, 1).oscillator() for _ in range(2))
    assert (str(first.f), str(first.g)) == (str(second.f), str(second.g))
    assert first != second


def test_twenty_families_are_drawn_alike_everywhere() -> None:
    assert len(STEEP) == 20
    assert {steep_states.family_of(number) for number in range(77)} == set(FAMILIES) - set(PARAMETRIC)
    one, other = steep_states.drawn(3, 17), steep_states.drawn(3, 17)
    assert one.numbers == other.numbers
    assert (one.tau == other.tau).all()
    assert steep_states.drawn(3, 18).numbers != one.numbers


def test_no_first_hit_of_the_parametric_families_is_wrong() -> None:
    columns = steep_states.check(200, 1, parametric=True).columns
    assert {FAMILIES[int(index)] for index in columns["family"]} == set(PARAMETRIC)
    assert np.isin(columns["true_status"], (graded_steps.HIT, graded_steps.MISS)).mean() > 0.95
    assert not steep_states.wrong(columns).any()
    late = columns | {"flight_time": columns["flight_time"] * (1 + 1e-6)}
    assert steep_states.wrong(late).sum() > 150


KNOWN = (
    ("x+tanh(50*xdot)/10", "cos(t)", lambda t, x, u, _p: np.cos(t) - x - np.tanh(50 * u) / 10,
     (VELOCITY, 0, 1 / 50, 5, 0), (0.3, 1.0), 2.927786),
    ("x+5*(1+tanh(100*(x-1/2)))", "cos(t)", lambda t, x, _u, _p: np.cos(t) - x - 5 * (1 + np.tanh(100 * (x - 0.5))),
     (POSITION, 0.5, 1 / 100, 500, 0), (0.3, 2.0), 0.907115),
    ("x", "-1/5+10*exp(1000*(cos(t)-1))", lambda t, x, _u, _p: 10 * np.exp(-2000 * np.sin(t / 2) ** 2) - 0.2 - x,
     (PHASE, 0, 1000**-0.5, 0, 2 * pi), (4.5, 1.0), 3.546468),
    ("x+5*exp(-6400*(x-1/2)**2)", "cos(t)", lambda t, x, _u, _p: np.cos(t) - x - 5 * np.exp(-6400 * (x - 0.5) ** 2),
     (POSITION, 0.5, 1 / 80, 400, 0), (0.3, 2.0), 3.000055),
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("force", "forcing", "plain", "layer", "launch", "time"), KNOWN)
def test_both_truths_give_known_flight_times(force, forcing, plain, layer, launch, time) -> None:
    motion = Motion(graded_steps.compiled(plain), NO_NUMBERS, np.array([layer], dtype=float), 0.0)
    hit = graded_steps.first_hit(motion, *launch, 30.0)
    assert hit.flight_time == pytest.approx(time, abs=6e-7)
    assert hit.crossed
    ball = ImpactOscillator(force, forcing, 0, "1/2").first_hit(*launch, digits=20, horizon=30).certified
    assert hit.flight_time == pytest.approx(float(ball.flight_time.value), rel=1e-13)
    assert hit.velocity == pytest.approx(float(ball.velocity.value), rel=1e-12)


@pytest.mark.slow
def test_steps_that_ignore_the_layer_do_not_agree_in_silence() -> None:
    """With the layer left out of the grading, the halved flights still find it or stay undecided."""
    plain, _, launch, time = KNOWN[1][2:]
    motion = Motion(graded_steps.compiled(plain), NO_NUMBERS, np.zeros((0, 5)), 0.0)
    hit = graded_steps.first_hit(motion, *launch, 30.0)
    assert hit.status == UNDECIDED or hit.flight_time == pytest.approx(time, abs=6e-7)


def test_a_dip_inside_a_step_is_found() -> None:
    """Under a constant force that turns upwards, x = t - t^2 + 0.3 a t^3 dips below 0 or not."""
    dips = graded_steps.compiled(lambda t, _x, _u, p: 6 * p[0] * t - 2)
    for share, status in ((0.2499, HIT), (0.2501, MISS)):  # t (1 - t + share t^2) has a double root at 1/4
        motion = Motion(dips, np.array([share]), np.zeros((0, 5)), 0.0)
        assert graded_steps.first_hit(motion, 0.0, 1.0, 30.0).status == status


@pytest.mark.parametrize(
    "number", [each if each % 4 == 0 else pytest.param(each, marks=pytest.mark.slow) for each in range(22)]
)
def test_truth_agrees_with_enclosures(number: int) -> None:
    case = steep_states.drawn(2, number, 2)
    tau, v = float(case.tau[0]), float(case.v[0])
    hit = graded_steps.first_hit(case.motion(), tau, v, 30.0)
    numbers, _ = steep_balls.by_digits(case.oscillator(), (tau, v), 20)
    assert numbers is not None
    assert hit.status == (HIT if numbers else MISS)
    if numbers:
        assert hit.flight_time == pytest.approx(float(numbers[0].value), rel=1e-12)


def columns(**changes: float) -> dict[str, np.ndarray]:
    """One state that is right, and what is changed about it."""
    usual = {"status": Status.hit, "flight_time": 2.0, "condition": 10.0, "true_status": HIT, "true_time": 2.0}
    return {name: np.array([value], dtype=float) for name, value in (usual | changes).items()}


@pytest.mark.parametrize(
    ("changes", "is_wrong"),
    [
        ({}, False),
        ({"flight_time": 2 + 1e-9}, False),
        ({"flight_time": 2 + 4e-9}, True),
        ({"flight_time": 2 + 4e-9, "condition": 1e6}, False),
        ({"flight_time": np.nan}, True),
        ({"condition": np.nan}, True),
        ({"status": Status.no_return, "flight_time": np.inf}, True),
        ({"status": Status.escaped, "flight_time": np.inf}, True),
        ({"status": Status.graze}, True),
        ({"status": Status.unresolved, "flight_time": np.nan}, False),
        ({"true_status": MISS, "true_time": np.inf}, True),
        ({"true_status": MISS, "status": Status.no_return}, False),
        ({"true_status": UNDECIDED, "flight_time": 3.0}, False),
    ],
)
def test_judge(changes: dict[str, float], is_wrong: bool) -> None:
    assert steep_states.wrong(columns(**changes)).tolist() == [is_wrong]


def beside(number: int, checked: bool = False, twice: bool = False, off: float = 0.0) -> dict[str, np.ndarray]:
    """The enclosure of a state whose doubles and fixed steps are those of the enclosure, but for a part of the time."""
    case = steep_states.drawn(0, number)
    (time, velocity), _ = steep_balls.by_digits(case.oscillator(), (float(case.tau[0]), float(case.v[0])), 20)
    state = Flown(number, 0, float(time.value) * (1 + off), float(velocity.value), float(time.value), checked, twice)
    return {name: np.array([value]) for name, value in zip(COLUMNS, enclosed(0, state), strict=True)}


def test_errors_are_measured_against_enclosures() -> None:
    """A planted flight time that is off by 1e-6 has that error, and an estimate below it is counted."""
    balls = beside(0, off=1e-6)
    assert balls["time_error"] == pytest.approx(1e-6, rel=1e-6)
    assert balls["velocity_error"] < 1e-15
    found = columns() | {name: np.array([1e-9]) for name in ("error", "velocity_error", "velocity_condition")}
    summed = summary(found, balls)
    assert (summed.agree, summed.disagree, summed.refused) == (1, 0, 0)
    assert summed.time is not None
    assert summed.velocity is not None
    assert (summed.time.below, summed.velocity.below) == (1, 0)
    assert summed.wrong
    honest = summary(found, beside(0))
    assert not honest.wrong
    late = summary(found, beside(0) | {"step_time_error": np.array([1e-6])})
    assert (late.disagree, late.wrong) == (1, True)


PULSE = 3  # a case that the second program decides in a tenth of a second


def test_enclosures_agree_with_the_second_program_and_with_more_digits() -> None:
    balls = beside(PULSE, checked=True, twice=True)
    assert (balls["checked"], balls["twice"]) == (AGREE, AGREE)


@pytest.mark.parametrize("name", ["flight_time", "velocity"])
@pytest.mark.parametrize(("digits", "checked", "twice"), [(20, APART, APART), (MORE, AGREE, APART)])
def test_an_enclosure_that_is_off_is_seen(name, digits, checked, twice, monkeypatch) -> None:
    """A number of an enclosure moved by a millionth of itself."""
    honest = ImpactOscillator.first_hit

    def moved(osc, *at, **named):
        hit = honest(osc, *at, **named)
        true = getattr(hit.certified, name)
        if named["digits"] == digits:
            wrong = Certified(true.value * (1 + mpmath.mpf(10) ** -6), true.radius, true.digits)
            hit.__dict__["certified"] = replace(hit.certified, **{name: wrong})
        return hit

    monkeypatch.setattr(ImpactOscillator, "first_hit", moved)
    balls = beside(PULSE, checked=True, twice=True)
    assert (balls["checked"], balls["twice"]) == (checked, twice)
    found = columns() | {name: np.array([1e-3]) for name in ("error", "velocity_error", "velocity_condition")}
    assert summary(found, balls).wrong


def test_states_that_are_not_decided_are_counted(monkeypatch) -> None:
    monkeypatch.setattr(steep_balls, "SECONDS", 0.0)
    assert beside(PULSE, checked=True)["checked"] == OPEN


@pytest.mark.slow
def test_most_steep_states_are_enclosed_twice() -> None:
    states = steep_states.check(25 * 8, 1).columns
    first = {name: column[::25] for name, column in states.items()}  # a state of each family
    found = steep_balls.check(first, (8, 2, 6), 1)
    assert (found.states, found.refused) == (8, 0)
    assert sum(found.checked) == 2
    assert found.twice == (6, 0, 0)
    assert not found.wrong


@pytest.mark.slow
def test_command(singimpact) -> None:
    told = singimpact(
        "bench", "states", "--family", "steep", "--states", "25", "--workers", "1", "--quick", "--json",
    )  # fmt: skip
    data = json.loads(told.stdout)["states"]
    assert sum(row["states"] for row in data["rows"]) == 25
    assert {row["kind"] for row in data["rows"]} == {"friction"}
    assert told.exit_code == int(any(row["wrong"] for row in data["rows"]))
