"""Models of hostile expressions, each flown in a process of its own; `python tests/tool/fuzzing/hostile.py` is the long run."""

import subprocess
import sys
from pathlib import Path

import pytest

RUN = [sys.executable, str(Path(__file__).parent / "hostile.py")]


@pytest.mark.parametrize("models", [24, pytest.param(120, marks=pytest.mark.slow)])
def test_a_hostile_model_takes_seconds_at_most(models):
    found = subprocess.run([*RUN, "--models", str(models), "--seed", "2"], capture_output=True, text=True, timeout=1800)
    assert found.returncode == 0, found.stdout + found.stderr
