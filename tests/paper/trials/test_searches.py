"""Crossings that trials look for are found, and words of a model as functions."""

import numpy as np
import pytest

from singimpact.algebra import DOUBLES, evaluate, function_of, parse
from singimpact.paper.trials import universal_orbits


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
