"""Certificates of folds, doublings, tori and grazes: accepted as made; other numbers and kinds are refused."""

from __future__ import annotations

import pytest
from second_program import changed, copied, dropped, is_read_back, no_number_may_change, places_of, refuses, renewed

import singimpact as si
from singimpact.certificates import Orbits, check
from singimpact.certificates.checker import event, motion, periodic_orbit
from singimpact.inputs import InputError

pytestmark = pytest.mark.slow  # seconds together: .ci/check runs them

LINEAR = si.linear("2.8", 0, "0.8")


@pytest.fixture(scope="module")
def branch():
    model = si.ImpactOscillator("x + 0.05*xdot", "A*cos(2.8*t)", "0.1", "0.8", {"A": "1"})
    orbit = next(each for each in model.periodic(1, 1) if each.visible)
    return si.branch(orbit, "A", (0.01, 3.0))


def event_of(branch, kind):
    return next(each for each in branch.events if each.kind == kind and each.orbit.visible)


@pytest.fixture(scope="module")
def made(branch):
    return si.certify(event_of(branch, "period-doubling").certified(10))


@pytest.fixture(scope="module")
def graze():
    """A = 0.3687...: the motion without impacts touches the wall."""
    model = si.ImpactOscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.45"})
    return si.certify(event_of(si.branch(model.periodic(1, 1)[0], "A", (0.3, 0.5)), "graze").certified(12))


@pytest.fixture(scope="module")
def duffing():
    model = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(w*t)", "0.3", "0.6", {"w": "1.7", "A": 1})
    (orbit,) = model.periodic(2, 1, start=(1.95786, 0.662042))
    return si.branch(orbit, "A", (0.6, 1.3))


@pytest.fixture(scope="module")
def torus():
    model = si.ImpactOscillator("x - mu*(1 - x**2)*xdot", "A*cos(w*t)", 0, "0.9", {"mu": "0.2", "A": "1.5", "w": "2.2"})
    (orbit,) = model.periodic(1, 1, start=(2.64089, 2.19428))
    return si.certify(event_of(si.branch(orbit, "A", (0.5, 1.6), step=0.1), "torus").certified(8))


def shifted(content, place, radii):
    """A copy with one value moved by some radii."""
    content = copied(content)
    number = content["parameter"] if place == "parameter" else content["states"][place[0]][place[1]]
    number["value"] = repr(float(number["value"]) + radii * float(number["radius"]))
    return content


def test_it_is_accepted_from_its_file(made, tmp_path):
    is_read_back(made, tmp_path / "event.json")
    assert repr(made).startswith("<certificate of a period-doubling: A = ")


def test_a_fold_is_accepted_and_no_other_number(branch, tmp_path):
    fold = si.certify(event_of(branch, "fold").certified(10))
    is_read_back(fold, tmp_path / "fold.json")
    no_number_may_change(fold, 11)
    refuses(shifted(fold.content, (0, "v"), 1e4))  # another orbit of the curve


def test_a_graze_is_accepted_and_no_other_number(graze, tmp_path):
    is_read_back(graze, tmp_path / "graze.json")
    assert repr(graze).startswith("<certificate of a graze: A = 0.36878177829")
    no_number_may_change(graze, 11)
    for place in ("parameter", (0, "tau")):
        refuses(shifted(graze.content, place, 1e4), "Krawczyk")
    moving = copied(graze.content)
    moving["states"][0]["v"]["value"] = "1e-20"
    refuses(moving, "v.value is not 0")


def test_grazes_that_are_none(graze):
    refuses({**graze.content, "unique_within": "1/2"})
    pressed = copied(graze.content)  # the mirror image: the mass is below the wall but where it touches it
    pressed["model"] |= {"g": "A*cos(0.8*t)", "clearance": "1"}
    refuses(pressed)


def test_krawczyk_is_what_refuses_another_graze(graze, monkeypatch):
    off = shifted(graze.content, "parameter", 1e4)
    monkeypatch.setattr(Orbits, "alone", lambda *_: None)
    check(renewed(off))
    monkeypatch.undo()
    refuses(off)


