"""Scenes: one layer runs nobody else's work, a coarse picture costs less, what was computed is not computed again."""

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.scenes import LAYERS, Scene, plot

NEGATIVE = si.linear(2, "0.7", "0.5")
STATES = {"tau": (-1.2, 1), "v": (0, 0.3), "pixels": 300}
SURFACE = {"tau": (-1.2, 1), "t": (-2, 2), "pixels": 300}
ALONE = {
    "horizon": {"lines", "horizon"},
    "zero-set": {"lines", "zero-set"},
    "visible": {"lines", "visible"},
    "beyond": {"beyond"},
    "cut": {"cut"},
    "outline": {"lines", "outline"},
    "discontinuities": {"lines", "visible", "discontinuities"},
    "gamma": {"gamma"},
    "foliation": {"foliation"},
    "stable-manifolds": {"stable-manifolds"},
    "orbits": {"orbits"},
}


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path / "cache"))


def scene(*layers, **more):
    window = SURFACE if LAYERS[layers[0]].plane == ("tau", "t") else STATES
    return Scene(NEGATIVE, layers, **(window | {"feet": ("0.6",), "orbits": ((-0.9, 0.1),), "leaves": 4} | more))


@pytest.mark.parametrize("layer", ALONE)
def test_one_layer_runs_its_own_work_alone(layer):
    made = scene(layer)
    made.draw()
    assert set(made.results.flights) == ALONE[layer]


def test_a_further_layer_costs_only_itself():
    alone = scene("horizon")
    alone.draw()
    both = scene("horizon", "zero-set")
    both.draw()
    assert both.results.cached == ["lines"]
    assert both.results.flights == {"horizon": 0, "zero-set": 0}
    seen = scene("visible", "zero-set")
    seen.draw()
    assert {need for need, count in seen.results.flights.items() if count} == {"visible"}


def test_a_layer_beside_another_in_one_scene(monkeypatch):
    monkeypatch.setattr("singimpact.scenes.layer_data.recall", lambda _key: None)
    one, two, both = scene("horizon"), scene("zero-set"), scene("horizon", "zero-set")
    spent = []
    for each in (one, two, both):
        each.draw()
        spent.append(each.results.flights)
    assert spent[2] == spent[0] | spent[1]


def test_what_is_kept_is_the_same_curve():
    first, again = scene("outline"), scene("outline")
    first.draw()
    again.draw()
    assert again.report()["flights"] == 0
    for old, new in zip(first.results.get("outline"), again.results.get("outline"), strict=True):
        assert np.array_equal(old.points, new.points)
        assert old.marks == new.marks


WIDE = {"tau": (0, 6), "t": (-6, 6), "v": (0, 3)}
NEAR_SWAN = {"tau": (-1.2, 1), "t": (-2, 2), "v": (0, 0.3)}


@pytest.mark.parametrize(
    ("layers", "clearance", "window"),
    [
        (("horizon", "zero-set"), "0.3", WIDE),
        (("discontinuities",), "0.7", NEAR_SWAN),
        (("stable-manifolds",), "0.3", {"tau": (0, 2.5), "v": (0, 0.5), "feet": ("1.5", "1.8")}),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in (
                *(((layer,), "0.3", WIDE) for layer in ("outline", "visible", "shadow", "gamma")),
                *(((layer,), "0.7", NEAR_SWAN) for layer in ("gamma", "foliation")),
                *((("outline",), clearance, NEAR_SWAN) for clearance in ("0.97", "0.99")),
                (("zero-set",), "0.95", {"tau": (-1, 5), "t": (-3, 3)}),
                (("discontinuities", "gamma", "foliation"), "0.7", NEAR_SWAN),
            )
        ),
    ],
)
def test_a_coarse_picture_costs_a_third_of_a_fine_one(layers, clearance, window, monkeypatch, tmp_path):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))  # what another scene has kept costs no flight
    small, large = (Scene(si.linear(2, clearance, "0.5"), layers, **window, pixels=pixels) for pixels in (400, 2000))
    for each in (small, large):
        each.draw()
    assert 0 < 3 * small.report()["flights"] <= large.report()["flights"]


