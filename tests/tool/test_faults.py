"""Faults: killed runs, damaged entries, one cache for two processes, disks that are full."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from singimpact import cache
from singimpact.paper import figures as kept_figures
from singimpact.scenes import keep, recall
from singimpact.surface import Curve

SWEEP = [
    "sweep",
    "--omega",
    "2",
    "--clearance",
    "0.3",
    "--restitution",
    "0.5",
    "--over",
    "clearance",
    "--from",
    "0.1",
    "--to",
    "0.5",
    "--points",
    "1000",
]
SWEEP += ["--tau", "1", "--v", "0.1", "--impacts", "2000", "--workers", "1"]
MACHINE = """
import os, sys
import singimpact as si
from singimpact.flights.compiled_model import compiled_model
model = si.ImpactOscillator("x**3", "cos(2*t)", 0, "-v*(1 - v)/2")
compiled_model(model).laws[0].compile_here()
print(model.impact_map(0.3, 0.5).status)
"""


def started(arguments, folder, **more):
    environment = os.environ | {"SINGIMPACT_CACHE": str(folder / "cache"), "NUMBA_CACHE_DIR": ""}
    return subprocess.Popen(
        [sys.executable, *arguments], env=environment, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, **more
    )


def command(folder, *arguments, **more):
    """A command in a cache of its own, but for machine code, which takes half a minute to compile."""
    kernels, shared = folder / "cache" / "kernels", Path(os.environ["SINGIMPACT_CACHE"]) / "kernels"
    if not kernels.exists():
        kernels.parent.mkdir(exist_ok=True)
        kernels.symlink_to(shared.resolve(), target_is_directory=True)
    return started(["-m", "singimpact", *map(str, arguments)], folder, **more)


def drafts(folder):
    return list(folder.rglob(".draft-*"))


def entries(place):
    """The whole files of a folder; a pattern that begins with * would find drafts too."""
    return list(place.glob("[!.]*"))


def wait_for(found, seconds=300):
    end = time.monotonic() + seconds
    while not found():
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.mark.parametrize(
    "number",
    [pytest.param(each, marks=pytest.mark.slow) for each in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)],
)
def test_an_interrupted_verify_keeps_whole_verdicts_and_resumes(number, tmp_path):
    place, output = tmp_path / "cache" / "verdicts", tmp_path / "verdicts.txt"
    run = command(tmp_path, "verify", "s3-slope-r", "e:lin", "e:swan", "-o", output)
    wait_for(lambda: len(entries(place)) > 1)
    run.send_signal(number)
    _, told = run.communicate(timeout=300)
    assert "Traceback" not in told
    assert not output.exists() or run.returncode == 0
    assert number == signal.SIGKILL or not drafts(tmp_path)
    before = {path: path.stat().st_mtime_ns for path in entries(place)}
    assert before
    assert all(cache.recall(path) is not None for path in before)
    again = command(tmp_path, "verify", "s3-slope-r", "e:lin", "e:swan", "-o", output)
    again.communicate(timeout=300)
    assert again.returncode == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert output.read_text().strip()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "all_of_them"),
    [(signal.SIGINT, True), (signal.SIGTERM, True), (signal.SIGTERM, False), (signal.SIGKILL, False)],
)
def test_an_interrupted_sweep_leaves_a_whole_file_and_resumes(number, all_of_them, tmp_path):
    results, output = tmp_path / "kept.npz", tmp_path / "table.txt"
    run = command(tmp_path, *SWEEP, "--keep", results, "-o", output, start_new_session=True)
    wait_for(lambda: begun(results))
    (os.killpg if all_of_them else os.kill)(run.pid, number)  # a terminal interrupts the workers too
    _, told = run.communicate(timeout=300)
    assert "Traceback" not in told
    assert not output.exists()
    assert number == signal.SIGKILL or not drafts(tmp_path)
    done = {}
    if number != signal.SIGKILL:  # which leaves the journal alone
        with np.load(results) as found:
            done = dict(zip(found["index"].tolist(), found["result"].tolist(), strict=True))
        assert 0 < len(done) < 1000
    again = command(tmp_path, *SWEEP, "--keep", results, "-o", output)
    again.communicate(timeout=300)
    assert again.returncode == 0
    with np.load(results) as found:
        assert found["index"].tolist() == list(range(1000))
        assert {at: found["result"][at].tolist() for at in done} == done


def begun(results):
    """Whether results have reached the journal of a file."""
    journal = results.with_name(results.name + ".part")
    return journal.exists() and journal.stat().st_size > 1000


def whole(picture):
    return picture.read_bytes().endswith(b"IEND\xaeB`\x82")


@pytest.mark.slow
def test_interrupted_figures_are_whole_and_go_on_where_they_were(tmp_path):
    place, kept_ones = tmp_path / "pictures", tmp_path / "cache" / "figures"
    run = command(tmp_path, "figure", "all", "-o", place)
    wait_for(lambda: len(list(place.glob("figure*.png"))) > 1)
    run.send_signal(signal.SIGINT)
    _, told = run.communicate(timeout=300)
    assert "Traceback" not in told
    assert not drafts(tmp_path)
    drawn = list(place.glob("figure*.png"))
    assert 1 < len(drawn) < 17
    assert all(map(whole, drawn))
    before = {path: path.stat().st_mtime_ns for path in kept_ones.glob("*.figure")}
    assert len(before) >= len(drawn)
    pictures = {path: path.read_bytes() for path in drawn}
    again = command(tmp_path, "figure", "all", "-o", place)
    again.communicate(timeout=300)
    assert again.returncode == 0
    assert len(list(place.glob("figure*.png"))) == len(list(kept_ones.glob("*.figure"))) == 17
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert {path: path.read_bytes() for path in pictures} == pictures


def test_a_figure_that_is_kept_is_not_computed_again(tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    first = kept_figures.kept_picture(4)
    asked = []
    monkeypatch.setattr(kept_figures, "picture", lambda number: asked.append(number) or first)
    assert kept_figures.kept_picture(4).to_dict() == first.to_dict()
    assert asked == []
    (entry,) = (tmp_path / "figures").iterdir()
    entry.write_bytes(entry.read_bytes()[:-1])
    kept_figures.kept_picture(4)
    assert asked == [4]


SCENE = """layers = ["gamma", "stable-manifolds", "foliation"]
tau = [-1.2, 1.0]
v = [0, 0.3]
pixels = 2000
feet = ["0.6"]
leaves = 48
[model]
f = "x"
g = "cos(2*t)"
clearance = "0.7"
restitution = "0.5"
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_an_interrupted_scene_keeps_its_curves(number, tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    asked = ("scene", tmp_path / "scene.toml", "-o", tmp_path / "scene.png", "--json")
    run = command(tmp_path, *asked)
    wait_for(lambda: entries(tmp_path / "cache" / "curves"))
    run.send_signal(number)
    _, told = run.communicate(timeout=300)
    assert "Traceback" not in told
    assert not (tmp_path / "scene.png").exists()
    again = command(tmp_path, *asked)
    answer, _ = again.communicate(timeout=300)
    report = json.loads(answer)
    assert whole(tmp_path / "scene.png")
    assert "gamma" in report["from_cache"]
    assert "foliation" not in report["from_cache"]


MODELS = {
    "clockless": 'f = "x - (1 - x**2)*xdot"\ng = "0"\nclearance = "-2.1"\nrestitution = "0.8"\n',
    "waves": 'f = "x"\ng = "cos(2.8*t) + cos(2.8*sqrt(2)*t)/50"\nclearance = "0.1"\nrestitution = "0.8"\n',
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("asked", "kind"), [("basins", ""), ("basins", "clockless"), ("basins", "waves"), ("bifurcation", "")]
)
def test_an_interrupted_picture_of_a_sweep_resumes(asked, kind, tmp_path, tmp_path_factory):
    output, cached = tmp_path / "picture.png", tmp_path_factory.getbasetemp()  # both compile the same
    given = ["--omega", "2.8", "--clearance", "0", "--restitution", "0.8", "--workers", "1"]
    if kind:
        (tmp_path / "model.toml").write_text(MODELS[kind])
        given = ["--model", tmp_path / "model.toml", "--workers", "1"]
    given += {
        "basins": ["--size", "180", "--impacts", "300"],
        "bifurcation": ["--from", "0.1", "--to", "0.3", "--points", "700"],
    }[asked]
    given += ["--keep", tmp_path / "kept.npz", "-o", output]
    run = command(cached, asked, *given)
    wait_for(lambda: begun(tmp_path / "kept.npz"))
    run.send_signal(signal.SIGTERM)
    _, told = run.communicate(timeout=300)
    assert "Traceback" not in told
    assert not output.exists()
    with np.load(tmp_path / "kept.npz") as found:
        done = dict(zip(found["index"].tolist(), found["result"], strict=True))
    again = command(cached, asked, *given)
    again.communicate(timeout=300)
    assert again.returncode == 0
    assert whole(output)
    with np.load(tmp_path / "kept.npz") as found:
        everything = dict(zip(found["index"].tolist(), found["result"], strict=True))
    assert 0 < len(done) < len(everything)
    assert all(np.array_equal(everything[at], done[at], equal_nan=True) for at in done)


DAMAGES = {
    "empty": lambda old: old[:0],
    "cut": lambda old: old[:-7],
    "one bit": lambda old: old[:-30] + bytes([old[-30] ^ 4]) + old[-29:],
    "no seal": lambda old: old[72:],
    "other": lambda old: b"{}" + old[:0],
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_curves_are_named(damage, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    keep("key", [Curve("a", np.array([[0.0, 1.0], [2.0, 3.0]]), ("tau", "t"), (), False, 0.1)])
    assert recall("key")[0].points.tolist() == [[0, 1], [2, 3]]
    (path,) = (tmp_path / "curves").iterdir()
    path.write_bytes(DAMAGES[damage](path.read_bytes()))
    assert recall("key") is None
    assert str(path) in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_machine_code_is_named_and_made_again(damage, tmp_path):
    def ran():
        return started(["-c", MACHINE], tmp_path).communicate(timeout=300)

    assert ran() == ("0\n", "")
    (path,) = (tmp_path / "cache" / "kernels").glob("*.o")
    whole = path.read_bytes()
    path.write_bytes(DAMAGES[damage](whole))
    answer, told = ran()
    assert answer == "0\n"
    assert told.count("\n") == 1
    assert str(path) in told
    assert ran() == ("0\n", "")


@pytest.mark.slow
def test_two_processes_share_a_cold_cache(tmp_path):
    runs = [command(tmp_path, "verify", "s3-dvdt") for _ in range(2)]
    codes = [started(["-c", MACHINE], tmp_path) for _ in range(2)]
    told = [run.communicate(timeout=300) for run in runs]
    assert [run.returncode for run in runs] == [0, 0]
    assert [err for _, err in told] == ["", ""]
    assert [run.communicate(timeout=300) for run in codes] == [("0\n", "")] * 2


FULL = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
"""


@pytest.mark.slow
def test_work_is_done_on_a_full_disk_and_told_once(tmp_path):
    answer, told = started(["-c", FULL + MACHINE], tmp_path).communicate(timeout=300)
    assert answer == "0\n"
    assert told.count("\n") == 1, told
    assert "the work goes on" in told


def test_an_output_on_a_full_disk_is_one_line(tmp_path):
    output = tmp_path / "told.txt"
    script = FULL + f"from singimpact.cli import main\nmain(['verify', 'e:yeq', '-o', {str(output)!r}])\n"
    run = started(["-c", script], tmp_path)
    _, told = run.communicate(timeout=300)
    assert run.returncode == 2
    assert "Traceback" not in told
    assert sum("cannot be written" in line for line in told.splitlines() if "cache" not in line) == 1
    assert not output.exists()
    assert not drafts(tmp_path)


@pytest.mark.slow
def test_an_unwritable_cache_folder_is_told_once(tmp_path):
    (tmp_path / "cache").touch()
    answer, told = started(["-c", MACHINE], tmp_path).communicate(timeout=300)
    assert answer == "0\n"
    assert told.count("\n") == 1


def test_old_drafts_are_taken_away(tmp_path):
    old, new = tmp_path / ".draft-old", tmp_path / ".draft-new"
    for draft in (old, new):
        draft.touch()
    os.utime(old, (0, 0))
    cache.keep(Path(tmp_path) / "entry", b"1")
    assert not old.exists()
    assert new.exists()


CONFINED = """
import resource
resource.setrlimit(resource.RLIMIT_AS, (500 << 20, 500 << 20))
import numpy as np
import singimpact as si
for model in (si.linear(2, "0.7", "0.5"), si.ImpactOscillator("x + x**3", "cos(1.7*t)", "0.1", "0.8")):
    orbit, ends = model.orbit("1.2", "0.3", impacts=1500), model.iterate(np.linspace(0, 1, 300), 0.3, impacts=4)
    print(orbit.kind.size > 1, ends.v.size)
"""


def test_little_address_space_costs_machine_code_alone(tmp_path):
    """To compile in 500 MB imports libraries without end: nothing is compiled, and one line says so."""
    run = started(["-c", CONFINED], tmp_path)
    answer, told = run.communicate(timeout=300)
    assert answer == "True 300\nTrue 300\n"
    assert told == (
        "singimpact: the model's flights are not compiled, for that needs 750 MB of address space and 500 MB are "
        "allowed (ulimit -v): they are slower; the work goes on\n"
    )
