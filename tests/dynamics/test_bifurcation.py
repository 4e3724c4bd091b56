"""Bifurcation diagrams over any number of a model, and with the last state carried over."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError


@pytest.mark.parametrize(("over", "value"), [("amplitude", 1.3), ("damping", 0.2), ("stiffness", 1.5), ("phase", 0.4)])
def test_a_number_that_the_model_does_not_name(over, value):
    with ThreadPoolExecutor(1) as pool:
        found = si.bifurcation(si.linear(2, 0, "0.5"), over, (value / 2, value), 2, impacts=60, kept=4, executor=pool)
    told = si.linear(2, 0, "0.5", **{over: value}).orbit(0, "0.1", impacts=60)
    assert found.events[-1, :, 1] == pytest.approx(told.v[-4:], rel=1e-12)


def test_an_orbit_of_one_impact_scales_with_the_amplitude():
    # at clearance 0 a linear model has no length but the amplitude
    found = si.bifurcation(si.linear(4, 0, "0.5"), "amplitude", (1, 2), 3, impacts=80, kept=1, direction="both")
    assert found.values.tolist() == [1, 1.5, 2, 2, 1.5, 1]
    # cos(4 t), one impact in two periods: v = 8/15, see `si.linear(4, 0, "0.5").periodic(1, 2)`
    assert found.events[:, 0, 1] == pytest.approx(8 / 15 * found.values, rel=1e-12)
    assert "up and down" in repr(found)


@pytest.mark.slow
def test_a_motion_without_impact_is_carried_until_it_meets_the_wall():
    osc = si.linear("0.8", -1, "0.8", damping="0.05", amplitude="-0.45")
    found = si.bifurcation(osc, "clearance", ("-1.6", "-1"), 25, start=("0.1", 1), impacts=200, kept=1, direction="up")
    size = 0.45 / np.hypot(1 - 0.64, 0.05 * 0.8)  # the amplitude of the settled motion without a wall
    # the first orbit starts at the wall, and has impacts before it leaves it
    assert np.isnan(found.events[1:, 0, 1]).tolist() == (found.values[1:] < -size).tolist()


def test_each_way_alone_is_its_half_of_both():
    osc = si.linear(2, "0.3", "0.5")
    given = {"impacts": 40, "kept": 3}
    both = si.bifurcation(osc, "omega", ("1.9", "2.1"), 4, direction="both", **given)
    up = si.bifurcation(osc, "omega", ("1.9", "2.1"), 4, direction="up", **given)
    down = si.bifurcation(osc, "omega", ("1.9", "2.1"), 4, direction="down", **given)
    assert up.events.tolist() == both.events[:4].tolist()
    assert down.values.tolist() == both.values[4:].tolist()
    assert down.events[-1] == pytest.approx(both.events[-1], abs=1e-8)  # settled orbits of one attractor


def test_both_ways_are_drawn_and_written(tmp_path):
    found = si.bifurcation(si.linear(2, "0.3", "0.5"), "clearance", (0.2, 0.3), 3, impacts=30, kept=2, direction="both")
    axes = si.plot(found)
    assert axes.get_xlim() == (0.2, 0.3)
    assert "impact, on the way down" in [text.get_text() for text in axes.get_legend().get_texts()]
    found.to_csv(tmp_path / "both.csv")
    assert len((tmp_path / "both.csv").read_text().splitlines()) == 13


def test_what_cannot_be_used_is_refused_in_a_sentence():
    osc = si.linear(2, "0.3", "0.5")
    with pytest.raises(InputError, match="direction = 'left' is not accepted: give 'up', 'down' or 'both'"):
        si.bifurcation(osc, "clearance", (0, 1), direction="left")
    with pytest.raises(InputError, match="without executor= and output="):
        si.bifurcation(osc, "clearance", (0, 1), direction="up", output="kept.npz")
    with pytest.raises(InputError, match="unknown number of the model 'mass'"):
        si.bifurcation(osc, "mass", (0, 1))
