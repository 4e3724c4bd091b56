"""x and x' along one flight: Taylor steps, or the closed form over an array of times, so that nothing is compiled."""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial as factorial_of
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import as_float, float_array
from singimpact.algebra.rings import DOUBLES
from singimpact.flights import flight_count
from singimpact.flights.blocks import BLOCKS
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.kernels.double_double import product_twice
from singimpact.flights.model_numbers import forcing_phases, numbers_of
from singimpact.flights.states import States
from singimpact.inputs import InputError
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.result import Result, in_words, plain

Array = np.ndarray[Any, Any]


class _Place(NamedTuple):
    """Fields of `Path`."""

    x: Any
    xdot: Any


class Path(_Place, Result):
    """x and x' at given times; nan at times that the solution does not reach."""

    __slots__ = ()

    def as_dict(self) -> dict[str, Any]:
        """x and x'."""
        return {name: plain(value) for name, value in self._asdict().items()}

    def __repr__(self) -> str:
        return in_words(self)


def path(osc: Oscillator, tau: Any, v: Any, t: Any) -> Path:
    """x and x' at the times t after (negative: before) the launch from (c, v) at tau; the obstacle is not felt.

    Parameters
    ----------
    osc : the model. tau, v : one launch. t : times since the launch, any shape.

    Examples
    --------
    >>> place = path(Oscillator("0", "-2", "0.5", 1), 0, 3, [0, 1, 3])
    >>> place.x.tolist(), place.xdot.tolist()
    ([0.5, 2.5, 0.5], [3.0, 1.0, -3.0])
    """
    states = States.read(tau, v).in_period(osc)
    if states.shape:
        raise InputError(f"tau and v have shape {states.shape}: one launch at a time has a path, give two numbers")
    times = float_array("t", t)
    flat, out = times.ravel(), np.full((times.size, 2), np.nan)
    for side in (flat >= 0, flat < 0):
        chosen = np.flatnonzero(side)
        chosen = chosen[np.argsort(np.abs(flat[chosen]), kind="stable")]
        if chosen.size:
            out[chosen] = _followed(osc, states, flat[chosen])
    x, xdot = out[:, 0] + as_float(osc.clearance), out[:, 1]
    return Path(x.reshape(times.shape)[()], xdot.reshape(times.shape)[()])


def _followed(osc: Oscillator, states: States, times: Array) -> Array:
    return many_paths(osc, states.tau, states.v, [times])[0]


def many_paths(osc: Oscillator, tau: Any, v: Any, times: Sequence[Array]) -> list[Array]:
    """x - c and x' of many launches, each at its own times: one array of shape (times, 2) a launch.

    Parameters
    ----------
    osc : the model. tau, v : arrays of launches. times : for each of them, times of one sign that run away from 0.

    Examples
    --------
    >>> many_paths(Oscillator("0", "-2", 0, 1), np.zeros(2), np.array([3.0, 0.0]), [np.array([1.0]), np.array([-1.0])])
    [array([[2., 1.]]), array([[-1.,  2.]])]
    """
    flight_count.add(len(times))
    if linear_form(osc) is not None:
        counts = [at.size for at in times]
        launch = np.repeat(forcing_phases(osc, tau), counts, axis=0)
        speed, forces = np.repeat(v, counts), np.repeat(acceleration(osc, tau), counts)
        both = places(launch, speed, forces, np.concatenate([*times, np.zeros(0)]), numbers_of(osc)[0])
        return np.split(both, np.cumsum(counts))[:-1]
    model = compiled_model(osc)
    starts = model.near(np.asarray(tau, dtype=float))
    return [model.follow(start, speed, at) for start, speed, at in zip(starts.tolist(), v.tolist(), times, strict=True)]


