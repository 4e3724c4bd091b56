"""Jumps and crossings that trials look for are found, and words of a model as functions."""

from types import SimpleNamespace

import numpy as np
import pytest

from singimpact.algebra import DOUBLES, evaluate, function_of, parse
from singimpact.paper.trials import surfaces, universal_orbits


def test_jumps_are_found_between_neighbours_and_smooth_changes_are_not():
    places = np.array([0.3, 1.111, 1.9])

    def impact_map(_tau, v):
        steep = 3 * np.tanh(40 * (v - 0.7))  # changes by 0.05 between neighbours, without a jump
        return SimpleNamespace(flight_time=steep + np.searchsorted(places, v))

    found = surfaces._jumps(SimpleNamespace(impact_map=impact_map), 0.0, count=6001)
    assert len(found) == len(places)
    for (low, high), place in zip(found, places, strict=True):
        assert low <= place <= high
        assert high - low < 1e-3


def test_crossings_are_counted_and_jumps_are_not(monkeypatch):
    def off(_sigma, v):
        return np.where(v < 0.5, np.sin(7 * np.pi * v), 5.0 * np.sign(v - 0.75))

    monkeypatch.setattr(universal_orbits, "_off", off)
    monkeypatch.setattr(universal_orbits, "_outline", lambda _: 1.0)
    assert universal_orbits._crossings(-2.0, 0.05, 1.0) == 3


@pytest.mark.parametrize("text", ["x + 0.1*xdot + 0.3*x**3", "sin(x)/(1 + x**2) - xdot**(1/3)", "2**x*exp(-xdot)", "3"])
def test_a_function_of_a_tree_gives_the_bits_of_its_evaluation(text):
    tree = parse(text, ["x", "xdot"])
    ready = function_of(tree, ("x", "xdot"), DOUBLES)
    for x, xdot in np.random.default_rng(1).uniform(0.1, 2, (20, 2)):
        assert ready(x, xdot) == evaluate(tree, {"x": x, "xdot": xdot}, DOUBLES)
