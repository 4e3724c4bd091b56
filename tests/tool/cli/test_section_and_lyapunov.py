"""section and lyapunov on the command line: numbers as in Python, JSON, a picture, one-line refusals."""

import json

import pytest

import singimpact as si

LINEAR = ("--omega", "2.8", "--clearance", "0", "--restitution", "0.8")
STATE = ("--tau", "0.1", "--v", "0.5")
OSC = si.linear("2.8", 0, "0.8")


def test_a_section_as_json_is_that_of_python(singimpact):
    told = json.loads(singimpact("section", *LINEAR, *STATE, "--impacts", "50", "--at", "pi/2.8", "--json").stdout)
    section = OSC.orbit("0.1", "0.5", impacts=50).section("pi/2.8")
    assert told["x"] == section.x.tolist()
    assert told["xdot"] == section.xdot.tolist()
    assert told["model"] == OSC.to_dict()


def test_a_section_as_a_table_leaves_the_first_states_out(singimpact):
    lines = singimpact("section", *LINEAR, *STATE, "--impacts", "20", "--skip", "3").stdout.splitlines()
    section = OSC.orbit("0.1", "0.5", impacts=20).section()
    assert lines[0].split() == ["t", "x", "xdot"]
    assert len(lines) == section.t.size - 3 + 1
    assert float(lines[1].split()[1]) == section.x[3]


def test_a_section_is_drawn(singimpact, tmp_path):
    result = singimpact("section", *LINEAR, *STATE, "-o", tmp_path / "section.png")
    assert result.exit_code == 0
    assert (tmp_path / "section.png").read_bytes().startswith(b"\x89PNG")
    axes = si.plot(OSC.orbit("0.1", "0.5", impacts=50).section())
    assert axes.get_xlabel() == "displacement $x$"


def test_exponents_as_json_and_as_text(singimpact):
    told = json.loads(singimpact("lyapunov", *LINEAR, *STATE, "--impacts", "500", "--json").stdout)
    found = si.lyapunov(OSC, "0.1", "0.5", 500)
    assert told["exponents"] == found.exponents.tolist()
    assert told["per_impact"] == found.per_impact.tolist()
    assert (told["status"], told["superstable"]) == ("hit", False)
    text = singimpact("lyapunov", *LINEAR, *STATE, "--impacts", "500", "--transient", "10").stdout
    assert "500 in a time of" in text
    resting = ("--omega", "0.9", "--clearance", "0.2", "--restitution", "0.4", "--tau", "0.3", "--v", "0.4")
    assert "superstable" in singimpact("lyapunov", *resting).stdout


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("section", *LINEAR, *STATE, "-o", "section.bmp"), "a file name ending in .png, .pdf or .svg"),
        (("section", *LINEAR, "--tau", "0", "--v", "-1"), "v = -1.0 is not accepted"),
        (("lyapunov", *LINEAR, *STATE, "--impacts", "0"), "0 is not in the range"),
    ],
)
def test_bad_input_ends_in_one_line(singimpact, arguments, told):
    result = singimpact(*arguments)
    assert result.exit_code == 2
    assert told in result.stderr
