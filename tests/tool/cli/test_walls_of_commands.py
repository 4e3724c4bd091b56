"""The commands that take models with two walls."""

import json

import pytest

import singimpact as si
from singimpact.status import Status

WALLS = [
    "--omega",
    "2.8",
    "--clearance",
    "-0.5",
    "--restitution",
    "0.8",
    "--upper",
    "0.5",
    "--upper-restitution",
    "0.7",
]
PAIR = si.linear("2.8", "-0.5", "0.8", upper=("0.5", "0.7"))


@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_the_map_has_the_wall_of_the_next_state(singimpact, wall):
    told = json.loads(singimpact("map", *WALLS, "--tau", "0.1", "--v", "1", "--wall", wall, "--json").stdout)
    step = PAIR.impact_map("0.1", "1", wall=wall)
    assert told["model"] == PAIR.to_dict()
    assert (told["steps"][0]["tau"], told["steps"][0]["v"]) == (step.tau, step.v)
    assert told["steps"][0]["wall"] == ("lower", "upper")[int(step.wall)]
    table = singimpact("map", *WALLS, "--tau", "0.1", "--v", "1", "--wall", wall).stdout.splitlines()
    assert table[0].endswith("next wall")
    assert table[1].endswith(told["steps"][0]["wall"])


def test_an_orbit_has_the_walls_of_its_impacts(singimpact, tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(PAIR.to_toml())
    named = ["--model", str(file), "--tau", "0.1", "--v", "1", "--impacts", "5"]
    told = json.loads(singimpact("orbit", *named, "--json").stdout)
    walls = [("lower", "upper")[code] for code in PAIR.orbit("0.1", "1", 5).wall.tolist()]
    assert [event["wall"] for event in told["impacts"]] == walls
    assert singimpact("orbit", *named, "--wall", "upper").stdout.splitlines()[1].split()[3] == "upper"


def test_commands_of_one_wall_say_so(singimpact):
    refused = singimpact("border", *WALLS)
    assert refused.exit_code != 0
    assert "takes a model with one wall" in refused.output


@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_the_theory_at_a_wall(singimpact, wall):
    at = ["--wall", wall]
    tau = "1.2" if wall == "lower" else "0.1"
    told = json.loads(singimpact("threshold", *WALLS, "--tau", tau, *at, "--json").stdout)
    found = PAIR.threshold(tau, wall=wall)
    assert (float(told["v"]), told["status"]) == (float(found.v), Status(int(found.status)).name)
    listed = json.loads(singimpact("classify", *WALLS, *at, "--json").stdout)
    assert listed["points"] == json.loads(json.dumps(PAIR.classify(wall=wall).as_dict()["points"]))
    ends = ("0", "0.4") if wall == "upper" else ("-0.4", "0")
    over = ("--over", "upper" if wall == "upper" else "clearance", "--between", *ends)
    moved = json.loads(singimpact("classify", *WALLS, *at, *over, "--json").stdout)["transitions"]["found"]
    assert [each["value"] for each in moved] == [each.value for each in PAIR.transitions(over[1], ends, wall=wall)]
