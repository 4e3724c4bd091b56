"""The closed form of linear flights against a matrix exponential in 40 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.flights import Allowance, CompiledModel, Emitted, Machine, path
from singimpact.oscillator import Oscillator

MODELS = {
    "undamped": ("x", "cos(2*t)"),
    "damped": ("x + 0.3*xdot", "cos(14*t/5) + sin(t)/3"),
    "damped, with a mean force": ("2*x + 0.1*xdot", "cos(7*t)/2 - 3/4"),
    "resonant": ("x", "cos(t)"),
    "nearly resonant": ("x", "cos(1000001*t/1000000)"),
    "critical": ("x + 2*xdot", "cos(t)"),
    "overdamped": ("x + 5*xdot", "sin(3*t) - 1/3"),
    "growing": ("x - xdot/20", "cos(2*t)"),
    "pushed away": ("-x/2", "cos(2*t)"),
    "a slow spring under a fast force": ("x/400", "cos(9*t) - 1/9"),
    "no spring": ("0.1*xdot", "cos(t)"),
    "constant": ("0", "-2"),
}
CLEARANCE = "0.3"


def exactly(name, tau, v, height, time):
    """x - c and x' in 40 digits: x, x', 1, and cosine and sine of every wave obey a linear equation.

    The size of the numbers that make up the solution is returned with them.
    """
    import sympy

    x, xdot, t = sympy.symbols("x xdot t")
    f, g = (sympy.nsimplify(sympy.sympify(text), rational=True) for text in MODELS[name])
    waves = sorted(g.atoms(sympy.cos, sympy.sin), key=str)
    rates = sorted({wave.args[0].coeff(t) for wave in waves}, key=str)
    size = 3 + 2 * len(rates)
    M = mpmath.zeros(size)
    M[0, 1], M[1, 0], M[1, 1] = 1, -mpf(f.coeff(x)), -mpf(f.coeff(xdot))
    M[1, 2] = mpf(g.subs(dict.fromkeys(waves, 0)))
    start = mpmath.matrix([mpf(sympy.Rational(CLEARANCE)) + mpmath.mpf(height), mpmath.mpf(v), 1, *[0] * (size - 3)])
    for at, rate in enumerate(rates):
        w, column = mpf(rate), 3 + 2 * at
        M[1, column], M[1, column + 1] = mpf(g.coeff(sympy.cos(rate * t))), mpf(g.coeff(sympy.sin(rate * t)))
        M[column, column + 1], M[column + 1, column] = -w, w
        start[column], start[column + 1] = mpmath.cos(w * mpmath.mpf(tau)), mpmath.sin(w * mpmath.mpf(tau))
    end = mpmath.expm(M * mpmath.mpf(time)) * start
    return end[0] - mpf(sympy.Rational(CLEARANCE)), end[1]


def mpf(number):
    return mpmath.mpf(int(number.p)) / int(number.q)


class Never(Machine):
    def entry(self, name):  # noqa: ARG002
        return None

    def interpreted(self, seconds, name):
        pass


@pytest.mark.parametrize("name", MODELS)
def test_against_a_matrix_exponential(name):
    """Of either sign and of all lengths, from the wall and off it; interpreted flights have the same bits."""
    model = si.ImpactOscillator(*MODELS[name], CLEARANCE, "1/2")
    flown = CompiledModel(model, Allowance(10.0))
    draw = np.random.default_rng(2)
    tau, v = draw.uniform(-6, 6, 60), draw.uniform(-1, 1, 60)
    times = draw.choice([-1, 1], 60) * 10 ** draw.uniform(-7, 1, 60)
    heights = np.where(draw.uniform(size=60) < 0.5, 0.0, 10 ** draw.uniform(-6, 1, 60))
    rows = flown.places(tau, v, times, heights)
    with mpmath.workdps(40):
        for row, *state in zip(rows, tau, v, heights, times, strict=True):
            _, _, height, time = state
            z, u = exactly(name, *state)
            reach = min(abs(time), 1) * (1 + abs(time)) * max(1, float(abs(u)), float(abs(z)))
            assert abs(row[0] - z) <= 2e-15 * (height * max(1, float(abs(z))) + reach) * (1 + abs(time)), state
            assert abs(row[1] - u) <= 4e-15 * (1 + height) * max(1, float(abs(u)), float(abs(z))) * (1 + abs(time)), (
                state
            )
    flown.machine = Never(Emitted())
    assert np.array_equal(flown.places(tau, v, times, heights), rows)


def test_a_wrong_place_would_be_seen():
    """The comparison above rejects a velocity that is 1e-13 off."""
    flown = CompiledModel(si.ImpactOscillator(*MODELS["damped"], CLEARANCE, "1/2"), Allowance(10.0))
    row = flown.places(np.array([0.4]), np.array([0.7 + 1e-13]), np.array([1.3]))[0]
    with mpmath.workdps(40):
        z, _ = exactly("damped", 0.4, 0.7, 0.0, 1.3)
        assert abs(row[0] - z) > 2e-15 * 3 * 2.3


@pytest.mark.parametrize("t", [1e-9, 1e-4, 0.1, 0.3, 0.35, 0.4, 1.0])
def test_next_to_a_swan_nothing_cancels(t):
    """x' = v + a t + a' t^2/2 + ... with a and a' next to nothing: against many digits."""
    model = Oscillator("x", "cos(14*t/5)", "0.999999999999", "1/2")
    with mpmath.workdps(50):
        tau, v, time, w = mpmath.mpf(1e-6), mpmath.mpf(1e-12), mpmath.mpf(t), mpmath.mpf(14) / 5
        amplitude, c = 1 / (1 - w**2), 1 - mpmath.mpf(10) ** -12
        height, speed = c - amplitude * mpmath.cos(w * tau), v + amplitude * w * mpmath.sin(w * tau)
        forced = -amplitude * w * mpmath.sin(w * (tau + time))
        true = speed * mpmath.cos(time) - height * mpmath.sin(time) + forced
        assert abs(path(model, 1e-6, 1e-12, t).xdot / true - 1) < 1e-14
