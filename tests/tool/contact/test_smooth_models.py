"""Zeros of smooth models whose formulas hold quotients, roots and logarithms, beside dense scans in numpy."""

import numpy as np
import pytest
from scipy.optimize import brentq

import singimpact as si
from singimpact.inputs import InputError


def drawn(rng):
    """g as text and as a function, smooth over the whole period 2 pi, however near its poles and branch points are."""
    near, other = 1 + 10 ** rng.uniform(-3, 0), 1 + 10 ** rng.uniform(-2.5, 0)
    kinds = [
        (f"1/({near!r} - cos(t))", lambda t: 1 / (near - np.cos(t))),
        (f"sqrt({near!r} + cos(t))", lambda t: np.sqrt(near + np.cos(t))),
        (f"log({near!r} + cos(t))", lambda t: np.log(near + np.cos(t))),
        (f"cos(t)/sqrt({near!r} - sin(t)**2)", lambda t: np.cos(t) / np.sqrt(near - np.sin(t) ** 2)),
        (f"sin(t)/({near!r} + cos(t)) + cos(2*t)/({other!r} - sin(t))",
         lambda t: np.sin(t) / (near + np.cos(t)) + np.cos(2 * t) / (other - np.sin(t))),
        (f"({near!r} + sin(t))**(1/3) - cos(t)", lambda t: np.cbrt(near + np.sin(t)) - np.cos(t)),
    ]  # fmt: skip
    return kinds[rng.integers(len(kinds))]


def zeros(function, low, high):
    """Sign changes on a grid that is fine next to poles, by Brent's method."""
    t = np.linspace(low, high, 200_001)
    values = function(t)
    return [
        brentq(function, t[i], t[i + 1], xtol=1e-14)
        for i in np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))
    ]


def test_tangency_points_of_drawn_smooth_models():
    rng = np.random.default_rng(7)
    seen = 0
    for _ in range(25):
        text, g = drawn(rng)
        sample = g(np.linspace(0, 2 * np.pi, 4001))
        c = float(rng.uniform(sample.min(), np.quantile(sample, 0.9)))
        points = si.tangency_points(si.ImpactOscillator("x", text, c, "0.8"))
        truth = zeros(lambda t, g=g, c=c: g(t) - c, 1e-9, 2 * np.pi + 1e-9)
        assert points.tau.tolist() == pytest.approx(truth, abs=1e-9), (text, c)
        seen += len(truth)
    assert seen > 30


def test_swan_points_of_drawn_smooth_forces():
    rng = np.random.default_rng(8)
    for _ in range(6):
        width, level = float(rng.uniform(0.05, 2)), float(rng.uniform(0.05, 0.4))
        for text, f in ((f"x/({width!r} + x**2)", lambda x, w=width: x / (w + x * x)),
                        (f"x/sqrt({width!r} + x**2)", lambda x, w=width: x / np.sqrt(w + x * x))):  # fmt: skip
            swans = si.swan_points(text, f"{level!r}*cos(t)", between=(-3, 3))
            truth = sorted(
                zeros(lambda x, f=f, s=level: f(x) - s, -3, 3) + zeros(lambda x, f=f, s=level: f(x) + s, -3, 3)
            )
            assert sorted(swan.clearance for swan in swans) == pytest.approx(truth, abs=1e-9), text


def test_what_rests_on_the_zeros_works_too():
    osc = si.ImpactOscillator("x", "1/(1.05 - cos(t))", "0.7", "0.6")
    assert len(si.classify(osc).points) > 1
    assert si.basins(osc, size=3, impacts=50).codes.shape == (3, 3)


def test_a_model_that_is_not_smooth_is_refused():
    with pytest.raises(InputError, match="smooth"):
        si.tangency_points(si.ImpactOscillator("x", "1/(1 - cos(t))", "0.3", "0.8"))
    with pytest.raises(InputError, match="not a polynomial"):
        si.swan_points("x/(1 + x**2)", "cos(t)/3")
    with pytest.raises(InputError, match="period"):
        si.tangency_points(si.ImpactOscillator("x", "t/(1 + t**2)", "0.3", "0.8"))
