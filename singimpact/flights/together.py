"""Many flights at rest at once, on numpy arrays: nothing is compiled, and models may differ in their clearance.

The emitted recurrence runs on arrays as it stands, one flight an element.  The launch velocity has a tiny imaginary
part, so that imaginary parts are derivatives by it.  Threads that each need flights, one after the other, meet here:
when all of them wait, their flights are made in one go.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from threading import Condition, Thread
from typing import Any, NamedTuple

import numpy as np

from singimpact.codegen.over_lists import FUNCTIONS, plain
from singimpact.codegen.taylor_recurrence import Recurrence
from singimpact.flights.limits import degree_for
from singimpact.flights.model_numbers import numbers_of_flow, recurrence_of
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]
EPSILON = 2.0**-52
TINY = 1e-100  # the imaginary part: its square is below every rounding


@dataclass(frozen=True)
class TogetherSettings:
    """Settings of the flights on arrays."""

    # part of the step on which the last two terms are at rounding: it is wished for, and no disc bounds the cut-off
    cautious: float = 0.8
    # x'' at the end of a step by its polynomial and by the recurrence: at most so many roundings apart, in sizes of x''
    defect: float = 1e5
    # steps at most
    steps: int = 1000


SETTINGS = TogetherSettings()


class NotTogether(ArithmeticError):
    """A step whose end does not fit the equation of motion: these flights are to be made one by one."""


class _Work(NamedTuple):
    X: list[Any]
    W: list[list[Any]]


@lru_cache(maxsize=64)
def runs_on_arrays(flow: Recurrence) -> bool:
    """Whether nothing in the recurrence depends on the sign of a value, and all of it is analytic.

    Examples
    --------
    >>> [runs_on_arrays(recurrence_of(Oscillator(f, 0, 0, 1))) for f in ("x**3", "exp(x)", "tanh(x)")]
    [True, True, False]
    """
    text = flow.source.partition("\ndef disc(")[0]
    return not any(part in text for part in ("abs(", "real_power(", "quotient(", "log("))


def rest_flights(osc: Oscillator, clearance: Array, tau: Array, lane: Array, times: Array) -> Array:
    """x - c, x' and their derivatives by the launch velocity at times[i] of the flight lane[i], shape (n, 4).

    Parameters
    ----------
    osc : the model, but for its clearance. clearance, tau : of every launch from rest. times : of either sign; those of
        a flight have one sign.

    Raises
    ------
    NotTogether : a step is not good enough.

    Examples
    --------
    >>> fall, zero = Oscillator("0", "-2", 0, 1), np.zeros(1)
    >>> rest_flights(fall, zero, zero, np.array([0, 0]), np.array([-1.0, -3.0])).tolist()
    [[-1.0, 2.0, -1.0, 1.0], [-9.0, 6.0, -3.0, 1.0]]
    """
    flow, order = recurrence_of(osc), degree_for(EPSILON)
    functions = {name: getattr(np, _NUMPY.get(name, name)) for name in FUNCTIONS}
    coefficients = plain(_unshared(flow.source), functions)["coefficients"]
    numbers = numbers_of_flow(osc, flow).tolist()
    table = np.full((times.size, 4), np.nan)
    ends = np.zeros(tau.size)
    np.maximum.at(ends, lane, np.abs(times))
    ahead = np.ones(tau.size)
    ahead[lane[times < 0]] = -1
    table[times == 0] = 0, 0, 0, 1
    z, u = np.zeros(tau.size, dtype=complex), np.full(tau.size, TINY * 1j)
    gone, active, bend = np.zeros(tau.size), np.flatnonzero(ends > 0), np.full(tau.size, np.nan)
    for _ in range(SETTINGS.steps):
        if not active.size:
            return table
        work = _Work([0] * (order + 2), [[0] * (order + 2) for _ in range(flow.rows)])
        start = ahead[active] * gone[active]
        with np.errstate(all="ignore"):
            coefficients(
                [tau[active]], start, z[active], u[active], 0.0, order, [clearance[active], *numbers[1:]], work
            )
            X = [np.broadcast_to(coefficient, active.shape) for coefficient in work.X[: order + 1]]
            X[0] = z[active]
            h = np.minimum(_wished(X, order, ends[active]), ends[active] - gone[active])
        _check(bend[active], X)
        here = np.full(tau.size, -1)
        here[active] = np.arange(active.size)
        rows = np.flatnonzero((here[lane] >= 0) & (np.abs(times) > gone[lane]))
        rows = rows[np.abs(times[rows]) <= (gone[lane] + np.append(h, 0.0)[here[lane]])[rows]]
        at = here[lane[rows]]
        position, speed, _ = _values(X, at, times[rows] - (ahead * gone)[lane[rows]])
        table[rows] = np.stack([position.real, speed.real, position.imag / TINY, speed.imag / TINY], axis=1)
        z[active], u[active], curve = _values(X, np.arange(active.size), ahead[active] * h)
        bend[active] = curve.real
        last = h >= ends[active] - gone[active]
        gone[active] += h
        active = active[~last]
    raise NotTogether


_NUMPY = {"atan": "arctan"}


@lru_cache(maxsize=64)
def _unshared(source: str) -> str:
    """a = a + b for a += b, which would change an array that has other names, and keep it real."""
    return re.sub(r"^( *)([^=\n]+?) ([-+*/])= (.*)$", r"\1\2 = \2 \3 (\4)", source, flags=re.MULTILINE)


def _wished(X: list[Array], order: int, longest: Array) -> Array:
    """`kernels.steps.wished_step` on arrays."""
    h = longest
    for _ in range(2):
        size = EPSILON * (np.abs(X[0]) + h * (np.abs(X[1]) + h * (np.abs(X[2]) + h * np.abs(X[3]))))
        for k in (order - 1, order):
            fit = (size / np.abs(X[k])) ** (1 / k)
            h = np.where(fit < h, fit, h)
    return np.asarray(SETTINGS.cautious * h)


def _values(X: list[Array], at: Array, h: Array) -> tuple[Array, Array, Array]:
    """The polynomials `at`, their first and second derivatives at h."""
    value, slope, bend = X[-1][at], np.zeros(at.size), np.zeros(at.size)
    for part in X[-2::-1]:
        bend = bend * h + slope
        slope = slope * h + value
        value = value * h + part[at]
    return value, slope, 2 * bend


def _check(bend: Array, X: list[Array]) -> None:
    """Each step, on arrival, by the equation of motion."""
    size = np.abs(X[2]) + np.abs(X[1]) + 1
    apart = np.abs(bend - 2 * X[2].real)[~np.isnan(bend)]
    if not np.all(apart <= SETTINGS.defect * EPSILON * size[~np.isnan(bend)]):
        raise NotTogether


@dataclass
class _Request:
    clearance: float
    tau: Array
    lane: Array
    times: Array
    answer: Any = None


@dataclass
class Meeting:
    """Flights at rest of several threads; models differ in the clearance alone.

    Parameters
    ----------
    osc : one of the models. threads : those at work.
    """

    osc: Oscillator
    threads: int
    _waiting: list[_Request] = field(default_factory=list)
    _changed: Condition = field(default_factory=Condition)

    def rest_flights(self, clearance: float, tau: Array, lane: Array, times: Array) -> Array:
        """`rest_flights` of one model, flown with those of all other threads."""
        request = _Request(clearance, tau, lane, times)
        with self._changed:
            self._waiting.append(request)
            self._fly()
            while request.answer is None:
                self._changed.wait()
        if isinstance(request.answer, Exception):
            raise request.answer
        return np.asarray(request.answer)

    def leave(self) -> None:
        """A thread needs no more flights."""
        with self._changed:
            self.threads -= 1
            self._fly()

    def _fly(self) -> None:
        if not self._waiting or len(self._waiting) < self.threads:
            return
        requests, self._waiting = self._waiting, []
        starts = np.cumsum([0, *(request.tau.size for request in requests)])
        try:
            states = rest_flights(
                self.osc,
                np.repeat([request.clearance for request in requests], np.diff(starts)),
                np.concatenate([request.tau for request in requests]),
                np.concatenate([request.lane + start for request, start in zip(requests, starts[:-1], strict=True)]),
                np.concatenate([request.times for request in requests]),
            )
            parts: list[Any] = np.split(states, np.cumsum([request.times.size for request in requests])[:-1])
        except Exception as error:  # each thread raises it in its own place
            parts = [error] * len(requests)
        for request, answer in zip(requests, parts, strict=True):
            request.answer = answer
        self._changed.notify_all()


def in_step(osc: Oscillator, tasks: Sequence[Callable[[Meeting | None], Any]]) -> list[Any]:
    """The results of tasks that each take a meeting for their flights, or None to make them one by one.

    Examples
    --------
    >>> fall = Oscillator("0", "-2", 0, 1)
    >>> one = np.zeros(1)
    >>> task = lambda meeting: meeting.rest_flights(0.0, one, np.array([0]), np.array([3.0]))[0, 0].item()
    >>> in_step(fall, [task, task])
    [-9.0, -9.0]
    """
    if not runs_on_arrays(recurrence_of(osc)):
        return [task(None) for task in tasks]
    meeting, results = Meeting(osc, len(tasks)), [None] * len(tasks)

    def run(n: int) -> None:
        try:
            results[n] = tasks[n](meeting)
        except Exception as error:
            results[n] = error  # type: ignore[call-overload]
        finally:
            meeting.leave()

    threads = [Thread(target=run, args=(n,), daemon=True) for n in range(len(tasks))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [
        tasks[n](None) if isinstance(outcome, NotTogether) else _sound(outcome) for n, outcome in enumerate(results)
    ]


def _sound(made: Any) -> Any:
    if isinstance(made, Exception):
        raise made
    return made
