"""Sweeps on any executor, kept and resumed."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context

import numpy as np
import pytest

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
    from singimpact.codegen.kernels import compiled

    for omega in (1.1, 1.7):
        linear(omega, 0.1, 0.5).impact_map(0.2, 0.3)
    before = compiled.cache_info().misses
    for omega in np.linspace(1, 3, 7):
        linear(float(omega), 0.2, 0.7, damping=0.01).impact_map(0.2, 0.3)
    assert compiled.cache_info().misses == before


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
