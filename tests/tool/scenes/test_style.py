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


NAMED = re.compile(r"""\b(?:\w*color|foreground|fill|stroke)["']?\s*[=:]\s*["']([^"'$]+)["']""")
NO_COLOURS = {"none", "auto", "inherit"}


def named(text):
    """Colours that a text names by hand: as six digits, as a share of white, or in words beside a property."""
    words = set(NAMED.findall(text)) - NO_COLOURS
    return {*LITERAL.findall(text), *re.findall(r"\b(?:tab|xkcd):\w+", text), *words}


def test_pictures_name_no_colour_of_their_own(request):
    """Verdicts of the graph of claims, and the terminal, have colours that no curve has."""
    root = request.config.rootpath
    paths = [*root.glob("singimpact/**/*.py"), *root.glob("docs/_extensions/*.py"), *root.glob("singimpact/**/page.js")]
    others = {"singimpact/scenes/style.py", "singimpact/paper/claims/index.py"}
    found = {str(path.relative_to(root)): named(path.read_text()) for path in paths}
    drawing = {name: colors for name, colors in found.items() if colors and name not in others}
    assert drawing == {"singimpact/scenes/drawing.py": {"black"}}  # an example of an argument


def test_a_colour_named_by_hand_is_seen():
    assert named('axes.plot(x, y, color="tab:blue", markerfacecolor="white")') == {"tab:blue", "white"}
    assert named('{"color": "0.35"}; edge = "#ABCDEF"; color="none", loc="best"') == {"0.35", "#ABCDEF"}


def test_notebooks_name_no_colour_of_their_own(request):
    root = request.config.rootpath
    for path in sorted(root.glob("notebooks/*.ipynb")):
        cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
        assert not LITERAL.findall("\n".join("".join(cell["source"]) for cell in cells)), path.name


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
    red, green, blue = (PENS[pen].color[n : n + 2] for n in (1, 3, 5))
    same = on_dark(PENS[pen].color) == PENS[pen].color
    assert same != (red == green == blue or PENS[pen].color in ON_DARK)  # greys change places


def luminance(color):
    red, green, blue = (int(color[n : n + 2], 16) / 255 for n in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue
