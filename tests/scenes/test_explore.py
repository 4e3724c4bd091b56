"""The page with a slider: what its frames hold, that it asks for no network, and that it moves in a browser."""

import re
import shutil
import sys

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.scenes.clearance_frames import clearance_film
from singimpact.scenes.explore import LINES, explore_page

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
NEGATIVE = si.linear(2, "0.9", "0.5")


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
    pytest.importorskip("plotly")
    page = explore_page(film)
    assert "No swan lies between" in page
    assert "<title>Across clearances</title>" in page


def test_page_holds_everything(film):
    pytest.importorskip("plotly")
    page = explore_page(film)
    assert not re.search(r"<(script|link|img)[^>]*(src|href)=\"?http", page)
    assert "default-src 'none'" in page
    assert all(line.label.split(":")[0] in page for line in LINES if line.label.isascii())


def test_without_plotly(film, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly", None)
    monkeypatch.setitem(sys.modules, "plotly.graph_objects", None)
    with pytest.raises(InputError, match="extra `interactive`"):
        explore_page(film)


@pytest.fixture
def browser():
    webdriver = pytest.importorskip("selenium.webdriver")
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for argument in (
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        "--window-size=1400,1000",
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    opened = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
    yield opened
    opened.quit()


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None or DRIVER is None, reason="Debian's chromium and chromium-driver are not here")
def test_slider_moves_the_curves_in_a_browser(film, browser, tmp_path):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.support.wait import WebDriverWait

    place = tmp_path / "page.html"
    place.write_text(explore_page(film))
    browser.get(place.as_uri())
    drawn = "return document.getElementById('explore').data.slice(0, 5).map(t => t.x.filter(x => x !== null).length)"
    paths = "return [...document.querySelectorAll('.scatterlayer .js-line')].map(p => p.getAttribute('d') || '')"
    WebDriverWait(browser, 30).until(lambda each: each.find_elements("css selector", ".slider-rail-touch-rect"))
    before, shown = browser.execute_script(drawn), browser.execute_script(paths)
    assert all(before)
    rail = browser.find_element("css selector", ".slider-rail-touch-rect")
    ActionChains(browser).move_to_element_with_offset(rail, rail.size["width"] // 2 - 8, 0).click().perform()
    WebDriverWait(browser, 10).until(lambda each: each.execute_script(drawn) != before)
    assert browser.execute_script(drawn) == [0] * 5  # past the swan nothing of it is left
    assert browser.execute_script(paths) != shown
    assert [entry for entry in browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")] == []
    asked = browser.execute_script("return performance.getEntriesByType('resource').map(e => e.name)")
    assert [name for name in asked if not name.startswith(("data:", "blob:"))] == []
