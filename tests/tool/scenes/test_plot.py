"""Pictures of orbits: drawn without a window, with everything that happened in them."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.impact_oscillator import linear
from singimpact.inputs import InputError
from singimpact.scenes import plot


def test_everything_that_happened_is_labelled() -> None:
    axes = plot(linear("0.9", "0.2", "0.4").orbit("0.3", "0.4", impacts=40))
    labels = axes.get_legend_handles_labels()[1]
    assert {"impact", "at rest on the wall", "end of chatter (summed)", "lifts off"} <= set(labels)
    axes.figure.canvas.draw()


def test_the_curve_stays_above_the_obstacle() -> None:
    axes = plot(linear("2.8", "0.1", "0.8").orbit(0.3, 0.4, impacts=30))
    places = axes.lines[0].get_ydata()
    assert np.nanmin(places) >= 0.1 - 1e-12


def test_every_hop_of_a_chatter_is_seen_in_the_sheet() -> None:
    """Each has a top inside the panel, at least 8 pixels of the printed picture away from the next one."""
    orbit = linear(2, "0.7", "0.5").orbit("1.2", "0.3", impacts=200)
    axes = plot(orbit, sheet=True)[3]
    assert axes.get_title() == f"first chatter, complete at t = {orbit.tau[orbit.kind == 'complete'][0]:.6g}"
    axes.figure.canvas.draw()
    (line,) = axes.lines
    points = line.get_transform().transform(line.get_xydata())
    tops = 1 + np.flatnonzero((np.diff(points[:-1, 1]) > 0) & (np.diff(points[1:, 1]) < 0))
    assert len(tops) == np.flatnonzero(orbit.kind == "complete")[0] - 1  # flights from the launch to the last impact
    pixels = points[tops] * 100 / axes.figure.dpi
    assert np.diff(pixels[:, 0]).min() > 8
    assert axes.get_ylim()[0] < line.get_ydata()[tops].min()


def test_a_sheet_without_a_chatter_has_three_panels() -> None:
    assert len(plot(linear("2.8", "0.1", "0.8").orbit(0.3, 0.4, impacts=30), sheet=True)) == 3
    assert len(plot(linear("2.8", "0.1", "0.8").orbit(0.3, 0.4, impacts=0), sheet=True)) == 3


@pytest.mark.parametrize("sheet", [False, True])
def test_a_dark_picture_has_the_colours_of_the_table(sheet) -> None:
    """Light letters and lines on a dark ground, also where it is darkened twice."""
    from matplotlib.colors import to_hex

    from singimpact.scenes import BLUE, on_dark

    orbit = linear(2, "0.7", "0.5").orbit("1.2", "0.3", impacts=60)
    axes = np.ravel(plot(orbit, sheet=sheet, dark=True))[0]
    plot(orbit, ax=axes, dark=True)
    axes.figure.canvas.draw()
    ground, ink = on_dark("#FFFFFF"), on_dark("#000000")
    assert {to_hex(part.get_facecolor()).upper() for part in (axes, axes.figure)} == {ground}
    letters = [axes.xaxis.label, *axes.get_xticklabels(), *axes.get_legend().get_texts()]
    assert {to_hex(text.get_color()).upper() for text in letters} == {ink}
    assert to_hex(axes.lines[0].get_color()).upper() == on_dark(BLUE)


def test_dark_basins_keep_the_colours_of_their_classes() -> None:
    from singimpact.scenes import on_dark

    found = linear("2.8", "0.1", "0.8", amplitude=-1).basins(size=12)
    light, dark = plot(found), plot(found, dark=True)
    faces = [[patch.get_facecolor()[:3] for patch in axes.get_legend().get_patches()] for axes in (light, dark)]
    assert len(faces[0]) == len(found.classes)
    for code, _, _ in found.classes:
        where = found.codes == code
        before, after = (np.unique(axes.images[0].get_array()[where][:, :3], axis=0) for axes in (light, dark))
        assert [len(before), len(after)] == [1, 1]
        assert np.abs(np.array(faces[1]) - after).sum(axis=1).min() < 1e-9
    assert on_dark("#FFFFFF") != "#FFFFFF"


def test_an_orbit_of_nothing() -> None:
    plot(linear("2.8", "0.1", "0.8").orbit(0.3, 0.4, impacts=0)).figure.canvas.draw()


def test_what_cannot_be_drawn() -> None:
    with pytest.raises(InputError, match="orbit"):
        plot(3)
