"""Sweeps on any executor, kept and resumed."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context

import numpy as np
import pytest

from singimpact.case_keys import key
from singimpact.cases import sweep
from singimpact.impact_oscillator import linear
from singimpact.inputs import InputError, Unfinished

CALLS = []


def landing(case):
    CALLS.append(case)
    clearance, v = case
    step = linear("2.8", clearance, "0.8").impact_map(0.3, v)
    return np.array([step.tau, step.v])


def fails_late(case):
    CALLS.append(case)
    if case == 17 and len(CALLS) < 30:
        raise KeyboardInterrupt
    return float(case)


CASES = [(float(c), float(v)) for c in np.linspace(-0.3, 0.3, 5) for v in (0.1, 0.4)]


def test_process_pool_is_the_default():
    found = sweep(landing, CASES)
    assert np.array_equal(found, [landing(case) for case in CASES])


def test_interrupted_sweep_keeps_what_it_has(tmp_path):
    CALLS.clear()
    output = tmp_path / "kept.npz"
    with pytest.raises(KeyboardInterrupt), ThreadPoolExecutor(1) as pool:
        sweep(fails_late, range(20), pool, output)
    kept = set(np.load(output)["index"].tolist())
    assert 0 < len(kept) < 20
    CALLS[:] = [None] * 30
    with ThreadPoolExecutor(1) as pool:
        assert sweep(fails_late, range(20), pool, output).tolist() == list(range(20))
    assert set(CALLS[30:]) == set(range(20)) - kept


def test_results_of_other_cases_are_refused(tmp_path):
    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, [1.0, 2.0], pool, output)
        assert sweep(abs, [1.0, 2.0], pool, output).tolist() == [1.0, 2.0]
        with pytest.raises(InputError, match="other cases"):
            sweep(abs, [1.0, 3.0], pool, output)
    output.write_text("no archive")
    with pytest.raises(InputError, match="not a file of results"):
        sweep(abs, [1.0], None, output)


def test_models_that_differ_in_numbers_compile_once():
    from singimpact.flights.machine import machine_of

    for omega in (1.1, 1.7):
        linear(omega, 0.1, 0.5).impact_map(0.2, 0.3)
    before = machine_of.cache_info().misses
    for omega in np.linspace(1, 3, 7):
        linear(float(omega), 0.2, 0.7, damping=0.01).impact_map(0.2, 0.3)
    assert machine_of.cache_info().misses == before


def test_dask_cluster(tmp_path):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None, local_directory=str(tmp_path)
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        found = sweep(landing, CASES, client.get_executor())
    assert np.array_equal(found, [landing(case) for case in CASES])


def dies_once(place, case):
    import os
    import signal

    with (place / f"{case}").open("a") as log:
        log.write("flown\n")
    if case == 13 and not (place / "died").exists():
        (place / "died").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return case * case


def dies_at_seven(case):
    import os

    if case == 7:
        os._exit(3)
    return case * case


def test_a_killed_worker_is_replaced_and_nothing_is_lost_or_doubled(tmp_path):
    output = tmp_path / "kept.npz"
    pool = ProcessPoolExecutor(2, mp_context=get_context("spawn"))
    with pool:
        found = sweep(partial(dies_once, tmp_path), range(40), pool, output)
    assert (tmp_path / "died").exists()
    assert found.tolist() == [case * case for case in range(40)]
    with np.load(output) as kept:
        assert kept["index"].tolist() == list(range(40))
        assert kept["result"].tolist() == found.tolist()


def test_a_case_that_ends_its_process_each_time_is_named(tmp_path):
    output = tmp_path / "kept.npz"
    with pytest.raises(Unfinished, match="1 of 12 cases ended their process each time, the first is case 7 = 7"):
        sweep(dies_at_seven, range(12), None, output)
    with np.load(output) as kept:
        assert kept["index"].tolist() == [case for case in range(12) if case != 7]


@pytest.mark.parametrize("keep", [0, 1, 100, -1])
def test_a_damaged_file_of_results_is_refused_by_name(keep, tmp_path):
    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, [1.0, 2.0], pool, output)
    output.write_bytes(output.read_bytes()[:keep])
    with pytest.raises(InputError, match="is not a file of results"):
        sweep(abs, [1.0, 2.0], None, output)


def times(k):
    def inner(x):
        return k * x

    return inner


def with_default(k):
    def inner(x, k=k):
        return k * x

    return inner


class Scaled:
    def __init__(self, k):
        self.k = k

    def method(self, x):
        return self.k * x

    def __call__(self, x):
        return self.k * x


def edited(body):
    """The function of a module before and after it was edited."""
    space = {"__name__": "somewhere"}
    exec(f"def helper(x):\n    return {body}\ndef inner(x):\n    return helper(x)", space)
    return space["inner"]


PAIRS = {
    "closures": (times(1), times(10), [1.0, 2.0], [1.0, 2.0]),
    "defaults": (with_default(1), with_default(10), [1.0, 2.0], [1.0, 2.0]),
    "lambdas": (lambda x: x, lambda x: 10 * x, [1.0, 2.0], [1.0, 2.0]),
    "methods": (Scaled(1).method, Scaled(10).method, [1.0, 2.0], [1.0, 2.0]),
    "objects": (Scaled(1), Scaled(10), [1.0, 2.0], [1.0, 2.0]),
    "edited": (edited("x"), edited("10*x"), [1.0, 2.0], [1.0, 2.0]),
    "names": (abs, np.sqrt, [1.0, 4.0], [1.0, 4.0]),
    "partial arguments": (partial(np.dot, np.arange(2000.0)), partial(np.dot, np.r_[0:1000.0, 7, 1001:2000.0]),
                          [1.0], [1.0]),
    "dtypes": (np.sum, np.sum, [np.array([1, 0])], [np.array([1, 0]).view("f8")]),
    "shapes": (np.sum, np.sum, [np.zeros((2, 3))], [np.zeros((3, 2))]),
    "long arrays in a case": (len, len, [(np.zeros(2000), 1)], [(np.r_[np.zeros(1000), 1, np.zeros(999)], 1)]),
    "one array and two": (np.size, np.size, [np.frombuffer(b"a\0b", "u1")],
                          [np.frombuffer(b"a", "u1"), np.frombuffer(b"b", "u1")]),
    "numbers of another kind": (float, float, [1], [1.0]),
}  # fmt: skip


@pytest.mark.parametrize("name", PAIRS)
def test_results_of_another_function_or_of_other_cases_are_not_taken_up(name, tmp_path):
    first, second, cases, others = PAIRS[name]
    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool:
        kept = sweep(first, cases, pool, output)
        assert np.array_equal(sweep(first, cases, pool, output), kept)
        with pytest.raises(InputError, match="another function"):
            sweep(second, others, pool, output)


def test_equal_functions_made_anew_take_up_the_file(tmp_path):
    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool:
        for _ in range(2):
            assert sweep(times(3), [1.0, 2.0], pool, output).tolist() == [3, 6]
            model = linear(2, "0.3", "0.5")
            sweep(partial(_landed, model), [0.1, 0.2], pool, tmp_path / "other.npz")


def _landed(model, v):
    return float(model.impact_map(0.3, v).tau)


def test_another_version_does_not_take_up_the_file(tmp_path, monkeypatch):
    import singimpact

    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool:
        sweep(times(3), [1.0], pool, output)
        monkeypatch.setattr(singimpact, "__version__", "99")
        with pytest.raises(InputError, match="version"):
            sweep(times(3), [1.0], pool, output)


def test_what_has_no_key_is_refused_with_the_way_out(tmp_path):
    import threading

    lock = threading.Lock()
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match="leave output= out"):
        sweep(lambda x: (lock, x)[1], [1.0], pool, tmp_path / "kept.npz")
    with ThreadPoolExecutor(1) as pool:
        assert sweep(lambda x: (lock, x)[1], [1.0], pool).tolist() == [1.0]


def plain_array():
    import io

    stream = io.BytesIO()
    np.save(stream, np.arange(3))
    return stream.getvalue()


@pytest.mark.parametrize(
    "made",
    [lambda path, _: path.write_bytes(plain_array()),
     lambda path, key: np.savez(path, key=key, index=np.array(3), result=np.arange(1)),
     lambda path, key: np.savez(path, key=key, index=np.array([0]), result=np.array(3)),
     lambda path, key: np.savez(path, key=key, index=np.zeros((1, 2), int), result=np.arange(1)),
     lambda path, key: np.savez(path, key=key, index=np.array([0]), result=np.array(["a"])),
     lambda path, key: np.savez(path, key=key, index=np.array([0, 1]), result=np.arange(3))],
)  # fmt: skip
def test_files_of_another_make_are_refused(made, tmp_path):
    output = tmp_path / "kept.npz"
    made(output, np.array(key(abs, [1.0, 2.0])))
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match="is not a file of results"):
        sweep(abs, [1.0, 2.0], pool, output)


class Deaths:
    """Stands for pools: a portion that holds a bad case loses its worker, so many times."""

    def __init__(self, times):
        self.left = dict(times)

    def __call__(self, function, items, part, _pool, kept, _line):
        from concurrent.futures import BrokenExecutor

        for index in part:
            if self.left.get(index, 0):
                self.left[index] -= 1
                raise BrokenExecutor
            kept.results[index] = function(items[index])


@pytest.mark.parametrize(("bad", "guilty"), [({3: 99}, [3]), ({3: 1}, []), ({0: 99, 1: 99}, [0, 1]), ({4: 99}, [4])])
@pytest.mark.parametrize("count", [2, 5, 7])
def test_the_case_that_kills_its_worker_is_found_and_no_other(bad, guilty, count, monkeypatch):
    from contextlib import nullcontext
    from types import SimpleNamespace

    from singimpact import cases

    monkeypatch.setattr(cases, "_run", Deaths(bad))
    monkeypatch.setattr(cases, "_executor", lambda *_: nullcontext())
    kept = SimpleNamespace(results={})
    found = cases._one_by_one(abs, list(range(count)), list(range(count)), kept, None)
    assert sorted(found) == [index for index in guilty if index < count]
    assert sorted(kept.results) == [index for index in range(count) if index not in found]


def test_of_a_worker_that_is_killed_once_no_case_is_guilty(monkeypatch):
    from contextlib import nullcontext
    from types import SimpleNamespace

    from singimpact import cases

    monkeypatch.setattr(cases, "_run", Deaths({0: 1}))
    monkeypatch.setattr(cases, "_executor", lambda *_: nullcontext())
    assert cases._one_by_one(abs, [5], [0], SimpleNamespace(results={}), None) == []


def test_results_beyond_the_cases_are_left_out(tmp_path):
    output = tmp_path / "kept.npz"
    np.savez(output, key=np.array(key(abs, [1.0])), index=np.array([0, 7]), result=np.array([5.0, 6.0]))
    with ThreadPoolExecutor(1) as pool:
        assert sweep(abs, [1.0], pool, output).tolist() == [5.0]
    assert cases_kept(output) == {0: 5.0}


def cases_kept(path):
    from singimpact.cases import _Kept

    return _Kept(path, key(abs, [1.0]), 1).results


@pytest.mark.parametrize("count", [400, 1600])
def test_a_file_is_written_as_often_as_its_results_grow_by_a_quarter(count, tmp_path, monkeypatch):
    """Portions of one case: all writes together put down a few times the results, not half their square."""
    from singimpact import cases

    rows = []
    true = np.savez
    monkeypatch.setattr(cases, "PORTIONS", cases.PoolSettings(each=count))
    monkeypatch.setattr(cases, "KEEPING", cases.KeepingSettings(share=0.0))
    monkeypatch.setattr(np, "savez", lambda stream, **parts: (rows.append(len(parts["index"])), true(stream, **parts)))
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, range(count), pool, tmp_path / "kept.npz")
    assert rows[0] == 1
    assert rows[-1] == count
    assert sum(rows) < 6 * count


def test_slow_cases_are_written_as_they_come(tmp_path):
    import time

    output, seen = tmp_path / "kept.npz", []

    def slow(case):
        if output.exists():
            with np.load(output) as kept:
                seen.append(len(kept["index"]))
        time.sleep(0.1)
        return case

    with ThreadPoolExecutor(1) as pool:
        sweep(slow, range(12), pool, output)
    assert max(seen) >= 9


def test_an_error_writes_what_there_is(tmp_path, monkeypatch):
    from singimpact import cases

    monkeypatch.setattr(cases, "KEEPING", cases.KeepingSettings(grown=1e9, share=0.0))
    CALLS.clear()
    output = tmp_path / "kept.npz"
    with pytest.raises(KeyboardInterrupt), ThreadPoolExecutor(1) as pool:
        sweep(fails_late, range(20), pool, output)
    with np.load(output) as kept:
        assert len(kept["index"]) >= 16