def test_a_touch_that_is_not_the_first_is_what_the_pieces_refuse(graze, monkeypatch):
    """With twice as many periods the orbit touches the wall half way; without the pieces that is accepted."""
    twice = {**copied(graze.content), "periods": "2"}
    refuses(twice)
    for module in (motion, periodic_orbit):
        monkeypatch.setattr(module, "first_root", lambda *_: None)
    check(renewed(twice))


@pytest.mark.parametrize("kind", ["fold", "period-doubling", "graze", "hidden impact"])
def test_events_of_two_impacts(kind, duffing, tmp_path):
    event = si.certify(event_of(duffing, kind).certified(10))
    is_read_back(event, tmp_path / "event.json")
    no_number_may_change(event, 13)
    for i in range(len(event.content["states"])):
        for name in ("tau", "v"):
            if float(event.content["states"][i][name]["value"]):
                refuses(shifted(event.content, (i, name), 1e4))
    refuses(shifted(event.content, "parameter", 1e4))


def test_a_torus(torus, tmp_path):
    is_read_back(torus, tmp_path / "torus.json")
    no_number_may_change(torus, 13)
    refuses(shifted(torus.content, "parameter", 1e4))


def test_any_changed_number_is_refused(made):
    no_number_may_change(made, 11)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"kind": "cusp"}, "kind is not fold or period-doubling"),
        ({"kind": "torus"}, "complex"),
        ({"kind": "fold"}, None),
        ({"kind": "graze"}, "the file has no 'unique_within'"),
        ({"over": "omega"}, "no parameter"),
        ({"period": "pi"}, "is not shown to have the period"),
        ({"periods": "0"}, "periods = 0: 1 to 1000 are accepted"),
        ({"states": []}, "states has 0 entries"),
    ],
)
def test_another_statement_is_refused(change, why, made):
    refuses({**copied(made.content), **change}, why)


@pytest.mark.parametrize("part", ["parameter", "tau", "v"])
def test_a_number_off_by_many_radii_is_refused(part, made):
    refuses(shifted(made.content, part if part == "parameter" else (0, part), 1e4))


def test_a_model_with_another_number_is_refused(made):
    content = copied(made.content)
    content["model"]["restitution"] = "0.81"
    refuses(content)


def test_a_number_that_moves_the_period_is_refused(made):
    content = copied(made.content)
    content["model"] |= {"g": "A*cos(w*t)", "parameters": {**content["model"]["parameters"], "w": "2.8"}}
    content["over"] = "w"
    refuses(content, "is not shown to have the period")


def test_without_the_change_of_sign_an_orbit_beside_the_event_passes(made, monkeypatch):
    """At another number of the same curve: its orbit is there, and its test does not vanish."""
    model = si.ImpactOscillator(**{**made.content["model"], "parameters": {"A": "0.9"}})
    orbit = si.certify(model.periodic(1, 1)[0].certified(10)).content
    content = {**copied(made.content), "states": orbit["states"], "parameter": {"value": "0.9", "radius": "1e-11"}}
    refuses(content)
    monkeypatch.setattr(event.Curve, "crossing", lambda curve, point, _: curve.solved(point)[0])
    dropped(monkeypatch, "change of sign")
    check(renewed(content))


def test_others_have_no_file(branch):
    from dataclasses import replace

    ball = event_of(branch, "period-doubling").certified(10)
    with pytest.raises(InputError, match="a cusp has no certificate as a file"):
        si.certify(replace(ball, kind="cusp"))
    with pytest.raises(InputError, match="only those over a parameter"):
        si.certify(replace(ball, over="clearance"))


@pytest.mark.parametrize("kind", ["fold", "graze"])
def test_any_other_number_with_a_digest_of_its_own_is_refused(kind, branch, graze):
    """But for the number's value in the model, which is not used, and a restitution without an impact."""
    content = (graze if kind == "graze" else si.certify(event_of(branch, kind).certified(10))).content
    unused = {"A", *(("restitution", "v") if kind == "graze" else ())}
    tried = 0
    for place in places_of(content):
        if unused.intersection(place) or place[-1] in ("radius", "unique_within"):
            continue
        forged = changed(content, place)
        if place[-1] == "value":
            inner = forged
            for key in place[:-1]:
                inner = inner[key]
            inner["value"] = repr(float(inner["value"]) + 1e4 * float(inner["radius"]))
        refuses(forged)
        tried += 1
    assert tried >= 6
