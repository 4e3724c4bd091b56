"""Certificates: accepted as they were made, refused with any number changed, checked by a program that stands alone."""

from __future__ import annotations

import ast
import json
import shutil
import subprocess
import sys
from fractions import Fraction

import flint
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from second_program import changed, dropped, places_of, refuses, renewed, weakened
from slowness import slowness

import singimpact as si
from singimpact.certificates import (
    CHECKER,
    STATEMENTS,
    TERMS,
    Certificate,
    Flight,
    Model,
    checker,
    defect,
    impact,
    read,
    require_period,
    taylor,
)
from singimpact.certificates.checker import formulas
from singimpact.inputs import InputError

MODELS = {
    "linear": si.linear("2.8", "0.1", "0.8"),
    "duffing": si.ImpactOscillator("0.1*xdot + x + e*x**3", "cos(1.7*t)", "0.3", "3/5", {"e": "0.3"}),
    "pendulum": si.ImpactOscillator("0.1*xdot + sin(x)", "cos(1.7*t)", "-0.25", "0.8"),
    "root and logarithm": si.ImpactOscillator("x*sqrt(1 + x**2) + log(2 + x**2)", "cos(1.7*t)", "-0.25", "0.8"),
    "layer": si.ImpactOscillator("x + 0.3*tanh(2*xdot)", "sin(1.7*t) + pi/9", "-0.25", "0.8"),
    "law": si.ImpactOscillator("x + atan(x)/3", "exp(-cos(t))", "0.3", "-0.8*v*exp(-v**2/10)"),
}


EACH = [pytest.param(name, marks=pytest.mark.slow) if name == "layer" else name for name in MODELS]


class Made(dict):
    """name -> certificate, made when it is first read: that of the layer takes seconds."""

    def __missing__(self, name):
        self[name] = si.certify(MODELS[name].impact_map("1.4", "0.6", digits=25))
        return self[name]


@pytest.fixture(scope="module")
def certificates():
    return Made()


@pytest.mark.parametrize("name", EACH)
def test_a_certificate_is_accepted_from_its_file(name, certificates, tmp_path):
    path = tmp_path / "certificate.json"
    certificates[name].save(path)
    assert si.read_certificate(path, seconds=round(9 * slowness())) == certificates[name]


@pytest.mark.parametrize("name", ["linear", "duffing"])
def test_any_changed_number_is_refused(name, certificates):
    content = certificates[name].content
    places = list(places_of(content))
    assert len(places) > 12
    for place in places:
        with pytest.raises(checker.Refused, match="digest"):
            checker.check(changed(content, place))
        if place[-1] != "radius":  # another number with a digest of its own: the motion itself refuses it
            forged = changed(content, place)
            if place[-1] == "value":  # the last digit is within the radius
                text = forged[place[0]]["value"]
                forged[place[0]]["value"] = f"{text[:-8]}{(int(text[-8]) + 1) % 10}{text[-7:]}"
            refuses(forged)


def test_a_check_leaves_no_limit_behind(certificates, monkeypatch):
    """What a program computes after it has checked a certificate may take as long as it likes."""
    checker.check(certificates["linear"].content)
    monkeypatch.setattr(formulas, "process_time", lambda: 1e9)
    formulas.Clock.look()


def test_a_radius_that_is_too_small_is_refused(certificates):
    content = json.loads(json.dumps(certificates["duffing"].content))
    content["velocity"]["radius"] = "1e-60"
    refuses(content)
    content["velocity"]["radius"] = "0"
    refuses(content, "radius")


def test_a_later_root_is_no_first_impact(certificates):
    """Where the motion without the wall comes down through x = c again: a true root with its true velocity."""
    tau = 1.4

    def moving(t, state):
        return [state[1], np.cos(2.8 * (tau + t)) - state[0]]

    def height(_, state):
        return state[0] - 0.1

    height.direction = -1
    flown = solve_ivp(moving, (0, 40), [0.1, 0.6], "DOP853", events=height, rtol=1e-13, atol=1e-13, max_step=0.05)
    time, (_, velocity) = flown.t_events[0][-1], flown.y_events[0][-1]
    later = json.loads(json.dumps(certificates["linear"].content))
    assert time > float(later["flight_time"]["value"]) + 1
    for name, value in {"flight_time": time, "velocity": velocity, "tau": tau + time, "v": -0.8 * velocity}.items():
        later[name] = {"value": repr(float(value)), "radius": "1e-9"}
    refuses(later, "flight_time is")


