"""The page with sliders, in a browser: what is drawn and flown there against what Python computes."""

import inspect
import json
import re

import numpy as np
import pytest
from explored_models import BENT, DUFFING, NEGATIVE, PARAMETRIC, TWO_WALLS

import singimpact as si
from singimpact.flights.kernels import roots
from singimpact.scenes import CURVES, PENS, clearance_film, explore_page, on_dark

SLOW = pytest.mark.slow


@pytest.fixture(scope="module")
def film():
    return clearance_film(NEGATIVE, steps=5)


def test_page_holds_everything(film):
    page = explore_page(film)
    assert len(page) < 1e6
    assert not re.search(r"(src|href)=[\"']?(http|//)|url\([\"']?(http|//)", page)
    assert "default-src 'none'" in page
    assert 'name="viewport"' in page
    assert all(label in json.loads(re.search(r"const LEGEND = (.*);", page)[1])[n]["label"]
               for n, (_, label) in enumerate(CURVES.values()))  # fmt: skip
    assert not re.search("@[a-z]+@", page)


def test_a_text_of_the_model_ends_no_script():
    page = explore_page(clearance_film(si.ImpactOscillator("x", "cos(a*t)", "0.3", 1, {"a": 2}), steps=2))  # no gamma
    assert page.count("</script>") == 1


