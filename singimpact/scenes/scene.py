"""A scene: a model, a window, the layers to show and the size of the picture; it computes what these need, no more."""

import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, constant
from singimpact.inputs import InputError, checked_methods, refuse, require, require_known, shown, unknown, whole
from singimpact.oscillator.model import FIELDS, Oscillator, read_fields, require_model
from singimpact.scenes.layer_data import Results, Shown
from singimpact.scenes.style import BLACK, GREY, PENS, WHITE, new_axes
from singimpact.store import read_bounded
from singimpact.surface.curve import STATES, SURFACE, Curve, window_ends

DPI = 100
LONGEST_TEXT = 200  # characters of a title or a mark; 200 000 made a picture of 16 MB
SIZES = (100, 8000)  # of a picture, in points
LEAVES = 500


# Layers of a scene: what each needs, the plane it lives in, and how it is drawn.

Drawer = Callable[[Any, list[Curve], str], None]


@dataclass(frozen=True)
class Layer:
    """need : the curves it draws. plane : names of the two axes. label : in the legend. draw : puts them on axes."""

    need: str
    plane: tuple[str, str]
    label: str
    draw: Drawer


def _strokes(pen: str, beads: bool = False) -> Drawer:
    def draw(axes: Any, curves: list[Curve], label: str) -> None:
        look = PENS[pen].beads() if beads else PENS[pen].line()
        for n, curve in enumerate(curves):
            axes.plot(*curve.points.T, **look, label=label if n == 0 else None)

    return draw


def _jumps(axes: object, curves: list[Curve], label: str) -> None:
    """The discontinuities on P, and the launches that graze a second wall."""
    _strokes("jump")(axes, [curve for curve in curves if curve.name != "cut"], label)
    _strokes("cut")(axes, [curve for curve in curves if curve.name == "cut"], PENS["cut"].words)


def _first_hits(pen: str) -> Drawer:

    def draw(axes: Any, curves: list[Curve], label: str) -> None:
        look = PENS[pen].line() | {"linewidth": 3.2, "linestyle": "solid"}
        for n, part in enumerate(part for curve in curves for part in curve.parts(curve.visible)):
            axes.plot(*part.points.T, **look, label=None if n else label)

    return draw


LAYERS: dict[str, Layer] = {
    "horizon": Layer("horizon", SURFACE, PENS["H"].words, _strokes("H")),
    "zero-set": Layer("zero-set", SURFACE, PENS["Z"].words, _strokes("Z")),
    "visible": Layer("visible", SURFACE, "visible part of $H$", _first_hits("H")),
    "shadow": Layer("shadow", SURFACE, PENS["shadow"].words, _strokes("shadow")),
    "cut": Layer("cut", SURFACE, PENS["cut"].words, _strokes("cut")),
    "beyond": Layer("beyond", SURFACE, PENS["beyond"].words, _strokes("beyond")),
    "outline": Layer("outline", STATES, PENS["P"].words, _strokes("P")),
    "discontinuities": Layer("discontinuities", STATES, PENS["jump"].words, _jumps),
    "gamma": Layer("gamma", STATES, PENS["gamma"].words, _strokes("gamma")),
    "stable-manifolds": Layer("stable-manifolds", STATES, r"$W^s_\tau$", _strokes("loop")),
    "foliation": Layer("foliation", STATES, PENS["manifold"].words, _strokes("manifold")),
    "orbits": Layer("orbits", STATES, PENS["orbit"].words, _strokes("orbit", beads=True)),
}


@partial(checked_methods, two_walls=True)
@dataclass(frozen=True)
class Scene:
    """A picture, before it is drawn.

    Parameters
    ----------
    osc : the oscillator. layers : their names, all in one plane: horizon, zero-set, visible, shadow in (tau, t), and
        of a model with two walls cut and beyond, the parts of H and Z whose flights meet the other wall;
        outline, discontinuities, gamma, stable-manifolds, foliation, orbits in (tau, v).
    tau : ends of the window. t : of either sign; flights of this length are looked at. v : ends, the lower one 0.
    pixels : width of the picture; curves are computed as exactly as it can show.
    feet : times whose W^s_tau the layer stable-manifolds draws. leaves : of the layer foliation.
    orbits : states (tau, v) of the layer orbits, and how many impacts. marks : (letter, tau, t or v).
    wall : of a model with two: the one whose V_c' and states are shown, "lower" (also without it) or "upper".

    Examples
    --------
    >>> scene = Scene(Oscillator("0", "12*(t**2 - 1)", 0, "1/2"), ("zero-set",), (-4, 4), t=(-6, 6), pixels=200)
    >>> [curve.closed for curve in scene.results.get("zero-set")], sorted(scene.results.flights)
    ([True], ['lines', 'zero-set'])
    """

    osc: Oscillator
    layers: tuple[str, ...] = ()
    tau: Any = (-1, 1)
    t: Any = None
    v: Any = None
    pixels: int = 800
    title: str = ""
    feet: tuple[Any, ...] = ()
    leaves: int = 16
    orbits: tuple[tuple[Any, Any], ...] = ()
    impacts: int = 50
    marks: tuple[tuple[str, float, float], ...] = ()
    wall: object = None
    plane: tuple[str, str] = field(init=False, default=STATES)
    model = property(lambda self: self.osc)

    def __post_init__(self) -> None:
        require_model("osc", self.osc)
        self.osc.seen_from(self.wall)  # refused before the work
        if isinstance(self.layers, str) or not isinstance(self.layers, Iterable):
            raise refuse("layers", self.layers, "a list of names of layers")
        self._set("pixels", whole("pixels", self.pixels, *SIZES))
        for name in self.layers:
            if not isinstance(name, str) or name not in LAYERS:
                raise unknown("layer", str(name), LAYERS)
        for name, most in (("leaves", LEAVES), ("impacts", 100_000)):
            self._set(name, whole(name, getattr(self, name), 1, most))
        self._set("layers", tuple(self.layers))
        self._set("title", checked_text("title", self.title))
        self._set("plane", self._plane())
        self._set("tau", window_ends("tau", self.tau))
        self._check_second()
        self._check_states()

    def _set(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)

    def _plane(self) -> tuple[str, str]:
        planes = {LAYERS[name].plane for name in self.layers}
        if len(planes) > 1:
            apart = [", ".join(n for n in self.layers if LAYERS[n].plane == plane) for plane in (SURFACE, STATES)]
            raise InputError(f"layers of two planes: {apart[0]} in (tau, t), {apart[1]} in (tau, v): make two scenes")
        return planes.pop() if planes else (STATES if self.t is None else SURFACE)

    def _check_second(self) -> None:
        for name in ("t", "v"):
            value = getattr(self, name)
            if value is not None:
                self._set(name, window_ends(name, value))
        if self.plane == SURFACE and self.t is None:
            raise InputError("window of t is missing: layers of (tau, t) need it")
        if self.plane == STATES and self.v is None:
            raise InputError("window of v is missing: layers of (tau, v) need it")
        if self.v is not None and self.v[1] <= 0:
            raise refuse("window of v", self.v, "an upper end > 0")

    def _check_states(self) -> None:
        if "stable-manifolds" in self.layers and not self.feet:
            raise InputError("feet is missing: layer stable-manifolds draws W^s_tau at the times named there")
        if "orbits" in self.layers and not self.orbits:
            raise InputError("orbits is missing: layer orbits draws those from the states (tau, v) named there")
        for state in self.orbits:
            if not isinstance(state, tuple | list) or len(state) != 2:
                raise refuse("orbits", state, "states of two numbers, tau and v")
        for mark in self.marks:
            require(isinstance(mark, tuple | list) and len(mark) == 3, "marks", mark, "a letter and two numbers")
        places = (
            (checked_text("marks", mark[0]), *(as_float(constant("marks", entry)) for entry in mark[1:]))
            for mark in self.marks
        )
        self._set("marks", tuple(places))

    @classmethod
    def read(cls, path: str | Path) -> "Scene":
        """A scene from a TOML file: the fields of a scene, with [model] as in a model file, or model = "FILE.toml"."""
        fields = _toml(path)
        require_known(f"key in scene file {shown(str(path))}:", fields, FILE_KEYS)
        if "model" not in fields or "tau" not in fields:
            raise InputError(f"scene file {shown(str(path))} has no {'model' if 'model' not in fields else 'tau'}")
        fields["osc"] = _model(fields.pop("model"), Path(path))
        for key in ("layers", "feet", "orbits", "marks"):
            if not isinstance(fields.get(key, []), list):
                raise refuse(key, fields[key], "a list")
            if key in fields:
                fields[key] = tuple(tuple(entry) if isinstance(entry, list) else entry for entry in fields[key])
        return cls(**fields)

    @property
    def seen(self) -> Oscillator:
        """The model whose lower wall is the one that is shown."""
        return self.osc.seen_from(self.wall)

    @property
    def times(self) -> tuple[float, float]:
        """The window of flight times."""
        wide = self.tau[1] - self.tau[0]
        found: tuple[float, float] = self.t if self.t is not None else (-wide, wide)
        return found

    @property
    def speeds(self) -> tuple[float, float]:
        """The window of velocities."""
        found: tuple[float, float] = self.v if self.v is not None else (0.0, 1.0)
        return found

    @cached_property
    def results(self) -> Results:
        """The curves of the layers, each computed when a layer first uses it."""
        windows = (self.tau, self.times, self.speeds, self.pixels)
        return Results(Shown(self.seen, *windows, self.feet, self.leaves, self.orbits, self.impacts))

    @cached_property
    def seconds(self) -> dict[str, float]:
        """Seconds by layer, filled by `draw`."""
        return {}

    def draw(self, axes: Any = None) -> Any:
        """The matplotlib axes with the layers; they say what is not there."""
        width = self.pixels / DPI
        axes = new_axes(width, 0.7 * width, DPI) if axes is None else axes
        missing = []
        for name in self.layers:
            start, layer = perf_counter(), LAYERS[name]
            curves = self.results.get(layer.need)
            if not any(_inside(curve.points, self._box()) for curve in curves):
                missing.append(name)
            layer.draw(axes, curves, layer.label)
            self.seconds[name] = perf_counter() - start
        self._dress(axes, missing)
        return axes

    def _repr_png_(self) -> bytes:
        from io import BytesIO

        file = BytesIO()
        self.draw().figure.savefig(file, format="png")
        return file.getvalue()

    def _box(self) -> tuple[tuple[float, float], tuple[float, float]]:
        return self.tau, self.times if self.plane == SURFACE else self.speeds

    def _dress(self, axes: Any, missing: list[str]) -> None:
        from matplotlib import patheffects

        (left, right), (low, high) = self._box()
        axes.axhline(0, color=GREY, linewidth=0.8, zorder=1)
        axes.set(xlim=(left, right), ylim=(low, high), xlabel=r"time $\tau$", title=self.title)
        axes.set_ylabel("flight time $t$" if self.plane == SURFACE else "velocity $v$")
        halo = [patheffects.withStroke(linewidth=3, foreground=WHITE)]
        for letter, x, y in self.marks:
            axes.plot([x], [y], "o", color=BLACK, markersize=4, zorder=6, clip_on=False)
            axes.annotate(letter, (x, y), (5, 5), textcoords="offset points", path_effects=halo, zorder=7)
        if missing or not self.layers:
            absent = f"in this window there is no {', no '.join(missing)}" if missing else "no layer: nothing to show"
            look = {"ha": "center", "va": "center", "color": GREY, "wrap": True, "path_effects": halo, "zorder": 8}
            axes.text(0.5, 0.5, absent, transform=axes.transAxes, **look)
        if axes.get_legend_handles_labels()[0]:
            # a small picture keeps its axes: the legend lies inside them, however wide its words are
            axes.legend(loc="best", fontsize="small", framealpha=0.9).set_in_layout(False)

    def report(self) -> dict[str, Any]:
        """Flights computed, seconds by layer, what came from the cache, curves of each layer in the window."""
        return {
            "flights": sum(self.results.flights.values()),
            "flights_by_need": dict(self.results.flights),
            "seconds_by_layer": dict(self.seconds),
            "from_cache": list(self.results.cached),
            "curves": {name: len(self.results.get(LAYERS[name].need)) for name in self.layers},
        }


