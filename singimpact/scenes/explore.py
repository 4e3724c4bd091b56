"""The interactive page: one HTML file that needs no network, with a slider for the clearance.

Left V_c' with the zero set Z and the horizon H, right the plane of states with the outline P and gamma.  The frames
are computed beforehand and lie in the page, so that the slider answers at once and the page works anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from singimpact.inputs import InputError, refuse, whole
from singimpact.oscillator.model import Oscillator
from singimpact.progress import ProgressLine
from singimpact.scenes.clearance_frames import SETTINGS, ClearanceFilm, ClearanceFrame, clearance_film
from singimpact.store import write_text


@dataclass(frozen=True)
class Line:
    """How a curve looks: colours that the colour-blind tell apart, and dashes and widths that survive grey-scale.

    Attributes
    ----------
    name : of the curve in a frame. label : in the legend. column : of the panel, 1 or 2.
    """

    name: str
    label: str
    column: int
    color: str
    dash: str = "solid"
    width: float = 2.0


LINES = (
    Line("Z", "Z: launched at rest", 1, "#0072B2"),
    Line("H", "H: lands at rest", 1, "#D55E00", "dash"),
    Line("P", "P = p(H), the outline", 2, "#999999", "dot", 1.5),
    Line("jumps", "visible part of P: G jumps", 2, "#D55E00", "dash", 3.0),
    Line("gamma", "γ, the threshold of chatter", 2, "#009E73", "solid", 3.0),
)
DIGITS = 6  # of the coordinates in the page: below a hundredth of a pixel

# The policy forbids the page to load anything; plotly.js draws symbols through data and blob addresses.
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>body {{ font-family: sans-serif; margin: 1em 2em; }} p {{ max-width: 60em; }}</style>
</head>
<body>
<h1>{title}</h1>
<p>{text}</p>
{figure}
</body>
</html>
"""


@dataclass(frozen=True)
class ExplorePage:
    """A page with a slider for the clearance; a notebook shows it below its cell.

    Attributes
    ----------
    film : the curves at each place of the slider. html : the page, one text that needs no network.
    """

    film: ClearanceFilm
    html: str

    def __repr__(self) -> str:
        low, high = self.film.frames[0].clearance, self.film.frames[-1].clearance
        megabytes = len(self.html) / 1e6
        return f"ExplorePage({len(self.film.frames)} clearances from {low:.6g} to {high:.6g}, {megabytes:.1f} MB)"

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{escape(self.html)}" width="100%" height="800" frameborder="0"></iframe>'

    def save(self, path: Any) -> None:
        """Write the page to a file."""
        write_text(path, self.html)


def explore(osc: Oscillator, between: Any = None, steps: int = SETTINGS.steps) -> ExplorePage:
    """A page on which Z, H, P and gamma change as the clearance moves through the nearest swan.

    Parameters
    ----------
    osc : the model. between : two clearances, the ends of the slider; both sides of the swan without them.
    steps : places of the slider, from 2 to 1001.

    Returns
    -------
    ExplorePage : `.save("page.html")` writes it; `.film.frames` has the curves as arrays.

    Raises
    ------
    InputError : ends or steps that are none; plotly is not installed (extra `interactive`).

    Examples
    --------
    >>> page = explore(Oscillator("x", "cos(2*t)", "0.9", "1/2"), steps=2)
    >>> print(repr(page).partition(", ")[0])
    ExplorePage(2 clearances from 1 to 1.13708
    """
    if not isinstance(osc, Oscillator):
        raise refuse("osc", osc, "an ImpactOscillator")
    whole("steps", steps, 2, 1001)
    require_plotly()
    with ProgressLine() as line:
        film = clearance_film(osc, between, steps, line.show)
    return ExplorePage(film, explore_page(film))


def explore_page(film: ClearanceFilm) -> str:
    """The page of a film.

    Raises
    ------
    InputError : plotly is not installed.
    """
    model = film.model
    text = (
        f"x'' + f(x, x') = g(t), x >= c, with f = {model.f}, g = {model.g}, restitution {model.restitution}. "
        f"{film.sentence}"
    )
    named = ", ".join(f"{name} = {value}" for name, value in model.parameters.items())
    shown = text + (f" Parameters: {named}." if named else "")
    figure = _figure(film).to_html(
        include_plotlyjs=True, include_mathjax=False, full_html=False, auto_play=False, div_id="explore",
        config={"displaylogo": False, "responsive": True},
    )  # fmt: skip
    return PAGE.format(
        title="Across clearances" if film.swan is None else "Through a swan", text=escape(shown), figure=figure
    )