def along(osc: Oscillator, tau: Array, v: Array, which: Array, times: Array) -> Array:
    """x - c and x' at times[i] >= 0 after the launch which[i] of many, shape (n, 2).

    Parameters
    ----------
    osc : the model. tau, v : launches. which : indices of launches, in rising order; `times` rise within each launch.

    Examples
    --------
    >>> along(Oscillator("0", "-2", 0, 1), np.zeros(2), np.array([3.0, 1.0]), np.array([0, 1]), np.ones(2)).tolist()
    [[2.0, 1.0], [0.0, -1.0]]
    """
    used, at = np.unique(which, return_inverse=True)
    launches, speeds = tau[used], v[used]
    if linear_form(osc) is None:
        cuts = np.flatnonzero(np.diff(at)) + 1
        parts = many_paths(osc, launches, speeds, np.split(times, cuts) if times.size else [])
        return np.concatenate([*parts, np.zeros((0, 2))])
    flight_count.add(used.size)
    phases, pushes, numbers = forcing_phases(osc, launches), acceleration(osc, launches), numbers_of(osc)[0]
    out = np.empty((times.size, 2))
    for begin in range(0, times.size, BLOCKS.states):
        rows = slice(begin, begin + BLOCKS.states)
        out[rows] = places(phases[at[rows]], speeds[at[rows]], pushes[at[rows]], times[rows], numbers)
    return out


def dropped(osc: Oscillator, start: tuple[float, float, float], times: Array) -> Array:
    """x - c and x' at rising times >= 0 after a start off the wall, shape (n, 2); the obstacle is not felt.

    Parameters
    ----------
    start : t, x', x - c.

    Examples
    --------
    >>> dropped(Oscillator("0", "-2", 0, 1), (0.0, 0.0, 4.0), np.array([1.0, 2.0])).tolist()
    [[3.0, -2.0], [0.0, -4.0]]
    """
    tau, v, height = start
    if linear_form(osc) is None:
        model = compiled_model(osc)
        return model.follow(float(model.near(np.array([tau]))[0]), v, times, height)
    one = np.ones(times.shape)
    return off_wall_places(osc, tau * one, v * one, height * one, times)


def off_wall_places(osc: Oscillator, tau: Array, v: Array, height: Array, times: Array) -> Array:
    """x - c and x' of a linear model at times[i] after the start i off the wall, shape (n, 2)."""
    numbers = numbers_of(osc)[0]
    driven = places(forcing_phases(osc, tau), v, acceleration(osc, tau), times, numbers)
    # the free motion from (1, 0) is the derivative of the one from (0, 1), and d times that one
    d, k = numbers[1], numbers[2]
    root = np.sqrt(complex(d * d / 4 - k))
    a, b = complex(-d / 2 + root), complex(-d / 2 - root)
    with np.errstate(all="ignore"):
        free = pair(a, b, times)
        slope = turning(a, times) + b * free
        return np.asarray(driven + height[:, None] * np.stack([slope.real + d * free.real, -k * free.real], axis=1))


def turning(a: Any, t: Any) -> Array:
    """e^{a t}; the rounding of the angle is made good."""
    angle, rest = product_twice(np.imag(a), 0.0, t, 0.0)
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(np.exp(np.real(a) * t) * ((c - rest * s) + 1j * (s + rest * c)))


def pair(a: complex, b: complex, t: Array) -> Array:
    """D[a, b](t) = (e^{a t} - e^{b t})/(a - b)."""
    y = (a - b) * t / 2
    found, near = np.empty(t.shape, dtype=complex), np.abs(y) < 0.1
    small, y2 = t[near], y[near] ** 2
    ratio = 1 + y2 / 6 * (1 + y2 / 20 * (1 + y2 / 42 * (1 + y2 / 72 * (1 + y2 / 110))))
    found[near] = turning(b, small) * turning(y[near], 1.0) * small * ratio
    if not near.all():
        found[~near] = (turning(a, t[~near]) - turning(b, t[~near])) / (a - b)
    return found


def triple(a: complex, b: complex, c: complex, t: Array) -> Array:
    """D[a, b, c](t), from the two points that are farthest apart, or from the series when all are close."""
    ab, bc, ca = abs(a - b), abs(b - c), abs(c - a)
    if ab >= bc and ab >= ca:
        b, c = c, b
    elif bc >= ca:
        a, b = b, a
    differences, far = np.empty(t.shape, dtype=complex), np.abs((a - c) * t) > 0.5
    if far.any():
        differences[far] = (pair(a, b, t[far]) - pair(b, c, t[far])) / (a - c)
    differences[~far] = series((a, b, c), t[~far], 13)
    return differences


