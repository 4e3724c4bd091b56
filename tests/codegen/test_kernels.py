"""Kernels on disk: one cache serves many processes."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from singimpact import store
from singimpact.codegen import kernels

FLIES = (
    "import singimpact as si; from singimpact.codegen import interpreted; "
    "interpreted.PATIENCE = interpreted.Patience(0.0, 0.0); "  # two flights would not pay for compiling
    "print(repr(float(si.linear('2.8', 0, '0.8').impact_map(0.9, 0.005).v)), "
    "repr(float(si.ImpactOscillator('x + x**3', 'cos(2*t)', 0, '0.8').impact_map(0.9, 0.005).v)))"
)


def flown(cache, clone):
    environment = {**os.environ, "SINGIMPACT_CACHE": str(cache), "NUMBA_CACHE_DIR": ""}
    run = subprocess.run(
        [sys.executable, "-c", FLIES], cwd=clone, env=environment, capture_output=True, text=True, check=True
    )
    return run.stdout


def files(cache):
    return {path.relative_to(cache): path.stat().st_mtime_ns for path in cache.rglob("*") if path.is_file()}


@pytest.mark.slow
def test_second_process_runs_what_the_first_compiled(tmp_path, clone):
    first = flown(tmp_path, clone)
    compiled = files(tmp_path)
    assert any(path.suffix == ".nbc" for path in compiled)
    assert flown(tmp_path, clone) == first
    assert files(tmp_path) == compiled


def test_read_only_cache_does_not_stop_a_computation(tmp_path, monkeypatch):
    (tmp_path / "taken").write_text("a file where a folder is needed")
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path / "taken"))
    assert kernels.filed("x = 1\n").parent == store.passing_folder()


def test_cache_off_is_a_passing_folder(monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", "off")
    assert store.cache_folder() == store.passing_folder()


@pytest.mark.parametrize("text", ["x = 1\n", "def twice(x):\n    return 2 * x\n"])
def test_equal_text_is_not_written_again(text, tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    stamp = kernels.filed(text).stat().st_mtime_ns
    assert kernels.filed(text).stat().st_mtime_ns == stamp
