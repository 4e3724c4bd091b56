"""Pictures of branches: each stretch in its style, events where they are, names clear of curves."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.text import Text

import singimpact as si
from singimpact.inputs import InputError
from singimpact.scenes import LINES, MARKS, orbit_color


@pytest.fixture(scope="module")
def branch():
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
    return si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.6, -0.2))


@pytest.fixture(scope="module")
def closed():
    osc = si.linear(omega="2.8", clearance="0.1", restitution="0.8", amplitude=-1)
    return si.branch(osc.periodic(3, 3)[0], "clearance", (-0.2, 0.3))


@pytest.fixture(scope="module")
def curves():
    osc = si.linear(1, -1, "0.8", damping="0.1", amplitude="-0.12")
    found = si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.3, -0.05))
    return [si.event_curve(each, ("amplitude", "omega"), ((-0.3, -0.05), (0.9, 1.1))) for each in found.events]


def stretches(axes, n: int, k: int):
    return [line for line in axes.lines if line.get_color() == orbit_color(n, k) and line.get_marker() == "None"]


@pytest.mark.slow
def test_each_stretch_has_its_style_and_ends_at_an_event(branch) -> None:
    axes = si.plot(branch)
    stable, unstable, virtual = stretches(axes, 1, 1)
    doubling, graze = (event.parameter for event in branch.events)
    assert [line.get_xdata()[i] for line in (stable, unstable, virtual) for i in (0, -1)] == pytest.approx(
        [-0.6, doubling, doubling, graze, graze, -0.2]
    )
    styles = [line.get_linestyle() for line in (stable, unstable, virtual)]
    assert (styles[0], len({*styles, stable.get_linewidth(), virtual.get_linewidth()})) == ("-", 4)
    assert virtual.get_ydata()[0] == pytest.approx(0, abs=1e-12)
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words == ["(1, 1) orbits", "stable", "unstable", "virtual: goes through the wall"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("amplitude", "velocity $v$ after an impact")


def test_events_are_marked_where_they_are_and_named(branch) -> None:
    axes = si.plot(branch)
    for event in branch.events:
        places = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == MARKS[event.kind]]
        assert np.abs(np.array(places) - [event.parameter, event.orbit.v[0]]).sum(axis=1).min() < 1e-12
    assert [text.get_text() for text in axes.texts] == ["doubling", "graze"]


def overlapped(axes) -> list[tuple[str, str]]:
    """Names that a curve or another name runs through."""
    axes.figure.canvas.draw()
    boxes = [(text.get_text(), Text.get_window_extent(text)) for text in axes.texts]  # without the line to its point
    found = [(a, b) for i, (a, one) in enumerate(boxes) for b, two in boxes[:i] if one.overlaps(two)]
    for line in axes.lines:
        data = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
        shares = np.linspace(0, 1, 200)[:, None, None]
        dense = (data[:-1] + shares * np.diff(data, axis=0)).reshape(-1, 2) if len(data) > 1 else data
        for name, box in boxes:
            inside = (dense > [box.x0, box.y0]).all(axis=1) & (dense < [box.x1, box.y1]).all(axis=1)
            found += [(name, "a curve")] if inside.any() else []
    return found


@pytest.mark.slow
def test_names_are_clear_of_curves_and_of_one_another(branch, curves) -> None:
    assert overlapped(si.plot(branch)) == []
    assert overlapped(si.plot(branch, height="phase")) == []
    assert overlapped(si.plot(curves)) == []


@pytest.mark.slow
def test_names_that_would_hide_a_curve_go_to_the_legend(closed) -> None:
    """As in the picture of README, where events pile up among the dots of an attractor."""
    settled = si.bifurcation(closed.oscillator, "clearance", (-0.1, 0.25), points=80, direction="both")
    sheet = si.plot([settled, closed], sheet=True)
    assert [overlapped(axes) for axes in sheet] == [[], []]
    (legend,) = sheet[0].figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert {"doubling", "fold", "graze", "(3, 3) orbits"} <= {*words, *(text.get_text() for text in sheet[0].texts)}
    assert len(words) == len(set(words))
    low, _ = sheet[0].get_ylim()
    assert low < 0  # a marker of a graze at v = 0 is whole


@pytest.mark.slow
def test_impacts_of_a_closed_branch_keep_together(closed) -> None:
    axes = si.plot(closed)
    # a graze has one marker, a fold one an impact
    shapes = [line.get_marker() for line in axes.lines]
    assert (shapes.count("^"), shapes.count("o"), shapes.count("s")) == (2, 6, 6)
    # no stretch jumps from one impact to another
    for line in stretches(axes, 3, 3):
        assert np.abs(np.diff(line.get_ydata())).max() < 0.1


def test_phases_are_cut_at_a_full_period() -> None:
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
    found = si.branch(osc.periodic(1, 1)[0], "phase", (-3, 3))
    axes = si.plot(found, height="phase")
    for line in stretches(axes, 1, 1):
        assert np.nanmax(np.abs(np.diff(line.get_ydata()))) < 0.5
    assert any(np.isnan(line.get_ydata()).any() for line in stretches(axes, 1, 1))
    # the phase of the forcing moves that of the impact, with period 2 pi
    heights = np.concatenate([line.get_ydata() for line in stretches(axes, 1, 1)])
    numbers = np.concatenate([line.get_xdata() for line in stretches(axes, 1, 1)])
    assert np.nanmax(
        np.abs((heights + numbers / (2 * np.pi) - heights[0] - numbers[0] / (2 * np.pi) + 0.5) % 1 - 0.5)
    ) < (1e-9)


def test_branches_over_a_bifurcation_diagram(branch) -> None:
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
    axes = si.plot(si.bifurcation(osc, "amplitude", ("-0.55", "-0.4"), points=5, impacts=60, kept=3))
    limits = axes.get_xlim(), axes.get_ylim()
    same = si.plot(branch, ax=axes)
    assert same is axes
    assert (axes.get_xlim(), axes.get_ylim()) == limits
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words[0] == "(2, 2) orbit"
    assert "(1, 1) orbits" in words
    assert [text.get_text() for text in axes.texts] == ["doubling"]  # the graze is outside


@pytest.mark.slow
def test_orbits_without_impact(branch) -> None:
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.3")
    free = si.branch(osc.periodic(0, 1)[0], "amplitude", (-0.6, -0.2))
    alone = si.plot(free)
    assert alone.get_ylabel() == "lowest $x - c$"
    seen, below = sorted(stretches(alone, 0, 1), key=lambda line: -float(line.get_xdata()[-1]))
    assert seen.get_ydata().min() == pytest.approx(0, abs=1e-12)
    assert below.get_ydata().max() == pytest.approx(0, abs=1e-12)
    together = si.plot([branch, free])
    assert all((line.get_ydata() == 0).all() for line in stretches(together, 0, 1))
    assert [text.get_text() for text in together.texts] == ["doubling", "graze"]  # both branches name one graze


@pytest.mark.slow
def test_event_curves_and_their_special_points(curves) -> None:
    axes = si.plot(curves)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("amplitude", "omega")
    assert [text.get_text() for text in axes.texts] == ["resonant graze"]
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words == ["fold", "graze", "doubling", "virtual: goes through the wall"]
    one = si.plot(curves[1])
    assert [text.get_text() for text in one.get_legend().get_texts()] == ["graze"]


@pytest.mark.slow
def test_what_cannot_be_drawn_together(branch, closed, curves) -> None:
    with pytest.raises(InputError, match="over one number"):
        si.plot([branch, closed])
    with pytest.raises(InputError, match="'v' or 'phase'"):
        si.plot(branch, height="x")
    with pytest.raises(InputError, match="branches, event curves"):
        si.plot([branch, curves[0]])


def test_styles_tell_stretches_apart_without_colour() -> None:
    assert len({str(style) for style, _ in LINES.values()}) == 3
    assert len(set(MARKS.values())) == len(MARKS) == 9
