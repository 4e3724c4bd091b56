"""Certificates of chatter limits: accepted as they were made; false ends, times and bounds are refused."""

from __future__ import annotations

import json
from fractions import Fraction

import flint
import pytest
from second_program import changed, copied, is_read_back, places_of, refuses, renewed, weakened

import singimpact as si
from singimpact.certificates import STATEMENTS, Model, checker, rest
from singimpact.inputs import InputError

DUFFING = si.ImpactOscillator("x + 0.1*xdot + e*x**3", "cos(1.7*t)", "0.3", "0.6", {"e": "0.3"})
LINEAR = si.linear("2.8", 0, "0.8")
STATES = {
    "linear": (LINEAR, "0.9", "0.005", 30, "accumulation"),
    "duffing": (DUFFING, "1.2", "0.02", 15, "accumulation"),
    "lift-off": (LINEAR, "1.1", "0.1", 20, "lift-off"),
}


@pytest.fixture(scope="module")
def made():
    return {name: si.certify(osc.chatter_limit(tau, v, digits=digits))
            for name, (osc, tau, v, digits, _) in STATES.items()}  # fmt: skip


@pytest.mark.parametrize("name", STATES)
def test_it_is_accepted_from_its_file(name, made, tmp_path):
    assert made[name].content["ends"] == STATES[name][-1]
    is_read_back(made[name], tmp_path / "limit.json")
    assert "certificate of the chatter limit from" in repr(made[name])


@pytest.mark.parametrize("name", ["duffing", "lift-off"])
def test_any_changed_number_is_refused(name, made):
    content = made[name].content
    places = list(places_of(content))
    assert len(places) >= 7
    for place in places:
        with pytest.raises(checker.Refused, match="digest"):
            checker.check(changed(content, place))
        if place[-1] == "radius":
            continue
        forged = changed(content, place)
        if place[-1] == "value":  # the last digits are within the radius
            text = content["tau"]["value"]
            forged["tau"]["value"] = f"{text[:-5]}{(int(text[-5]) + 1) % 10}{text[-4:]}"
        refuses(forged)


@pytest.mark.parametrize(("name", "other"), [("duffing", "lift-off"), ("lift-off", "accumulation"), ("duffing", "x")])
def test_another_end_is_refused(name, other, made):
    refuses({**made[name].content, "ends": other}, "ends in|ends is not accumulation or lift-off")


def test_a_radius_that_is_too_small_is_refused(made):
    content = copied(made["duffing"].content)
    content["tau"]["radius"] = "1e-17"  # the value itself is off by more
    refuses(content, "tau is")


def test_a_law_of_restitution_is_refused(made):
    content = copied(made["duffing"].content)
    content["model"]["restitution"] = "-0.6*v"
    refuses(content, "no number")


def rest_of(name, tau, v):
    osc = STATES[name][0]
    model = Model(osc.to_dict())
    tau, v = (flint.arb(Fraction(part).numerator) / Fraction(part).denominator for part in (tau, v))
    return rest(model, tau, v, model.push(tau, v * 0), model.ratio())


@pytest.mark.parametrize("name", ["linear", "duffing"])
def test_the_rest_is_bounded_from_both_sides(name):
    """At velocities of many sizes: what is left contains the true end, and is of second order in v wide."""
    osc, tau = STATES[name][:2]
    for power in range(3, 9):
        v = Fraction(1, 10**power)
        flint.ctx.prec = 200
        try:
            left = rest_of(name, tau, v)
            end = osc.chatter_limit(tau, str(float(v)), digits=30).tau
            assert left.contains(flint.arb(str(end)) - flint.arb(tau))
            assert float(left.rad()) < 2000 * float(v) ** 2
        finally:
            flint.ctx.prec = 53


def test_bounds_that_do_not_close_are_none():
    assert rest_of("linear", "0.9", "0.5") is None
    fast = Model({**LINEAR.to_dict(), "restitution": "0.999"})
    one = flint.arb("0.9")
    assert rest(fast, one, flint.arb("1e-3"), fast.push(one, one * 0), fast.ratio()) is None
    elastic = Model({**LINEAR.to_dict(), "restitution": "1"})
    assert rest(elastic, one, flint.arb("1e-3"), elastic.push(one, one * 0), elastic.ratio()) is None


@pytest.mark.parametrize(
    ("condition", "instead", "change"),
    [
        ('lies_within(tau + left, content["tau"])', "True", {"tau": {"value": "1.3220", "radius": "1e-9"}}),
        ("2 * v / (low * (1 - r * q))", "2 * v / (high * (1 - r / q))", {}),
    ],
)
def test_a_checker_without_a_condition_says_otherwise(condition, instead, change, made, monkeypatch):
    weak = weakened("chatter_limit", condition, instead)
    content = {**copied(made["duffing"].content), **change}
    monkeypatch.setitem(STATEMENTS, "chatter limit", weak)
    if change:
        checker.check(renewed(content))
        monkeypatch.undo()
    refuses(content)


def test_limits_without_certificate_are_refused():
    with pytest.raises(InputError, match="not certified"):
        si.certify(LINEAR.chatter_limit("0.9", "0.005"))
    with pytest.raises(InputError, match="not certified"):
        si.certify(LINEAR.chatter_limit(["0.9", "1"], ["0.005", "0.005"], digits=15))
    with pytest.raises(InputError, match="starts at rest"):
        si.certify(LINEAR.chatter_limit("0.3", 0, digits=15))


def test_the_text_of_a_certificate_is_read_again(made):
    assert json.loads(made["linear"].text) == made["linear"].content
