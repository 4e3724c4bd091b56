"""x and x' along one flight: in Taylor steps, or from the closed form of a linear model."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array, as_float, float_array
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.results import count_flights
from singimpact.flights.states import States
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, in_words, plain


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
            out[chosen] = many_paths(osc, states.tau, states.v, [flat[chosen]])[0]
    x, xdot = out[:, 0] + as_float(osc.clearance), out[:, 1]
    return Path(x.reshape(times.shape)[()], xdot.reshape(times.shape)[()])


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
    count_flights(len(times))
    counts = np.array([own.size for own in times], dtype=int)
    both = followed(osc, np.asarray(tau, float), np.asarray(v, float), counts, np.concatenate([*times, np.zeros(0)]))
    return np.split(both, np.cumsum(counts))[:-1]


def followed(osc: Oscillator, tau: Array, v: Array, counts: Array, times: Array, heights: Array | float = 0.0) -> Array:
    """x - c and x' after states, each at as many of the times as `counts` says, shape (times, 2).

    Parameters
    ----------
    tau, v : of the states. times : those of a state run away from 0. heights : x - c at the states.

    Examples
    --------
    >>> two = np.array([1, 1])
    >>> followed(Oscillator("0", "-2", 0, 1), np.zeros(2), np.zeros(2), two, np.ones(2), np.array([1.0, 2.0])).tolist()
    [[0.0, -2.0], [1.0, -2.0]]
    """
    model = compiled_model(osc)
    starts = model.near(tau)
    if model.linear:
        above = heights if np.ndim(heights) == 0 else np.repeat(heights, counts)
        return model.places(np.repeat(starts, counts), np.repeat(v, counts), times, above)
    return model.follow_all(starts, v, counts, times, heights)


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
    used, counts = np.unique(which, return_counts=True)
    count_flights(used.size)
    return followed(osc, tau[used], v[used], counts, times)


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
    return followed(osc, np.array([tau]), np.array([v]), np.array([times.size]), times, height)


def ends(osc: Oscillator, tau: Array, v: Array, times: Array) -> tuple[Array, Array, Array]:
    """x - c, x' and x'' at one time of each flight; the obstacle is not felt, and v may be negative.

    Examples
    --------
    >>> [part.tolist() for part in ends(Oscillator("0", "-2", 0, 1), np.zeros(1), np.full(1, 3.0), np.full(1, 3.0))]
    [[0.0], [-3.0], [-2.0]]
    """
    count_flights(tau.size)
    rows, ended = np.full((tau.size, 2), np.nan), np.isfinite(times)
    rows[ended] = followed(osc, tau[ended], v[ended], np.ones(np.count_nonzero(ended), int), times[ended])
    position, speed = rows.T
    return position, speed, acceleration_off_wall(osc, position, speed, tau + times)


def acceleration_off_wall(osc: Oscillator, position: Array, speed: Array, t: Array | float = 0.0) -> Array:
    """x'' = g - f where x - c and x' are given, at times t.

    Examples
    --------
    >>> acceleration_off_wall(Oscillator("x", "cos(t)", 1, 1), np.ones(1), np.zeros(1)).tolist()
    [-1.0]
    """
    state = {"x": as_float(osc.clearance) + position, "xdot": speed, "t": t}
    with np.errstate(all="ignore"):
        forcing, force = (evaluate(tree, state, DOUBLES) for tree in (osc.forcing(), osc.force()))
        return np.asarray(forcing - force + 0 * position)
