"""One table of looks: figures, scenes and notebooks take colours from it, and curves differ without colour."""

import json
import re

import pytest

from singimpact.scenes import (
    BLUE,
    EVENT_PENS,
    LAYERS,
    LINES,
    ON_DARK,
    PENS,
    VERMILLION,
    Pen,
    on_dark,
    orbit_color,
    orbit_width,
)

LITERAL = re.compile(r"#[0-9A-Fa-f]{6}\b")


def test_notebooks_and_figures_name_no_colour_of_their_own(request):
    """The two grounds of figures and the pale surface of figure 1 are no curves."""
    root = request.config.rootpath
    for path in sorted(root.glob("notebooks/*.ipynb")):
        cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
        assert not LITERAL.findall("\n".join("".join(cell["source"]) for cell in cells)), path.name
    found = {
        literal
        for path in (root / "singimpact/paper/figures").glob("*.py")
        for literal in LITERAL.findall(path.read_text())
    }
    assert found <= {"#14181C", "#FFFFFF", "#BBD9EE"}


def test_layers_of_scenes_are_called_as_in_figures():
    pens = {"horizon": "H", "zero-set": "Z", "shadow": "shadow", "outline": "P", "discontinuities": "jump",
            "gamma": "gamma", "foliation": "manifold", "orbits": "orbit"}  # fmt: skip
    assert {name: LAYERS[name].label for name in pens} == {name: PENS[pen].words for name, pen in pens.items()}


def same_in_grey(one, other):
    """Same style, less than half a point of width apart, and less than a fifth of the way from black to white."""
    shades = abs(luminance(one.color) - luminance(other.color))
    return one.style == other.style and abs(one.width - other.width) < 0.5 and shades < 0.2


@pytest.mark.parametrize(
    "together",
    [("H", "Z", "shadow", "jump"), ("P", "jump", "gamma", "manifold", "loop", "rest"), ("W^s", "W^u"),
     ("manifold", "loop", "preimage", "jump", "gamma", "epsilon"), ("P", "graph", "axis"), ("before", "at", "graph")],
)  # fmt: skip
def test_curves_of_one_picture_differ_in_grey(together):
    pairs = [(first, second) for n, first in enumerate(together) for second in together[:n]]
    assert [pair for pair in pairs if same_in_grey(*(PENS[name] for name in pair))] == []


def test_branches_and_events_differ_in_grey():
    orbits = [Pen(orbit_color(1, k), width=LINES["stable"][1] * orbit_width(1, k)) for k in range(1, 7)]
    for pens in (orbits, list(EVENT_PENS.values())):
        assert [(n, m) for n, one in enumerate(pens) for m in range(n) if same_in_grey(one, pens[m])] == []
    assert same_in_grey(Pen(BLUE), Pen(VERMILLION))


@pytest.mark.parametrize("pen", PENS)
def test_curves_are_seen_on_both_grounds(pen):
    assert luminance(PENS[pen].color) < 0.8
    assert luminance(on_dark(PENS[pen].color)) > 0.3
    assert set(ON_DARK) & {PENS[pen].color} or on_dark(PENS[pen].color) == PENS[pen].color


def luminance(color):
    red, green, blue = (int(color[n : n + 2], 16) / 255 for n in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue
