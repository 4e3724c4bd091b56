"""scene, figure, basins, bifurcation on the command line: pictures, reports, one-line refusals."""

import json

import pytest

import singimpact as si
from singimpact.cli import main

SCENE = """
layers = ["horizon", "zero-set"]
tau = ["-pi/2", 1.0]
t = [-2, 2]
pixels = 200
[model]
f = "x"
g = "cos(2*t)"
clearance = 0.7
restitution = 0.5
"""


def run(capsys, *words):
    with pytest.raises(SystemExit) as left:
        main([str(word) for word in words])
    return left.value.code, *capsys.readouterr()


def test_scene(capsys, tmp_path):
    (tmp_path / "s.toml").write_text(SCENE)
    code, out, _ = run(capsys, "scene", tmp_path / "s.toml", "-o", tmp_path / "s.png", "--json")
    assert code == 0
    assert (tmp_path / "s.png").stat().st_size > 1000
    told = json.loads(out)
    assert set(told["seconds_by_layer"]) == {"horizon", "zero-set"}
    code, out, _ = run(capsys, "scene", tmp_path / "s.toml", "-o", tmp_path / "s.svg")
    assert "0 flights computed" in out


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("horizon", "horizn"), "unknown layer 'horizn': the nearest known are horizon"),
        (("t = [-2, 2]", "t = [2, -2]"), "window of t"),
        (("layers", "layer"), "unknown key"),
        (("tau", "v"), "has no tau"),
    ],
)
def test_refused_scenes(capsys, tmp_path, change, told):
    (tmp_path / "s.toml").write_text(SCENE.replace(*change))
    code, _, error = run(capsys, "scene", tmp_path / "s.toml", "-o", tmp_path / "s.png")
    assert code == 2
    assert error.count("\n") == 1
    assert told in error
    assert not (tmp_path / "s.png").exists()


@pytest.mark.parametrize("words", [["figure", "18"], ["figure", "x"], ["scene", "none.toml", "-o", "a.png"],
                                   ["scene", "none.toml", "-o", "a.gif"]])  # fmt: skip
def test_refusals(capsys, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    code, _, error = run(capsys, *words)
    assert code == 2
    assert error.count("\n") == 1


def test_a_figure_that_is_none_leaves_no_folder(capsys, tmp_path):
    code, _, error = run(capsys, "figure", "18", "-o", tmp_path / "new")
    assert (code, error.count("\n")) == (2, 1)
    assert not (tmp_path / "new").exists()


@pytest.mark.slow
def test_basins_and_bifurcation(capsys, tmp_path):
    model = ["--omega", 2, "--clearance", "0.3", "--restitution", "0.5", "--workers", 1]
    code, out, _ = run(capsys, "basins", *model, "--size", 20, "-o", tmp_path / "b.png", "--json")
    assert code == 0
    told = json.loads(out)
    assert {each["class"] for each in told["classes"]} == {"(1, 1) orbit"}
    assert 0.05 < told["first_chatter_completes"] < 0.2
    code, out, _ = run(capsys, "basins", *model, "--size", 10, "--layer", "first-chatter", "-o", tmp_path / "f.png")
    assert code == 0
    assert "first chatter completes" in out
    code, _, _ = run(capsys, "bifurcation", *model, "--from", "0.9", "--to", "1.1", "--points", 3, "--impacts", 40,
                     "-o", tmp_path / "c.png")  # fmt: skip
    assert code == 0
    assert (tmp_path / "c.png").exists()


def test_basins_over_a_number_are_shares(capsys, tmp_path):
    model = ["--omega", "2.8", "--clearance", "0.1", "--restitution", "0.8", "--amplitude", -1]
    words = ["basins", *model, "--over", "clearance", "0.05", "0.15", "--values", 3, "--states", 40, "--impacts", 2000]
    code, out, _ = run(capsys, *words, "-o", tmp_path / "o.png", "--json")
    assert code == 0
    told = json.loads(out)
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    shares = si.basins(osc, over="clearance", between=("0.05", "0.15"), values=3, states=40, impacts=2000)
    assert told["share"] == shares.share.tolist()
    assert told["attractor"] == [name for _, name, _ in sorted(shares.classes)]
    assert (tmp_path / "o.png").stat().st_size > 1000
    code, out, _ = run(capsys, *words, "-o", tmp_path / "o.png")
    assert code == 0
    assert out.split()[0] == "clearance"
    assert f"{shares.share[2, 0]:.4f}" in out.splitlines()[-1]
    code, _, error = run(capsys, "basins", *model, "--over", "nothing", 0, 1, "-o", tmp_path / "n.png")
    assert code == 2
    assert "unknown number of the model 'nothing'" in error
    assert not (tmp_path / "n.png").exists()


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (["--over", "clearance", 0, 1, "--size", 30], "--size = 30 is not accepted"),
        (["--over", "clearance", 0, 1, "--layer", "first-chatter"], "--layer = 'first-chatter' is not accepted"),
        (["--states", 10], "--states = 10 is not accepted: give --over beside it"),
        (["--values", 10], "--values = 10 is not accepted: give --over beside it"),
    ],
)
def test_basins_refuse_an_option_that_nothing_would_read(capsys, tmp_path, given, named):
    model = ["--omega", "2.8", "--clearance", "0.1", "--restitution", "0.8"]
    code, _, error = run(capsys, "basins", *model, *given, "-o", tmp_path / "n.png")
    assert code == 2
    assert named in error
    assert list(tmp_path.iterdir()) == []


def test_one_figure_as_a_file_of_its_own(capsys, tmp_path):
    code, told, _ = run(capsys, "figure", "4", "-o", tmp_path / "cusp.svg")
    assert code == 0
    assert "cusp.svg" in told
    assert (tmp_path / "cusp.svg").read_text().startswith("<?xml")
    code, _, error = run(capsys, "figure", "all", "-o", tmp_path / "all.svg")
    assert code == 2
    assert "several figures" in error
    assert not (tmp_path / "all.svg").exists()


def test_basins_without_a_clock_take_windows_of_starts(capsys, tmp_path):
    (tmp_path / "m.toml").write_text('f = "x - (1 - x**2)*xdot"\ng = "0"\nclearance = "-2.1"\nrestitution = "0.8"\n')
    words = ["basins", "--model", tmp_path / "m.toml", "--size", 6, "-o", tmp_path / "b.png"]
    code, out, _ = run(capsys, *words, "--x", -1, 1, "--xdot", 0, 1)
    assert code == 0
    assert "limit cycle without impact, period 6.66329  1.0000" in out
    assert (tmp_path / "b.png").stat().st_size > 1000
    code, _, error = run(capsys, *words, "--tau", 0, 1)
    assert code
    assert "give --x and --xdot for this model" in error
