"""Orbits of one impact in k periods of a linear model, all of them, in closed form.

With T = k P fixed, x(T) - c and x'(T) are linear in v and in the cosines and sines of the launch phase:
    v B + L_1(tau) = 0,   v (B' + 1/r) + L_2(tau) = 0,      so L_2 B - L_1 (B' + 1/r) = 0,
a trigonometric polynomial in tau, whose roots are eigenvalues.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.flights.family import LinearFamily, family
from singimpact.flights.model_numbers import linear_waves
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]


def phases_and_speeds(osc: Oscillator, k: int) -> tuple[Array, Array] | None:
    """Phases in [0, period) and velocities of all solutions, virtual ones too; None where there is a continuum.

    Parameters
    ----------
    osc : a linear model with a period and a number for restitution.

    Examples
    --------
    >>> tau, v = phases_and_speeds(Oscillator("x", "cos(4*t)", 0, "0.5"), 2)
    >>> [round(float(each), 12) for each in v]
    [-0.533333333333, 0.533333333333]
    """
    flights = family(osc)
    assert isinstance(flights, LinearFamily)
    assert osc.period is not None
    period, r = as_float(osc.period), as_float(osc.restitution)
    time = k * period
    flow = flights.flow({}, time)[:2]
    by_v = np.array([flow[0, 1], flow[1, 1] + 1 / r])
    waves = linear_waves(osc)
    degrees = [round(abs(as_float(wave.rate)) * period / (2 * np.pi)) for wave in waves]
    size = max(degrees, default=0)
    # the coefficients of e^{i m omega tau}, m = -size ... size, of L_1 and L_2
    series = np.zeros((2, 2 * size + 1), dtype=complex)
    series[:, size] = flow[:, 2]
    for j, (wave, degree) in enumerate(zip(waves, degrees, strict=True)):
        sign = 1 if as_float(wave.rate) > 0 else -1
        turned = (flow[:, 3 + 2 * j] - 1j * flow[:, 4 + 2 * j]) / 2 * np.exp(1j * as_float(wave.phase))
        series[:, size + sign * degree] += turned
        series[:, size - sign * degree] += np.conj(turned)
    total = series[1] * by_v[0] - series[0] * by_v[1]
    scale = np.abs(series).max() * np.abs(by_v).max()
    if np.abs(total).max() <= 1e-13 * scale:
        return None
    angles = _refined(_near(total), total, size)
    tau = np.mod(angles, 2 * np.pi) * period / (2 * np.pi)
    powers = np.exp(1j * np.outer(angles, np.arange(-size, size + 1)))
    parts = (powers @ series.T).real
    row = int(np.argmax(np.abs(by_v)))
    return tau, -parts[:, row] / by_v[row]


def _near(total: Array) -> Array:
    """Real roots of a real trigonometric polynomial and near them, from its coefficients of e^{i m angle}."""
    if len(total) == 3:  # a + b cos(angle + shift)
        share = -total[1].real / (2 * abs(total[2])) if total[2] else np.inf
        if abs(share) > 1 + 1e-9:
            return np.zeros(0)
        turn = np.arccos(np.clip(share, -1, 1))
        return np.asarray(np.array([turn, -turn]) - np.angle(total[2]))
    roots = np.roots(np.trim_zeros(np.where(np.abs(total) < 1e-15 * np.abs(total).max(), 0, total))[::-1])
    return np.asarray(np.angle(roots[np.abs(np.abs(roots) - 1) < 1e-6]))


def _refined(angles: Array, total: Array, size: int) -> Array:
    """Real roots of a real trigonometric polynomial near these angles, each once; the others were none."""
    orders = 1j * np.arange(-size, size + 1)
    at = angles.copy()
    with np.errstate(all="ignore"):
        for _ in range(50):
            waves = np.exp(np.outer(at, orders))
            step = (waves @ total).real / (waves @ (orders * total)).real
            at = at - np.clip(step, -0.1, 0.1)
            if not (np.abs(step) > 1e-15).any():
                break
    waves = np.exp(np.outer(at, orders))
    good = np.abs((waves @ total).real) <= 1e-13 * np.abs(total).sum()
    roots: list[float] = []
    for angle in np.sort(np.mod(at[good], 2 * np.pi)).tolist():
        if all(min(abs(angle - other), 2 * np.pi - abs(angle - other)) > 1e-9 for other in roots):
            roots.append(angle)
    return np.array(roots)
