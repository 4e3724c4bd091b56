"""The series in fresh processes: CPU time and memory, with room for a machine that is shared."""

import pytest

from singimpact.bench.series import TASKS, measured

QUICK = [task for task in TASKS if task.limit is not None and task.limit <= 0.5]


@pytest.mark.parametrize("task", QUICK, ids=lambda task: task.name)
def test_limit_is_kept(task):
    """The better of two: another process may take the cache away from one."""
    runs = []
    for _ in range(2):
        runs.append(measured(task))
        if runs[-1].good:
            break
    best = min(runs, key=lambda run: run.seconds)
    assert best.seconds <= 1.5 * task.limit, best.line()
    assert best.megabytes < 100
