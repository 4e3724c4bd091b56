"""The mutation command: changes that parse, that spare words, and a trial that sees a wrong formula."""

import ast
import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import mutate
from single_changes import mutants_of

SOURCE = '''
"""Adds 1 - 1."""
from dataclasses import dataclass

@dataclass
class Settings:
    much: float = 1 + 2  # a setting

def f(x: int = 3 - 1) -> "a - b":
    """One - two."""
    if not x < 2 and g(x, 1):
        raise ValueError("3 - 4" + str(5))
    return -x**2 + 4*x % 7
'''


def test_changes_are_of_formulas_and_parse():
    found = mutants_of("f.py", SOURCE)
    for mutant in found:
        changed = mutant.applied(SOURCE)
        assert changed != SOURCE
        ast.parse(changed)
    assert {(each.line, each.was, each.text) for each in found} == {
        (9, "3", "4"), (9, "-", "+"), (9, "1", "2"), (11, "not ", ""), (11, "<", "<="), (11, "2", "3"),
        (11, "and", "or"), (11, "x, 1", "1, x"), (11, "1", "2"), (13, "-", "+"), (13, "2", "3"),
        (13, "+", "-"), (13, "4", "5"), (13, "*", "/"), (13, "%", "//"), (13, "7", "8"),
    }  # fmt: skip


def test_the_seed_draws_the_same_mutants_and_every_file_is_there(clone):
    assert [str(each) for each in mutate.drawn(30, 5)] == [str(each) for each in mutate.drawn(30, 5)] != []
    assert {each.file for each in mutate.drawn(100, 1)} == set(mutate.GUARDS)
    for file, guards in mutate.GUARDS.items():
        assert (clone / file).exists(), file
        assert all((clone / guard).exists() for guard in guards), guards


def test_the_quickest_tests_that_run_the_line_come_first():
    mutant = next(each for each in mutants_of("demo.py", "def half(x):\n    return x / 2\n") if each.was == "/")
    lines = {"demo.py": {"1": [("never", 0.1)], "2": [("slow", 50.0), ("quick", 1.0), ("middle", 15.0)]}}
    assert mutate.nearest(mutant, lines) == ["quick", "middle"]
    assert mutate.nearest(mutant, {}) == []


@pytest.mark.slow
def test_a_wrong_formula_is_noticed_and_one_that_no_test_reads_is_not(tmp_path, monkeypatch):
    (tmp_path / "demo.py").write_text("def half(x):\n    return x / 2\n\n\ndef unread(x):\n    return x / 2\n")
    (tmp_path / "test_demo.py").write_text("import demo\n\n\ndef test_half():\n    assert demo.half(4) == 2\n")
    monkeypatch.setattr(mutate, "GUARDS", {"demo.py": ["test_demo.py"]})
    source = (tmp_path / "demo.py").read_text()
    first, second = (each for each in mutants_of("demo.py", source) if each.was == "/")
    lines = mutate.lines_run(tmp_path, ["demo.py"])
    assert mutate.nearest(first, lines) == ["test_demo.py::test_half"]
    assert mutate.nearest(second, lines) == []
    for known in (lines, {}):
        assert mutate.noticed(first, tmp_path, known) == "FAILED test_demo.py::test_half"
        assert mutate.noticed(second, tmp_path, known) == ""
    assert (tmp_path / "demo.py").read_text() == source


def test_a_survivor_is_explained_by_its_line_and_its_change():
    (told, *_) = json.loads(mutate.EXPLAINED.read_text())
    source = (mutate.ROOT / told["file"]).read_text()
    found = [each for each in mutants_of(told["file"], source) if (each.was, each.text) == (told["was"], told["text"])]
    reasons = [mutate.reason(each) for each in found]
    assert told["because"] in reasons
    assert "NOT EXPLAINED" in reasons
    for each in json.loads(mutate.EXPLAINED.read_text()):
        assert each["line"] in (mutate.ROOT / each["file"]).read_text()