def test_the_program_stands_alone(certificates, tmp_path):
    """Copied to an empty folder and run without the package; its imports are the standard library and flint."""
    nodes = [node for path in CHECKER.glob("*.py") for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    imported = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    imported |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and not node.level}
    assert {name.partition(".")[0] for name in imported} - set(sys.stdlib_module_names) == {"flint"}
    assert all(node.level < 2 for node in nodes if isinstance(node, ast.ImportFrom))
    alone = tmp_path / "checker"
    shutil.copytree(CHECKER, alone, ignore=shutil.ignore_patterns("__pycache__"))
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    certificates["pendulum"].save(good)
    bad.write_text(good.read_text(encoding="utf-8").replace("sin(x)", "sin(x)*1.0001"), encoding="utf-8")
    text = f"import runpy, sys; sys.argv = ['checker', {str(good)!r}, {str(bad)!r}]\n" \
           f"try:\n    runpy.run_path({str(alone)!r}, run_name='__main__')\nfinally:\n    " \
           "assert not any(name.startswith(('singimpact', 'numpy')) for name in sys.modules)"  # fmt: skip
    done = subprocess.run([sys.executable, "-I", "-c", text], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr == ""
    first, second = done.stdout.splitlines()
    assert first.endswith("good.json: holds")
    assert "bad.json: refused: the digest" in second


@pytest.mark.parametrize("name", EACH)
def test_both_programs_enclose_the_same_impacts(name):
    """At random states, weak and strong: each within the other's radius."""
    osc, rng = MODELS[name], np.random.default_rng(4)
    model = Model(osc.to_dict())
    for tau, v in zip(rng.uniform(0, 3, 4), 10.0 ** rng.uniform(-6, 0.3, 4), strict=True):
        found = osc.impact_map(tau, v, digits=20).certified
        if found is None:
            continue
        flint.ctx.prec, flint.ctx.cap = 160, TERMS
        try:
            exact = (formulas.ball(Fraction(part)) for part in (tau, v))
            time, velocity, _ = Flight(model, *exact, 100).first_hit()
            for ball, told in ((time, found.flight_time), (velocity, found.velocity)):
                assert ball.overlaps(read(told.as_dict()))
                assert ball.rad() < 1e-15
        finally:
            flint.ctx.prec, flint.ctx.cap = 53, 10


def test_three_traps_of_balls():
    """Branch cuts on which flint's values stay finite, series cut in silence, and a disc that f is not analytic on."""
    beside = flint.acb(-1, flint.arb(0, 1))
    assert beside.log().is_finite()
    assert beside.sqrt().is_finite()
    assert not formulas.applied("log", beside).is_finite()
    assert not formulas.applied("sqrt", beside).is_finite()
    assert not formulas.applied("atan", flint.acb(0, flint.arb(1, 0.1))).is_finite()
    flint.ctx.prec, flint.ctx.cap = 100, TERMS
    try:
        model = Model({"f": "sin(x)", "g": "0", "clearance": "0", "restitution": "1"})
        (X,) = taylor(model, flint.arb(0), [flint.arb(1)], [flint.arb(1)], 40)
        assert len(X) == 41
        assert all(a.mid() != 0 for a in X[11:])
        kink = Model({"f": "sqrt(x)", "g": "0", "clearance": "0", "restitution": "1"})
        assert defect(kink, flint.arb(0), [[flint.arb(1), flint.arb(0), flint.arb("-0.5")]], flint.arb(4)) is None
        assert defect(kink, flint.arb(0), [[flint.arb(1), flint.arb(0), flint.arb("-0.5")]], flint.arb(0.1)) is not None
    finally:
        flint.ctx.prec, flint.ctx.cap = 53, 10


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ({}, "only certificates"),
        ({"schema": checker.SCHEMA, "statement": "it is so"}, "only certificates"),
        ({"schema": checker.SCHEMA, "statement": "first impact", "digest": "0"}, "digest"),
        (renewed({"schema": checker.SCHEMA, "statement": "first impact"}), "has no '"),
    ],
)
def test_what_is_no_certificate_is_refused(content, why):
    with pytest.raises(checker.Refused, match=why):
        checker.check(content)


def test_files_are_answered_one_by_one(certificates, tmp_path, capsys):
    good, bad, none = (tmp_path / name for name in ("good.json", "bad.json", "none.json"))
    certificates["linear"].save(good)
    bad.write_text("{")
    assert checker.main([str(good)]) == 0
    assert checker.main([str(good), str(bad), str(none)]) == 1
    answers = [line.partition(": ")[2] for line in capsys.readouterr().out.splitlines()]
    assert answers[:2] == ["holds", "holds"]
    assert answers[2].startswith("refused: Expecting")
    assert "No such file" in answers[3]
    assert (flint.ctx.prec, flint.ctx.cap) == (53, 10)


