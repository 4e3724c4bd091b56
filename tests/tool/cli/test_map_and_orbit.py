"""`singimpact map` and `orbit`: what they ask of the oscillator and how they tell the answer."""

import json
import sys

import pytest
from fakes import oscillator_room, scenes_room

LINEAR = ["--omega", "pi/2.8", "--clearance", "-0.25", "--restitution", "4/5"]


@pytest.fixture(autouse=True)
def rooms(monkeypatch):
    monkeypatch.setitem(sys.modules, "singimpact.impact_oscillator", oscillator_room())
    scenes = scenes_room()
    monkeypatch.setitem(sys.modules, "singimpact.scenes", scenes)
    monkeypatch.setitem(sys.modules, "singimpact.scenes.orbit_picture", scenes)


def test_map_as_a_table(singimpact):
    lines = singimpact("map", *LINEAR, "--tau", "pi/2", "--v", "0.5").stdout.splitlines()
    assert lines[0].split("  ")[0] == "tau"
    assert lines[1].split()[-1] == "hit"
    assert len(lines) == 2


def test_numbers_keep_the_text_that_was_written(singimpact):
    model = json.loads(singimpact("map", *LINEAR, "--tau", "1/3", "--v", "0.5", "--json").stdout)["model"]
    assert model["restitution"] == "0.8"
    assert model["clearance"] == "-0.25"
    assert "pi" in model["g"]


def test_several_states(singimpact):
    steps = json.loads(singimpact("map", *LINEAR, "--tau", "1", "--tau", "2", "--v", "0.5", "--json").stdout)["steps"]
    assert [step["from"]["tau"] for step in steps] == ["1", "2"]
    assert [step["status"] for step in steps] == ["hit", "no_return"]
    assert steps[1]["flight_time"] is None


def test_a_status_that_is_not_hit_is_explained(singimpact):
    told = singimpact("map", *LINEAR, "--tau", "2", "--v", "0.5").stdout
    assert "no_return: no impact before the horizon" in told


def test_digits(singimpact):
    result = singimpact("map", *LINEAR, "--tau", "1", "--v", "0.5", "--digits", "40", "--json")
    step = json.loads(result.stdout)["steps"][0]
    assert step["flight_time"] == "0." + "3" * 40
    assert (step["certified"], step["note"]) == (None, "not certified: a fake")


def test_model_file(singimpact, tmp_path):
    file = tmp_path / "model.toml"
    file.write_text('f = "x"\ng = "cos(2*t)"\nclearance = 0.3\nrestitution = 0.5\n')
    result = singimpact("map", "--model", file, "--tau", "1", "--v", "0.5", "--json")
    assert json.loads(result.stdout)["model"]["g"] == "cos(2*t)"


def test_orbit_as_a_table(singimpact):
    told = singimpact("orbit", *LINEAR, "--tau", "1", "--v", "0.5", "--impacts", "2").stdout
    assert "phase" in told
    assert "sticking" in told


def test_orbit_as_json(singimpact):
    told = json.loads(singimpact("orbit", *LINEAR, "--tau", "1", "--v", "0.5", "--json").stdout)
    assert told["impacts"][0] == {"tau": 1.0, "v": 0.5, "kind": "impact"}
    assert told["phases"] == [{"kind": "sticking", "start": 1.5, "end": 2.0}]


@pytest.mark.parametrize("ending", ["png", "pdf", "svg"])
def test_orbit_as_a_picture(ending, singimpact, tmp_path):
    result = singimpact("orbit", *LINEAR, "--tau", "1", "--v", "0.5", "-o", tmp_path / f"orbit.{ending}")
    assert result.exit_code == 0, result.output
    assert result.stdout == ""
    assert [path.name for path in tmp_path.iterdir()] == [f"orbit.{ending}"]
    assert (tmp_path / f"orbit.{ending}").stat().st_size > 500
