"""`digits=` in threads: the bits of one thread, and the user's precisions as they were."""

import dataclasses
import functools
import gc
import inspect
import os
import pkgutil
import re
import subprocess
import sys
import threading
from importlib import import_module

import flint
import mpmath
import numpy as np
import pytest
import sympy

import singimpact as si
from singimpact import fixed_points, theory
from singimpact.algebra import Remembered, precision
from singimpact.branches import starts

THREADS = 8
FORGETTING = ("singimpact.algebra", "singimpact.contact", "singimpact.theory")
INTERNAL = ("bench", "claims", "cli", "documents", "generated")

LINEAR = si.linear("2.8", 0, "0.8")
WAVES = si.linear(2, "0.3", "1/2", damping="0.1")
CUBIC = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")
BENT = si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.5*v + v**3/10")
CLOSED = si.linear(4, 0, "1/2")
PARAMETRIC = si.ImpactOscillator("(1 + 0.3*cos(2*t))*x + 0.1*xdot + 0.2*x**3", "cos(t)", "0.2", "0.8")
PLASTIC = si.linear("2.8", "0.1", 0)
PAIR = si.linear("2.8", "-0.5", "0.8", upper=("0.5", "0.7"))
CLOCKLESS = si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-1.5", "0.8")


def swans(digits):
    return [point.certified(digits) for point in si.swan_points("x + 3*x**3/10", "cos(2*t)")]


@functools.cache
def crossing():
    """A homoclinic point."""
    return si.homoclinic_points(si.linear("2.8", 0, "0.8").periodic(1, 1)[0], v=1)[0]


def points(digits):
    found = si.tangency_points(WAVES, digits=digits)
    return (
        found.certified(),
        found.certified(digits + 5),
        [(point.certified(digits), point.value(digits)) for point in found],
    )


@functools.cache
def events():
    """The graze and the doubling of a branch."""
    (orbit,) = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45").periodic(1, 1)
    found = si.branch(orbit, "amplitude", (-0.6, -0.3)).events
    return [event for event in found if event.orbit.visible and event.kind in ("graze", "period-doubling")]


def series(name, **more):
    """A series of a model; of gamma and its like also the enclosures."""

    def call(digits):
        found = getattr(theory, name)(order=3, model=WAVES, digits=digits, **more)
        return (found, found.certified(digits)) if hasattr(found, "certified") else found

    return call


