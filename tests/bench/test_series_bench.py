"""The series in fresh processes: CPU time and memory, with room for a machine that is shared."""

import pytest

from singimpact.bench import LIMITED

QUICK = [task for task in LIMITED if task.limit <= 0.5]


@pytest.mark.parametrize("task", QUICK, ids=lambda task: f"{task.case}, order {task.order}")
def test_limit_is_kept(task):
    """The better of two: another process may take the cache away from one."""
    runs = []
    for _ in range(2):
        runs.append(task.cost())
        if runs[-1].seconds <= task.limit:
            break
    best = min(runs, key=lambda run: run.seconds)
    assert best.seconds <= 1.5 * task.limit
    assert best.megabytes < 100
