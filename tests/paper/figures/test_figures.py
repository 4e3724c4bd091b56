"""The paper's figures by their data: named points, tangencies, crossings, orders of contact."""

import json
import re
from functools import lru_cache

import numpy as np
import pytest
from click.testing import CliRunner

import singimpact as si
from singimpact.inputs import InputError
from singimpact.paper import CLAIMS, FIGURES, drawn, legend_words, picture
from singimpact.paper.claims import BEYOND as CLAIMS_BEYOND
from singimpact.paper.figures import BEYOND

made = lru_cache(maxsize=None)(picture)
LETTERS = {
    1: set(), 2: set(), 3: {"w_*"}, 4: {"w_*"}, 5: {"w_*"}, 6: {"w_*"}, 7: {"w_*", "w_1"}, 8: {"w_*"}, 9: {"A", "B"},
    10: {"A", "D", "E"}, 11: set("ABCDE"), 12: {"D'", "B'", "E'", "A''", "C''", "E''"}, 13: {"A", "B", "E'", "N"},
    14: set("ABCDE"), 15: {"D'", "B'", "E'", "A''", "C''", "E''"}, 16: {"A", "B", "D'", "C''", "Q"},
    17: {"A", "X", "Q", "D'"},
}  # fmt: skip


def lines(number, name):
    return [line.points for panel in made(number).panels for line in panel.lines if line.name == name]


def dots(number):
    found = {}
    for panel in made(number).panels:
        for dot in panel.dots:
            found.setdefault(dot.letter.strip("$"), dot.place)
    return found


def test_there_are_seventeen():
    assert list(FIGURES) == list(range(1, 18))


@pytest.mark.parametrize(
    "number", [pytest.param(each, marks=pytest.mark.slow) if each in (2, 5) else each for each in FIGURES]
)
def test_claims_letters_and_data(number):
    found = made(number)
    assert found.number == number
    assert found.claims
    assert set(found.claims) <= set(CLAIMS)
    assert set(dots(number)) >= LETTERS[number]
    json.dumps(found.to_dict(), allow_nan=False)


@pytest.mark.parametrize("number", FIGURES)
def test_letters_stand_inside_the_picture(number):
    for panel in made(number).panels:
        (left, right), (low, high) = panel.box
        for dot in panel.dots:
            assert left <= dot.place[0] <= right, dot
            assert low <= dot.place[1] <= high, dot


def test_2_cusps_come_and_go():
    facts = made(2).facts
    assert (facts["lips <"], facts["lips >"]) == (2, 0)
    assert (facts["beaks <"], facts["beaks >"]) == (2, 0)
    assert (facts["swallowtail <"], facts["swallowtail >"]) == (2, 0)


@pytest.mark.slow
def test_2_shows_what_the_transitions_are():
    from singimpact.paper import CHANGES, damped
    from singimpact.surface import transitions

    for change in CHANGES:
        near = change.value - 0.01, change.value + 0.01
        found = [each for each in transitions(damped(), change.over, near, (0, 12)) if each.kind == change.kind]
        assert min(abs(each.value - change.value) + abs(each.t - change.t) for each in found) < 1e-4


def test_3_leaves_have_the_eigendirection():
    facts = made(3).facts
    assert abs(facts["drawn"] / facts["slope"] - 1) < 0.05


def test_5_gamma_lies_between_p_and_the_axis_with_a_quadratic_tangency():
    assert 0 < made(5).facts["gamma_below_P"] < 1
    assert abs(made(5).facts["order"] - 2) < 0.1


def test_7_epsilon_is_tangent():
    assert abs(made(7).facts["order"] - 2) < 0.15


def test_8_gamma_is_cubically_tangent():
    assert abs(made(8).facts["order"] - 3) < 0.1


def test_9_two_cusps():
    assert made(9).facts == {"cusps_positive": 2, "cusps_negative": 2}


def test_13_gamma_ends_between_e_and_a():
    facts = made(13).facts
    assert facts["E"] < facts["gamma_end"] < facts["A"] < facts["N"]


def test_14_the_shadow_joins_d_to_c():
    (shadow,) = lines(14, "shadow DC")
    named = dots(14)
    assert np.abs(shadow[0] - named["D"]).max() < 1e-12
    assert np.abs(shadow[-1] - named["C"]).max() < 1e-12
    assert np.hypot(*np.diff(shadow, axis=0).T).max() < 0.06


def test_15_the_edges_of_the_cut():
    (jump,) = lines(15, "arc D''C''")[:1]
    assert made(15).facts["gap"] < 1e-12
    assert jump[1:, 1].max() < 0


def test_17_w_s_of_x_passes_a_and_q():
    points = np.vstack([*lines(17, "W^s(X)"), *lines(17, "lambda")])
    for name in ("A", "Q", "X"):
        assert np.hypot(*(points - dots(17)[name]).T).min() < 1e-2
    assert made(17).facts["pieces"] > 2
    arcs = [part for n in (1, 2, 3) for part in lines(17, f"G^-{n}(delta)")]
    heights = [np.interp(-0.3, *part[np.argsort(part[:, 0])].T) for part in arcs]
    (gamma,) = lines(17, "gamma")
    floor = np.interp(-0.3, *gamma[np.argsort(gamma[:, 0])].T)
    assert sorted(heights, reverse=True) == heights
    assert heights[-1] > floor


def test_17_loops_close_around_delta_and_accumulate_on_gamma():
    """G^{-1}(lambda) is a loop at A around delta; each further one is nearer to gamma by the multiplier across it."""
    facts, size = made(17).facts, np.ptp([dots(17)["A"][0], dots(17)["X"][0]])
    assert any(line.label == r"$G^{-1}(\lambda)$" for line in made(17).panels[0].lines)
    (right,), (left,) = (lines(17, f"G^-1(lambda), {side} branch") for side in ("right", "left"))
    assert max(np.hypot(*(end - dots(17)["A"])) for end in (right[0], left[-1])) < 0.02 * size
    assert facts["gap 1 left"] < facts["gap delta"] < facts["gap 1 right"]
    count = int(facts["generations"])
    assert count >= 5
    gaps = [facts[f"gap {n} {side}"] for n in range(1, count + 1) for side in ("right", "left")]
    assert sorted(gaps, reverse=True) == gaps
    assert gaps[-1] > 0
    shrunk = float(1 / si.fixed_points.tangency("1/2").mu.value)
    assert facts["gap 6 right"] / facts["gap 5 right"] == pytest.approx(shrunk, rel=0.02)


@pytest.mark.parametrize("number", [pytest.param(2, marks=pytest.mark.slow), 11, 16])
def test_drawn_without_a_warning(number):
    si.figure(number).canvas.draw()


def test_the_command(tmp_path):
    from singimpact.cli.picture_commands import figure_command

    told = CliRunner().invoke(figure_command, ["11", "-o", str(tmp_path), "--format", "svg", "--data"])
    assert told.exit_code == 0, told.output
    assert (tmp_path / "figure11.svg").read_text().count("<path") > 5
    data = json.loads((tmp_path / "figure11.json").read_text())
    assert re.match("x", data["model"]) or data["model"]
    assert set("ABCDE") <= {letter.strip("$") for letter in data["panels"][0]["points"]}


@pytest.mark.parametrize("wrong", [0, 18, "x", True, 2.5, "²", "1" * 5000])
def test_no_such_figure(wrong):
    with pytest.raises(InputError, match="a number from 1 to 17, or B1 to B11"):
        si.figure(wrong)


@pytest.mark.parametrize("number", FIGURES)
def test_every_line_is_in_the_legend_and_the_figure_has_a_caption(number):
    """A curve that no legend names is the axis t = 0 alone; captions are sentences with closed formulas."""
    from singimpact.paper import legend_words
    from singimpact.scenes import LONGEST_TEXT, PENS

    found, words = made(number), legend_words(made(number))
    drawn = {line.words or PENS[line.pen].words for panel in found.panels for line in panel.lines if line.pen != "axis"}
    assert drawn <= set(words)
    assert len(words) == len(set(words))
    assert all(len(each) < LONGEST_TEXT / 3 for each in words)
    assert found.caption.endswith(".")
    assert found.caption.count("$") % 2 == 0
    assert found.to_dict()["caption"] == found.caption


@pytest.mark.parametrize("number", [4, 13, *(pytest.param(each, marks=pytest.mark.slow) for each in (5, 9, 15, 16))])
def test_letters_are_clear_of_curves_and_of_one_another(number):
    """The box of each letter, less its margins, holds no part of a curve, and no other letter."""
    from matplotlib.text import Text

    figure = si.figure(number)
    figure.canvas.draw()
    for axes in (axes for axes in figure.axes if axes.lines):  # others hold a legend
        texts = [text for text in axes.texts if text.get_text()]
        for text in texts:
            text.get_window_extent()  # an annotation moves to its place when it is asked for its extent
        boxes = [Text.get_window_extent(text) for text in texts]  # without the lines to their points
        curves = np.vstack([dense(line) for line in axes.lines])
        for n, (text, box) in enumerate(zip(texts, boxes, strict=True)):
            inside = (curves > [box.x0 + 2, box.y0 + 3]) & (curves < [box.x1 - 2, box.y1 - 3])
            assert not inside.all(axis=1).any(), text.get_text()
            assert not any(box.overlaps(other) for other in boxes[:n]), text.get_text()


def dense(line):
    """Points of a drawn line, in pixels, one a pixel."""
    points = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
    length = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    share = np.arange(0, min(length[-1], 1e5), 1.0)
    return np.stack([np.interp(share, length, column) for column in points.T], axis=1)


def test_outlines_are_smooth_at_the_size_of_print():
    """A chord of P in figures 5 and 13 deviates from the curve by less than a tenth of a point of print."""
    for number, name in ((5, "P_*"), (13, "arc BE' of P")):
        (box,) = [panel.box for panel in made(number).panels]
        points = lines(number, name)[0] / [side[1] - side[0] for side in box] * 72 * 4
        inner = points[(points[:, 1] > 0) & (points[:, 1] < 72 * 4)]
        first, middle, last = inner[:-2], inner[1:-1], inner[2:]
        chord = last - first
        aside = np.abs(chord[:, 0] * (middle - first)[:, 1] - chord[:, 1] * (middle - first)[:, 0]) / np.hypot(*chord.T)
        assert aside.max() < 0.4, number  # two chords together: four times one


@pytest.mark.parametrize("look", [{}, {"serif": True}, {"dark": True}])
def test_letters_are_eight_points_high_on_a_journals_page(look):
    figure = si.figure(11, **look)
    axes = figure.axes[0]
    assert figure.get_size_inches()[0] <= 7
    assert {text.get_fontsize() for text in (axes.xaxis.label, axes.yaxis.label, *axes.texts)} == {8.0}
    assert axes.xaxis.label.get_fontfamily() == (["STIXGeneral"] if look.get("serif") else ["sans-serif"])
    ticks = axes.xaxis.get_ticklabels()
    assert all(tick.get_fontfamily() == axes.xaxis.label.get_fontfamily() for tick in ticks)
    ground, ink = np.mean(figure.get_facecolor()[:3]), axes.texts[0].get_color()
    assert (ground < 0.2) == bool(look.get("dark"))
    assert ink != figure.get_facecolor()


