"""Certificates of period doublings: accepted as they were made; other numbers and kinds are refused."""

from __future__ import annotations

import pytest
from second_program import copied, is_read_back, no_number_may_change, refuses, renewed, weakened

import singimpact as si
from singimpact.certificates import checker
from singimpact.certificates.checker import files
from singimpact.inputs import InputError

LINEAR = si.linear("2.8", 0, "0.8")


@pytest.fixture(scope="module")
def branch():
    model = si.ImpactOscillator("x + 0.05*xdot", "A*cos(2.8*t)", "0.1", "0.8", {"A": "1"})
    orbit = next(each for each in model.periodic(1, 1) if each.visible)
    return si.branch(orbit, "A", (0.2, 3.0))


@pytest.fixture(scope="module")
def made(branch):
    (event,) = [each for each in branch.events if each.kind == "period-doubling" and each.orbit.visible]
    return si.certify(event.certified(10))


def test_it_is_accepted_from_its_file(made, tmp_path):
    is_read_back(made, tmp_path / "event.json")
    assert repr(made).startswith("<certificate of a period-doubling: A = ")


def test_any_changed_number_is_refused(made):
    no_number_may_change(made, 11)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"kind": "torus"}, "an event is a period-doubling"),
        ({"kind": "fold"}, "an event is a period-doubling"),
        ({"over": "omega"}, "no parameter"),
        ({"period": "pi"}, "is not shown to have the period"),
        ({"periods": "0"}, "closes after periods"),
        ({"states": []}, "closes after periods"),
    ],
)
def test_another_statement_is_refused(change, why, made):
    refuses({**copied(made.content), **change}, why)


@pytest.mark.parametrize("part", ["parameter", "tau", "v"])
def test_a_number_off_by_many_radii_is_refused(part, made):
    content = copied(made.content)
    number = content["parameter"] if part == "parameter" else content["states"][0][part]
    number["value"] = repr(float(number["value"]) + 1e4 * float(number["radius"]))
    refuses(content)


def test_a_model_with_another_number_is_refused(made):
    content = copied(made.content)
    content["model"]["restitution"] = "0.81"
    refuses(content)


def test_a_number_that_moves_the_period_is_refused(made):
    content = copied(made.content)
    content["model"] |= {"g": "A*cos(w*t)", "parameters": {**content["model"]["parameters"], "w": "2.8"}}
    content["over"] = "w"
    refuses(content, "is not shown to have the period")


@pytest.mark.slow
def test_without_the_change_of_sign_an_orbit_beside_the_event_passes(made, monkeypatch):
    """At another number of the same curve: its orbit is there, and its test does not vanish."""
    model = si.ImpactOscillator(**{**made.content["model"], "parameters": {"A": "0.9"}})
    orbit = si.certify(model.periodic(1, 1)[0].certified(10)).content
    content = {**copied(made.content), "states": orbit["states"], "parameter": {"value": "0.9", "radius": "1e-11"}}
    refuses(content)
    condition = "sorted(signs) != [-1, 1]"
    weak = weakened("event", condition, "False")
    monkeypatch.setitem(
        weak.__globals__, "crossing", lambda family, value, point, _: (value, family.solved(value, point)[0])
    )
    monkeypatch.setitem(files.STATEMENTS, "event", weak)
    checker.check(renewed(content))


def test_others_have_no_file(branch):
    from dataclasses import replace

    (event,) = [each for each in branch.events if each.kind == "period-doubling" and each.orbit.visible]
    ball = event.certified(10)
    with pytest.raises(InputError, match="a fold has no certificate as a file"):
        si.certify(replace(ball, kind="fold"))
    with pytest.raises(InputError, match="only those over a parameter"):
        si.certify(replace(ball, over="clearance"))
