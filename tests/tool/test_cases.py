"""Sweeps on any executor, kept and resumed."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
import zlib
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from singimpact import cases
from singimpact.case_files import HEAD, InMemory, Journal, NpzFile, Record
from singimpact.case_keys import cases_key, function_key
from singimpact.case_pools import Place, computed
from singimpact.cases import POOL, _Source, _Work, sweep
from singimpact.impact_oscillator import linear
from singimpact.inputs import InputError, Unfinished
from singimpact.progress import ProgressLine


class Log(list):
    """A list that is pickled by its name, so that what was logged is not part of a key."""

    def __reduce_ex__(self, _protocol):
        return "CALLS"


CALLS = Log()


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
    from singimpact.flights import machine_of

    for omega in (1.1, 1.7):
        linear(omega, 0.1, 0.5).impact_map(0.2, 0.3)
    before = machine_of.cache_info().misses
    for omega in np.linspace(1, 3, 7):
        linear(float(omega), 0.2, 0.7, damping=0.01).impact_map(0.2, 0.3)
    assert machine_of.cache_info().misses == before


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


@pytest.mark.slow
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


@pytest.mark.plain_code
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


def archive(path, key, chunks, result):
    """A file of results with one chunk of cases."""
    digest = list(bytes.fromhex(cases_key([1.0])))
    np.savez(path, key=key, chunks=chunks, result=result, cases=np.array([digest] * len(chunks), np.uint8))


def plain_array():
    import io

    stream = io.BytesIO()
    np.save(stream, np.arange(3))
    return stream.getvalue()


@pytest.mark.parametrize(
    "made",
    [lambda path, _: path.write_bytes(plain_array()),
     lambda path, key: np.savez(path, key=key, index=np.arange(1), result=np.arange(1)),
     lambda path, key: archive(path, key, np.array([0, 1]), np.arange(1)),
     lambda path, key: archive(path, key, np.array([[0, 1]]), np.array(3)),
     lambda path, key: archive(path, key, np.array([[0, 0]]), np.zeros(0)),
     lambda path, key: archive(path, key, np.array([[0, 1]]), np.array(["a"])),
     lambda path, key: archive(path, key, np.array([[0, 2]]), np.arange(3)),
     lambda path, key: archive(path, key, np.array([[-3, 2]]), np.arange(2)),
     lambda path, key: archive(path, key, np.array([[0, 2], [1, 2]]), np.arange(4))],
)  # fmt: skip
def test_files_of_another_make_are_refused(made, tmp_path):
    output = tmp_path / "kept.npz"
    made(output, np.array(function_key(abs)))
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match="is not a file of results"):
        sweep(abs, [1.0, 2.0], pool, output)


@pytest.mark.parametrize(("bad", "guilty"), [({3: 99}, [3]), ({3: 1}, []), ({0: 99, 1: 99}, [0, 1]), ({4: 99}, [4])])
@pytest.mark.parametrize("count", [2, 5, 7])
def test_the_case_that_kills_its_worker_is_found_and_no_other(bad, guilty, count):
    """Stands for pools: a chunk that holds a bad case loses its worker, so many times."""
    left = dict(bad)

    class Pool(Place):
        replaceable = True

        def __init__(self):
            pass

        width = 2

        def submit(self, function, items, seconds):
            done = Future()
            for item in items:
                if left.get(item, 0):
                    left[item] -= 1
                    done.set_exception(BrokenExecutor())
                    return done
            done.set_result(computed(function, items, seconds))
            return done

    store = InMemory()
    work = _Work(abs, _Source(range(count), store), store, ProgressLine(), count, size=count)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cases, "place_of", lambda *_: Pool())
        work.run(None)
    assert sorted(number for number, _ in work.fatal) == [index for index in guilty if index < count]
    assert store.done == count - len(work.fatal)


def test_fewer_cases_than_results_are_refused(tmp_path):
    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, [1.0, 2.0], pool, output)
        with pytest.raises(InputError, match="other cases"):
            sweep(abs, [1.0], pool, output)


@pytest.mark.parametrize("name", ["kept.npz", "kept.zarr"])
def test_longer_cases_are_continued(name, tmp_path):
    require(name)
    output = tmp_path / name
    with ThreadPoolExecutor(1) as pool:
        sweep(fails_late, range(5), pool, output)
        CALLS.clear()
        found = sweep(fails_late, (n for n in range(12)), pool, output)
    assert found[:].tolist() == list(range(12))
    assert sorted(CALLS) == list(range(5, 12))
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_store_that_is_continued_and_interrupted_again_loses_nothing(tmp_path):
    require("kept.zarr")
    output = tmp_path / "kept.zarr"
    with ThreadPoolExecutor(1) as pool:
        sweep(fails_late, range(5), pool, output)
        CALLS.clear()
        with pytest.raises(KeyboardInterrupt):
            sweep(fails_late, range(40), pool, output)
        assert [path.name for path in tmp_path.iterdir()] == ["kept.zarr.part"]
        assert min(CALLS) == 5
        CALLS[:] = [None] * 30
        assert sweep(fails_late, range(40), pool, output)[:].tolist() == list(range(40))
    assert min(CALLS[30:]) > 5


@pytest.mark.plain_code
@pytest.mark.parametrize("name", ["kept.npz", "kept.zarr"])
def test_what_was_done_is_not_computed_again(name, tmp_path):
    require(name)
    output = tmp_path / name
    with ThreadPoolExecutor(2) as pool:
        first = sweep(landing, CASES, pool, output)
        CALLS.clear()
        again = sweep(landing, CASES, pool, output)
    assert CALLS == []
    assert np.array_equal(first[:], again[:])
    assert np.array_equal(again[:], [landing(case) for case in CASES])


def require(name):
    if name.endswith(".zarr"):
        pytest.importorskip("zarr", reason="needs zarr, of the extra `cluster`")


KILLED = """
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from test_cases import slow
from singimpact.cases import sweep
with ThreadPoolExecutor(2) as pool:
    sweep(partial(slow, Path(sys.argv[2])), (n for n in range(300)), pool, sys.argv[3])
