"""The first script with a model of one's own in a new cache folder: at most twice the second, and 3 s."""

import subprocess
import sys

import pytest
from slowness import slowness

MODEL = """
import time
start = time.process_time()
import singimpact as si
osc = si.ImpactOscillator("x + 0.3*x**3 + 0.2*tanh(xdot/0.05)", "cos(omega*t)", "0.1", "0.8", {"omega": "1.7"})
"""
CALLS = {
    "periodic": "osc.periodic(1, 1)",
    "branch": "osc.periodic(1, 1)[0].branch('clearance', (0.05, 0.4))",
    "branch over omega": "osc.periodic(1, 1)[0].branch('omega', (1.6, 1.9))",
    "bifurcation": "osc.bifurcation('clearance', (0.05, 0.4), points=20)",
    "basins": "osc.basins(size=40)",
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CALLS)
def test_the_first_script_is_not_ten_times_slower_than_the_second(name, tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    text = f"{MODEL}{CALLS[name]}\nprint(time.process_time() - start)"
    first, second = (
        float(subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True).stdout)
        for _ in range(2)
    )
    assert first <= 2 * second + 3 * slowness()
    assert next(tmp_path.rglob("*.o"), None) is not None
