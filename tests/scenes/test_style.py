"""One table of looks: figures, scenes and notebooks take colours from it, and curves differ without colour."""

import json
import re

import pytest

from singimpact.scenes.layers import LAYERS
from singimpact.scenes.style import ON_DARK, PENS, on_dark

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


@pytest.mark.parametrize("plane", [("H", "Z", "shadow"), ("P", "jump", "gamma", "manifold", "loop", "rest")])
def test_curves_of_one_plane_differ_in_grey(plane):
    """In style, in width, or in luminance by a tenth."""
    for n, first in enumerate(plane):
        for second in plane[:n]:
            one, other = PENS[first], PENS[second]
            apart = abs(luminance(one.color) - luminance(other.color)) > 0.1
            assert one.style != other.style or abs(one.width - other.width) > 0.3 or apart, (first, second)


@pytest.mark.parametrize("pen", PENS)
def test_curves_are_seen_on_both_grounds(pen):
    assert luminance(PENS[pen].color) < 0.8
    assert luminance(on_dark(PENS[pen].color)) > 0.3
    assert set(ON_DARK) & {PENS[pen].color} or on_dark(PENS[pen].color) == PENS[pen].color


def luminance(color):
    red, green, blue = (int(color[n : n + 2], 16) / 255 for n in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue
