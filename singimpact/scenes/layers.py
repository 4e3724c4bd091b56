"""Layers of a scene: what each needs, the plane it lives in, and how it is drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from singimpact.scenes.style import PENS
from singimpact.surface.curve import STATES, SURFACE, Curve

Drawer = Callable[[Any, list[Curve], str], None]


@dataclass(frozen=True)
class Layer:
    """need : the curves it draws. plane : names of the two axes. label : in the legend. draw : puts them on axes."""

    need: str
    plane: tuple[str, str]
    label: str
    draw: Drawer


def _strokes(pen: str) -> Drawer:
    def draw(axes: Any, curves: list[Curve], label: str) -> None:
        for n, curve in enumerate(curves):
            axes.plot(*curve.points.T, **PENS[pen].line(), label=label if n == 0 else None)

    return draw


def _first_hits(pen: str) -> Drawer:
    """The stretches that are first hits."""

    def draw(axes: Any, curves: list[Curve], label: str) -> None:
        given: str | None = label
        for curve in curves:
            for part in curve.parts(curve.visible):
                look = PENS[pen].line() | {"linewidth": 3.2, "linestyle": "solid"}
                axes.plot(*part.points.T, **look, label=given)
                given = None

    return draw


def _steps(axes: Any, curves: list[Curve], label: str) -> None:
    for n, curve in enumerate(curves):
        axes.plot(*curve.points.T, **PENS["orbit"].beads(), label=label if n == 0 else None)


LAYERS: dict[str, Layer] = {
    "horizon": Layer("horizon", SURFACE, PENS["H"].words, _strokes("H")),
    "zero-set": Layer("zero-set", SURFACE, PENS["Z"].words, _strokes("Z")),
    "visible": Layer("visible", SURFACE, "visible part of $H$", _first_hits("H")),
    "shadow": Layer("shadow", SURFACE, PENS["shadow"].words, _strokes("shadow")),
    "outline": Layer("outline", STATES, PENS["P"].words, _strokes("P")),
    "discontinuities": Layer("discontinuities", STATES, PENS["jump"].words, _strokes("jump")),
    "gamma": Layer("gamma", STATES, PENS["gamma"].words, _strokes("gamma")),
    "stable-manifolds": Layer("stable-manifolds", STATES, r"$W^s_\tau$", _strokes("loop")),
    "foliation": Layer("foliation", STATES, PENS["manifold"].words, _strokes("manifold")),
    "orbits": Layer("orbits", STATES, PENS["orbit"].words, _steps),
}
