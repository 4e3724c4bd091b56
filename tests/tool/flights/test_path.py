"""The closed form over arrays against that of the kernels, and against an equation that it must solve."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.algebra import as_float
from singimpact.flights import forcing_phases, linear_numbers, numbers_of, over_floats, path, places
from singimpact.oscillator import Oscillator, acceleration

MODELS = {
    "undamped": ("x", "cos(2*t)"),
    "damped": ("x + 0.3*xdot", "cos(14*t/5) + sin(t)/3"),
    "resonant": ("x", "cos(t)"),
    "critical": ("x + 2*xdot", "cos(t)"),
    "no spring": ("0.1*xdot", "cos(t)"),
    "constant": ("0", "-2"),
}


@pytest.mark.parametrize("name", MODELS)
def test_as_the_kernel_has_it(name):
    model = Oscillator(*MODELS[name], "0.3", "1/2")
    rng = np.random.default_rng(2)
    p = numbers_of(model)[0]
    tau, v, t = rng.uniform(0, 6, 80), rng.uniform(0, 1, 80), 10 ** rng.uniform(-5, 1, 80)
    launch = forcing_phases(model, tau)
    space, numbers = over_floats(), linear_numbers(model, as_float)
    found = places(launch, v, acceleration(model, tau), t, p)
    for row, start, speed, time in zip(found, launch, v, t, strict=True):
        z, u, _ = space["restart"](start.tolist(), float(speed), float(time), 0.0, 0.0, 0.0, 2.0**-52, numbers)
        assert abs(row[0] - z) <= 2e-14 * min(time, 1) * (1 + time)
        assert abs(row[1] - u) <= 2e-14 * (1 + time)


def test_there_and_back():
    model = Oscillator("x + 0.3*xdot", "cos(14*t/5)", "0.3", "1/2")
    tau, v, t = np.array([0.4]), np.array([0.7]), np.array([1.3])
    h = 1e-4
    launch, push = forcing_phases(model, tau), acceleration(model, tau)
    before, here, after = (places(launch, v, push, t + s, numbers_of(model)[0])[0] for s in (-h, 0, h))
    bend = (after[1] - before[1]) / (2 * h)
    pull = np.cos(2.8 * 1.7) - (here[0] + 0.3) - 0.3 * here[1]
    assert bend == pytest.approx(pull, abs=1e-6)


@pytest.mark.parametrize("t", [1e-9, 1e-4, 0.1, 0.3, 0.35, 0.4, 1.0])
def test_next_to_a_swan_nothing_cancels(t):
    """x' = v + a t + a' t^2/2 + ... with a and a' next to nothing: against many digits."""
    import mpmath

    model = Oscillator("x", "cos(14*t/5)", "0.999999999999", "1/2")
    with mpmath.workdps(50):
        tau, v, time, w = mpmath.mpf(1e-6), mpmath.mpf(1e-12), mpmath.mpf(t), mpmath.mpf(14) / 5
        amplitude, c = 1 / (1 - w**2), 1 - mpmath.mpf(10) ** -12
        height, speed = c - amplitude * mpmath.cos(w * tau), v + amplitude * w * mpmath.sin(w * tau)
        forced = -amplitude * w * mpmath.sin(w * (tau + time))
        true = speed * mpmath.cos(time) - height * mpmath.sin(time) + forced
        assert abs(path(model, 1e-6, 1e-12, t).xdot / true - 1) < 1e-14
