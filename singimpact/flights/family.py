"""Flights of a family of models that do not feel the wall: ends at given times, with exact derivatives.

    z = x - c and x' at time T after a launch from x = c, differentiated by T, tau, v and by numbers of the model

A branch of periodic orbits passes a graze smoothly in these coordinates (`branches`).  A linear model is one matrix
exponential: its state and the cosines and sines of its forcing obey a linear equation, and a block beside its matrix
gives the derivative by a parameter.  Any other model is flown in Taylor steps, with a third column of the variational
equation that the parameter drives.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, factorial, frexp, inf, pi, sin
from threading import RLock
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Expression,
    Name,
    add,
    evaluate,
    multiply,
    names_in,
    negate,
    substitute,
    subtract,
)
from singimpact.algebra.numbers import Array, as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.codegen.taylor_recurrence import recurrence
from singimpact.flights.compiled_model import CompiledModel, compiled_model
from singimpact.flights.kernels import layout
from singimpact.flights.model_numbers import fastest_rate, recurrence_of
from singimpact.oscillator.linear import LinearForm, form_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION, period_over, value_of
from singimpact.oscillator.rebound import rho_of

Values = Mapping[str, float]


@dataclass(frozen=True)
class FamilySettings:
    """Settings of the samples of a flight."""

    # places a turn of its fastest motion
    samples: float = 24.0
    # the fewest of a flight, and the most
    least: int = 16
    most: int = 4000
    # Taylor steps of a flight
    steps: int = 1000


SETTINGS = FamilySettings()


class End(NamedTuple):
    """The end of one flight: (x - c, x') and its derivatives by T, tau, v and by each number, shape (numbers, 2)."""

    place: Array
    by_time: Array
    by_tau: Array
    by_v: Array
    by_numbers: Array


class Number(NamedTuple):
    """A tree in the numbers that move, as a double with its derivatives by them."""

    value: float
    slopes: tuple[float, ...]


class Family(ABC):
    """The models that differ from one in some numbers: the clearance, the restitution, parameters.

    Parameters
    ----------
    osc : a model. over : names of the numbers that move.
    """

    linear = False
    """Whether its flights have a closed form."""
    _last_push: tuple[tuple[float, ...], float] = ((), 0.0)

    def __init__(self, osc: Oscillator, over: Sequence[str] = ()) -> None:
        self.osc, self.over = osc, tuple(over)
        self.fixed = {name: tree for name, tree in osc.parameters.items() if name not in over}
        self.start = {name: value_of(osc, name) for name in over}
        self.fastest = fastest_rate(osc)
        period = period_over(osc, over)
        self._period = None if period is None else self._tree(period)
        law = rho_of(Name(RESTITUTION) if RESTITUTION in over else osc.restitution)
        self._rho = [self._tree(tree) for tree in (law, derivative(law, "v"))]
        # flights of one orbit have the same numbers: those of the last call are remembered
        self._last_period: tuple[Values, Number] | None = None

    # ---- numbers

    def _tree(self, tree: Expression) -> tuple[Expression, tuple[Expression, ...]]:
        """A tree in which the numbers that move are letters, and its derivatives by them."""
        kept = substitute(tree, self.fixed)
        return kept, tuple(derivative(kept, name) for name in self.over)

    def _number(self, trees: tuple[Expression, tuple[Expression, ...]], values: Values) -> Number:
        tree, slopes = trees
        return Number(_float(tree, values), tuple(_float(each, values) for each in slopes))

    def period(self, values: Values) -> Number:
        """The period of the forcing; of a model without one nan."""
        if self._period is None:
            return Number(np.nan, (np.nan,) * len(self.over))
        last = self._last_period
        if last is not None and last[0] == values:
            return last[1]
        period = self._number(self._period, values)
        if period.value < 0:
            period = Number(-period.value, tuple(-slope for slope in period.slopes))
        self._last_period = dict(values), period
        return period

    def rebound(self, velocity: float, values: Values) -> tuple[float, float, tuple[float, ...]]:
        """rho at x' before an impact, its derivative, and its derivatives by the numbers."""
        given = {**values, "v": velocity}
        tree, slopes = self._rho[0]
        return (_float(tree, given), _float(self._rho[1][0], given), tuple(_float(each, given) for each in slopes))

    def oscillator(self, values: Values) -> Oscillator:
        """The model with these numbers, each the double that it is."""
        return self.osc.replace(**values)

    def one_wall(self, values: Values) -> Oscillator:
        """The model of one wall that its flights start from."""
        return self.oscillator(values)

    # ---- flights

    def push(self, values: Values, period: float) -> float:
        """The largest |x''| of a mass at rest on the wall, at eight phases of a period."""
        at, (last, push) = (0.0 if self.osc.autonomous else period, *values.values()), self._last_push
        if at != last:
            push = max(abs(float(self.end(values, i * period / 8, 0.0, 0.0).by_time[1])) for i in range(8))
            self._last_push = at, push
        return push

    def link(self, values: Values, state: Array, later: Array) -> tuple[Array, Array]:
        """The misses of a later state (tau, v) after a flight, and their derivatives by both states and by the numbers,
        of shape (2, 4 + numbers). It need be no first hit, and is smooth through grazes.
        """
        (tau, v), (arrival, after) = state.tolist(), later.tolist()
        end = self.end(values, tau, v, arrival - tau)
        rho, slope, by_numbers = self.rebound(float(end.place[1]), values)
        columns = np.stack([end.by_tau - end.by_time, end.by_v, end.by_time, 0 * end.by_v, *end.by_numbers], axis=1)
        columns[1] *= slope
        columns[1, 3:] += [-1.0, *by_numbers]
        return np.array([end.place[0], rho - after]), columns

    @abstractmethod
    def end(self, values: Values, tau: float, v: float, time: float) -> End:
        """The end of a flight; launches in the first period keep what depends on the period smooth."""

    @abstractmethod
    def path(self, values: Values, tau: float, v: float, time: float) -> Array:
        """x - c and x' at evenly spaced times after the launch, the last of them `time`, shape (samples, 2)."""

    def samples(self, values: Values, time: float) -> int:
        """The number of samples that show the shape of a flight; a forcing that has become faster is followed."""
        period = self.period(values).value
        turns = min(abs(time) * max(self.fastest, 4 * pi / period if period > 0 else 0.0) / (2 * pi), SETTINGS.most)
        return int(min(max(SETTINGS.samples * turns, SETTINGS.least), SETTINGS.most))


def family(osc: Oscillator, over: Sequence[str] = ()) -> Family:
    """The family of a model over some of its numbers.

    Parameters
    ----------
    osc : the model. over : "clearance", "restitution" or parameters.

    Examples
    --------
    >>> moving = family(Oscillator("x", "A*cos(2*t)", 0, "0.8", {"A": 1}), ("A",))
    >>> end = moving.end({"A": 3.0}, 0.5, 1.0, 2.0)
    >>> before, after = (moving.end({"A": 3 + h}, 0.5, 1.0, 2.0).place for h in (-1e-6, 1e-6))
    >>> bool(abs((after - before) / 2e-6 - end.by_numbers[0]).max() < 1e-9)
    True
    """
    return _family(osc, tuple(over))


@lru_cache(maxsize=64, typed=True)
def _family(osc: Oscillator, over: tuple[str, ...]) -> Family:
    form = form_of(osc.f, osc.g)
    return SteppedFamily(osc, over) if form is None else LinearFamily(osc, over, form)


class LinearFamily(Family):
    """y' = M y for y = (x - c, x', 1, cosine and sine of every wave)."""

    linear = True

    def __init__(self, osc: Oscillator, over: Sequence[str], form: LinearForm) -> None:
        super().__init__(osc, over)
        clearance: Any = Name(CLEARANCE) if CLEARANCE in over else osc.clearance
        steady = add(form.constant, negate(multiply(form.stiffness, clearance)))
        waves = [tree for wave in form.harmonics for tree in (wave.rate, wave.phase, wave.cosine, wave.sine)]
        self._trees = [self._tree(tree) for tree in (form.damping, form.stiffness, steady, *waves)]
        self._known = [
            self._number(entry, {}) if names_in(entry[0]).isdisjoint(over) else None for entry in self._trees
        ]
        self.waves = len(form.harmonics)
        self._last: tuple[Values, list[Number]] | None = None

    def numbers(self, values: Values) -> list[Number]:
        """Damping, stiffness, constant part of a_c; rate, phase, cosine, sine of every wave."""
        last = self._last
        if last is not None and last[0] == values:
            return last[1]
        numbers = [
            constant or self._number(trees, values) for constant, trees in zip(self._known, self._trees, strict=True)
        ]
        self._last = dict(values), numbers
        return numbers

    def end(self, values: Values, tau: float, v: float, time: float) -> End:
        p, count = self.numbers(values), len(self.over)
        n = 3 + 2 * self.waves
        matrix, start = self._matrix([number.value for number in p]), self._start(p, tau, v)
        blocks = np.zeros(((1 + count) * n,) * 2)
        for k in range(1 + count):
            blocks[k * n : (k + 1) * n, k * n : (k + 1) * n] = matrix
        for k in range(count):
            blocks[:n, (k + 1) * n : (k + 2) * n] = self._matrix([number.slopes[k] for number in p], flow=False)
        grown = exponential(blocks * time)
        flow = grown[:2, :n]
        state = flow @ start
        turned = np.zeros(n)
        for j in range(self.waves):
            rate = p[3 + 4 * j].value
            turned[3 + 2 * j], turned[4 + 2 * j] = -rate * start[4 + 2 * j], rate * start[3 + 2 * j]
        by_numbers = np.zeros((count, 2))
        for k in range(count):
            moved = np.zeros(n)
            for j in range(self.waves):
                angle = p[3 + 4 * j].slopes[k] * tau + p[4 + 4 * j].slopes[k]
                moved[3 + 2 * j], moved[4 + 2 * j] = -angle * start[4 + 2 * j], angle * start[3 + 2 * j]
            by_numbers[k] = grown[:2, (k + 1) * n : (k + 2) * n] @ start + flow @ moved
        bend = matrix[1] @ (grown[:n, :n] @ start)
        return End(state, np.array([state[1], bend]), flow @ turned, flow[:, 1].copy(), by_numbers)

    def constants(self, values: Mapping[str, Array]) -> list[Array]:
        """The values of `numbers`, or of arrays of numbers."""
        return [evaluate(tree, values, DOUBLES) for tree, _ in self._trees]

    def flow(self, values: Mapping[str, Array], time: Array) -> Array:
        """e^{M T}: its first two rows give x - c and x' from v, 1 and the cosines and sines at the launch.

        Parameters
        ----------
        values : arrays of numbers, shape (m,). time : of each, shape (m,).
        """
        return exponential(self._matrix(self.constants(values), shape=time.shape) * time[:, None, None])

    def path(self, values: Values, tau: float, v: float, time: float) -> Array:
        p, count = self.numbers(values), self.samples(values, time)
        flow = exponential(self._matrix([each.value for each in p]) * (time / count))
        states = (flow @ self._start(p, tau, v))[None]
        while len(states) < count:  # so many places again, as many steps later
            states = np.concatenate([states, states @ flow.T])
            flow = flow @ flow
        return np.asarray(states[:count, :2])

    def _start(self, p: list[Number], tau: float, v: float) -> Array:
        angles = [p[3 + 4 * j].value * tau + p[4 + 4 * j].value for j in range(self.waves)]
        return np.array([0.0, v, 1.0, *(part for angle in angles for part in (cos(angle), sin(angle)))])

    def _matrix(self, p: Sequence[Array | float], flow: bool = True, shape: tuple[int, ...] = ()) -> Array:
        """M of these numbers; linear in them but for the 1 of x - c, which a derivative has not."""
        size = 3 + 2 * self.waves
        matrix = np.zeros((size, size, *shape))
        matrix[0, 1] = 1.0 if flow else 0.0
        matrix[1, 0], matrix[1, 1], matrix[1, 2] = -p[1], -p[0], p[2]
        for j in range(self.waves):
            at, (rate, _phase, cosine, sine) = 3 + 2 * j, p[3 + 4 * j : 7 + 4 * j]
            matrix[1, at], matrix[1, at + 1] = cosine, sine
            matrix[at, at + 1], matrix[at + 1, at] = -rate, rate
        return np.moveaxis(matrix, (0, 1), (-2, -1))


class SteppedFamily(Family):
    """Flights in Taylor steps; the flow of every number has a compiled model of its own.

    The numbers of these models are changed from call to call, so one thread flies at a time.
    """

    def __init__(self, osc: Oscillator, over: Sequence[str]) -> None:
        super().__init__(osc, over)
        # next to a singularity a flight is given up: a branch would halve its steps for minutes there
        allowance = replace(compiled_model(osc).allowance, steps=SETTINGS.steps)
        flows = [
            recurrence_of(osc),
            *(recurrence(osc.f, osc.g, push_by(osc, name)) for name in over if name != RESTITUTION),
        ]
        self.flows, self.models = flows, [CompiledModel(osc, allowance, flow) for flow in flows]
        for model in self.models:
            model.flat[layout.TURN : layout.TURN + 5] = 0.0  # launch times are not reduced by a period that moves
        self._trees = [[substitute(tree, self.fixed) for tree in flow.constants] for flow in flows]
        self._force, self._forcing = substitute(osc.f, self.fixed), substitute(osc.g, self.fixed)
        self._at: tuple[float, ...] | None = None
        self._alone = RLock()

    def _moved(self, values: Values) -> None:
        at = tuple(values[name] for name in self.over)
        if at == self._at:
            return
        for model, trees in zip(self.models, self._trees, strict=True):
            clearance = values.get(CLEARANCE, as_float(self.osc.clearance))
            model.flat[layout.SCALARS : -1] = [clearance, *(_float(tree, values) for tree in trees)]
            model.forget_lists()
        self._at = at

    def end(self, values: Values, tau: float, v: float, time: float) -> End:
        with self._alone:
            return self._end(values, tau, v, time)

    def _end(self, values: Values, tau: float, v: float, time: float) -> End:
        self._moved(values)
        launch = np.array([tau]), np.array([v]), np.array([time])
        by_v, by_v_dot, by_tau, by_tau_dot = self.models[0].variations(*launch)[0]
        if not np.isfinite(by_v):  # it does not get there
            nothing = np.full(2, np.nan)
            return End(nothing, nothing, nothing, nothing, np.full((len(self.over), 2), np.nan))
        state = self.models[0].follow(tau, v, np.array([time]))[0]
        by_numbers, models = np.zeros((len(self.over), 2)), iter(self.models[1:])
        for k, name in enumerate(self.over):
            if name != RESTITUTION:
                by_numbers[k] = next(models).variations(*launch)[0, 2:]
        clearance = values.get(CLEARANCE, as_float(self.osc.clearance))
        names = {**values, "x": clearance + state[0], "xdot": state[1], "t": tau + time}
        with np.errstate(all="ignore"):
            bend = _float(self._forcing, names) - _float(self._force, names)
        return End(
            state, np.array([state[1], bend]), np.array([by_tau, by_tau_dot]), np.array([by_v, by_v_dot]), by_numbers
        )

    def path(self, values: Values, tau: float, v: float, time: float) -> Array:
        with self._alone:
            self._moved(values)
            return self.models[0].follow(tau, v, np.linspace(0.0, time, self.samples(values, time) + 1)[1:])


_ORDER = 19
_TAYLOR = np.array([1 / factorial(k) for k in range(_ORDER + 1)]).reshape(5, 4)


def exponential(matrix: Array) -> Array:
    """e^M of a small matrix, or a stack of them, by its Taylor series, scaled and squared; scipy's is ten times slower.

    Examples
    --------
    >>> exponential(np.array([[0.0, 1.0], [0.0, 0.0]])).tolist()
    [[1.0, 1.0], [0.0, 1.0]]
    """
    size = float(np.abs(matrix).sum(axis=-2).max())
    halvings = max(frexp(size)[1], 0) if size < inf else 0
    A = matrix * 2.0**-halvings
    powers = np.empty((4, *matrix.shape))
    powers[0], powers[1] = np.eye(matrix.shape[-1]), A
    np.matmul(A, A, out=powers[2])
    np.matmul(powers[2], A, out=powers[3])
    parts = (_TAYLOR @ powers.reshape(4, -1)).reshape(5, *matrix.shape)
    fourth = powers[2] @ powers[2]
    total = parts[4]
    for polynomial in parts[3::-1]:
        total = total @ fourth + polynomial
    for _ in range(halvings):
        total = total @ total
    return np.asarray(total)


def push_by(osc: Oscillator, name: str) -> Expression:
    """The force on the derivative of x - c by a number: g_p - f_p, for the clearance -f_x.

    Examples
    --------
    >>> print(push_by(Oscillator("x + b*x**3", "cos(t)", 0, 1, {"b": 2}), "b"))
    -x**3
    """
    if name == CLEARANCE:
        return negate(derivative(osc.f, "x"))
    return subtract(derivative(osc.g, name), derivative(osc.f, name))


def _float(tree: Expression, values: Mapping[str, Any]) -> float:
    return float(evaluate(tree, values, DOUBLES))