"""


def slow(log, case):
    import time

    time.sleep(0.01)
    with log.open("a") as stream:
        stream.write(f"{case}\n")
    return [case, 0.5 * case]


@pytest.mark.parametrize("name", ["kept.npz", pytest.param("kept.zarr", marks=pytest.mark.slow)])
def test_a_sweep_that_is_killed_goes_on_where_it_was(name, tmp_path):
    """Nothing that was kept is lost or computed again; beyond that at most a chunk a worker is."""
    require(name)
    log, output = tmp_path / "log", tmp_path / name
    log.touch()
    child = subprocess.Popen([sys.executable, "-c", KILLED, Path(__file__).parent, log, output])
    while len(log.read_text().split()) < 120:
        assert child.poll() is None
        time.sleep(0.01)
    child.send_signal(signal.SIGKILL)
    child.wait()
    assert not output.exists()
    before = set(map(int, log.read_text().split()))
    place = tmp_path / f"{name}.part"
    journal = Journal(place / "journal" if place.is_dir() else place, function_key(partial(slow, log)), output)
    kept = {case for record, _ in journal.read() for case in range(record.start, record.start + record.count)}
    journal.close()
    assert kept <= before
    assert kept
    log.write_text("")
    with ThreadPoolExecutor(2) as pool:
        found = sweep(partial(slow, log), range(300), pool, output)
    assert found[:].tolist() == [[case, 0.5 * case] for case in range(300)]
    assert sorted(map(int, log.read_text().split())) == sorted(set(range(300)) - kept)
    chunk = POOL.seconds / 0.01 + 1
    assert len(before - kept) <= 2 * POOL.ahead * chunk
    assert {path.name for path in tmp_path.iterdir()} == {"log", name}


@pytest.mark.parametrize("cut", [1, 40, 90, 300])
def test_a_journal_that_was_not_written_whole_is_cut_where_it_ends(cut, tmp_path):
    output = tmp_path / "kept.npz"
    journal = Journal(tmp_path / "kept.npz.part", function_key(fails_late), output)
    store = NpzFile(output, function_key(fails_late))
    for start in (0, 4, 8):
        items = list(range(start, start + 4))
        store.add(Record(start, 4, cases_key(items)), np.array(items, dtype=float))
    store.journal.close()
    whole = journal.path.read_bytes()
    journal.path.write_bytes(whole[:-cut])
    CALLS.clear()
    with ThreadPoolExecutor(1) as pool:
        assert sweep(fails_late, range(12), pool, output).tolist() == list(range(12))
    assert sorted(CALLS) in [list(range(first, 12)) for first in (0, 4, 8)]
    assert not journal.path.exists()


STRANGE = [(0, 2, 10**18), (0, 2, 10**30), (10**30, 2, -1), (0, 10**30, 5), (-1, 1, 5)]


@pytest.mark.parametrize("numbers", [*STRANGE, (0, 7, 5)])
def test_a_journal_of_a_stranger_is_cut_or_refused(numbers, tmp_path):
    """Its checksums are right and its lengths are not; a record of the right length has no results."""
    output = tmp_path / "kept.npz"
    start, count, size = numbers
    head = f"{start} {count} {'0' * 64} {size} ".encode()
    content = b"abcde"
    line = head + f"{zlib.crc32(content, zlib.crc32(head)):08x}\n".encode()
    (tmp_path / "kept.npz.part").write_bytes(HEAD + function_key(abs).encode() + b"\n" + line + content)
    with ThreadPoolExecutor(1) as pool:
        if numbers in STRANGE:
            assert sweep(abs, [-1.0, 2.0], pool, output).tolist() == [1, 2]
            return
        with pytest.raises(InputError, match="is damaged"):
            sweep(abs, [-1.0, 2.0], pool, output)


def test_a_changed_byte_in_a_journal_is_not_taken_for_a_result(tmp_path):
    output = tmp_path / "kept.npz"
    store = NpzFile(output, function_key(fails_late))
    store.add(Record(0, 2, cases_key([0, 1])), np.array([0.0, 1.0]))
    store.journal.close()
    place = tmp_path / "kept.npz.part"
    place.write_bytes(place.read_bytes()[:-1] + b"\x7f")
    with ThreadPoolExecutor(1) as pool:
        assert sweep(fails_late, range(2), pool, output).tolist() == [0.0, 1.0]


def test_two_processes_do_not_write_one_output(tmp_path):
    output = tmp_path / "kept.npz"
    store = NpzFile(output, function_key(fails_late))
    store.add(Record(0, 2, cases_key([0, 1])), np.array([0.0, 1.0]))
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match="is being written by another process"):
        sweep(fails_late, range(2), pool, output)
    store.leave()


def test_cases_are_read_as_they_are_needed(monkeypatch):
    """Of a generator, no more than some chunks a worker are in memory."""
    monkeypatch.setattr(cases, "POOL", cases.PoolSettings(most=50))
    done, most = [], []

    def counted():
        for case in range(5000):
            most.append(case - len(done))
            yield case

    with ThreadPoolExecutor(2) as pool:
        found = sweep(lambda case: (done.append(case), case)[1], counted(), pool)
    assert found.tolist() == list(range(5000))
    assert max(most) <= 50 * 2 * POOL.ahead


def test_chunks_end_after_a_time_and_not_after_a_count():
    """Slow cases that follow fast ones: the chunk that was made for fast ones is cut."""
    sizes = []

    class Pool(ThreadPoolExecutor):
        def submit(self, function, *args):
            future = super().submit(function, *args)
            sizes.append(len(future.result()[0]))
            return future

    with Pool(1) as pool:
        sweep(lambda case: time.sleep(0.05 * (case > 400)), range(420), pool)
    assert max(sizes) > 50
    assert max(sizes[-3:]) <= 5


@pytest.mark.slow
def test_memory_holds_a_few_chunks_of_large_results(tmp_path, monkeypatch):
    """Of 160 MB, written to a store, no more than chunks of a megabyte are in memory."""
    require("kept.zarr")
    import tracemalloc

    from singimpact import case_pools

    monkeypatch.setattr(case_pools, "PLACE", case_pools.PlaceSettings(bytes=1 << 20))
    output = tmp_path / "kept.zarr"
    with ThreadPoolExecutor(1) as pool:
        sweep(partial(np.full, 10_000), (float(n) for n in range(10)), pool, output)  # imports are no results
        tracemalloc.start()
        found = sweep(partial(np.full, 10_000), (float(n) for n in range(2000)), pool, output)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert found.shape == (2000, 10_000)
    assert np.array_equal(found[:, 0], np.arange(2000.0))
    assert peak < 30e6


def test_types_of_results_are_kept(tmp_path):
    zarr = pytest.importorskip("zarr", reason="needs zarr, of the extra `cluster`")
    with ThreadPoolExecutor(1) as pool:
        assert sweep(lambda case: case / 2 if case else 0, range(3), pool).tolist() == [0, 0.5, 1]
        with pytest.raises(InputError, match="results of case 1 are float64, those before int64: give one type"):
            sweep(lambda case: case / 2 if case else 0, range(3), pool, tmp_path / "kept.zarr")
        with pytest.raises(InputError, match="function gives results of type <U1, and output= takes numbers"):
            sweep(str, range(3), pool, tmp_path / "text.npz")
        assert sweep(abs, [], pool, tmp_path / "none.zarr").shape == (0,)
        sweep(np.eye, [3, 3], pool, tmp_path / "eyes.zarr")
        with pytest.raises(InputError, match=r"results of case 1 have shape \(4, 4\), those of others \(3, 3\)"):
            sweep(np.eye, [3, 4], pool)
    assert zarr.open_group(tmp_path / "eyes.zarr", mode="r")["result"].shape == (2, 3, 3)


def test_a_store_of_something_else_is_refused(tmp_path):
    pytest.importorskip("zarr", reason="needs zarr, of the extra `cluster`")
    output = tmp_path / "kept.zarr"
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, [1.0, 2.0], pool, output)
        for function, items in ((abs, [1.0, 3.0]), (np.sqrt, [1.0, 2.0]), (abs, [1.0])):
            with pytest.raises(InputError, match="other cases, another function or version"):
                sweep(function, items, pool, output)
        (tmp_path / "other.zarr").mkdir()
        with pytest.raises(InputError, match="is not a store of results"):
            sweep(abs, [1.0], pool, tmp_path / "other.zarr")
        with pytest.raises(InputError, match="cannot be written"):
            sweep(abs, [1.0], pool, tmp_path / "nowhere" / "kept.zarr")


def test_without_zarr_the_refusal_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "zarr", None)
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match="needs zarr, which is not installed: python"):
        sweep(abs, [1.0], pool, tmp_path / "kept.zarr")


def test_an_error_names_its_case_and_writes_what_there_is(tmp_path):
    output = tmp_path / "kept.npz"
    with ThreadPoolExecutor(1) as pool, pytest.raises(ZeroDivisionError) as caught:
        sweep(lambda case: 1 / (case - 30), range(40), pool, output)
    assert caught.value.__notes__[0].startswith("in case 30 = 30 of the sweep of function = ")
    with np.load(output) as kept:
        assert kept["index"].tolist()[:30] == list(range(30))
    assert not (tmp_path / "kept.npz.part").exists()


def test_a_full_disk_ends_a_sweep_in_one_line(tmp_path, monkeypatch):
    import errno
    import io

    class Full(io.BytesIO):
        def flush(self):
            if self.tell():
                raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Journal, "_opened", lambda _: Full())
    with (
        ThreadPoolExecutor(1) as pool,
        pytest.raises(InputError, match=r"cannot be written .No space left on device.: give a place"),
    ):
        sweep(abs, [1.0], pool, tmp_path / "kept.npz")
