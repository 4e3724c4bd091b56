"""The cascade beside a border orbit: impacts of the released orbit, and what attracts it, over the distance."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.branches.border import BorderOrbit
from singimpact.branches.cascade import Cascade, CascadeWindow
from singimpact.inputs import InputError
from singimpact.scenes.label_places import legend_below, legend_entries
from singimpact.scenes.style import BLACK, BLUE, GREY, LETTERS, ORANGE, VERMILLION


@dataclass(frozen=True)
class BorderPictureSettings:
    """Settings of a picture of a cascade.

    Parameters
    ----------
    places : in each window at which an orbit is flown until it settles. size : of the marks; windows : where there are
        more of these, the marks get smaller. decades : of multipliers below 1 that are shown.
    """

    places: int = 8
    size: float = 3.6
    windows: int = 35
    decades: float = 2.5


SETTINGS = BorderPictureSettings()
WORDS = {
    "same": "attractor that closes at each return",
    "more": "attractor that closes after more returns",
    "rest": "attractor with complete chatter",
    "none": "no periodic attractor seen",
}
MARKS = {"same": ("o", BLUE), "more": ("D", ORANGE), "rest": ("^", VERMILLION), "none": (".", GREY)}


def draw_border(border: BorderOrbit, axes: Any, below: Any = None) -> Any:
    """Draw the cascade of a border orbit and return the axes.

    Parameters
    ----------
    axes : for the number of impacts a return. below : for the size of the larger multiplier, or None.
    """
    cascade = border.cascade
    if len(cascade) < 2:
        raise InputError(f"this border orbit has no cascade to draw: {'; '.join(cascade.notes)}")
    samples = cascade.sampled(SETTINGS.places)
    size = SETTINGS.size * min(1.0, SETTINGS.windows / len(cascade))
    _stairs(cascade, axes)
    for kind, (marker, color) in MARKS.items():
        rows = [(sample.distance, _height(sample, border)) for sample in samples if _kind(sample, border) == kind]
        if rows:
            axes.plot(
                *np.array(rows).T,
                marker,
                color=color,
                markersize=size,
                linestyle="none",
                markeredgewidth=0.9,
                label=WORDS[kind],
                zorder=4,
            )
    name = LETTERS.get(border.over, border.over)
    axes.set_title(
        f"border orbit at {name} = {float(border.parameter):.12g}, chatter completes {border.side}", fontsize="medium"
    )
    axes.set(xscale="log", ylabel="impacts a return")
    if below is not None:
        _multipliers(samples, border, below, size)
        axes.tick_params(labelbottom=False)
    last = axes if below is None else below
    last.set_xlabel(f"distance from the border orbit in {name}")
    legend_below(last, legend_entries(axes), 2, 0.18 if below is None else 0.3)
    return axes


def _stairs(cascade: Cascade, axes: Any) -> None:
    """N of the released orbit, constant between edges."""
    distance = np.array(cascade.distance, dtype=float)
    # beyond the first edge one impact less, beyond the last one as long as the window before
    places = np.concatenate([[distance[0] ** 2 / distance[1]], distance, [distance[-1] ** 2 / distance[-2]]])
    axes.plot(
        np.repeat(places, 2)[1:-1],
        np.repeat(np.concatenate([[cascade.impacts[0] - 1], cascade.impacts]), 2),
        color=BLACK,
        linewidth=1.0,
        zorder=2,
        label="released orbit, up to the end of $\\gamma$",
    )
    axes.set_xlim(places[-1], places[0])


def _kind(window: CascadeWindow, border: BorderOrbit) -> str:
    if window.orbit is None:
        return "none"
    if window.orbit.kind == "chatter":
        return "rest"
    return "same" if window.orbit.k == round(border.period) else "more"


def _height(window: CascadeWindow, border: BorderOrbit) -> float:
    """Impacts of an attractor a return; those with rest, or none, at the released orbit's."""
    orbit = window.orbit
    if orbit is None or orbit.kind == "chatter":
        return float(window.impacts)
    return float(orbit.n) * border.period / orbit.k


def _multipliers(samples: tuple[CascadeWindow, ...], border: BorderOrbit, axes: Any, size: float) -> None:
    """The size of the larger multiplier; 0 of a superstable orbit has no place on this axis."""
    for kind in ("same", "more"):
        marker, color = MARKS[kind]
        rows = [
            (sample.distance, abs(complex(sample.orbit.multipliers[0])))
            for sample in samples
            if sample.orbit is not None and _kind(sample, border) == kind
        ]
        if rows:
            axes.plot(*np.array(rows).T, marker, color=color, markersize=size, linestyle="none", zorder=4)
    axes.axhline(1, color=BLACK, linewidth=0.6, zorder=1)
    axes.set(yscale="log", ylim=(10**-SETTINGS.decades, 2), ylabel="larger multiplier, size")