def test_the_command_takes_serif_and_dark(tmp_path):
    from singimpact.cli.picture_commands import figure_command

    written = []
    for n, options in enumerate([[], ["--serif"], ["--dark"]]):
        target = tmp_path / f"{n}.svg"
        told = CliRunner().invoke(figure_command, ["11", "-o", str(target), *options])
        assert told.exit_code == 0, told.output
        written.append(target.read_text())
    assert "STIX" in written[1]
    assert len(set(written)) == 3
    assert "#14181c" in written[2]


SECONDS = ("B7", "B8", "B9", "B10", "B11")  # many true orbits


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in SECONDS else name for name in BEYOND]
)
def test_figures_beyond_the_paper_have_claims_and_data(name):
    found = made(name)
    assert found.number == name
    assert found.claims or name == "B10"  # whose data are enclosures themselves
    assert set(found.claims) <= set(CLAIMS_BEYOND)
    assert found.caption.endswith(".")
    json.dumps(found.to_dict(), allow_nan=False)
    for panel in found.panels:
        (left, right), (low, high) = panel.box
        assert all(left <= dot.place[0] <= right and low <= dot.place[1] <= high for dot in panel.dots)


@pytest.mark.slow
@pytest.mark.parametrize("number", ["B7", "B8"])
def test_orbits_and_words_of_both_planes(number):
    found = made(number)
    assert set(found.claims) <= set(CLAIMS_BEYOND)
    assert found.caption.endswith(".")
    assert found.caption.count("$") % 2 == 0
    assert legend_words(found) == ["apparent outline $P$", "discontinuities of $G$: visible part of $P$"]
    json.dumps(found.to_dict(), allow_nan=False)
    drawn(found).canvas.draw()
    for panel in found.panels:
        (left, right), (low, high) = panel.box
        for dot in panel.dots:
            assert left < dot.place[0] < right
            assert low <= dot.place[1] <= high


def test_the_paper_has_none_of_them():
    assert not set(BEYOND) & set(FIGURES)
    with pytest.raises(InputError, match="B1 to B11"):
        picture("B12")


@pytest.mark.slow
def test_b9_slopes():
    """Slopes of gamma between two points, beside (j+1)/(1-q); the second term raises them, most at q = 2/5."""
    lines = made("B9").panels[0].lines
    marks = [line.points[0] for line in lines if line.beads]
    assert len(marks) == 16
    for j, (q, slope) in zip(np.repeat([1, 1, 2, 2], 4), marks, strict=True):
        assert 0 < slope - (j + 1) / (1 - q) < (0.05 if q == 0.4 else 0.01)


def test_b1_the_ball_falls_freely():
    """y'' by differences of the drawn orbit is A(s), until it lands."""
    _, ball, _, same = made("B1").panels
    orbit, landing, *_ = (line.points.T for line in same.lines)
    s, y = orbit[:, orbit[0] < landing[0, 0]]
    second = np.diff(np.diff(y) / np.diff(s)) / np.diff((s[:-1] + s[1:]) / 2)
    wanted = np.interp(s[1:-1], *ball.lines[0].points.T)
    assert np.abs(second - wanted).max() < 1e-3 * np.abs(wanted).max()


def test_b2_starts_at_the_foot_without_restitution():
    """X = 3 at r = 0: the mass stays where it first lands."""
    assert made("B2").facts["at r = 0"] == pytest.approx(-0.8, abs=1e-12)


def test_b3_ends_of_the_exponents():
    facts = made("B3").facts
    assert all(abs(facts[f"alpha at r = 1, j = {j}"] - 3 / (3 + 2 * j)) < 1e-3 for j in range(6))


def test_b5_bounds():
    facts = made("B5").facts
    assert 2.94 < facts["least"] < facts["most"] < 3.06
    assert abs(facts["limit"] - 2.9410294) < 1e-7


def test_b6_height_of_the_hop():
    facts = made("B6").facts
    assert abs(facts["height at c = 0.999"] - 9 / 8) < 2e-3
    assert facts["height at c = 0.9"] < facts["height at c = 0.97"] < facts["height at c = 0.999"]