@pytest.mark.parametrize("text", ["not JSON", "[1, 2]"])
def test_a_file_that_is_no_certificate(text, tmp_path):
    path = tmp_path / "certificate.json"
    with pytest.raises(InputError, match="cannot be read"):
        si.read_certificate(path)
    path.write_text(text)
    with pytest.raises(InputError, match=r"not JSON|only certificates"):
        si.read_certificate(path)


def test_text_of_a_model_is_data(certificates):
    content = json.loads(json.dumps(certificates["pendulum"].content))
    content["model"]["f"] = "__import__('os').getcwd()"
    refuses(content, "not understood")


@pytest.mark.parametrize(("seconds", "why"), [(1, "not decided within 1 s of CPU"), ("long", "seconds = 'long'")])
def test_so_many_seconds_and_no_more(seconds, why, certificates):
    with pytest.raises(InputError, match=why):
        certificates["layer"].check(seconds=seconds)


def test_results_without_certificate_are_refused():
    osc = MODELS["linear"]
    with pytest.raises(InputError, match="no digits="):
        si.certify(osc.impact_map(1.4, 0.6))
    with pytest.raises(InputError, match=r"osc.impact_map\(tau, v, digits=30\)"):
        si.certify(7)
    with pytest.raises(InputError, match="not certified"):
        si.certify(si.linear(2, 1, "0.5").impact_map(0, 0, digits=20))
    with pytest.raises(InputError, match="is refused: only certificates"):
        Certificate({}).check()


# ---- periodic orbits

ORBITS = {
    "saddle": (MODELS["duffing"], 2, 1, [(1.957856511, 0.662042377), (3.413988162, 0.066334603)]),
    "three impacts": (MODELS["duffing"], 3, 2, [(1.819875727, 0.495927498), (2.600820600, 0.232388853),
                                                (5.627117408, 0.759287054)]),
    "linear": (si.linear("4.19", "0.17", "0.7"), 2, 2, [(0.184300495, 0.117042955), (0.902095350, 0.235121802)]),
    "complex multipliers": (si.ImpactOscillator("sin(x) + xdot/10", "cos(w*t)", "0", "1/2", {"w": "4"}), 1, 2,
                            [(1.266516408, 0.404810628)]),
}  # fmt: skip


@pytest.fixture(scope="module")
def orbits():
    return {
        name: si.certify(osc.periodic(n, k, start=start)[0].certified(20))
        for name, (osc, n, k, start) in ORBITS.items()
    }


@pytest.mark.parametrize("name", ORBITS)
def test_a_periodic_orbit_is_accepted_from_its_file(name, orbits, tmp_path):
    path = tmp_path / "orbit.json"
    orbits[name].save(path)
    assert si.read_certificate(path) == orbits[name]
    _, n, k, _ = ORBITS[name]
    assert f"certificate of the ({n}, {k}) periodic orbit" in repr(orbits[name])


@pytest.mark.slow
def test_any_changed_number_of_an_orbit_is_refused(orbits):
    content = orbits["saddle"].content
    places = list(places_of(content))
    assert len(places) > 20
    for place in places:
        with pytest.raises(checker.Refused, match="digest"):
            checker.check(changed(content, place))
        if place[-1] == "radius" or place[-1] == "unique_within":
            continue
        forged = changed(content, place)
        if place[-1] == "value":  # the last digits are within the radius
            inner = forged
            for key in place[:-1]:
                inner = inner[key]
            text = inner["value"]
            inner["value"] = text[:-12] + str((int(text[-12]) + 1) % 10) + text[-11:] if len(text) > 14 else "0.1"
        refuses(forged)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"period": "pi"}, "is not shown to have the period pi"),
        ({"periods": "2"}, "Krawczyk"),
        ({"periods": "0"}, "periods = 0: 1 to 1000 are accepted"),
        ({"states": []}, "states has 0 entries"),
        pytest.param({"unique_within": "1/10"}, "refused|shown|Krawczyk|maps|grew|lost|disc|step",
                     marks=pytest.mark.slow),
        ({"multipliers": [{name: {"value": "0", "radius": "1e-9"} for name in ("real", "imaginary")}] * 2},
         "a multiplier is"),
    ],
)  # fmt: skip
def test_false_statements_about_an_orbit_are_refused(change, why, orbits):
    refuses({**orbits["saddle"].content, **change}, why)


