"""x and x' along one flight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.numbers import as_float, float_array
from singimpact.flights import counted
from singimpact.flights.closed_arrays import places
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.model_numbers import forcing_phases, numbers_of
from singimpact.flights.states import States
from singimpact.inputs import InputError
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator


class Path(NamedTuple):
    """x and x' at the times asked for; nan where the solution does not reach."""

    x: Any
    xdot: Any


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
    states = States.read(tau, v)
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


def _followed(osc: Oscillator, states: States, times: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return many_paths(osc, states.tau, states.v, [times])[0]


def many_paths(osc: Oscillator, tau: Any, v: Any, times: Sequence[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """x - c and x' of many launches, each at its own times: one array of shape (times, 2) a launch.

    Parameters
    ----------
    osc : the model. tau, v : arrays of launches. times : for each of them, times of one sign that run away from 0.

    Examples
    --------
    >>> many_paths(Oscillator("0", "-2", 0, 1), np.zeros(2), np.array([3.0, 0.0]), [np.array([1.0]), np.array([-1.0])])
    [array([[2., 1.]]), array([[-1.,  2.]])]
    """
    counted.add(len(times))
    if linear_form(osc) is not None:
        counts = [at.size for at in times]
        launch = np.repeat(forcing_phases(osc, tau), counts, axis=0)
        speed, forces = np.repeat(v, counts), np.repeat(acceleration(osc, tau), counts)
        both = places(launch, speed, forces, np.concatenate([*times, np.zeros(0)]), numbers_of(osc)[0])
        return np.split(both, np.cumsum(counts))[:-1]
    model = compiled_model(osc)
    starts = model.near(np.asarray(tau, dtype=float))
    return [model.follow(start, speed, at) for start, speed, at in zip(starts.tolist(), v.tolist(), times, strict=True)]