def beyond(a: complex, b: complex, rate: complex, t: Array) -> Array:
    """rate D[a, b, 0, rate](t) = D[a, b, rate](t) - D[a, b, 0](t); for short times nothing cancels."""
    found, far = np.empty(t.shape, dtype=complex), np.maximum(abs(rate), max(abs(a), abs(b))) * np.abs(t) > 1.0
    if far.any():
        found[far] = triple(a, b, rate, t[far]) - triple(a, b, 0j, t[far])
    found[~far] = rate * series((a, b, 0j, rate), t[~far], 18)
    return found


def series(points: tuple[complex, ...], t: Array, terms: int) -> Array:
    """D[points](t) of points that are close for such times, by complete homogeneous polynomials about their mean."""
    mean, last = sum(points) / len(points), len(points) - 1
    factorial = float(factorial_of(last))
    sums: list[Any] = [np.ones(t.shape, dtype=complex) for _ in points]
    total: Any = sums[0] / factorial
    for m in range(1, terms + 1):
        sums[0] = sums[0] * (points[0] - mean) * t
        for at in range(1, len(points)):
            sums[at] = sums[at - 1] + (points[at] - mean) * t * sums[at]
        factorial *= m + last
        total = total + sums[-1] / factorial
    return np.asarray(total * t**last * turning(mean, t))


def places(launch: Array, v: Array, push: Array, time: Array, p: Array) -> Array:
    """x - c and x' at time[i] after launch i, which may be negative, shape (n, 2).

    Parameters
    ----------
    launch : cosine and sine of every phase. v, time : as they are. p : the numbers of the kernel.
    push : a_c at the launches: known to all its digits, where the sum of constant and waves would have cancelled.

    Examples
    --------
    >>> free_fall = np.array([0.0, 0.0, 0.0, -2.0, 0.0])
    >>> times, push = np.array([1.0, -1.0]), np.array([-2.0, -2.0])
    >>> places(np.zeros((2, 0)), np.array([3.0, 0.0]), push, times, free_fall).tolist()
    [[2.0, 1.0], [-1.0, 2.0]]
    """
    root = np.sqrt(complex(p[1] * p[1] / 4 - p[2]))
    a, b = complex(-p[1] / 2 + root), complex(-p[1] / 2 - root)
    with np.errstate(all="ignore"):  # what grows out of the range of doubles is inf or nan, as in the kernel
        free = pair(a, b, time)
        slope = turning(a, time) + b * free
        z, u = v * free.real + push * triple(a, b, 0j, time).real, v * slope.real + push * free.real
        for j in range((len(p) - 5) // 3):
            rate = 1j * p[5 + 3 * j]
            wave = complex(p[6 + 3 * j], -p[7 + 3 * j]) * (launch[:, 2 * j] + 1j * launch[:, 2 * j + 1])
            z = z + (wave * beyond(a, b, rate, time)).real
            u = u + (wave * rate * triple(a, b, rate, time)).real
    return np.stack([z, u], axis=1)


def ends(osc: Oscillator, tau: Array, v: Array, times: Array) -> tuple[Array, Array, Array]:
    """x - c, x' and x'' at one time of each flight; the obstacle is not felt, and v may be negative.

    Examples
    --------
    >>> [part.tolist() for part in ends(Oscillator("0", "-2", 0, 1), np.zeros(1), np.full(1, 3.0), np.full(1, 3.0))]
    [[0.0], [-3.0], [-2.0]]
    """
    flight_count.add(tau.size)
    if linear_form(osc) is not None:
        rows = places(forcing_phases(osc, tau), v, acceleration(osc, tau), times, numbers_of(osc)[0])
    else:
        model = compiled_model(osc)
        rows = np.full((tau.size, 2), np.nan)
        for i in np.flatnonzero(np.isfinite(times)).tolist():
            rows[i] = model.follow(float(tau[i]), float(v[i]), times[i : i + 1])[0]
    position, speed = rows.T
    with np.errstate(all="ignore"):
        forcing = evaluate(osc.forcing(), {"t": tau + times}, DOUBLES)
        force = evaluate(osc.force(), {"x": as_float(osc.clearance) + position, "xdot": speed}, DOUBLES)
        return position, speed, np.asarray(forcing - force + 0 * position)
