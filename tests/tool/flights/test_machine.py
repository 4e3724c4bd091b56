"""Compiled entries: kept as object code, the same numbers as interpreted ones, never needed to get an answer."""

from __future__ import annotations

import gc
import os
import re
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import singimpact as si
from singimpact import store
from singimpact.codegen import object_code
from singimpact.flights import (
    FOLLOW,
    HITS,
    ITERATE,
    JUDGE,
    LAW,
    MODULES,
    PREPARE,
    PREPARE_BATCH,
    RELEASES,
    SEGMENT,
    VARIATIONS,
    Allowance,
    CompiledModel,
    Emitted,
    KernelCompiler,
    constants,
    counted,
    interruptible,
    machine,
    shipped_code,
)
from singimpact.flights.compiled_model import compiled_model

MODELS = {
    "linear": si.linear("2.8", 0, "0.8"),
    "two waves, damped": si.ImpactOscillator("x + xdot/5", "cos(2*t) + sin(3*t)/9", "0.3", "0.6"),
    "constant": si.ImpactOscillator("0", "-2", 0, "0.9"),
    "a law": si.linear("2.8", 0, "-0.8*v - 0.1*(-v)**1.5"),
    "duffing": si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6"),
    "between walls": si.ImpactOscillator("x + x**3", "3*cos(1.7*t)", "-0.5", "0.6", upper="0.4"),
}


@pytest.fixture(scope="module")
def compiled():
    """Models whose entries are compiled in this process."""
    for model in MODELS.values():
        flown = compiled_model(model)
        for name in flown.machine.emitted.entries[:2]:
            flown.machine.compile_here(name)
        for text in (*flown.laws, *flown.recurrences):
            text.compile_here()
    return MODELS


def interpreted(model):
    """A compiled model that finds no entry."""
    flown = CompiledModel(model, Allowance(compiled_model(model).allowance.horizon))
    flown.machine = Never(flown.machine.emitted)
    return flown


class Never(machine.Machine):
    def entry(self, name):  # noqa: ARG002
        return None

    def interpreted(self, seconds, name):
        pass


@pytest.mark.parametrize("name", MODELS)
def test_interpreted_and_compiled_flights_agree(name, compiled):
    model, rng = compiled[name], np.random.default_rng(5)
    tau, v = rng.uniform(0, 3, 60), 10 ** rng.uniform(-6, 0.3, 60)
    fast, slow = compiled_model(model), interpreted(model)
    codes, rows = fast.hits(tau, v)
    plain_codes, plain_rows = slow.hits(tau, v)
    assert np.array_equal(codes == 0, np.isin(plain_codes, (0, 30)))
    assert np.allclose(rows[:2], plain_rows[:2], rtol=1e-12, equal_nan=True)
    assert np.allclose(fast.variations(tau, v, rows[0]), slow.variations(tau, v, rows[0]), rtol=1e-9, atol=1e-12)
    ends, slow_ends = fast.iterate(tau[:8], v[:8], 2), slow.iterate(tau[:8], v[:8], 2)
    assert np.array_equal(ends[2], slow_ends[2])
    assert np.allclose(ends[0], slow_ends[0], rtol=1e-9)
    out, code = fast.segment(float(tau[0]), float(v[0]), 5)
    plain_out, plain_code = slow.segment(float(tau[0]), float(v[0]), 5)
    assert code == plain_code
    assert np.allclose(out[:, :5], plain_out[:, :5], rtol=1e-9)
    if not fast.linear:
        ones = np.ones(tau.size)
        assert np.allclose(fast.judged(tau, v, ones)[:4], slow.judged(tau, v, ones)[:4], rtol=1e-9)
        times = np.linspace(0.1, 2, 5)
        assert np.allclose(fast.follow(0.3, 0.5, times), slow.follow(0.3, 0.5, times), rtol=1e-12)


@pytest.mark.parametrize("name", MODELS)
def test_one_state_is_an_array_of_one(name, compiled):
    model, rng = compiled[name], np.random.default_rng(6)
    tau, v = rng.uniform(-5, 5, 40), 10 ** rng.uniform(-6, 0.3, 40)
    many = model.impact_map(tau, v)
    for index, (at, speed) in enumerate(zip(tau.tolist(), v.tolist(), strict=True)):
        one = model.impact_map(at, speed)
        assert (one.tau, one.v, one.status) == (many.tau[index], many.v[index], many.status[index])
        assert one.condition == pytest.approx(many.condition[index], rel=1e-14)
        assert one.error == pytest.approx(many.error[index], rel=1e-12)


