"""Phases of arrays of times: bit for bit those of exact arithmetic."""

from fractions import Fraction

import numpy as np
import pytest

from singimpact.algebra.numbers import as_float, constant
from singimpact.oscillator.period import phase_of, reduced


@pytest.mark.parametrize("text", ["2*pi", "pi/1.7", "1/3", "1e-7", "1e-70", "1000000*pi"])
@pytest.mark.parametrize("far", [3, 1e4, 2e7])
def test_phases_of_arrays_are_the_exact_ones(text, far):
    period = constant("period", text)
    size = as_float(period)
    times = np.concatenate([np.random.default_rng(1).uniform(-far, far, 200), np.arange(-20, 20) / 2]) * size
    exact = [phase_of(Fraction(time), period) if abs(time) > size else time for time in times.tolist()]
    assert reduced(times, period).tolist() == exact