def _figure(film: ClearanceFilm) -> Any:
    plotly = require_plotly()
    panels = ("V<sub>c</sub>': launches and flight times", "impacts: launch time and velocity")
    figure = plotly.subplots.make_subplots(rows=1, cols=2, subplot_titles=panels, horizontal_spacing=0.09)
    start = _start(film)
    for trace, line in zip(_traces(film.frames[start]), LINES, strict=True):
        figure.add_trace({**trace, "mode": "lines", "name": line.label, "connectgaps": False,
                          "line": {"color": line.color, "dash": line.dash, "width": line.width}}, row=1,
                         col=line.column)  # fmt: skip
    for column in (1, 2):
        figure.add_trace({**_dots(film.frames[start]), "mode": "markers", "name": "tangency points",
                          "showlegend": column == 1, "marker": {"color": "black", "size": 9, "symbol": "diamond"}},
                         row=1, col=column)  # fmt: skip
    figure.frames = [
        {"name": str(n), "data": [*_traces(frame), _dots(frame), _dots(frame)], "traces": list(range(len(LINES) + 2))}
        for n, frame in enumerate(film.frames)
    ]
    figure.update_layout(**_layout(film, start))
    figure.update_xaxes(title="launch phase τ", range=film.tau, zeroline=False)
    figure.update_yaxes(title="flight time t", range=film.t, row=1, col=1)
    figure.update_yaxes(title="velocity v", range=film.v, row=1, col=2)
    return figure


def _start(film: ClearanceFilm) -> int:
    """The frame nearest to the model's own clearance is seen first."""
    from singimpact.algebra.numbers import as_float

    here = as_float(film.model.clearance)
    return int(np.argmin([abs(frame.clearance - here) for frame in film.frames]))


def _layout(film: ClearanceFilm, start: int) -> dict[str, Any]:
    at_once = {"mode": "immediate", "frame": {"duration": 0, "redraw": False}, "transition": {"duration": 0}}
    steps = [
        {"method": "animate", "args": [[str(n)], at_once], "label": _label(film, frame)}
        for n, frame in enumerate(film.frames)
    ]
    slider = {"active": start, "currentvalue": {"prefix": "clearance c = "}, "pad": {"t": 50}, "steps": steps,
              "name": "clearance"}  # fmt: skip
    return {"sliders": [slider], "template": "plotly_white", "height": 640,
            "legend": {"orientation": "h", "y": 1.18}, "margin": {"t": 120, "l": 60, "r": 20}}  # fmt: skip


def _label(film: ClearanceFilm, frame: ClearanceFrame) -> str:
    return f"{frame.clearance:.6g}" + (
        " = c_0" if film.swan is not None and frame.clearance == film.swan.clearance else ""
    )


def _traces(frame: ClearanceFrame) -> list[dict[str, Any]]:
    made = [frame.line(line.name) for line in LINES]
    return [{"type": "scatter", "x": _short(x), "y": _short(y)} for x, y in made]


def _dots(frame: ClearanceFrame) -> dict[str, Any]:
    # the page keeps showing a trace whose new data are empty: a gap erases it
    if not len(frame.tangencies):
        return {"type": "scatter", "x": [None], "y": [None]}
    return {"type": "scatter", "x": _short(np.array(frame.tangencies)), "y": [0.0] * len(frame.tangencies)}


def _short(values: Any) -> list[float | None]:
    """A few digits, and null for a gap."""
    return [float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None for value in values.tolist()]


def require_plotly() -> Any:
    """The library, or one line that says how to have it.

    Raises
    ------
    InputError : it is not installed.
    """
    try:
        import plotly.graph_objects
        import plotly.subplots
    except ImportError:
        raise InputError("the page needs plotly, which is not installed: add the extra `interactive`") from None
    return plotly