def checked_text(name: str, text: Any) -> str:
    """A text that a picture can show: of at most LONGEST_TEXT printable characters, its formulas readable.

    Raises
    ------
    InputError : it is longer, has control characters, or a formula between dollars that is none.

    Examples
    --------
    >>> checked_text("title", "a swan")
    'a swan'
    """
    content = str(text)
    if len(content) > LONGEST_TEXT or not content.replace("\n", "").isprintable():
        raise refuse(name, content, f"at most {LONGEST_TEXT} printable characters")
    if "$" in content:
        from matplotlib.mathtext import MathTextParser

        try:
            MathTextParser("path").parse(content)
        except ValueError as error:
            reason = str(error).strip().splitlines()[-1]
            raise refuse(name, content, f"formulas between dollars that can be typeset ({reason})") from None
    return content


FILE_KEYS = ("model", *(name for name in Scene.__dataclass_fields__ if name not in ("osc", "plane")))


def _inside(points: Any, box: Any) -> bool:
    (left, right), (low, high) = box
    x, y = np.asarray(points)[:, :2].T
    return bool(np.any((x >= left) & (x <= right) & (y >= low) & (y <= high)))


def _toml(path: str | Path) -> dict[str, Any]:
    try:
        return tomllib.loads(read_bounded(path, "scene file").decode("utf-8"), parse_float=str)
    except InputError:  # a ValueError too
        raise
    except (ValueError, RecursionError) as error:  # an integer of 5000 digits is a plain ValueError
        raise InputError(f"scene file {shown(str(path))} is not TOML: {' '.join(str(error).split())}") from None


def _model(fields: Any, path: Path) -> Oscillator:
    """A table as in a model file, or the name of one, beside the scene."""
    if isinstance(fields, str):
        return Oscillator(**read_fields(path.parent / fields))
    require(isinstance(fields, dict), "model", fields, "a table [model] or the name of a model file")
    require_known("key in [model]:", fields, FIELDS)
    for key in FIELDS[:4]:
        if key not in fields:
            raise InputError(f"[model] has no {key}: a model needs {', '.join(FIELDS[:4])}")
    return Oscillator(**fields)
