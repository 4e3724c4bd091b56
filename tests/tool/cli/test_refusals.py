"""The caller's mistakes: one line on standard error, exit code 2, nothing on standard output."""

import sys

import pytest
from fakes import claims_room, oscillator_room, scenes_room

LINEAR = ["--omega", "2.8", "--clearance", "0", "--restitution", "0.8"]
STATE = ["--tau", "0.9", "--v", "0.005"]


@pytest.fixture(autouse=True)
def rooms(monkeypatch):
    monkeypatch.setitem(sys.modules, "singimpact.paper.claims", claims_room())
    monkeypatch.setitem(sys.modules, "singimpact.impact_oscillator", oscillator_room())
    monkeypatch.setitem(sys.modules, "singimpact.scenes", scenes_room())


REFUSED = {
    ("mpa",): "unknown command 'mpa': the nearest known are map",
    ("map", "--restitutoin", "1"): "--restitution",
    ("map", *LINEAR): "Missing option '--tau'",
    ("map", *STATE): "a model is --model FILE, or --omega --clearance --restitution",
    ("map", *STATE, "--omega", "2", "--clearance", "0"): "no --restitution given",
    ("map", *STATE, *LINEAR, "--model", "a.toml"): "name two models",
    ("map", *STATE, "--model", "absent.toml"): "'absent.toml' cannot be read",
    ("map", *LINEAR, *STATE, "--tau", "1", "--tau", "2", "--v", "1"): "3 --tau and 2 --v do not pair",
    ("map", *LINEAR[:-1], "1.5", *STATE): "restitution = '1.5' is not accepted: give a number from 0 to 1",
    ("map", *LINEAR[:-1], "abc", *STATE): "restitution = 'abc'",
    ("map", *LINEAR[:-1], "__import__('os')", *STATE): "restitution",
    ("map", *LINEAR, "--tau", "nan", "--v", "1"): "tau = 'nan'",
    ("map", *LINEAR, *STATE, "--digits", "0"): "0 is not in the range",
    ("orbit", *LINEAR, *STATE, "--impacts", "many"): "--impacts = many is not accepted: give a whole number",
    ("orbit", *LINEAR, *STATE, "-o", "absent/orbit.png"): "output = 'absent/orbit.png' cannot be written",
    ("map", *LINEAR, *STATE, "-o", "."): "output = '.' is a folder",
    ("verify", "-o", "absent/verdicts.txt"): "output = 'absent/verdicts.txt' cannot be written",
    ("verify", "e:meqq"): "unknown claim 'e:meqq': the nearest known are e:meq",
    ("derive", "nothing"): "unknown section 'nothing'",
    ("derive", "--format", "word"): "'word' is not one of",
}


@pytest.mark.parametrize("arguments", REFUSED)
def test_one_line_that_names_the_input(arguments, singimpact):
    result = singimpact(*arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("singimpact: ")
    assert result.stderr.count("\n") == 1
    assert REFUSED[arguments] in result.stderr


def test_nothing_is_left_of_a_picture_that_failed(singimpact, tmp_path, monkeypatch):
    def fails(orbit):
        raise RuntimeError(f"cannot draw {orbit}")

    scenes = type(sys)("singimpact.scenes")
    scenes.plot = scenes.orbit_sheet = fails
    monkeypatch.setitem(sys.modules, "singimpact.scenes", scenes)
    monkeypatch.setitem(sys.modules, "singimpact.scenes.orbit_picture", scenes)
    result = singimpact("orbit", *LINEAR, *STATE, "-o", tmp_path / "orbit.png")
    assert isinstance(result.exception, RuntimeError)
    assert list(tmp_path.iterdir()) == []


def test_no_command_is_help(singimpact):
    result = singimpact()
    assert result.exit_code == 0
    assert "verify" in result.stdout
