"""Arrays shared out among threads: the same bits as in one, an error of any of them, no more than were asked for."""

from __future__ import annotations

import threading

import numpy as np
import pytest

import singimpact as si
from singimpact.flights import Allowance, CompiledModel, on_threads, shared_out, threads_now

MODELS = {
    "linear": si.linear("2.8", 0, "0.8"),
    "linear with a law": si.linear("2.8", 0, "-0.8*v - 0.1*(-v)**1.5"),
    "duffing": si.ImpactOscillator("x + x**3", "cos(1.7*t)", "0.3", "0.6"),
    "parametric": si.ImpactOscillator("(1 + cos(2*t)/5)*x + x**3", "cos(t)", "0.3", "0.6"),
    "without a clock": si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-1.5", "0.8"),
    "between walls": si.linear("2.8", "-0.5", "0.8", upper=("0.4", "-0.7*v + v**2/50")),
    "duffing between walls": si.ImpactOscillator("x + x**3", "3*cos(1.7*t)", "-0.5", "0.6", upper="0.4"),
}


def states(count):
    draw = np.random.default_rng(5)
    return draw.uniform(-5, 5, count), 10 ** draw.uniform(-4, 0.3, count)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("count", [1, 4095, 8192, 8193, 20_011])
def test_any_number_of_threads_has_the_same_bits(name, count):
    model, (tau, v) = MODELS[name], states(count)
    flown = CompiledModel(model, Allowance(10.0))
    for text in (*flown.laws, *flown.recurrences):  # interpreted orbits differ from batches in the last bit
        text.compile_here()
    want, last = model.impact_map(tau, v, threads=1), model.iterate(tau[:500], v[:500], 40, threads=1)
    for threads in (2, 3, None):
        got, end = model.impact_map(tau, v, threads=threads), model.iterate(tau[:500], v[:500], 40, threads=threads)
        for one, other in ((want, got), (last, end)):
            assert np.array_equal(one.tau, other.tau, equal_nan=True)
            assert np.array_equal(one.v, other.v, equal_nan=True)
            assert np.array_equal(one.status, other.status)
        assert np.array_equal(want.error, got.error, equal_nan=True)


@pytest.mark.parametrize("threads", [0, -1, 257, 1.0, "2", True])
def test_what_is_no_number_of_threads_is_refused(threads):
    for call in (MODELS["linear"].impact_map, MODELS["linear"].first_hit, MODELS["linear"].iterate):
        with pytest.raises(si.InputError, match=r"threads = .* a whole number from 1 to 256"):
            call([0.1, 0.2], 0.5, threads=threads)
    assert threads_now() >= 1


def test_slices_make_up_the_whole_and_are_not_too_short():
    for threads, end, least in [(1, 10, 1), (3, 10, 1), (8, 10, 4), (2, 0, 5), (5, 4, 1)]:
        parts = []
        with on_threads(threads):
            shared_out(parts.append, 0, end, least)
        parts.sort(key=lambda part: part.start)
        assert [index for part in parts for index in range(part.start, part.stop)] == list(range(end))
        assert len(parts) <= threads
        assert len(parts) == 1 or min(part.stop - part.start for part in parts) >= least


def test_an_error_of_any_thread_is_raised():
    def work(part):
        if part.stop == 10:
            raise ValueError("the last one")

    with on_threads(3), pytest.raises(ValueError, match="the last one"):
        shared_out(work, 0, 10, 1)


def test_a_call_is_not_heard_by_another_thread():
    seen = []
    with on_threads(1):
        thread = threading.Thread(target=lambda: seen.append(threads_now()))
        thread.start()
        thread.join()
        assert threads_now() == 1
    assert seen == [threads_now()]
