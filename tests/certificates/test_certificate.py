"""Certificates: accepted as they were made, refused with any number changed, checked by a program that stands alone."""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
import sys
from fractions import Fraction

import flint
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.certificates import checker
from singimpact.certificates.certificate import CHECKER, Certificate
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


def renewed(content):
    """With the digest of what it now says."""
    return {**content, "digest": checker.digest_of(content)}


@pytest.mark.parametrize("name", EACH)
def test_a_certificate_is_accepted_from_its_file(name, certificates, tmp_path):
    path = tmp_path / "certificate.json"
    certificates[name].save(path)
    assert si.read_certificate(path) == certificates[name]


def numbers_of(content, path=()):
    """The places of all texts that hold a digit."""
    for key, part in content.items():
        if isinstance(part, dict):
            yield from numbers_of(part, (*path, key))
        elif key not in ("schema", "statement", "digest") and re.search(r"\d", part):
            yield (*path, key)


def changed(content, place):
    """A copy in which the last digit that counts is another one."""
    made = json.loads(json.dumps(content))
    inner = made
    for key in place[:-1]:
        inner = inner[key]
    mantissa, e, exponent = inner[place[-1]].partition("e-")
    at = max(found.start() for found in re.finditer(r"\d", mantissa))
    digit = str((int(mantissa[at]) + 3) % 10)
    inner[place[-1]] = mantissa[:at] + digit + mantissa[at + 1 :] + e + exponent
    return made


@pytest.mark.parametrize("name", ["linear", "duffing"])
def test_any_changed_number_is_refused(name, certificates):
    content = certificates[name].content
    places = list(numbers_of(content))
    assert len(places) > 12
    for place in places:
        with pytest.raises(checker.Refused, match="digest"):
            checker.check(changed(content, place))
        if place[-1] != "radius":  # another number with a digest of its own: the motion itself refuses it
            forged = changed(content, place)
            if place[-1] == "value":  # the last digit is within the radius
                text = forged[place[0]]["value"]
                forged[place[0]]["value"] = f"{text[:-8]}{(int(text[-8]) + 1) % 10}{text[-7:]}"
            with pytest.raises(checker.Refused):
                checker.check(renewed(forged))


def test_a_radius_that_is_too_small_is_refused(certificates):
    content = json.loads(json.dumps(certificates["duffing"].content))
    content["velocity"]["radius"] = "1e-60"
    with pytest.raises(checker.Refused):
        checker.check(renewed(content))
    content["velocity"]["radius"] = "0"
    with pytest.raises(checker.Refused, match="radius"):
        checker.check(renewed(content))


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
    with pytest.raises(checker.Refused, match="flight_time is"):
        checker.check(renewed(later))


def test_the_program_stands_alone(certificates, tmp_path):
    """Copied to an empty folder and run without the package; its imports are the standard library and flint."""
    tree = ast.parse(CHECKER.read_text(encoding="utf-8"))
    imported = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    imported |= {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert {name.partition(".")[0] for name in imported} - set(sys.stdlib_module_names) == {"flint"}
    alone = tmp_path / "checker.py"
    shutil.copyfile(CHECKER, alone)
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    certificates["pendulum"].save(good)
    bad.write_text(good.read_text(encoding="utf-8").replace("sin(x)", "sin(x)*1.0001"), encoding="utf-8")
    text = f"import runpy, sys; sys.argv = ['checker.py', {str(good)!r}, {str(bad)!r}]\n" \
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
    model = checker.Model(osc.to_dict())
    for tau, v in zip(rng.uniform(0, 3, 4), 10.0 ** rng.uniform(-6, 0.3, 4), strict=True):
        found = osc.impact_map(tau, v, digits=20).certified
        if found is None:
            continue
        flint.ctx.prec, flint.ctx.cap = 160, checker.TERMS
        try:
            exact = (checker.ball(Fraction(part)) for part in (tau, v))
            time, velocity = checker.flight(model, *exact, 100)
            for ball, told in ((time, found.flight_time), (velocity, found.velocity)):
                text = told.as_dict()
                claimed = checker.ball(Fraction(text["value"])) + checker.within(checker.ball(Fraction(text["radius"])))
                assert ball.overlaps(claimed)
                assert ball.rad() < 1e-15
        finally:
            flint.ctx.prec, flint.ctx.cap = 53, 10


def test_three_traps_of_balls():
    """Branch cuts on which flint's values stay finite, series cut in silence, and a disc that f is not analytic on."""
    beside = flint.acb(-1, flint.arb(0, 1))
    assert beside.log().is_finite()
    assert beside.sqrt().is_finite()
    assert not checker.applied("log", beside).is_finite()
    assert not checker.applied("sqrt", beside).is_finite()
    assert not checker.applied("atan", flint.acb(0, flint.arb(1, 0.1))).is_finite()
    flint.ctx.prec, flint.ctx.cap = 100, checker.TERMS
    try:
        model = checker.Model({"f": "sin(x)", "g": "0", "clearance": "0", "restitution": "1"})
        X = checker.taylor(model, flint.arb(0), flint.arb(1), flint.arb(1), 40)
        assert len(X) == 41
        assert all(a.mid() != 0 for a in X[11:])
        kink = checker.Model({"f": "sqrt(x)", "g": "0", "clearance": "0", "restitution": "1"})
        assert checker.defect(kink, flint.arb(0), [flint.arb(1), flint.arb(0), flint.arb("-0.5")], flint.arb(4)) is None
        assert (
            checker.defect(kink, flint.arb(0), [flint.arb(1), flint.arb(0), flint.arb("-0.5")], flint.arb(0.1))
            is not None
        )
    finally:
        flint.ctx.prec, flint.ctx.cap = 53, 10


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ({}, "only certificates"),
        ({"schema": checker.SCHEMA, "statement": "it is so"}, "only certificates"),
        ({"schema": checker.SCHEMA, "statement": "first impact", "digest": "0"}, "digest"),
        (renewed({"schema": checker.SCHEMA, "statement": "first impact"}), "not a certificate: KeyError"),
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
    with pytest.raises(checker.Refused, match="not understood"):
        checker.check(renewed(content))


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