def test_states_of_a_virtual_orbit_are_refused():
    """A solution of the closing conditions whose flight is below the wall on its way: another impact comes before."""
    osc = si.linear("2.8", "0.1", "0.8")
    from singimpact.branches.starts import two_impacts

    points, _ = two_impacts(osc, 2)
    visible = [tuple(np.round(orbit.v, 8)) for orbit in osc.periodic(2, 2)]
    refused = 0
    for first, second, v, after in points:
        speeds = {tuple(np.round(pair, 8)) for pair in ((v, after), (after, v))}
        if min(v, after) <= 0 or abs(v - after) < 1e-6 or speeds.intersection(visible):
            continue
        states = [{"tau": {"value": repr(float(t)), "radius": "1e-9"}, "v": {"value": repr(float(w)), "radius": "1e-9"}}
                  for t, w in ((first, v), (second, after))]  # fmt: skip
        content = {"schema": checker.SCHEMA, "statement": "periodic orbit", "model": osc.to_dict(), "states": states,
                   "period": str(osc.period), "periods": "2", "unique_within": "1e-8", "multipliers": []}  # fmt: skip
        refuses(content)
        refused += 1
    assert refused


@pytest.mark.parametrize(
    ("g", "period", "holds"),
    [
        ("cos(1.7*t)", "(20/17)*pi", True),
        ("cos(1.7*t)", "(10/17)*pi", False),
        ("cos(1.7*t + 1)*sin(w*t/2)", "40*pi/17", True),
        ("exp(-cos(pi*t)) + 3", "2", True),
        ("cos(t) + t/1000", "2*pi", False),
        ("cos(t**2)", "2*pi", False),
        ("cos(sqrt(2)*t)", "2*pi/sqrt(2)", False),  # true, and not shown
    ],
)
def test_a_period_is_shown_exactly(g, period, holds):
    formula = formulas.Formula(g, {"w": "1.7"})
    if holds:
        require_period(formula, period)
        return
    with pytest.raises(checker.Refused, match="not shown to have the period"):
        require_period(formula, period)


@pytest.mark.parametrize("name", ["duffing", "law", pytest.param("layer", marks=pytest.mark.slow)])
def test_derivatives_of_the_impact_map_contain_differences(name):
    """D G of the second program over a ball of states, against difference quotients of first impacts in doubles."""
    osc, tau, v, h = MODELS[name], 1.4, 0.6, 1e-5
    flint.ctx.prec, flint.ctx.cap = 130, TERMS
    try:
        rows = impact(Model(osc.to_dict()), flint.arb(tau, 1e-9), flint.arb(v, 1e-9), 96)
        known = [[(float(part.mid()), float(part.rad())) for part in row] for row in rows]
    finally:
        flint.ctx.prec, flint.ctx.cap = 53, 10
    for k, shift in enumerate(((h, 0), (0, h))):
        ends = [osc.impact_map(tau + s * shift[0], v + s * shift[1]) for s in (1, -1)]
        quotient = [(ends[0].tau - ends[1].tau) / (2 * h), (ends[0].v - ends[1].v) / (2 * h)]
        for row, value in zip(known, quotient, strict=True):
            assert abs(row[k][0] - value) < 1e-7 + row[k][1]
            assert row[k][1] < 1e-2


@pytest.mark.parametrize("condition", ["abs(part) < radius", "self.span if i == n - 1 else 0"])
def test_a_checker_without_a_condition_accepts_what_is_false(condition, orbits, monkeypatch):
    """Krawczyk's condition, and the period that is taken off, are what refuses: without them it is otherwise."""
    if "abs" in condition:
        dropped(monkeypatch, "Krawczyk")
    else:
        monkeypatch.setitem(STATEMENTS, "periodic orbit", weakened("periodic_orbit", condition))
    content = json.loads(json.dumps(orbits["saddle"].content))
    if "abs" in condition:
        content["states"][0]["v"]["value"] = "0.66"
        content["multipliers"] = []
        checker.check(renewed(content))
        monkeypatch.undo()
    refuses(content)


def test_orbits_that_are_not_certified_are_refused():
    (orbit,) = si.linear(4, 0, "0.5").periodic(1, 2)
    assert "certificate of the (1, 2) periodic orbit" in repr(si.certify(orbit))
    for chatter in si.linear(2, "0.99", "0.5").periodic(float("inf"), 1):
        with pytest.raises(InputError, match="an orbit with impacts"):
            si.certify(chatter)
