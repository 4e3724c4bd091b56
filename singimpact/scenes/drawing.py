"""One call for everything that can be drawn."""

from __future__ import annotations

from typing import Any

from singimpact.dynamics.orbit import Orbit
from singimpact.inputs import refuse
from singimpact.scenes.orbit import draw_orbit
from singimpact.scenes.scene import Scene
from singimpact.scenes.style import PENS
from singimpact.surface.curve import Curve

LETTERS = {"tau": r"time $\tau$", "t": "flight time $t$", "v": "velocity $v$"}


def plot(thing: Any, axes: Any = None) -> Any:
    """Draw a thing and return the matplotlib axes.

    Parameters
    ----------
    thing : an orbit, a scene or a curve. axes : where to draw; those of a new figure of pyplot when it is not given, so
        that a notebook shows it and `matplotlib.pyplot.show()` does.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> plot(linear("2.8", 0, "0.8").orbit(0.9, 0.3, impacts=5)).get_xlabel()
    'time $t$'
    """
    if isinstance(thing, Scene):
        return thing.draw(axes)
    if isinstance(thing, Curve):
        return _curve(thing, _new_axes() if axes is None else axes)
    if not isinstance(thing, Orbit):
        raise refuse("thing to plot", type(thing).__name__, "an orbit, a scene or a curve")
    return draw_orbit(thing, _new_axes() if axes is None else axes)


def _curve(curve: Curve, axes: Any) -> Any:
    pen = PENS.get(curve.name, PENS["graph"])
    axes.plot(*curve.points.T, **pen.line(), label=f"${curve.name}$" if curve.name in PENS else curve.name)
    for mark in curve.marks:
        place = curve.points[mark.index]
        axes.plot(*place, "o", color="black", markersize=4)
        axes.annotate(mark.name, place, (5, 5), textcoords="offset points")
    axes.set_xlabel(LETTERS.get(curve.axes[0], curve.axes[0]))
    axes.set_ylabel(LETTERS.get(curve.axes[1], curve.axes[1]))
    axes.legend(loc="best")
    return axes


def _new_axes() -> Any:
    import matplotlib.pyplot

    return matplotlib.pyplot.figure(figsize=(8.0, 4.0), dpi=150, layout="constrained").add_subplot()
