"""Words of a model as functions."""

import numpy as np
import pytest

from singimpact.algebra import DOUBLES, evaluate, function_of, parse


@pytest.mark.parametrize("text", ["x + 0.1*xdot + 0.3*x**3", "sin(x)/(1 + x**2) - xdot**(1/3)", "2**x*exp(-xdot)", "3"])
def test_a_function_of_a_tree_gives_the_bits_of_its_evaluation(text):
    tree = parse(text, ["x", "xdot"])
    ready = function_of(tree, ("x", "xdot"), DOUBLES)
    for x, xdot in np.random.default_rng(1).uniform(0.1, 2, (20, 2)):
        assert ready(x, xdot) == evaluate(tree, {"x": x, "xdot": xdot}, DOUBLES)
