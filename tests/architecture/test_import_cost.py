"""What is not needed is not loaded."""

import os
import subprocess
import sys

import pytest

HEAVY = {"sympy", "scipy", "numba", "mpmath", "flint", "matplotlib", "click", "rich", "jinja2"}
LOADED = "import sys; print(*sorted({name.partition('.')[0] for name in sys.modules}))"


def loaded(statement, clone):
    run = subprocess.run(
        [sys.executable, "-c", f"{statement}; {LOADED}"], cwd=clone, capture_output=True, text=True, check=True
    )
    return set(run.stdout.split())


def test_package_loads_nothing_heavy(clone):
    assert not loaded("import singimpact", clone) & HEAVY


def test_misspelt_name_loads_nothing_heavy(clone):
    assert not loaded("import singimpact; hasattr(singimpact, 'liner')", clone) & HEAVY


def test_command_loads_click_alone(clone):
    assert loaded("import singimpact.cli", clone) & HEAVY == {"click"}


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_is_quick(option, clone):
    """CPU time of the child, best of three: a shared machine may disturb one."""
    spent = [cpu_seconds([sys.executable, "-m", "singimpact", option], clone) for _ in range(3)]
    assert min(spent) < 0.4


def cpu_seconds(command, folder):
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL)
    _, code, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(code)
    assert process.returncode == 0
    return usage.ru_utime + usage.ru_stime