def test_figure_b5_from_the_command_line(tmp_path):
    from singimpact.cli import main

    done = CliRunner().invoke(main, ["figure", "B5", "-o", str(tmp_path), "--data"])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "figureB5.png").stat().st_size > 10000
    assert json.loads((tmp_path / "figureB5.json").read_text())["figure"] == "B5"


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in SECONDS else name for name in BEYOND]
)
def test_figures_beyond_the_paper_have_titles(name, monkeypatch):
    """Each carries its title, and no panel of several has a letter alone."""
    monkeypatch.setattr("singimpact.paper.figures.picture", made)  # the data are those of the test above
    figure = si.figure(name)
    assert figure.get_suptitle() == made(name).title
    titles = [axes.get_title() for axes in figure.axes]
    assert len(titles) == 1 or all(len(title) > 4 for title in titles)


def test_figures_of_the_paper_leave_their_titles_to_its_captions():
    assert si.figure(11).get_suptitle() == ""


def test_8_says_what_the_hairpins_are():
    assert "hairpin" in made(8).caption
    assert any("hairpin" in words for words in legend_words(made(8)))


def ink(figure):
    """The pixels of a light figure that are not white."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].min(axis=2) < 250


def test_1_fills_its_picture():
    dark = ink(si.figure(1))
    for axis in (0, 1):
        used = np.flatnonzero(dark.any(axis=axis))
        assert np.ptp(used) > 0.8 * dark.shape[1 - axis]


def test_16_has_no_empty_quarter():
    dark = ink(si.figure(16))
    height, width = dark.shape
    for rows in (slice(0, height // 2), slice(height // 2, height)):
        for columns in (slice(0, width // 2), slice(width // 2, width)):
            quarter = np.argwhere(dark[rows, columns])
            assert np.ptp(quarter[:, 1]) > 0.3 * width


@pytest.mark.slow
def test_5_has_its_legend_where_no_curve_is():
    figure = si.figure(5)
    figure.canvas.draw()
    (axes,) = figure.axes
    box = axes.get_legend().get_window_extent()
    assert axes.bbox.x0 < box.x0 < box.x1 <= axes.bbox.x1 + 1
    points = np.vstack([dense(line) for line in axes.lines])
    assert not ((points > [box.x0, box.y0]) & (points < [box.x1, box.y1])).all(axis=1).any()


@pytest.mark.slow
def test_2_has_no_power_of_ten_beside_its_titles():
    figure = si.figure(2)
    figure.canvas.draw()
    assert [axes.yaxis.get_offset_text().get_text() for axes in figure.axes] == [""] * 9
    assert [bool(axes.get_ylabel()) for axes in figure.axes] == [True, False, False] * 3


@pytest.mark.slow
def test_b10_leaves_open_what_a_dot_hides():
    diagram = made("B10")
    assert diagram.facts == {"open": 4.0}
    curves = [line for line in diagram.panels[0].lines if not line.beads]
    assert len(curves) == 20  # six lines of one impact and seven of two
    assert {line.pen for line in curves} == {
        f"({n}, {k}) orbits, {word}" for n, k in ((1, 1), (1, 2), (2, 2)) for word in ("stable", "unstable")
    }


@pytest.mark.slow
def test_b11_has_the_curves_of_a_contact_of_order_three():
    """The graze of the hop has one coefficient for every r; the border orbit has its certified value at r = 1/2."""
    half, every = made("B11").panels
    grazes, border = ({line.name: line.points for line in every.lines}[name] for name in
                      ("graze of the hop", r"border orbit, $\kappa_*(r)$"))  # fmt: skip
    assert np.allclose(grazes[:, 1], -2 * np.sqrt(2) / 27, atol=1e-5)
    assert border[8] == pytest.approx((0.5, -0.247345775310), abs=1e-5)
    assert len([line for line in half.lines if line.name == "swan"]) == 2
