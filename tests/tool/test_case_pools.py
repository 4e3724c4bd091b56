"""Where cases are computed: plain scripts, functions that cannot be sent, interruptions, clusters."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context

import numpy as np
import pytest

import singimpact as si
from singimpact import case_pools
from singimpact.case_pools import Here, Place, WorkerPool, place_of, script_can_be_imported
from singimpact.cases import sweep
from singimpact.inputs import InputError, Unfinished


def run(tmp_path, text, **more):
    """A script in a new process, which leaves a line in `bodies` whenever its body runs."""
    script = tmp_path / "script.py"
    head = f"with open({str(tmp_path / 'bodies')!r}, 'a') as stream:\n    stream.write('body\\n')\n"
    script.write_text(head + text)
    return subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=100, **more)


def bodies(tmp_path):
    return (tmp_path / "bodies").read_text().count("body")


PLAIN = {
    "a function of the script": (
        "import singimpact as si\ndef f(x):\n    return x * x\nprint(si.sweep(f, [1.0, 2.0, 3.0]).tolist())",
        "[1.0, 4.0, 9.0]\n",
    ),
    "a function of a module": (
        "import math, singimpact as si\nprint(si.sweep(math.sqrt, [1.0, 4.0, 9.0]).tolist())",
        "[1.0, 2.0, 3.0]\n",
    ),
    "a class of the script in the cases": (
        "import operator, singimpact as si\nclass C:\n    x = 2\n"
        "print(si.sweep(operator.attrgetter('x'), [C(), C()]).tolist())",
        "[2, 2]\n",
    ),
    "a class of the script in a later case": (
        "import operator, singimpact as si\nclass C:\n    real = 2\n"
        "print(si.sweep(operator.attrgetter('real'), [1, 3, C()]).tolist())",
        "[1, 3, 2]\n",
    ),
    "basins": (
        "import singimpact as si\nprint(si.basins(si.linear(2, '0.7', '0.5'), ((0, 3), (0, 1)), 8))",
        "Basins(8 x 8 states: (inf, 1) chatter for ever 100 %)\n",
    ),
    "a bifurcation diagram": (
        "import singimpact as si\n"
        "print(si.bifurcation(si.linear(2, 0, '0.5'), 'clearance', (0.2, 0.3), 2, impacts=10, kept=2))",
        "Bifurcation(over clearance: 2 values from 0.2 to 0.3, 2 events of each)\n",
    ),
    "an output": (
        "import singimpact as si\ndef f(x):\n    return x * x\n"
        "print(si.sweep(f, range(3), output='kept.npz').tolist())",
        "[0, 1, 4]\n",
    ),
}


@pytest.mark.parametrize("name", PLAIN)
def test_a_plain_script_works_and_its_body_runs_once(name, tmp_path):
    text, printed = PLAIN[name]
    done = run(tmp_path, text, cwd=tmp_path)
    assert (done.stdout, done.stderr, done.returncode) == (printed, "", 0)
    assert bodies(tmp_path) == 1


GUARDED = """
import os, sys, singimpact as si
def f(x):
    return os.getpid()
def main():
    here = os.getpid()
    print(here not in si.sweep(f, range(4)).tolist())
if __name__ == "__main__":
    main()