# public name -> (calls with a number of digits, the digits)
borders = functools.partial(si.border_orbits, si.linear("2.8", "0.6", "1/2"), between=("0.6", "0.61"), points=3)
CALLS = {
    "ImpactOscillator.impact_map": (
        [lambda d: LINEAR.impact_map("1.2", "0.01", digits=d), lambda d: BENT.impact_map("0.3", "0.7", digits=d),
         lambda d: CUBIC.impact_map("1.2", "0.1", digits=d), lambda d: PARAMETRIC.impact_map("1.2", "0.1", digits=d),
         lambda d: CLOCKLESS.impact_map("1.2", "0.1", digits=d), lambda d: PLASTIC.impact_map("1.2", "0.1", digits=d),
         lambda d: PAIR.impact_map("1.2", ["1.5", "0.1"], digits=d, wall=["l", "u"])],
        (5, 20, 33),
    ),
    "ImpactOscillator.first_hit": ([lambda d: WAVES.first_hit(["0.1", "pi/3"], [0, "1e-30"], digits=d)], (15, 40, 70)),
    "ImpactOscillator.inverse_map": ([lambda d: BENT.inverse_map("1.2", "0.01", digits=d)], (20, 50)),
    "ImpactOscillator.enclosed_impact": (
        [lambda d: CUBIC.enclosed_impact("1.2", "0.1", radii={"v": "1e-6"}, digits=d)], (12, 30),
    ),
    "PeriodicOrbit.certified": ([lambda d: CLOSED.periodic(1, 2)[0].certified(d)], (20,)),
    "Crossing.certified": ([lambda d: crossing().certified(d)], (5,)),
    "Event.certified": ([lambda d: [event.certified(d) for event in events()]], (15, 30)),
    "ImpactOscillator.chatter_limit": (
        [lambda d: WAVES.chatter_limit("1.2", "0.01", digits=d), lambda d: BENT.chatter_limit("1.2", "0.01", digits=d),
         lambda d: PARAMETRIC.chatter_limit("2.5", "0.01", digits=d),
         lambda d: PLASTIC.chatter_limit("1.2", "0.1", digits=d)],
        (12, 30),
    ),
    "theory.grazing_map": (
        [lambda d: theory.grazing_map(3, model=BENT, at="0.25", digits=d).xdot[2],
         lambda d: theory.grazing_map(4, model=si.linear(2, "-0.2", "0.5"), at="0.3", digits=d).xdot[4]],
        (20, 40),
    ),
    "border_orbits": ([lambda d: borders(digits=d)[0].parameter], (20,)),
    "constants": ([lambda d: [constant.value for constant in si.constants("1/2", d)]], (20,)),
    "contact_points": ([lambda d: si.contact_points(si.linear(2, 0, "1/2"), 2, "clearance", digits=d)], (12, 30)),
    "ImpactOscillator.periodic": ([lambda d: CLOSED.periodic(1, 2, digits=d)], (25,)),
    "threshold": ([lambda d: si.threshold(LINEAR, "pi/2.8", digits=d)], (10,)),
    "tangency_points": ([points], (12, 35)),
    "TangencyPoints.certified": ([points], (20,)),
    "TangencyPoint.certified": ([points], (25,)),
    "TangencyPoint.value": ([points], (30,)),
    "SwanPoint.certified": ([swans], (12, 45)),
    "PowerSeries.certified": ([series("gamma")], (15,)),
    "fixed_points.tangency": ([lambda d: fixed_points.tangency("0.7", digits=d)], (20, 50, 79)),
    "fixed_points.swan": ([lambda d: fixed_points.swan("1/3", digits=d)], (15, 60)),
    "fixed_points.multipliers": ([lambda d: fixed_points.multipliers(3, "1/2", digits=d)], (12, 40)),
} | {
    f"theory.{name}": ([series(name, **more)], (12, 40))
    for name, more in {
        "v_c": {"tau": "1.2"}, "gamma": {}, "dynamics_on_gamma": {}, "normal_form": {},
        "fibre": {"tau": "1.2"}, "chatter_limit": {"tau": "1.2"},
    }.items()
}  # fmt: skip
SLOW = ("ImpactOscillator.periodic", "threshold")  # flown by two threads alone
SECONDS = {*SLOW, "Crossing.certified", "Event.certified", "border_orbits", "constants"}  # left to the slow test


def bits(value):
    """A result as nested tuples that are equal only for equal bits."""
    if hasattr(value, "_mpc_"):
        return value._mpc_
    if isinstance(value, sympy.Basic):
        return sympy.srepr(value)
    if hasattr(value, "_mpf_"):
        return value._mpf_
    if isinstance(value, float | np.floating):
        return float(value).hex()
    if isinstance(value, np.ndarray | list | tuple):
        return tuple(bits(part) for part in (value.ravel() if isinstance(value, np.ndarray) else value))
    if isinstance(value, dict):
        return tuple((str(key), bits(part)) for key, part in value.items())
    if hasattr(value, "coefficients"):
        return bits(dict(value.coefficients))
    if dataclasses.is_dataclass(value):
        return tuple(bits(getattr(value, each.name)) for each in dataclasses.fields(value))
    return str(value)


def work(names):
    return [(name, index, d) for name in names for index in range(len(CALLS[name][0])) for d in CALLS[name][1]]


def done(job):
    name, index, digits = job
    return bits(CALLS[name][0][index](digits))


def forget():
    """Empty the caches of numbers, so that threads compute and do not look up."""
    for each in gc.get_objects():
        if type(each) is Remembered:
            each.clear()
        if type(each) is functools._lru_cache_wrapper:
            room = (each.__module__ or "").split(".")[:2]
            if (
                room[0] == "singimpact"
                and room[1:] in (["algebra"], ["contact"], ["theory"])
                and each is not precision._made_context
            ):
                each.cache_clear()


