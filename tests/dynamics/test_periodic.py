"""Periodic orbits against closed forms."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from singimpact.dynamics.periodic import periodic
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.inputs import InputError


@pytest.mark.parametrize("n", [1, 2, 3])
def test_one_impact_in_n_periods(n: int) -> None:
    omega, r, c = 2 * n, 0.5, 0.02
    (found,) = periodic(linear(omega, c, r), 1, n)
    G = 1 / (1 - omega**2)
    v = 2 * r * omega * np.sqrt(G * G - c * c) / (1 - r)
    assert found.v[0] == pytest.approx(v, rel=1e-12)
    assert G * np.cos(omega * found.tau[0]) == pytest.approx(c, rel=1e-9)
    assert G * omega * np.sin(omega * found.tau[0]) == pytest.approx(v * (1 / r - 1) / 2, rel=1e-12)
    assert np.prod(found.multipliers) == pytest.approx(r**2, rel=1e-9)


def test_digits() -> None:
    (found,) = periodic(linear(4, 0, "0.5"), 1, 2, digits=30)
    with mpmath.workdps(40):
        assert abs(found.v[0] - mpmath.mpf(8) / 15) < mpmath.mpf(10) ** -29
        assert abs(found.tau[0] - 3 * mpmath.pi / 8) < mpmath.mpf(10) ** -29
        assert abs(found.multipliers[0] * found.multipliers[1] - mpmath.mpf(1) / 4) < mpmath.mpf(10) ** -29


@pytest.mark.parametrize(("n", "k"), [(0, 1), (1, 0), (1.5, 1), (True, 1)])
def test_bad_counts(n: object, k: object) -> None:
    with pytest.raises(InputError):
        periodic(linear(4, 0, "0.5"), n, k)


def test_no_period() -> None:
    with pytest.raises(InputError, match="period"):
        periodic(ImpactOscillator("0", "-1", 0, "0.5"), 1, 1)
