"""The suite watches itself: a process that a test leaves behind is named."""

import subprocess
import sys
from pathlib import Path

import pytest
from left_behind import SUITE, left_behind


def test_processes_of_a_run_are_recognised():
    if not Path("/proc/self/environ").exists():
        pytest.skip("no /proc")
    words = [sys.executable, "-c", "print('begun', flush=True); input()"]
    child = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={SUITE: "some run"})
    try:
        assert child.stdout.readline() == b"begun\n"  # before, its environment may still be that of its parent
        assert list(left_behind("some run", patience=0)) == [child.pid]
        assert left_behind("another run", patience=0) == {}
    finally:
        child.communicate(b"\n")
    assert left_behind("some run", patience=0) == {}