@pytest.mark.slow
def test_growth_ends_where_the_picture_tells_nothing_new():
    """Loops of W^s accumulate on gamma: a fine picture shows more of them, and none without end."""
    model, window = si.linear(2, "0.95", "0.5"), ((-1.2, 1.0), (0.0, 0.06))
    from singimpact.dynamics import stable_manifold, swan_configuration
    from singimpact.surface import Window

    foot = repr(swan_configuration(model, near=0).X)
    coarse, fine = (stable_manifold(model, Window(*window, 1 / pixels), foot) for pixels in (300, 1500))
    assert 2 < len(coarse) < len(fine) < 40
    assert sum(map(len, fine)) < 20_000


def test_an_empty_scene_says_so():
    axes = Scene(NEGATIVE, (), (-1, 1), v=(0, 1)).draw()
    assert "no layer" in axes.texts[0].get_text()


def test_a_window_without_curves_says_what_is_not_there():
    made = Scene(si.linear(2, "1.01", "0.5"), ("zero-set", "horizon"), (-0.5, 0.5), t=(-0.5, 0.5), pixels=200)
    assert "no zero-set, no horizon" in made.draw().texts[0].get_text()


def test_a_curve_is_drawn_with_its_marks():
    (curve,) = scene("horizon").results.get("horizon")
    assert {text.get_text() for text in plot(curve).texts} >= {"tangency", "cusp"}


def test_a_scene_file(tmp_path):
    text = 'layers = ["orbits"]\ntau = [-1, 1]\nv = [0, "1/2"]\npixels = 200\norbits = [["0.1", "0.2"]]\n'
    (tmp_path / "model.toml").write_text(NEGATIVE.to_toml())
    (tmp_path / "scene.toml").write_text(text + 'model = "model.toml"\n')
    made = Scene.read(tmp_path / "scene.toml")
    assert made.model == NEGATIVE
    made.draw().figure.canvas.draw()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"layers": ("horizn",)}, "unknown layer 'horizn'.*horizon"),
        ({"layers": ("horizon", "gamma")}, "layers of two planes"),
        ({"layers": ("horizon",)}, "window of t is missing"),
        ({"v": (1, 0)}, "window of v"),
        ({"pixels": 3}, "pixels = 3"),
        ({"layers": ("stable-manifolds",)}, "feet is missing"),
        ({"orbits": (3,)}, "orbits = 3"),
        ({"marks": (("A", 1),)}, "marks"),
        ({"layers": "gamma"}, "layers = 'gamma'"),
        ({"osc": 3}, "osc = 3"),
    ],
)
def test_refusals(change, told):
    with pytest.raises(InputError, match=told):
        Scene(**({"osc": NEGATIVE, "layers": ("gamma",), "tau": (-1, 1), "v": (0, 1)} | change))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("tau = [0, 1]", "has no model"),
        ('layer = ["horizon"]', "unknown key.*layers"),
        ("tau = [0", "is not TOML"),
        ("tau = [0, 1]\nmodel = 3", "model = 3"),
        ('tau = [0, 1]\nlayers = "x"\n[model]\nf = "x"', "f, g, clearance|layers"),
    ],
)
def test_refused_files(tmp_path, text, told):
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(InputError, match=told):
        Scene.read(tmp_path / "scene.toml")


def test_a_scene_of_a_wall_shows_the_cut_and_leaves_out_what_lies_beyond_it(tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(
        'wall = "upper"\nlayers = ["horizon", "zero-set", "visible", "beyond", "cut"]\ntau = [-0.5, 4]\nt = [-4, 4]\n'
        '[model]\nf = "x + 0.1*xdot + 0.3*x**3"\ng = "cos(1.7*t)"\nclearance = "-0.3"\nrestitution = "0.6"\n'
        'upper = "0.4"\n'
    )
    made = Scene.read(file)
    labels = [text.get_text() for text in made.draw().get_legend().get_texts()]
    assert {"cut: the flight grazes the other wall", "beyond the cut: the flight meets the other wall"} <= set(labels)
    states = Scene(made.osc, ("discontinuities", "orbits"), (-0.5, 4), v=(0, 1), orbits=((0.5, 0.3),), wall="upper")
    labels = [text.get_text() for text in states.draw().get_legend().get_texts()]
    assert "cut: the flight grazes the other wall" in labels
    flown = si.ImpactOscillator(**made.osc.to_dict()).orbit(0.5, 0.3, 50, wall="upper")
    (shown,) = states.results.get("orbits")
    assert len(shown) == np.count_nonzero(flown.wall == 1) < len(flown.wall)
    with pytest.raises(InputError, match="wall"):
        scene("cut", wall="upper")
