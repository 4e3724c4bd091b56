"""chatter, threshold, sweep, ensemble, regions: what they print and what they refuse."""

import inspect
import json
from importlib import import_module

import pytest

import singimpact as si
from singimpact.dynamics import ENDING, SEARCH

LINEAR = ["--omega", "2.8", "--clearance", "0", "--restitution", "1/2"]


def test_chatter(singimpact):
    done = singimpact("chatter", *LINEAR, "--tau", "0.9", "--v", "0.005", "--json")
    told = json.loads(done.output)
    assert (done.exit_code, told["status"]) == (0, "complete")
    assert told["error"] < 1e-12
    many = json.loads(singimpact("chatter", *LINEAR, "--tau", "0.9", "--v", "0.005", "--digits", "20", "--json").output)
    assert abs(float(many["tau"]) - told["tau"]) <= told["error"]
    assert many["value"].startswith(many["tau"][:15])
    assert float(many["radius"]) < 1e-19
    assert "radius" not in told


def test_threshold(singimpact):
    told = json.loads(singimpact("threshold", *LINEAR, "--tau", "pi/2.8", "--json").output)
    assert abs(told["v"] - 0.1008699912692559258909) < 1e-13
    assert "0.100869991269" in singimpact("threshold", *LINEAR, "--tau", "pi/2.8").output
    many = singimpact("threshold", *LINEAR, "--tau", "pi/2.8", "--digits", "20").output
    assert "value   0.100869991269255925890" in many
    assert "radius" in many
    refused = singimpact("threshold", *LINEAR, "--tau", "0")
    assert refused.exit_code == 2


def test_ensemble(singimpact):
    asked = ["--tau", "0", "6", "--v", "0", "1", "--size", "20", "--until", "40"]
    values = json.loads(singimpact("ensemble", *LINEAR, *asked, "--json").output)["averages"]
    assert set(values) == {"impacts", "v", "rest", "escape_rate"}
    assert "20 orbits" in singimpact("ensemble", *LINEAR, *asked).output


def test_regions(singimpact, tmp_path):
    window, picture = ["--from", "2", "-0.1", "--to", "3", "0.2", "--size", "6"], tmp_path / "regions.png"
    asked = [*LINEAR, *window, "-o", picture]
    classes = json.loads(singimpact("regions", *asked, "--json").output)["classes"]
    assert sum(item["share"] for item in classes) == pytest.approx(1)
    assert picture.stat().st_size > 5000
    assert classes[0]["class"] in singimpact("regions", *asked).output
    values = json.loads(singimpact("regions", *asked, "--of", "impacts", "--json").output)["impacts"]
    assert len(values) == len(values[0]) == 6
    assert "impacts 0" in singimpact("regions", *asked, "--of", "impacts").output
    upper = ["--upper", "0.6", "--wall", "upper"]
    assert "lu" in singimpact("regions", *asked, *upper).output
    for wrong in (["--of", "colour"], ["--over", "omega", "omega"]):
        assert singimpact("regions", *asked, *wrong).exit_code == 2


@pytest.mark.slow
@pytest.mark.plain_code  # kept results have the bytecode in their key
def test_sweep(singimpact, tmp_path):
    given = [*LINEAR, "--over", "clearance", "--from", "-0.1", "--to", "0.1", "--points", "3"]
    given += ["--tau", "0.3", "--v", "0.4"]
    keep = ["--workers", "1", "--keep", tmp_path / "kept.npz"]
    first, again = (singimpact("sweep", *given, *keep, "--json").output for _ in range(2))
    assert first == again
    assert [case["clearance"] for case in json.loads(first)["cases"]] == [-0.1, 0.0, 0.1]
    refused = singimpact("sweep", *LINEAR, "--over", "mass", "--from", "1", "--to", "2", "--tau", "0", "--v", "1")
    assert refused.exit_code == 2


@pytest.mark.parametrize(("name", "setting"), [("chatter", ENDING), ("threshold", SEARCH)])
def test_the_command_and_the_function_fly_as_many_impacts_as_the_setting_says(name, setting):
    orbit_commands = import_module("singimpact.cli.orbit_commands")
    command = getattr(orbit_commands, f"{name}_command")
    (option,) = (each for each in command.params if each.name == "impacts")
    function = si.ImpactOscillator.chatter_limit if name == "chatter" else si.threshold
    assert option.default == inspect.signature(function).parameters["impacts"].default == setting.impacts
