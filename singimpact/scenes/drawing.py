"""One call for everything that can be drawn."""

from __future__ import annotations

from typing import Any

from singimpact.dynamics.orbit import Orbit
from singimpact.inputs import refuse
from singimpact.scenes.orbit import draw_orbit


def plot(thing: Any, axes: Any = None) -> Any:
    """Draw a thing and return the matplotlib axes.

    Parameters
    ----------
    thing : an orbit. axes : where to draw; new ones without a window when it is not given.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> plot(linear("2.8", 0, "0.8").orbit(0.9, 0.3, impacts=5)).get_xlabel()
    'time $t$'
    """
    if not isinstance(thing, Orbit):
        raise refuse("thing to plot", type(thing).__name__, "an orbit")
    return draw_orbit(thing, _new_axes() if axes is None else axes)


def _new_axes() -> Any:
    # a Figure of its own needs no window and no backend, and is freed with its axes
    from matplotlib.figure import Figure

    return Figure(figsize=(8.0, 4.0), dpi=150, layout="constrained").add_subplot()
