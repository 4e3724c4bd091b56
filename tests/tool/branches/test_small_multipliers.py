"""Multipliers of orbits that contract strongly: their product is r^(2n) exp(-d k P) in closed form."""

import numpy as np
import pytest

import singimpact as si


def test_the_product_of_the_multipliers_of_damped_orbits():
    rng, seen = np.random.default_rng(5), 0
    for _ in range(25):
        omega, damping, r = (
            f"{value:.3f}" for value in (rng.uniform(0.5, 2), rng.uniform(0.5, 8), rng.uniform(0.3, 0.9))
        )
        osc = si.linear(omega, f"{rng.uniform(-1, 0):.3f}", r, damping=damping, amplitude=f"{rng.uniform(2, 8):.3f}")
        for n, k in ((1, 1), (1, 2), (2, 2)):
            for orbit in osc.periodic(n, k):
                truth = 2 * n * np.log(float(r)) - float(damping) * k * 2 * np.pi / float(omega)
                assert np.log(np.abs(orbit.multipliers)).sum() == pytest.approx(truth, rel=1e-9)
                seen += 1
    assert seen > 15


def test_the_product_with_a_damping_that_varies():
    """ln of the product is the integral of -f_v along the orbit, by Simpson's rule on a sampled orbit."""
    osc = si.ImpactOscillator("x + 4*xdot + xdot**3", "5*cos(t)", "-0.3", "0.7")
    for orbit in osc.periodic(1, 1):
        tau, v = float(orbit.tau[0]), float(orbit.v[0])
        hit = osc.first_hit(tau, v)
        t = np.linspace(0, float(hit.flight_time), 20_001)
        speeds = osc.flight(tau, v, t).xdot
        values, h = 4 + 3 * speeds**2, t[1]
        loss = h / 3 * (values[0] + values[-1] + 4 * values[1:-1:2].sum() + 2 * values[2:-1:2].sum())
        truth = 2 * np.log(0.7) - loss
        assert np.log(np.abs(orbit.multipliers)).sum() == pytest.approx(truth, abs=1e-7)