@pytest.fixture(scope="module", autouse=True)
def few_starts():
    """Orbits are sought from few states: with the usual number of them a kernel is compiled, which takes 15 s."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(starts, "SETTINGS", dataclasses.replace(starts.SETTINGS, phases=6, speeds=4, fewer=(6, 4)))
        yield


@pytest.fixture(scope="module")
def alone(few_starts):  # noqa: ARG001
    """The result of a job in one thread, computed once."""
    return functools.cache(done)


@pytest.fixture
def often():
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)


def taking_digits():
    """Names of public functions, and of public methods of any class, with a parameter `digits`."""
    found = set()
    for room, owner in (("", si), ("theory.", theory), ("fixed_points.", fixed_points)):
        # a name that a room loads late stands among its imports for the type checker
        late = re.findall(r"^    from \S+ import (\w+) as \1$", inspect.getsource(owner), re.M)
        found |= {room + name for name in {*dir(owner), *late} if takes_digits(getattr(owner, name), owner)}
    for module in pkgutil.walk_packages(si.__path__, "singimpact."):
        if module.name.split(".")[1] not in (*INTERNAL, "__main__"):
            for _, kind in inspect.getmembers(import_module(module.name), inspect.isclass):
                found |= {f"{kind.__name__}.{name}" for name in public_methods(kind)}
    return found


def takes_digits(each, room):
    """Whether an object of a room is a public function with `digits`; not one of another room that is used there."""
    if not inspect.isfunction(each) or each.__name__.startswith("_") or "." in each.__qualname__:
        return False  # a method that is a function too is tried as a method
    return "digits" in inspect.signature(each).parameters and each.__module__.startswith(
        room.__name__.removesuffix(".__init__"))  # fmt: skip


def public_methods(kind):
    if not kind.__module__.startswith("singimpact.") or kind.__name__.startswith("_"):
        return []
    return [name for name, each in vars(kind).items() if not name.startswith("_") and inspect.isfunction(each)
            and "digits" in inspect.signature(each).parameters]  # fmt: skip


def test_every_public_function_with_digits_is_tried_here():
    assert taking_digits() == set(CALLS)


def in_threads(tasks):
    """The results of lists of jobs, each list in a thread of its own; all must come back."""
    results, errors = [{} for _ in tasks], []

    def run(jobs, found):
        try:
            for job in jobs:
                found[job] = done(job)
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=run, args=pair, daemon=True) for pair in zip(tasks, results, strict=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    assert not any(thread.is_alive() for thread in threads), "a thread does not come back"
    assert errors == []
    return results


MILLISECONDS = sorted(set(CALLS) - SECONDS)
NAMES = [
    pytest.param(set(MILLISECONDS[::9]), id="some"),
    pytest.param(set(MILLISECONDS), id="those of milliseconds", marks=pytest.mark.slow),
    pytest.param(set(CALLS), id="all", marks=pytest.mark.slow),
]


@pytest.mark.usefixtures("often")
@pytest.mark.parametrize("names", NAMES)
def test_eight_threads_give_the_bits_of_one(alone, names):
    before = mpmath.mp.prec, flint.ctx.prec
    quick, slow = work(sorted(names - set(SLOW))), work(sorted(names & set(SLOW)))
    for job in quick + slow:
        alone(job)
    for _ in range(2 if names == set(CALLS) else 1):
        forget()
        shifted = [quick[7 * n :] + quick[: 7 * n] for n in range(THREADS)]
        tasks = [jobs + (slow if n % 4 == 0 else []) for n, jobs in enumerate(shifted)]
        for found in in_threads(tasks):
            assert {job: value for job, value in found.items() if value != alone(job)} == {}
    assert (mpmath.mp.prec, flint.ctx.prec) == before


class Untouched(list):
    """Where mpmath.mp keeps its precision: whoever sets it, even for a moment, fails."""

    def __setitem__(self, *_):
        raise AssertionError("the precision of mpmath.mp is set")


@pytest.mark.parametrize("names", NAMES)
def test_results_do_not_depend_on_the_precisions_of_the_user(alone, names, monkeypatch):
    """What is computed under no precision of its own would be computed with 20 bits here."""
    own = precision._own_context()
    before = mpmath.mp.prec, flint.ctx.prec, own.prec
    wanted = {job: alone(job) for job in work(sorted(names))}
    forget()
    try:
        mpmath.mp.prec, flint.ctx.prec, own.prec = 20, 20, 20
        monkeypatch.setattr(mpmath.mp, "_prec_rounding", Untouched(mpmath.mp._prec_rounding))
        assert [job for job, value in wanted.items() if done(job) != value] == []
        assert (mpmath.mp.prec, flint.ctx.prec, own.prec) == (20, 20, 20)
    finally:
        monkeypatch.undo()
        mpmath.mp.prec, flint.ctx.prec, own.prec = before


@pytest.mark.slow
def test_an_orbit_was_found(alone):
    assert alone(("ImpactOscillator.periodic", 0, 25))


def test_inverse_map_has_its_digits():
    step = LINEAR.impact_map("1.2", "0.01", digits=60)
    back = LINEAR.inverse_map(step.tau, step.v, digits=50)
    with mpmath.workdps(60):
        assert abs(back.tau - mpmath.mpf("1.2")) < 1e-48
        assert abs(back.v - mpmath.mpf("0.01")) < 1e-48


def test_numbers_belong_to_the_context_of_the_user():
    step = LINEAR.impact_map("1.2", "0.01", digits=40)
    limit = LINEAR.chatter_limit("1.2", "0.01", digits=20)
    for value in (step.tau, step.v, step.flight_time, limit.tau, limit.error, limit.certified.radius):
        assert type(value) is mpmath.mpf
    with mpmath.workdps(60):
        assert (step.tau + mpmath.mpf(10) ** -50) != step.tau


def test_precisions_are_put_back_when_a_call_raises(monkeypatch):
    from singimpact.flights.enclosures import taylor_step

    def raises(*_):
        raise RuntimeError("in the middle")

    monkeypatch.setattr(taylor_step, "widest_disc", raises)
    before = mpmath.mp.prec, flint.ctx.prec, precision._own_context().prec
    with pytest.raises(RuntimeError):
        CUBIC.impact_map("1.2", "0.1", digits=33)
    with pytest.raises(si.InputError):
        CUBIC.impact_map("1.2", "0.1", digits=0)
    for bad in (precision.balls_at(-5), precision.balls_at("many")):
        with pytest.raises((TypeError, ValueError, OverflowError)), bad:
            pass
    assert (mpmath.mp.prec, flint.ctx.prec, precision._own_context().prec) == before
    free = threading.Thread(target=lambda: done(("fixed_points.tangency", 0, 20)), daemon=True)
    free.start()
    free.join(60)
    assert not free.is_alive()


FORKED = """
import os, threading, flint, singimpact as si
osc, stop = si.linear("2.8", 0, "0.8"), threading.Event()
def busy():
    while not stop.is_set():
        osc.chatter_limit("1.2", "0.01", digits=30)
osc.chatter_limit("1.2", "0.01", digits=30)  # a module that another thread imports is never there for the child
thread = threading.Thread(target=busy, daemon=True)
thread.start()
codes = []
for _ in range(5):
    child = os.fork()
    if not child:
        osc.impact_map("1.2", "0.01", digits=40)
        os._exit(0 if flint.ctx.prec == 53 else 1)
    codes.append(os.waitpid(child, 0)[1])
stop.set()
thread.join()
print(codes)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_a_child_forked_in_the_middle_of_another_thread_s_call_computes():
    found = subprocess.run([sys.executable, "-W", "ignore", "-c", FORKED], capture_output=True, text=True, timeout=100)
    assert found.stdout == "[0, 0, 0, 0, 0]\n", found.stderr