"""


def test_a_script_with_a_guard_has_processes(tmp_path):
    done = run(tmp_path, GUARDED)
    assert (done.stdout, done.stderr, done.returncode) == ("True\n", "", 0)
    assert bodies(tmp_path) > 1  # each worker imports the script


def test_functions_of_modules_have_processes_without_a_guard(tmp_path):
    text = "import os, singimpact as si\nfrom singimpact.bench.measuring import cost\n" + (
        "import operator\nprint(os.getpid() in si.sweep(operator.methodcaller('__call__'), [os.getpid] * 3).tolist())"
    )
    done = run(tmp_path, text)
    assert (done.stdout, done.stderr, bodies(tmp_path)) == ("False\n", "", 1)


REFUSED = {
    "a lambda": ("si.sweep(lambda x: x, [1])", r"function = '<lambda>' cannot be sent to other processes \("),
    "a closure": (
        "def outer():\n    def inner(x):\n        return x\n    return inner\nsi.sweep(outer(), [1])",
        "function = 'outer.<locals>.inner' cannot be sent to other processes",
    ),
    "a case": ("import math\nsi.sweep(math.sqrt, [lambda: 1])", "cases cannot be sent to other processes"),
    "a pool that would run the script again": (
        "import multiprocessing as mp, concurrent.futures as cf\n"
        "with cf.ProcessPoolExecutor(2, mp.get_context('spawn')) as pool:\n    si.sweep(abs, [1], pool)",
        "executor = ProcessPoolExecutor starts processes that run this script again: put the call under",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_sent_ends_in_one_line(name, tmp_path):
    text, message = REFUSED[name]
    done = run(tmp_path, f"import singimpact as si\ntry:\n    {text.replace(chr(10), chr(10) + '    ')}\n"
                         "except si.InputError as error:\n    print(error)")  # fmt: skip
    import re

    assert re.match(message, done.stdout), done
    assert "executor=concurrent.futures.ThreadPoolExecutor()" in done.stdout
    assert (done.stdout.count("\n"), done.stderr, bodies(tmp_path)) == (1, "", 1)


def test_what_is_no_executor_is_refused():
    with pytest.raises(InputError, match="executor = 4 is not accepted: give a concurrent"):
        sweep(abs, [1.0], 4)


GUARDS = {
    "if __name__ == '__main__':\n    call()": True,
    "def main():\n    call()\nif __name__ == '__main__':\n    main()": True,
    "call()": False,
    "for _ in range(1):\n    call()": False,
    "def main():\n    call()\nmain()": False,
    "import threading\nthread = threading.Thread(target=call)\nthread.start()\nthread.join()": False,
    "import threading\nif __name__ == '__main__':\n    t = threading.Thread(None, call)\n    t.start()\n    t.join()": (
        True
    ),
}


@pytest.mark.parametrize("text", GUARDS)
def test_a_guard_is_seen(text, tmp_path):
    call = "def call():\n    from singimpact import case_pools\n    print(case_pools.script_can_be_imported())\n"
    done = run(tmp_path, call + text)
    assert (done.stdout, done.stderr) == (f"{GUARDS[text]}\n", "")


def test_a_process_without_a_script_cannot_import_it():
    code = "from singimpact.case_pools import script_can_be_imported as s; print(s())"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "False\n"
    assert script_can_be_imported() in (True, False)


WAITING = """
def wait(x):
    import os, time
    open(f"at-work-{os.getpid()}", "w").close()
    time.sleep(x)
"""
INTERRUPTED = """
import singimpact as si
from waiting import wait as other
si.sweep({function}, [3600.0] * 4{more})
"""


@pytest.mark.parametrize(
    ("function", "more"),
    [
        ("wait", ""),
        *(
            pytest.param("other", each, marks=pytest.mark.slow)
            for each in ("", ", output='kept.npz'", ", output='kept.zarr'")
        ),
    ],
)
def test_an_interruption_ends_a_sweep_and_its_workers(function, more, tmp_path):
    """Cases of an hour: whatever waits for one of them does not end in time."""
    if "zarr" in more:
        pytest.importorskip("zarr", reason="needs zarr, of the extra `cluster`")
    script = tmp_path / "script.py"
    (tmp_path / "waiting.py").write_text(WAITING)
    script.write_text(WAITING + INTERRUPTED.format(function=function, more=more))
    child = subprocess.Popen(
        [sys.executable, script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path,
        start_new_session=True,
    )  # fmt: skip
    try:
        while not list(tmp_path.glob("at-work-*")):
            assert child.poll() is None
            time.sleep(0.01)
        os.killpg(child.pid, signal.SIGINT)  # as a terminal does
        _, errors = child.communicate()  # ends when the last process that writes to it has ended
    finally:
        if alive(child.pid):
            os.killpg(child.pid, signal.SIGKILL)
    assert child.returncode != 0
    assert errors.count("Traceback") == 1
    assert errors.rstrip().endswith("KeyboardInterrupt")


def test_workers_do_not_hear_an_interruption_before_they_ignore_it():
    """Ctrl-C in a terminal reaches them while they start, too."""
    with WorkerPool(1) as pool:
        pool.submit(abs, 1)  # starts the process
        (worker,) = pool._processes.values()
        os.kill(worker.pid, signal.SIGINT)
        assert pool.submit(abs, -2).result() == 2
        assert pool.submit(signal.getsignal, signal.SIGINT).result() == signal.SIG_IGN
        assert pool.submit(signal.pthread_sigmask, signal.SIG_BLOCK, ()).result() == set()


def alive(group):
    """Whether a process of a group is left."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def test_the_line_of_progress_moves_while_nothing_ends(monkeypatch):
    from singimpact import cases

    shown = []
    monkeypatch.setattr(cases.ProgressLine, "show", lambda _, done, total, text: shown.append((done, total, text)))
    with ThreadPoolExecutor(1) as pool:
        sweep(time.sleep, [0.6], pool)
    assert len(shown) >= 4
    assert shown[-1] == (1, 1, "cases")
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, (n for n in range(3)), pool)
    assert shown[-1] == (3, None, "cases")


def test_a_worker_sweeps_by_itself(monkeypatch):
    assert isinstance(place_of(None, abs, [1]), case_pools.Processes)
    monkeypatch.setattr(case_pools, "_OURS", [True])
    assert isinstance(place_of(None, abs, [1]).executor, Here)


def nested(count):
    return sweep(abs, range(count))


def test_a_sweep_in_a_sweep():
    with WorkerPool(2) as pool:
        assert sweep(nested, [3, 3], pool).tolist() == [[0, 1, 2]] * 2