@pytest.fixture
def opened(browser, film, tmp_path):
    """The browser with the page of the film, or of another model; a page that complains fails its test."""

    def show(model=None, between=("0.1", "0.2"), steps=2):
        place = tmp_path / "page.html"
        place.write_text(explore_page(film if model is None else clearance_film(model, between=between, steps=steps)))
        browser.get(place.as_uri())
        return browser

    yield show
    assert [entry for entry in browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")] == []
    asked = browser.execute_script("return performance.getEntriesByType('resource').map(e => e.name)")
    assert [name for name in asked if not name.startswith(("data:", "blob:"))] == []


MOVE = """const input = at(arguments[0]); input.value = arguments[1];
input.dispatchEvent(new Event("input")); input.dispatchEvent(new Event("change"));"""
DRAWN = """const panel = at(arguments[0]), number = (node, name) => Number(node.getAttribute(name));
const ticks = [...panel.querySelectorAll("text")].map(
  (text) => [text.getAttribute("text-anchor"), number(text, "x"), number(text, "y"), text.textContent]);
const paths = {};
for (const path of panel.querySelectorAll("path")) {
  paths[path.dataset.curve] = [path.getAttribute("d"), path.getAttribute("stroke")];
}
const dots = [...panel.querySelectorAll("[data-dots=tangencies] circle")].map(
  (dot) => [number(dot, "cx"), number(dot, "cy")]);
return { ticks, paths, dots };"""


def scale(ticks):
    """From pixels to data, by the numbers at the axes."""
    named = [(place, float(text)) for place, text in ticks if re.fullmatch(r"-?[0-9.]+", text)]
    assert len(named) >= 2
    factor, start = np.polyfit(*zip(*named, strict=True), 1)
    assert np.abs(np.polyval([factor, start], [place for place, _ in named]) - [value for _, value in named]).max() < (
        1e-6 * np.ptp([value for _, value in named])
    )
    return lambda pixels: factor * pixels + start


def read(browser, panel):
    """Curves and tangency points of a panel in the coordinates of its axes, with the size of a pixel; colours."""
    drawn = browser.execute_script(DRAWN, panel)
    exponent = {"y": 1.0, "x": 1.0}
    for anchor, _, y, text in drawn["ticks"]:
        if found := re.search(r"\(in 1e(-?\d+)\)", text):
            exponent["y" if anchor is None and y < 20 else "x"] = 10.0 ** int(found[1])
    bottom = max(y for anchor, _, y, text in drawn["ticks"] if anchor == "middle" and re.fullmatch(r"-?[0-9.]+", text))
    to_x = scale([(x, text) for anchor, x, y, text in drawn["ticks"] if anchor == "middle" and y == bottom])
    to_y = scale([(y - 4, text) for anchor, x, y, text in drawn["ticks"] if anchor == "end"])
    pixel = np.array([abs(to_x(1) - to_x(0)) * exponent["x"], abs(to_y(1) - to_y(0)) * exponent["y"]])

    def data(pairs):
        pairs = np.array(pairs, dtype=float).reshape(-1, 2)
        return np.stack([to_x(pairs[:, 0]) * exponent["x"], to_y(pairs[:, 1]) * exponent["y"]], axis=1)

    curves = {
        name: [data(re.findall(r"(-?[\d.]+) (-?[\d.]+)", part)) for part in path.split("M") if part]
        for name, (path, _) in drawn["paths"].items()
    }
    return curves, data(drawn["dots"]), pixel, {name: color for name, (_, color) in drawn["paths"].items()}


def test_what_is_drawn_is_the_data_at_ten_places(opened, browser):
    film = clearance_film(NEGATIVE, steps=10)
    browser = opened()
    browser.get(browser.current_url)
    path = browser.current_url.removeprefix("file://")
    with open(path, "w") as page:
        page.write(explore_page(film))
    browser.get(browser.current_url)
    own = [frame.clearance for frame in film.frames].index(0.9)  # the model's clearance is a place of the slider
    assert browser.execute_script("return [Number(at('clearance').value), state.frame]") == [own, own]
    for n, frame in enumerate(film.frames):
        browser.execute_script(MOVE, "clearance", n)
        for panel, names in (("surface", ("Z", "H")), ("states", ("P", "jumps", "gamma"))):
            curves, dots, pixel, colors = read(browser, panel)
            assert set(curves) == {CURVES[name][0] for name in names}
            for name in names:
                shown, wanted = curves[CURVES[name][0]], [curve.points for curve in frame.curves[name]]
                assert [len(part) for part in shown] == [len(part) for part in wanted]
                for part, points in zip(shown, wanted, strict=True):
                    assert np.abs((part - points) / pixel).max() < 0.05
                assert colors[CURVES[name][0]] == PENS[CURVES[name][0]].color
            assert (
                np.abs((dots - np.array([(tau, 0) for tau in frame.tangencies]).reshape(-1, 2)) / pixel).max(initial=0)
                < 0.05
            )
        label = browser.execute_script("return at('clearance-now').textContent")
        assert float(label.split(" ")[0]) == pytest.approx(frame.clearance, rel=1e-5)
        assert ("the swan" in label) is (frame.clearance == 1)
    mark = browser.execute_script("""const mark = document.querySelector(".swan"), box = mark.getBoundingClientRect();
    const slider = at("clearance"), left = slider.getBoundingClientRect().left;
    return [mark.textContent, (box.left + box.right) / 2, left, slider.clientWidth]""")
    swan = [frame.clearance for frame in film.frames].index(1.0)
    assert mark[0] == "c\u2080 = 1"
    assert mark[1] == pytest.approx(mark[2] + 8 + swan / 9 * (mark[3] - 16), abs=2)  # below the handle


def flown(browser, model, tau, v, impacts):
    """The states that the page computes for a model that differs from its own in clearance, r or parameters."""
    values = {name: float(str(value)) for name, value in model.parameters.items()}
    ask = """const fly = flyer(arguments[0], arguments[1], arguments[2], MODEL.period);
    return flown(fly, arguments[3], arguments[4], arguments[5])"""
    r = float(str(model.slope_at_rest()))
    return browser.execute_script(ask, float(str(model.clearance)), r, values, tau, v, impacts)


@pytest.mark.parametrize(
    "model",
    [
        NEGATIVE.replace(clearance="0.15"),
        *(pytest.param(each, marks=pytest.mark.slow) for each in (DUFFING.replace(clearance="0.15"), BENT, PARAMETRIC)),
    ],
)
def test_orbits_of_the_page_are_those_of_python(opened, model):
    browser = opened(model.replace(clearance="0.15"))
    compared = 0
    for tau, v in ((0.3, 0.5), (1.1, 1.7), (-2.0, 0.9), (4.0, 0.05)):
        truth, found = model.orbit(tau, v, impacts=12), flown(browser, model, tau, v, 12)
        same = min(len(truth.tau), len(found["tau"]))
        kinds = list(truth.kind[:same])
        kept = kinds.index("complete") if "complete" in kinds else same
        # away from grazes: those next to one lose digits in both
        slow = [k for k in range(1, kept) if abs(truth.v[k]) < 1e-3 * truth.v[k - 1]]
        kept = min([kept, *slow])
        assert found["kind"][:kept] == kinds[:kept]
        for name in ("tau", "v"):
            wanted = getattr(truth, name)[:kept]
            # each impact from the state of Python: along an orbit the last digits grow apart
            ends = [flown(browser, model, float(truth.tau[k]), float(truth.v[k]), 1)[name][1] for k in range(kept - 1)]
            assert np.abs(np.array(ends) / wanted[1:] - 1).max() < 1e-12
            assert np.abs(np.array(found[name][:kept]) / wanted - 1).max() < 1e-10
        compared += kept - 1
        shifted = flown(browser, model.replace(clearance=float(str(model.clearance)) + 1e-9), tau, v, 12)
        assert np.abs(np.array(shifted["tau"][1:kept]) / truth.tau[1:kept] - 1).max() > 1e-12  # the comparison can fail
    assert compared >= 20


FLOWN_FROM = """const fly = flyer(MODEL.clearance, MODEL.r, MODEL.parameters, MODEL.period);
%s
return arguments[0].map(([tau, v, wall, most]) => flown(wall ? fly.across : fly, tau, v, most));"""
FAULTS = {
    "tau": "fly.rules.gap += 1e-6;",
    "wall": "fly.across.rules.gap = Infinity;",
    "v": "fly.across.w = fly.across.w.map((each) => 0.99 * each);",
}
"""Another place of the upper wall, a lower wall that is passed, another restitution: columns that they change."""


@pytest.mark.parametrize(
    "name",
    ["linear", "impact pair", "Duffing", *(pytest.param(name, marks=SLOW) for name in ("harvester", "stops", "bent"))],
)
def test_flights_between_two_walls_are_those_of_python(opened, name):
    model, rng = TWO_WALLS[name], np.random.default_rng(5)
    browser = opened(model)
    tau, v, walls = rng.uniform(-5, 5, 150), rng.uniform(0.02, 2, 150), rng.integers(0, 2, 150)
    truth = model.impact_map(tau, v, wall=walls)
    own = np.flatnonzero((truth.status == si.Status.hit) & (np.abs(truth.velocity) > 1e-2 * v))
    assert own.size > 120
    assert len({*zip(walls[own], truth.wall[own], strict=True)}) == 4  # from both walls to both
    rows = [[float(tau[k]), float(v[k]), int(walls[k]), 1] for k in own]

    def columns(fault=""):
        orbits = browser.execute_script(FLOWN_FROM % fault, rows)
        return {key: np.array([orbit[key][-1] for orbit in orbits]) for key in ("tau", "v", "wall")}

    found = columns()
    assert (found["wall"] == truth.wall[own]).all()
    for key in ("tau", "v"):
        wanted = getattr(truth, key)[own]
        assert (np.abs(found[key] - wanted) <= 1e-11 * (1 + np.abs(wanted))).all()
    for key, fault in FAULTS.items():
        assert (np.abs(columns(fault)[key] - found[key]) > 1e-8).any(), key


@pytest.mark.parametrize("name", ["linear", "impact pair", "Duffing", pytest.param("bent", marks=SLOW)])
@pytest.mark.parametrize("wall", [0, 1])
def test_orbits_between_two_walls_are_those_of_python(opened, name, wall):
    model, starts = TWO_WALLS[name], ((0.3, 0.5), (1.1, 1.7), (-2.0, 0.9))
    rows = [[tau, v, wall, 12] for tau, v in starts]
    shown = opened(model).execute_script(FLOWN_FROM % "", rows)
    for (tau, v), found in zip(starts, shown, strict=True):
        truth = model.orbit(tau, v, impacts=12, wall=wall)
        assert found["wall"] == truth.wall.tolist()
        assert found["kind"] == truth.kind.tolist()
        for key in ("tau", "v"):
            # rounding errors grow along an orbit
            assert np.abs(np.array(found[key][:8]) / getattr(truth, key)[:8] - 1).max() < 1e-10
    assert {1} < {*np.concatenate([found["wall"] for found in shown])}


def test_steps_are_bounded_by_the_recurrence_of_the_model(opened):
    """`steps.disc` is that of x'' = 0 and stays out of the page."""
    counted = """let calls = 0;
    const { coefficients } = SIDES[0], fly = flyer(MODEL.clearance, MODEL.r, MODEL.parameters, MODEL.period);
    const { taylor_flight } = flights_with(coefficients, () => { calls += 1; return [0, 0]; });
    taylor_flight([0.3], 0.5, 1, NaN, fly.p, fly.rules, fly.work, []);
    return calls"""
    assert opened(TWO_WALLS["Duffing"]).execute_script(counted) > 0


def test_both_walls_and_their_impacts_are_drawn(opened):
    model = TWO_WALLS["Duffing"]
    browser = opened(model, between=None, steps=3)
    browser.execute_script("start_orbit(0.3, 0.5)")
    truth = model.orbit(0.3, 0.5, impacts=200)
    shown = browser.execute_script("""const dots = (name) => document.querySelectorAll(`[data-dots=${name}] circle`);
    const ends = [...document.querySelectorAll("#motion [data-wall]")].map((line) => Number(line.dataset.wall));
    return { walls: ends, heights: film.points.map((point) => point[1]), orbit: state.orbit,
      counts: ["orbit", "orbit-upper", "impacts", "impacts-upper"].map((name) => dots(name).length),
      open: document.querySelector("[data-dots=orbit-upper]").getAttribute("fill"),
      labels: [...document.querySelectorAll("#legend li")].map((line) => line.textContent),
      notes: at("notes").textContent, start: at("wall").value }""")
    upper = int((truth.wall == 1).sum())
    assert shown["counts"][:2] == [201 - upper, upper]
    assert shown["walls"] == [0, pytest.approx(0.7)]
    assert 0 < shown["counts"][3] < shown["counts"][2]
    assert max(shown["heights"]) == pytest.approx(0.7, abs=1e-12)
    assert min(shown["heights"]) >= -1e-12
    assert shown["open"].lower() == "#ffffff"
    assert {"impacts of the orbit at the upper wall", "cut: the flight grazes the upper wall"} <= set(shown["labels"])
    assert f"200 impacts, {upper} of them at the upper wall," in shown["notes"]
    time = 0.5 * (truth.tau[1] + truth.tau[2])  # of a flight that starts at the upper wall, or ends there
    assert {*truth.wall[1:3].tolist()} == {0, 1}
    height = browser.execute_script("return height(arguments[0])", time)
    assert height == pytest.approx(float(truth.sample(time).x) + 0.3, abs=5e-3)
    assert browser.execute_script("return csv()").splitlines()[:2] == ["tau,v,kind,wall", "0.3,0.5,start,0"]


def test_the_cut_is_drawn_in_both_planes(opened):
    model = si.linear("2.8", "-0.3", "0.8", upper="-0.299")
    browser = opened(model, between=None, steps=3)
    browser.execute_script("at('axes').value = 'follow'; show()")
    frame = clearance_film(model, steps=3).frames[1]
    for panel, name in (("surface", "cut"), ("states", "cut-launches")):
        curves, _, pixel, colors = read(browser, panel)
        points = np.vstack([curve.points for curve in frame.curves[name]])
        drawn = np.vstack(curves["cut"])
        assert len(points) / 2 <= len(drawn) < 0.6 * len(points) + 2
        assert max(np.abs((points - point) / pixel).max(axis=1).min() for point in drawn) < 0.05
        assert colors["cut"] == PENS["cut"].color


def test_curves_sketched_between_two_walls_end_at_the_cut(opened):
    model = si.ImpactOscillator("x", "cos(w*t)", "-0.3", "0.8", {"w": "2.8"}, upper="-0.299")
    browser = opened(model, between=None, steps=3)
    frame = clearance_film(si.linear("2.8", "-0.3", "0.8", upper="-0.299"), steps=3).frames[1]
    ask = "return sketched(flyer(-0.3, 0.8, { w: 2.8 }, MODEL.period), arguments[0], 160, 161)"
    found = browser.execute_script(ask, {"tau": frame.view.tau, "t": frame.view.t})
    cell = np.array([np.ptp(frame.view.tau), np.ptp(frame.view.t)]) / 160 * 3
    drawn = np.vstack([np.reshape(part, (-1, 2)) for part in found["Z"]])
    true = np.vstack([curve.points for curve in frame.curves["Z"]])
    for points, line in ((drawn, true), (true, drawn)):
        assert np.abs((points[:, None] - line[None]) / cell).max(axis=2).min(axis=1).max() < 1


def test_chatter_at_the_upper_wall_is_that_of_python(opened):
    model = si.ImpactOscillator("x", "1 + 2*cos(t)", "-1", "0.6", upper="0.3")
    truth = model.orbit(-0.5, 0.02, impacts=300, wall="upper")
    (found,) = opened(model).execute_script(FLOWN_FROM % "", [[-0.5, 0.02, 1, 300]])
    for kind in ("complete", "release"):
        first, second = truth.kind.tolist().index(kind), found["kind"].index(kind)
        assert truth.wall[first] == found["wall"][second] == 1
        assert truth.tau[first] == pytest.approx(found["tau"][second], rel=1e-11)


@pytest.mark.parametrize(("g", "wall", "told"), [("-2", 0, "touches the upper wall"), ("2", 1, "touches x = c")])
def test_a_touch_of_the_other_wall_ends_the_orbit(opened, g, wall, told):
    """x = 2 t - t^2 between 0 and 1, from either wall."""
    browser = opened(si.ImpactOscillator("0", g, 0, "1/2", upper=1))
    browser.execute_script("FILM.frames[0].c = 0; to_frame(0); start_orbit(0, 2, arguments[0])", wall)
    assert told in browser.execute_script("return at('notes').textContent")
    browser.execute_script("start_orbit(0, arguments[0])", 2 * (1 + 1e-12))
    assert browser.execute_script("return state.orbit.wall.slice(0, 2)") == [wall, 1 - wall]
    assert "nearly a graze" in browser.execute_script("return at('notes').textContent")


def test_a_link_keeps_the_wall_and_its_restitution(opened):
    browser = opened(TWO_WALLS["Duffing"])
    browser.execute_script(MOVE, "restitution-upper", 120)
    browser.execute_script("start_orbit(0.7, 0.25)")
    browser.execute_script(MOVE, "wall", 1)
    asked = "return [state.r, state.r_upper, state.wall, ...state.orbit.wall.slice(0, 5), ...state.orbit.v.slice(0, 5)]"
    before, link = browser.execute_script(asked), browser.execute_script("return location.pathname + address()")
    assert before[:4] == [0.6, pytest.approx(0.604), 1, 1]
    browser.get("about:blank")
    browser.get(f"file://{link}")
    assert browser.execute_script(asked) == before
    model = TWO_WALLS["Duffing"].replace(clearance="0.1", upper_restitution=before[1])
    assert model.orbit(0.7, 0.25, impacts=4, wall="upper").wall.tolist() == before[3:8]


def test_parameters_moved_are_those_of_another_model(opened):
    browser = opened(DUFFING.replace(clearance="0.15"))
    other = DUFFING.replace(clearance="0.15", omega="1.9", restitution="0.8")
    truth, found = other.orbit(0.3, 0.5, impacts=8), flown(browser, other, 0.3, 0.5, 8)
    assert np.abs(np.array(found["tau"]) / truth.tau - 1).max() < 1e-12
    assert np.abs(np.array(found["v"]) / truth.v - 1).max() < 1e-12


def test_chatter_rests_and_lifts_off_when_it_does_in_python(opened):
    model = DUFFING.replace(clearance="0.7")
    browser = opened(model)
    truth, found = model.orbit(-0.5, 0.02, impacts=3000), flown(browser, model, -0.5, 0.02, 3000)
    for kind, close in (("complete", 1e-11), ("release", 1e-13)):
        first, second = truth.tau[list(truth.kind).index(kind)], found["tau"][found["kind"].index(kind)]
        assert first == pytest.approx(second, rel=close)
    start = "state.frame = 0; at('impacts').value = 3000; FILM.frames[0].c = 0.7; start_orbit(-0.5, 0.02);"
    browser.execute_script(start)
    assert "looked for at 400 times a period" in browser.execute_script("return at('notes').textContent")


def test_a_ball_rests_for_ever(opened):
    found = flown(
        opened(si.ImpactOscillator("0", "-2", "0.15", "1/2")), si.ImpactOscillator("0", "-2", 0, "1/2"), 0, 1, 99
    )
    assert (found["kind"][-1], found["ending"]) == ("complete", 50)
    assert found["tau"][-1] == pytest.approx(2, rel=1e-12)


def test_a_fast_launch_against_a_weak_mean_force_is_followed_until_it_is_back(opened):
    """Its flight is longer than the horizon of slow launches."""
    model = si.ImpactOscillator("0", "cos(2*t) - 1/2000", "0", "1/2")
    hit, found = model.first_hit(0.0, 3.0), flown(opened(model.replace(clearance="0.15")), model, 0.0, 3.0, 1)
    assert hit.flight_time > 10_000
    assert found["tau"][1] == pytest.approx(float(hit.flight_time), rel=1e-10)


def test_a_touch_that_doubles_do_not_decide_ends_the_orbit(opened):
    """x = t (t - 1)^2 up to a rounding: x'' = 6 t - 4 from v = 1."""
    model = si.ImpactOscillator("0", "6*t - 4", 0, "1/2")
    browser = opened(model)
    assert flown(browser, model, 0, 1, 5)["ending"] == 5
    browser.execute_script("state.frame = 0; FILM.frames[0].c = 0; start_orbit(0, 1); ")
    assert "doubles do not decide" in browser.execute_script("return at('notes').textContent")
    near = 1 - 1e-12  # a launch that is slower by this part: an impact at which x' is about -1e-6
    browser.execute_script("start_orbit(0, arguments[0])", near)
    assert "nearly a graze" in browser.execute_script("return at('notes').textContent")


def test_a_click_starts_an_orbit_and_sliders_move_it(opened, film):
    from selenium.webdriver.common.action_chains import ActionChains

    browser = opened()
    browser.execute_script("at('axes').value = 'follow'")
    browser.execute_script(MOVE, "clearance", 0)
    _, _, pixel, _ = read(browser, "states")
    frame = film.frames[0]
    panel = browser.find_element("id", "states")
    ActionChains(browser).move_to_element_with_offset(panel, 60, -70).click().perform()
    tau, v = browser.execute_script("return state.start")
    box = browser.execute_script("return PAGE_NOW.states.box")
    middle = panel.size["width"] / 2 + 60, panel.size["height"] / 2 - 70
    wanted = (
        frame.view.tau[0] + (middle[0] - box["left"]) * pixel[0],
        frame.view.v[1] - (middle[1] - box["top"]) * pixel[1],
    )
    assert np.abs((np.array([tau, v]) - wanted) / pixel).max() < 2
    truth = NEGATIVE.replace(clearance=frame.clearance).orbit(tau, v, impacts=3)
    shown = browser.execute_script("return state.orbit")
    assert np.abs(np.array(shown["tau"][:3]) / truth.tau[:3] - 1).max() < 1e-12
    before = browser.execute_script("return at('motion').querySelector('path').getAttribute('d')")
    assert "nan" not in before.lower()
    browser.execute_script(MOVE, "restitution", 160)
    r = browser.execute_script("return state.r")
    assert r != 0.5
    truth = NEGATIVE.replace(clearance=frame.clearance, restitution=r).orbit(tau, v, impacts=3)
    shown = browser.execute_script("return state.orbit")
    assert np.abs(np.array(shown["v"][:3]) / truth.v[:3] - 1).max() < 1e-12
    curves, *_ = read(browser, "states")
    assert not curves["gamma"]  # it belongs to another r
    assert curves["P"]
    assert "drawn at r = 0.5 only" in browser.execute_script("return at('curves-note').textContent")
    browser.find_element("id", "reset").click()
    assert browser.execute_script("return [state.r, state.frame]") == [0.5, 1]
    browser.find_element("id", "swan").click()
    assert browser.execute_script("return [state.frame, frame().c]") == [2, 1]


def test_curves_sketched_in_the_page_are_those_of_python(opened):
    """At the parameters of another model: within a cell of its grid."""
    model = si.ImpactOscillator("x", "cos(w*t)", "0.9", "1/2", {"w": 2})
    browser = opened(model)
    other = clearance_film(NEGATIVE, steps=3).frames[0]
    window = {"tau": other.view.tau, "t": other.view.t}
    made = "return sketched(flyer(arguments[0], 0.5, { w: 2 }, MODEL.period), arguments[1], 160, 161)"
    found = browser.execute_script(made, other.clearance, window)
    cells = {"Z": (np.ptp(other.view.tau) / 160, np.ptp(other.view.t) / 160)}
    cells["H"] = cells["P"] = cells["Z"]
    for name in ("Z", "H"):
        drawn = np.vstack([np.reshape(part, (-1, 2)) for part in found[name]])
        true = np.vstack([curve.points for curve in other.curves[name]])
        for points, line in ((drawn, true), (true, drawn)):
            away = np.abs((points[:, None] - line[None]) / (np.array(cells[name]) * 3)).max(axis=2).min(axis=1)
            assert away.max() < 1
    assert len(found["Z"]) == 1  # one closed line
    assert found["Z"][0][:2] == found["Z"][0][-2:]


def test_a_parameter_moved_shows_sketches_and_says_so(opened):
    browser = opened(si.ImpactOscillator("x", "cos(w*t)", "0.15", "1/2", {"w": 2}))
    browser.execute_script(MOVE, "parameter-0", 110)
    said = browser.execute_script("return [at('curves-note').textContent, turn_now, state.given.w]")
    assert "sketched" in said[0]
    assert said[1] == pytest.approx(2 * np.pi / said[2], rel=1e-12)


def test_it_opens_with_an_orbit_that_plays(opened):
    browser = opened()
    height = "return Number(document.querySelector('#mass [data-height]').dataset.height)"
    time = "return Number(document.querySelector('#mass [data-height]').dataset.time)"
    start, shown = browser.execute_script("return [state.start, state.orbit.tau.length]")
    assert shown > 2
    assert browser.execute_script(height) == 0
    browser.find_element("id", "play").click()
    browser.execute_async_script("setTimeout(arguments[0], 700)")
    assert browser.find_element("id", "play").text == "Pause"
    browser.find_element("id", "play").click()
    now, x = browser.execute_script(time), browser.execute_script(height)
    assert now > start[0]
    browser.execute_async_script("setTimeout(arguments[0], 200)")
    assert browser.execute_script(time) == now  # it pauses
    truth = NEGATIVE.orbit(*start, impacts=200).sample(now).x - 0.9
    assert x == pytest.approx(float(truth), abs=2e-3)


def test_a_link_keeps_the_state(opened):
    browser = opened(DUFFING)
    browser.execute_script(MOVE, "clearance", 1)
    browser.execute_script(MOVE, "restitution", 120)
    browser.execute_script(MOVE, "parameter-0", 90)
    browser.execute_script("start_orbit(0.7, 0.25)")
    asked = "return [frame().c, state.r, state.given.omega, ...state.start, state.orbit.v[2]]"
    before, link = browser.execute_script(asked), browser.execute_script("return location.pathname + address()")
    browser.get("about:blank")
    browser.get(f"file://{link}")
    assert browser.execute_script(asked) == before
    assert before[3:5] == [0.7, 0.25]


def test_files_of_the_orbit_and_of_the_picture(opened):
    from xml.etree import ElementTree

    browser = opened()
    lines = browser.execute_script("return csv()").splitlines()
    assert lines[0] == "tau,v,kind"
    assert len(lines) == 1 + browser.execute_script("return state.orbit.tau.length")
    assert float(lines[1].split(",")[0]) == browser.execute_script("return state.start[0]")
    drawing = ElementTree.fromstring(browser.execute_script("return picture()"))
    curves = {path.get("data-curve") for path in drawing.iter("{http://www.w3.org/2000/svg}path")}
    assert {"Z", "H", "P", "jump", "gamma", "motion"} <= curves


def test_by_night_it_is_dark(opened):
    browser = opened()
    ground = "return getComputedStyle(document.body).backgroundColor"
    line = "return document.querySelector('#states [data-curve=jump]').getAttribute('stroke')"
    day = browser.execute_script(ground), browser.execute_script(line)
    night = {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", night)
    try:
        assert day == ("rgb(255, 255, 255)", PENS["jump"].color)
        browser.execute_async_script("setTimeout(arguments[0], 100)")
        assert browser.execute_script(ground) == "rgb(20, 24, 28)"
        assert browser.execute_script(line) == on_dark(PENS["jump"].color) != day[1]
        strokes = "return [...document.querySelectorAll('#legend line')].map(line => line.getAttribute('stroke'))"
        assert on_dark(PENS["jump"].color) in browser.execute_script(strokes)
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def test_a_phone_shows_it_without_scrolling_sideways(opened):
    browser = opened()
    size = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        browser.get(browser.current_url)
        browser.execute_script("start_orbit(3, 0.2)")
        assert browser.execute_script("return [innerWidth, document.documentElement.scrollWidth]") == [390, 390]
        letters = browser.execute_script("""return [...document.querySelectorAll("text, label, p, li, button")].map(
            (each) => {
              const svg = each.ownerSVGElement, factor = svg ? svg.clientWidth / svg.viewBox.baseVal.width : 1;
              return parseFloat(getComputedStyle(each).fontSize) * factor;
            })""")
        assert min(letters) > 11.5
    finally:
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_the_kernels_in_javascript_are_bit_for_bit_those_of_python(opened):
    from singimpact.codegen import translated

    text = "\n".join(translated(inspect.getsource(roots)).values())
    rng = np.random.default_rng(3)
    given = [[abs(q[0]), *q[1:].tolist()] for q in rng.normal(size=(200, 9))]
    browser = opened()
    call = f"{text}\nreturn arguments[0].map((q) => first_root(q, 8, 1.5, 0, 1e-15));"
    found = browser.execute_script(call, given)
    assert found == [list(roots.first_root(q, 8, 1.5, 0.0, 1e-15)) for q in given]
    wrong = text.replace("8 * (Math.abs(a0)", "7 * (Math.abs(a0)").replace("(2 * a0) / slope", "(2.1 * a0) / slope")
    assert wrong != text
    assert browser.execute_script(call.replace(text, wrong), given) != found
