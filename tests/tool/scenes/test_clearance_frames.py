"""The frames of the page with sliders: what is computed for each place of the clearance, before a browser opens it."""

import numpy as np
import pytest
from explored_models import NEGATIVE, TWO_WALLS

import singimpact as si
from singimpact.inputs import InputError
from singimpact.scenes import clearance_film, explore_page


@pytest.fixture(scope="module")
def film():
    return clearance_film(NEGATIVE, steps=5)


def test_frames_lie_on_both_sides_of_the_swan_and_on_it(film):
    assert [len(frame.tangencies) for frame in film.frames] == [2, 2, 1, 0, 0]
    assert film.frames[2].clearance == film.swan.clearance == 1
    pieces = [{name: len(curves) for name, curves in frame.curves.items()} for frame in film.frames]
    assert all(pieces[0][name] for name in ("Z", "H", "P", "jumps", "gamma"))
    assert not any(pieces[-1].values())


def test_gamma_ends_at_its_tangency_point(film):
    frame = film.frames[0]
    (foot,) = [tuple(curve.points[0]) for curve in frame.curves["gamma"] if curve.marked("foot").size]
    assert np.abs(np.array(foot) - (frame.tangencies[0], 0)).max() < 1e-12


@pytest.mark.parametrize("name", [None, pytest.param("duffing_friction", marks=pytest.mark.slow)])
def test_gamma_bends_smoothly_also_at_the_swan(name):
    """A chord of gamma deviates from the curve by less than a quarter of a pixel of a panel of 600."""
    film = clearance_film(NEGATIVE if name is None else si.models[name](), steps=5)
    drawn = [(frame, curve) for frame in film.frames for curve in frame.curves["gamma"]]
    assert film.swan.clearance in [frame.clearance for frame, _ in drawn]
    for frame, curve in drawn:
        steps = np.diff(curve.points, axis=0) / [np.ptp(frame.view.tau), np.ptp(frame.view.v)] * 600
        turns = np.abs(np.diff(np.unwrap(np.arctan2(*steps.T[::-1]))))
        assert (np.hypot(*steps.T)[1:] * turns / 8).max() < 0.25, frame.clearance


@pytest.mark.slow
def test_the_outline_opens_like_that_of_the_universal_model():
    """Its cusps stand at +-3 half distances, in a window of +-4."""
    small = clearance_film(NEGATIVE, between=("0.999", "1.001"), steps=3)
    (outline,) = small.frames[0].curves["P"]
    half = (small.frames[0].tangencies[1] - small.frames[0].tangencies[0]) / 2
    cusps = outline.marked("cusp")
    assert np.abs(np.abs(cusps[:, 0]) / half - 3).max() < 5e-3
    assert np.abs(cusps[:, 1]).max() < small.v[1]


def test_positive_swan_has_gamma_too():
    opened = clearance_film(si.linear(2, "-0.9", "0.5"), steps=2)
    assert (opened.swan.kind, len(opened.frames[0].tangencies)) == ("positive", 1)  # one of the two is the swan itself
    assert opened.frames[1].curves["gamma"]


@pytest.mark.parametrize(
    ("model", "given", "told"),
    [
        (NEGATIVE, {"between": (3, 2)}, "between"),
        (NEGATIVE, {"steps": 1}, "steps = 1"),
        (3, {}, "model = 3"),
        (TWO_WALLS["linear"], {"between": ("-0.6", "0.5")}, "below the upper wall, which stays at x = 0.5"),
    ],
)
def test_refusals(model, given, told):
    with pytest.raises(InputError, match=told):
        clearance_film(model, **given)


def test_a_model_without_a_swan_is_shown_around_its_clearance():
    film = clearance_film(si.universal(-1, "0.5"), steps=2)
    assert (film.swan, [round(frame.clearance, 9) for frame in film.frames]) == (None, [-0.1, 0.1])
    assert all(len(frame.tangencies) == 2 for frame in film.frames)
    assert "No swan lies between c = -0.1 and c = 0.1: f does not contain x" in film.sentence
    cusps = film.frames[0].curves["P"][0].marked("cusp")
    assert np.abs(cusps[:, 1]).max() == pytest.approx(64)
    assert np.abs(cusps[:, 1]).max() < film.v[1]


def test_ends_without_a_swan_between_them_are_shown():
    film = clearance_film(NEGATIVE, between=("0.2", "0.4"), steps=2)
    assert film.swan is None
    assert film.sentence == "No swan lies between c = 0.2 and c = 0.4."
    assert all(frame.curves["gamma"] for frame in film.frames)
    page = explore_page(film)
    assert "No swan lies between" in page
    assert "<title>x&#x27;&#x27; + x = cos(omega*t), x \u2265 c</title>" in page