def test_all_cases_that_end_their_process_are_not_sought_for_ever(monkeypatch):
    from singimpact import cases

    monkeypatch.setattr(cases, "POOL", cases.PoolSettings(fatal=2, deaths=1))
    with WorkerPool(1) as pool, pytest.raises(Unfinished, match="2 cases and perhaps more ended their process"):
        sweep(os._exit, range(1, 100), pool)


def test_a_pool_of_the_caller_is_replaced_by_one_of_its_kind():
    pool = ProcessPoolExecutor(3, mp_context=get_context("spawn"))
    new = place_of(pool, abs, [1]).again()
    assert new.executor._mp_context is pool._mp_context
    assert (new.width, place_of(pool, abs, [1]).again(1).width) == (3, 1)


def test_the_width_of_an_executor():
    class Other:
        num_workers = 7

        def submit(self):
            pass

    assert place_of(Other(), abs, [1]).width == 7
    Other.num_workers = None
    assert place_of(Other(), abs, [1]).width == (os.cpu_count() or 1)
    assert type(place_of(Other(), abs, [1])) is Place


@pytest.fixture
def cluster(tmp_path):
    distributed = pytest.importorskip("distributed", reason="needs distributed, of the extra `cluster`")
    import logging

    with (
        distributed.LocalCluster(
            n_workers=4, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=logging.CRITICAL,
            local_directory=str(tmp_path / "dask"),
        ) as cluster,
        distributed.Client(cluster) as client,
    ):  # fmt: skip
        yield client


def squared(log, case):
    with (log / str(os.getpid())).open("a") as stream:
        stream.write(f"{case}\n")
    time.sleep(0.01)
    return np.array([case, case * case])


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["client", "executor"])
def test_a_cluster_that_loses_a_worker(kind, cluster, tmp_path):
    """Four workers, one of them killed in the middle: every case is in the result, once."""
    log, output, killed = tmp_path / "log", tmp_path / "kept.npz", []
    log.mkdir()

    def cases():
        for case in range(600):
            if case == 300:
                killed.append(next(iter(cluster.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)
            yield case

    found = sweep(partial(squared, log), cases(), cluster if kind == "client" else cluster.get_executor(), output)
    assert found.tolist() == [[case, case * case] for case in range(600)]
    with np.load(output) as kept:
        assert kept["index"].tolist() == list(range(600))
    at_work = {int(path.name) for path in log.iterdir()}
    assert set(killed) < at_work
    assert len(at_work) >= 4


@pytest.mark.slow
def test_the_width_of_a_cluster_is_its_cores_and_not_ours(cluster, monkeypatch):
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    place = place_of(cluster, abs, [1])
    assert place.width == 4
    assert place_of(cluster.get_executor(), abs, [1]).width == 4
    cluster.cluster.scale(2)
    monkeypatch.setattr(case_pools, "PLACE", case_pools.PlaceSettings(interval=0.0))
    for _ in range(300):
        if place.width == 2:
            break
        time.sleep(0.1)
    assert place.width == 2


@pytest.mark.slow
def test_cases_that_look_like_tasks_of_the_cluster_are_cases(cluster):
    assert sweep(lambda pair: pair[1], [(abs, -2), (abs, -3)], cluster).tolist() == [-2, -3]


@pytest.mark.slow
def test_a_case_that_ends_its_workers_ends_the_sweep_in_one_line(cluster):
    with pytest.raises(Unfinished, match="workers of the cluster were lost with case 0 = 3"):
        sweep(os._exit, [3], cluster)


@pytest.mark.slow
def test_basins_and_diagrams_on_a_cluster(cluster):
    osc = si.linear(2, "0.7", "0.5")
    assert np.array_equal(
        si.basins(osc, ((0, 3), (0, 1)), 4, executor=cluster).codes, si.basins(osc, ((0, 3), (0, 1)), 4).codes
    )
    found, alone = (
        si.bifurcation(osc, "clearance", ("0.2", "0.3"), 2, impacts=10, kept=2, executor=executor)
        for executor in (cluster.get_executor(), None)
    )
    assert np.array_equal(found.events, alone.events, equal_nan=True)


@pytest.mark.parametrize("executor", ["None", "ThreadPoolExecutor(1)"])
def test_an_interruption_while_futures_are_locked_ends_the_script(executor, tmp_path):
    """Ctrl-C within `wait`, which locks futures one by one and keeps those locks when it is left then."""
    text = (
        "import math, singimpact as si\nfrom concurrent.futures import ThreadPoolExecutor\n"
        "from singimpact import cases\n"
        "def interrupted(futures, *_):\n    for future in futures:\n        future._condition.acquire()\n"
        "    raise KeyboardInterrupt\n"
        f"cases.wait = interrupted\nsi.sweep(math.sqrt, [1.0] * 100, executor={executor})"
    )
    done = run(tmp_path, text)
    assert done.returncode != 0
    assert done.stderr.strip().splitlines()[-1] == "KeyboardInterrupt"