@pytest.fixture
def often():
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def in_threads(work, count=8):
    """The results of a function of the number of its thread."""
    found = [None] * count

    def run(at):
        found[at] = work(at)

    threads = [threading.Thread(target=run, args=(at,)) for at in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    return found


@pytest.mark.usefixtures("often")
def test_threads_that_fly_one_state_a_call_do_not_meet(compiled):
    model, rng = compiled["linear"], np.random.default_rng(7)
    states = list(zip(rng.uniform(0, 2, 200).tolist(), rng.uniform(0.05, 2, 200).tolist(), strict=True))

    def ends(_):
        return [(step.tau, step.v) for _ in range(10) for step in (model.impact_map(*state) for state in states)]

    assert in_threads(ends) == [ends(0)] * 8


@pytest.mark.usefixtures("compiled")
def test_tables_are_filled_beside_those_that_other_threads_fly_through(monkeypatch):
    model = CompiledModel(MODELS["linear"], compiled_model(MODELS["linear"]).allowance)
    called, kinds = CompiledModel._call, []

    def watched(self, entry, job, *given, **more):
        before = self.flat.copy()
        result = called(self, entry, job, *given, **more)
        assert np.array_equal(self.flat, before)
        kinds.append(job[0])
        return result

    monkeypatch.setattr(CompiledModel, "_call", watched)
    model.hits(np.array([0.3]), np.array([0.5]))
    model.iterate(np.full(8, 0.3), np.full(8, 0.5), 1)
    assert {PREPARE, PREPARE_BATCH} <= set(kinds)


def test_what_is_read_later_does_not_follow_the_caller_s_arrays(compiled):
    tau, v = np.array([0.3, 0.7]), np.array([0.5, 1.1])
    want = compiled["duffing"].impact_map(tau.copy(), v.copy()).condition
    step = compiled["duffing"].impact_map(tau, v)
    tau[:], v[:] = 1.9, 0.01
    assert np.array_equal(step.condition, want)


def test_a_rebound_law_may_have_any_number_of_constants():
    law = "-v*(1/2 + v**2/101 + v**4/1007 + v**6/10007 + v**8/100003 + v**10/1000003)/(1 + v**2/103 + v**4/1009)"
    osc = si.linear(2, 0, law)
    step = osc.impact_map(0.3, 0.7)
    speed = abs(step.velocity)
    want = speed * (0.5 + speed**2 / 101 + speed**4 / 1007 + speed**6 / 10007) / (1 + speed**2 / 103 + speed**4 / 1009)
    assert step.v == pytest.approx(want, rel=1e-4)
    assert osc.orbit(0.3, 0.7, 3).v[1] == pytest.approx(step.v, rel=1e-12)


def test_a_law_costs_its_models_no_kernels(compiled):
    flown = compiled_model(compiled["a law"])
    assert flown.machine is compiled_model(compiled["linear"]).machine
    assert flown.laws[0].machine.emitted.entries == (LAW,)
    flown.segment(0.3, 0.7, 3)
    assert flown.rho[-1] > 1
    without = interpreted(compiled["a law"])
    without.laws[:] = [machine.Called(Never(without.laws[0].machine.emitted), without.rho)]
    rows, _ = flown.segment(0.3, 0.7, 20)
    plain, _ = without.segment(0.3, 0.7, 20)
    assert without.rho[-1] == 1
    assert np.allclose(rows[:, :5], plain[:, :5], rtol=1e-9)


def test_one_state_with_a_law_of_its_own_is_flown_once(compiled):
    with counted() as count:
        compiled["linear"].replace(restitution="-0.8*v").impact_map(0.3, 0.7)
    assert count.flights == 1


@pytest.fixture(scope="module")
def whole_entry(tmp_path_factory):
    """An entry of the kernels as a cache has it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SINGIMPACT_CACHE", str(tmp_path_factory.mktemp("cache")))
        place = machine.Machine(Emitted()).place("linear_entry")
        machine.cache.keep(place, shipped_code("linear_entry"))
        return place.read_bytes()


@pytest.fixture
def nothing_shipped(monkeypatch):
    """No object code of the kernels comes with the package."""
    monkeypatch.setattr(machine, "shipped_code", lambda _: None)


@pytest.fixture
def other(tmp_path, monkeypatch, compiled, whole_entry, nothing_shipped):  # noqa: ARG001
    """A machine without entries, in a cache of its own; in this process nothing compiles."""
    emitted = compiled_model(compiled["linear"]).machine.emitted
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(object_code, "emitted", lambda *_: pytest.fail("compiled here"))
    other = machine.Machine(emitted)
    store.folder(other.place("linear_entry").parent)
    return other


def test_kernels_without_object_code_are_compiled_when_their_flights_have_cost_as_much(other, monkeypatch, capsys):
    monkeypatch.setattr(machine, "SETTINGS", replace(machine.SETTINGS, silent=0.0))
    calls = []
    monkeypatch.setattr(
        machine.Machine, "_code", lambda _, name: calls.append(name) or time.sleep(0.2) or shipped_code(name)
    )
    for seconds in (10.0, 19.0):
        other.interpreted(seconds, "linear_entry")
        assert other.entry("linear_entry") is None
    other.interpreted(2.0, "linear_entry")
    assert other.entry("linear_entry")
    assert other.place("linear_entry").is_file()
    assert "compiled, in about 30 s, once a cache: there is no object code of the kernels" in capsys.readouterr().err
    other.compile_here("linear_entry")
    machine.Machine(other.emitted).compile_here("linear_entry")
    assert calls == ["linear_entry"]


def test_linear_models_share_their_machine():
    assert compiled_model(si.linear(2, 0, 1)).machine is compiled_model(MODELS["linear"]).machine
    assert compiled_model(si.linear(2, 0, "-0.8*v + v**2/10")).machine is compiled_model(MODELS["linear"]).machine
    assert compiled_model(MODELS["duffing"]).machine is not compiled_model(MODELS["linear"]).machine


def test_models_in_taylor_steps_share_their_kernels(compiled):
    """One has its own recurrence, which kernels call."""
    duffing, other = compiled["duffing"], si.ImpactOscillator("sin(x)", "cos(2*t)", "0.3", "0.6")
    assert compiled_model(duffing).machine is compiled_model(other).machine
    assert compiled_model(duffing).recurrences[0].machine is not compiled_model(other).recurrences[0].machine
    compiled_model(other).recurrences[0].compile_here()
    assert compiled_model(other).flat[-1] > 1
    tau, v = np.linspace(0, 3, 40), np.linspace(0.01, 1, 40)
    kept = interpreted(other)
    assert np.allclose(compiled_model(other).hits(tau, v)[1][:2], kept.hits(tau, v)[1][:2], rtol=1e-12, equal_nan=True)


def test_a_name_means_one_thing_in_all_kernels():
    found = {}
    for module in MODULES:
        for name, part in vars(module).items():
            if callable(part) and getattr(part, "__module__", "") == module.__name__:
                assert found.setdefault(name, part) is part, name
    assert constants()["LANES"] == 64


@pytest.mark.usefixtures("compiled")
def test_object_code_leaves_other_compiled_code_of_the_process_alone():
    """It defines what it never calls inside itself; a loader's symbols would serve numba's code too."""
    import numba

    @numba.njit
    def checked(x):
        if x < 0:
            raise ValueError("negative")
        return x

    assert checked(1.0) == 1.0
    with pytest.raises(ValueError, match="negative"):
        checked(-1.0)


def test_declarations_for_exceptions_end_the_process():
    text = (
        "declare i32 @PyErr_Clear(i8* nocapture) #1\n@PyExc_Error = external global i8\ndeclare double @exp(double)\n"
    )
    closed = object_code._closed(text)
    assert "define internal i32 @PyErr_Clear(i8* nocapture) #1 {\n  call void @abort()" in closed
    assert "@PyExc_Error = internal global i8 0" in closed
    assert "declare double @exp(double)" in closed


FLY = """
import sys, time, numpy as np, singimpact as si
from singimpact.flights.compiled_model import compiled_model
osc = si.linear("2.8", 0, "0.8")
first = osc.impact_map(0.9, 0.005)
rng = np.random.default_rng(0)
end = time.monotonic() + float(sys.argv[1])
while True:
    step = osc.impact_map(rng.uniform(0, 3, 50), rng.uniform(0.1, 2, 50))
    there = compiled_model(osc).machine.entry("linear_entry") is not None
    if there or time.monotonic() > end:
        break
print(first.tau, there, "numba" in sys.modules)
"""


def flown(place, seconds, **around):
    environment = {**os.environ, "SINGIMPACT_CACHE": str(place), **around}
    command = [sys.executable, "-c", FLY, str(seconds)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()


def test_the_first_call_in_a_new_cache_is_compiled_and_needs_no_numba(tmp_path):
    assert flown(tmp_path, 0)[1:] == ["True", "False"]
    assert not list(tmp_path.rglob("*.o"))


@pytest.mark.parametrize("around", [{"NUMBA_DISABLE_JIT": "1"}, {"SINGIMPACT_CACHE": "off"}])
def test_without_compiled_entries_flights_are_interpreted(around, tmp_path):
    answer = flown(tmp_path, 0, **around)
    assert float(answer[0]) == pytest.approx(float(MODELS["linear"].impact_map(0.9, 0.005).tau), rel=1e-14)
    assert answer[2] == "False"


def test_cache_off_is_a_passing_folder(monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", "off")
    assert store.cache_folder() == store.passing_folder()


@pytest.mark.usefixtures("nothing_shipped")
def test_damaged_object_code_is_named_and_not_run(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    other = machine.Machine(Emitted())
    code = b"no machine code"
    machine.cache.keep(other.place("linear_entry"), code)
    place = other.place("linear_entry")
    place.write_bytes(place.read_bytes()[:-1] + b"E")
    assert other.entry("linear_entry") is None
    assert str(place) in capsys.readouterr().err


@pytest.mark.parametrize("stub", ["empty", "another entry", "no function", "cut"])
def test_a_sealed_entry_that_is_not_the_one_is_never_called(stub, other, whole_entry, capsys):
    """An address of 0 would be called, and end the process."""
    import llvmlite.binding as llvm

    place = other.place("linear_entry")
    code = machine.cache.unsealed(place, whole_entry)
    if stub == "another entry":
        machine.cache.keep(other.place("batch_entry"), code)
        os.rename(other.place("batch_entry"), place)
    elif stub == "no function":
        text = f'target triple = "{llvm.get_process_triple()}"\ndefine i64 @other() {{ ret i64 1 }}'
        machine.cache.keep(place, object_code._machine().emit_object(llvm.parse_assembly(text)))
    else:
        machine.cache.keep(place, {"empty": b"", "cut": code[:40]}[stub])
    assert other.entry("linear_entry") is None
    assert str(place) in capsys.readouterr().err
    assert not place.exists()
    machine.cache.keep(place, code)
    other._looked.clear()
    assert other.entry("linear_entry") is not None


def test_the_name_of_an_entry_depends_on_the_settings_of_the_compiler(monkeypatch):
    def name():
        machine._digest_of_sources.cache_clear()
        return machine.Machine(Emitted()).digest

    try:
        before = name()
        monkeypatch.setenv("NUMBA_NUM_THREADS", "1")  # changes no code
        assert name() == before
        monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
        assert name() != before
    finally:
        monkeypatch.undo()
        machine._digest_of_sources.cache_clear()


@pytest.mark.slow
def test_kernels_have_one_object_code_whatever_level_numba_is_set_to(monkeypatch):
    """In the process that compiles, and in one that compiles by itself."""
    import numba

    texts = []
    for level in (0, 3):
        monkeypatch.setattr(numba.config, "OPT", type(numba.config.OPT)(level))
        text = KernelCompiler(True).text("taylor_entry")
        assert level == numba.config.OPT
        texts.append(Counter(re.findall(r"(?m)^ +(?:%\S+ = )?(\w+)", text)))  # instructions, without names
    assert texts[0] == texts[1]


OWN_LAW = "def law(v, w):\n    return w[0] * v + {} * v\n"


def test_a_text_of_a_model_is_compiled_once_its_flights_have_cost_as_much(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    own = machine.Machine(Emitted(rho=OWN_LAW.format(1.25)))
    own.interpreted(own.price / 2, LAW)
    assert own.entry(LAW) is None
    own.interpreted(own.price, LAW)
    assert own.entry(LAW)[1] is not None
    assert [path.name for path in tmp_path.rglob("*.o")] == [own.place(LAW).name]
    assert capsys.readouterr().err == ""  # a line comes after a second
    assert machine.Machine(own.emitted).entry(LAW) is not None  # from the cache


def test_derivatives_cost_more_than_flights_so_their_text_is_compiled_sooner(tmp_path, monkeypatch):
    """About as soon as their interpreted code has taken the time of compiling: 35 ms a derivative, 300 ms."""
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    osc = si.ImpactOscillator("x + 0.3*x**3 + 0.2*tanh(20*xdot) + sin(x)/7", "cos(1.7*t)", "0.1", "0.8")
    text = compiled_model(osc).recurrences[0]
    assert not text.is_bound()
    calls = 0
    while not text.is_bound() and calls < 200:
        osc.derivative(0.3 + calls / 100, 0.5)
        calls += 1
    assert 3 <= calls <= 20


def test_a_text_that_takes_longer_says_so_and_threads_compile_it_once(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    monkeypatch.setattr(machine, "SETTINGS", replace(machine.SETTINGS, silent=0.0))
    own = machine.Machine(Emitted(rho=OWN_LAW.format(1.5)))
    codes, write = [], own._code
    monkeypatch.setattr(own, "_code", lambda name: codes.append(name) or time.sleep(0.2) or write(name))
    entries = in_threads(lambda _: own.compile_here(LAW))
    assert codes == [LAW]
    assert len({id(entry) for entry in entries}) == 1
    assert "characters of code" in capsys.readouterr().err


def test_a_text_that_cannot_be_compiled_raises_its_reason(tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    with pytest.raises(ValueError, match="nothing_known"):
        machine.Machine(Emitted(rho="def law(v, w):\n    return nothing_known(v)\n")).compile_here(LAW)


def test_the_kinds_of_work_are_told_apart():
    kinds = (PREPARE, PREPARE_BATCH, HITS, SEGMENT, ITERATE,
             VARIATIONS, FOLLOW, JUDGE, RELEASES)  # fmt: skip
    assert len(set(kinds)) == len(kinds)


def test_an_interrupted_call_has_the_numbers_of_its_model_to_its_end(compiled, monkeypatch):
    """The code reads them at an address, whatever the caller lets go of."""
    osc, goes_on = compiled["duffing"], threading.Event()
    model = CompiledModel(osc, compiled_model(osc).allowance)
    numbers = weakref.ref(model.flat)

    class Interrupted(threading.Thread):
        def join(self, timeout=None):
            if timeout is not None:
                raise KeyboardInterrupt

    monkeypatch.setattr(interruptible, "Thread", Interrupted)
    model._seconds.clear()
    model._guess = 1.0
    with pytest.raises(KeyboardInterrupt):
        model._timed(lambda *_: goes_on.wait() or 0, (model._sizes,), 10**6, ())
    (late,) = [thread for thread in threading.enumerate() if thread.name == interruptible.NAME]
    del model
    gc.collect()
    assert numbers() is not None
    goes_on.set()
    while late.is_alive():
        time.sleep(0.01)
    del late
    gc.collect()
    assert numbers() is None


@pytest.mark.parametrize("name", ["duffing", "between walls"])
def test_long_calls_hear_an_interruption(compiled, monkeypatch, name):
    """Ctrl-C comes when another thread makes the call, and the main one waits for it."""
    osc = compiled[name]
    osc.iterate(0.3, 0.5, 100)
    begun = threading.Event()

    def interrupts():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    class Watched(threading.Thread):
        def start(self):
            super().start()
            begun.set()

    monkeypatch.setattr(interruptible, "Thread", Watched)
    compiled_model(osc)._seconds.clear()  # the call is expected to be long, however fast the last ones were
    monkeypatch.setattr(compiled_model(osc), "_guess", 1.0)
    interrupting = threading.Thread(target=interrupts)
    interrupting.start()
    with pytest.raises(KeyboardInterrupt):
        osc.iterate(0.3, 0.5, 1_000_000)
    interrupting.join()
    late = [thread for thread in threading.enumerate() if thread.name == interruptible.NAME]
    assert late  # the call itself has not ended
    for thread in late:
        thread.join()
    # what the interrupted call wrote into is not lent again
    again = osc.iterate(0.3, 0.5, 100)
    assert again == osc.iterate(0.3, 0.5, 100)
