"""The check counts lines by room, and fails where too few of a room ran."""

import json
import runpy

import pytest


@pytest.fixture
def rooms(clone):
    return runpy.run_path(str(clone / ".ci" / "rooms.py"))


def told(executed, missing):
    return {"executed_lines": list(range(executed)), "missing_lines": list(range(executed, executed + missing))}


def test_lines_are_counted_by_room(rooms):
    files = {"singimpact/theory/a.py": told(9, 1), "/x/singimpact/theory/deep/b.py": told(10, 0),
             "singimpact/status.py": told(3, 0), "singimpact/cli/c.py": told(0, 5)}  # fmt: skip
    assert rooms["rooms"](files) == {"cli": (0, 5), "the ground": (3, 3), "theory": (19, 20)}


def test_lines_of_two_runs_count_together(rooms):
    runs = [{"a.py": {"executed_lines": [1, 2], "missing_lines": [3, 4]}},
            {"a.py": {"executed_lines": [3], "missing_lines": [1, 2, 4]}}]  # fmt: skip
    assert rooms["together"](runs) == {"a.py": {"executed_lines": {1, 2, 3}, "missing_lines": {4}}}


@pytest.mark.parametrize(("missing", "code"), [(10, 0), (11, 1)])
def test_too_few_lines_fail(missing, code, rooms, tmp_path, capsys):
    files = {"singimpact/theory/a.py": told(90, missing), "singimpact/cli/c.py": told(0, 5)}
    (tmp_path / "lines.json").write_text(json.dumps({"files": files}))
    assert rooms["main"](tmp_path / "lines.json") == code
    assert ("below 90 %: theory" in capsys.readouterr().out) == bool(code)
