"""CPU of the first commands: descendants that outlive their parents count, and a command that costs more fails."""

from __future__ import annotations

import json
import sys

import pytest

from singimpact.bench import first_commands

BURN = "import time; begun = time.process_time()\nwhile time.process_time() - begun < {}: pass"
ORPHAN = "import subprocess, sys; subprocess.Popen([sys.executable, '-c', {!r}], start_new_session=True)"


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux adopts orphans")
def test_a_process_that_outlives_its_parent_counts(tmp_path):
    plain, orphan = (
        first_commands.cpu_of([sys.executable, "-c", text], str(tmp_path))
        for text in ("pass", ORPHAN.format(BURN.format(0.4)))
    )
    assert orphan - plain > 0.3


def test_a_ratio_that_has_grown_by_half_fails(monkeypatch, tmp_path, capsys):
    stored = tmp_path / "stored.json"
    stored.write_text(json.dumps(dict.fromkeys(first_commands.COMMANDS, 2.0)))
    monkeypatch.setattr(first_commands, "STORED", stored)
    monkeypatch.setattr(sys, "argv", ["first_commands"])
    for busy in (1.0, 3.0):  # a slower machine slows the reference too
        for spent, code in ((2.9, 0), (3.1, 1)):
            monkeypatch.setattr(first_commands, "cpu_of", lambda *_, busy=busy: busy)
            monkeypatch.setattr(first_commands, "_in_new_folder", lambda _, busy=busy, spent=spent: busy * spent)
            assert first_commands.main() == code
            assert ("OVER BY HALF" in capsys.readouterr().out) is bool(code)


def test_every_command_has_a_stored_ratio():
    assert json.loads(first_commands.STORED.read_text()).keys() == first_commands.COMMANDS.keys()