def test_a_model_without_a_bound_of_all_swans_is_shown_too():
    film = clearance_film(si.models.pendulum(), steps=5)
    assert 0 in [frame.clearance for frame in film.frames]  # its own
    assert film.swan is not None


def test_the_models_own_clearance_is_a_place_of_the_slider():
    far = clearance_film(si.linear("2.8", "0.1", "0.8", amplitude=-1), steps=21)
    places = [frame.clearance for frame in far.frames]
    assert {0.1, 1.0} <= set(places)
    assert places == sorted(places)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["duffing_friction", "shaw_holmes", "pendulum", "chin"])
def test_a_page_as_it_is_asked_for_has_400_kilobytes_at_most(name):
    assert len(si.models[name]().explore().html.encode()) < 400_000


@pytest.mark.slow
@pytest.mark.parametrize("name", ["impact pair", "harvester", "stops", "Duffing"])
def test_a_page_of_two_walls_is_not_larger(name):
    assert len(TWO_WALLS[name].explore().html.encode()) < 400_000


def test_a_restitution_with_a_parameter_of_its_own_is_shown_at_a_swan():
    model = si.ImpactOscillator("x", "cos(2*t)", "0.9", "-0.8*v + b*v**2", {"b": "0.05"})
    assert clearance_film(model, steps=2).swan.clearance == 1


@pytest.mark.parametrize(
    ("model", "swan"),
    [
        (TWO_WALLS["linear"], -1),
        (si.linear("2.8", "0.5", "0.8", upper="0.9"), -1),  # the swan at 1 lies above the upper wall
        (si.linear("2.8", "0.9", "0.8", upper="1.01"), 1),
        (TWO_WALLS["harvester"].replace(clearance="0.45"), None),
    ],
)
def test_the_slider_ends_below_the_upper_wall(model, swan):
    film = clearance_film(model, steps=4)
    assert (film.swan and film.swan.clearance) == swan
    own, upper = float(str(model.clearance)), float(str(model.upper))
    places = [frame.clearance for frame in film.frames]
    assert own in places
    assert own < places[-1] < upper
    assert f"The upper wall stays at x = {upper}; the curves are of the lower." in film.sentence


def test_curves_of_two_walls_end_at_the_cut():
    model = si.linear("2.8", "-0.3", "0.8", upper="-0.299")
    frame, alone = (clearance_film(osc, steps=3).frames[1] for osc in (model, model.one_wall()))
    assert frame.clearance == alone.clearance == -0.3
    surface = si.ImpactSurface(model.replace(clearance=-0.3), frame.view.tau, frame.view.t, 1 / 300)
    assert [curve.points.tolist() for curve in frame.curves["cut"]] == [curve.points.tolist() for curve in surface.cut]
    drawn = frame.curves["cut-launches"] + frame.curves["jumps"]
    assert sum(map(len, drawn)) == sum(map(len, surface.discontinuities))
    assert {curve.name for curve in frame.curves["jumps"]} <= {"P"}
    assert {curve.name for curve in frame.curves["cut-launches"]} == {"cut"}
    assert sum(map(len, frame.curves["Z"])) < sum(map(len, alone.curves["Z"]))
    assert not {"cut", "cut-launches"} & set(alone.curves)


def test_windows_follow_the_swan(film):
    """A window holds the curves of its frame and is not much larger."""
    for frame in film.frames[:2]:
        Z = np.vstack([curve.points for curve in frame.curves["Z"]])
        share = np.ptp(Z[:, 1]) / np.ptp(frame.view.t)
        assert 0.4 < share < 1
        assert np.abs(frame.curves["P"][0].points[:, 1]).max() < frame.view.v[1]
    assert np.ptp(film.frames[1].view.v) < np.ptp(film.frames[0].view.v) * 0.7


def test_a_swan_of_a_force_with_t_opens_the_slider():
    """a_c = cos 2t - (1 + cos(2t)/5) c: the swan at pi/2 is where 1 + 4c/5 = 0."""
    film = clearance_film(si.ImpactOscillator("(1 + cos(2*t)/5)*x + 0.1*xdot", "cos(2*t)", "-0.3", "0.7"), steps=3)
    assert abs(film.swan.clearance + 1.25) < 1e-12
    assert [len(frame.tangencies) for frame in film.frames] == [1, 2, 2]
