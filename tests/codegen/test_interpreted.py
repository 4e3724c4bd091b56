"""A kernel's text gives the same numbers interpreted and compiled, and is compiled when that is worth while."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.codegen import interpreted, kernels

SUMS = "def sums(a, n, out):\n    for i in range(n):\n        out[i, 0] = a[i, 1] / a[i, 0]\n        row = out[i]\n        row[1] = sin(a[i, 1])\n"  # noqa: E501


@pytest.fixture
def fresh(tmp_path, monkeypatch):
    """A cache and a process that have compiled nothing."""
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    monkeypatch.setattr(interpreted, "_SPENT", {})


def summed(text, a, cost):
    out = np.zeros((len(a), 2))
    interpreted.function(text, ("sums",), "sums", cost)(a, len(a), out)
    return out


@pytest.mark.usefixtures("fresh")
def test_same_numbers_and_nothing_compiled():
    a = np.random.default_rng(0).uniform(-2, 2, (50, 2))
    text = SUMS + "# one\n"
    found = summed(text, a, 1.0)
    assert not kernels.is_compiled(text, ("sums",), "sums")
    assert np.array_equal(found[:, 0], a[:, 1] / a[:, 0])
    compiled = summed(text, a, 1e9)
    assert kernels.is_compiled(text, ("sums",), "sums")
    assert np.array_equal(found, compiled)


@pytest.mark.usefixtures("fresh")
def test_what_python_refuses_is_left_to_doubles():
    found = summed(SUMS + "# two\n", np.array([[0.0, 1.0]]), 1.0)
    assert found[0, 0] == np.inf


@pytest.mark.usefixtures("fresh")
def test_patience_ends():
    text, a = SUMS + "# three\n", np.ones((1, 2))
    share = interpreted.PATIENCE.fresh / 2.5
    for _ in range(2):
        summed(text, a, share)
    assert not kernels.is_compiled(text, ("sums",), "sums")
    summed(text, a, share)
    assert kernels.is_compiled(text, ("sums",), "sums")


@pytest.mark.slow
@pytest.mark.parametrize("force", ["x", "x + x**3"])
def test_flights_are_the_same_both_ways(force, monkeypatch):
    from singimpact.flights.impact_map import first_hit
    from singimpact.oscillator.model import Oscillator

    model = Oscillator(force, "cos(2*t)", "0.3", "1/2")
    rng = np.random.default_rng(3)
    tau, v = rng.uniform(0, 3, 60), rng.uniform(0, 1, 60)
    both = []
    for fresh in (1e12, 0.0):
        monkeypatch.setattr(interpreted, "PATIENCE", interpreted.Patience(fresh, fresh))
        monkeypatch.setattr(kernels, "_READY", {})
        both.append(first_hit(model, tau, v))
    assert np.array_equal(both[0].status, both[1].status)
    for one, other in ((both[0].flight_time, both[1].flight_time), (both[0].velocity, both[1].velocity)):
        assert np.abs(one / other - 1).max() < 1e-13
