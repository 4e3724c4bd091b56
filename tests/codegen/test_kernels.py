"""Kernels on disk: one cache serves many processes."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
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


FLY = """
import numpy as np, singimpact as si
from singimpact.codegen import interpreted
interpreted.PATIENCE = interpreted.Patience(fresh=-1.0, kept=-1.0)  # as for work that pays for a compiler
osc, tau, v = si.linear("2.8", 0, "0.8"), np.linspace(0, 2, 40), np.linspace(0.1, 2, 40)
soft = si.ImpactOscillator("x + x**3", "cos(1.7*t)", "0.3", "0.6")
print(repr([osc.impact_map(tau, v).v.tolist(), soft.impact_map(tau, v).v.tolist()]))
"""


def test_without_just_in_time_compiling_kernels_run_as_they_stand(tmp_path):
    def flown(**around):
        found = subprocess.run(
            [sys.executable, "-c", FLY], env=os.environ | around, capture_output=True, text=True, check=False
        )
        assert found.returncode == 0, found.stderr
        return np.array(eval(found.stdout))

    found = flown(NUMBA_DISABLE_JIT="1", SINGIMPACT_CACHE=str(tmp_path))
    assert np.allclose(found, flown(), rtol=1e-12, equal_nan=True)


def test_without_numba_much_work_ends_in_one_sentence(tmp_path):
    hidden = "import sys; sys.modules['numba'] = None\n"
    around = os.environ | {"SINGIMPACT_CACHE": str(tmp_path)}
    found = subprocess.run(
        [sys.executable, "-c", hidden + FLY], env=around, capture_output=True, text=True, check=False
    )
    assert found.stderr.splitlines()[-1].startswith("singimpact.inputs.Unfinished: so much work needs a compiler")
    few = FLY.replace("fresh=-1.0, kept=-1.0", "")
    found = subprocess.run(
        [sys.executable, "-c", hidden + few], env=around, capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stderr
