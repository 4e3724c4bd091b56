"""Chatter as a leak: the rate of coming to rest, beside the growth of distances and an uncertainty exponent."""

import numpy as np
import pytest

import singimpact as si

PERIODS = 80
APART = 10.0 ** -np.arange(4, 9)


def launches(period, fastest, count):
    rng = np.random.default_rng(0)
    return rng.uniform(0, period, count), rng.uniform(0.02 * fastest, fastest, count)


def growth(osc, period, tau, v):
    """The Lyapunov exponent a period of orbits on the saddle: of pairs that both fly on long after."""
    end, times = (PERIODS + 1) * period, np.arange(4, 18) * period
    one, other = (si.ensemble(osc, tau, speeds, until=end, sample=times) for speeds in (v, v * (1 + 1e-10)))
    late = np.minimum(one.first_rest, other.first_rest) > 30 * period
    with np.errstate(divide="ignore"):
        distance = np.log(np.hypot(one.x - other.x, one.xdot - other.xdot)[:, late])
    mean = distance[:, np.isfinite(distance).all(axis=0)].mean(axis=1)
    small = mean < np.log(1e-4)
    return np.polyfit(times[small] / period, mean[small], 1)[0]


def uncertainty(osc, period, tau, v):
    """The exponent of the share of pairs that rest for the first time more than half a period apart."""
    end = (PERIODS + 1) * period

    def rest(speeds):
        return np.nan_to_num(si.ensemble(osc, tau, speeds, until=end).first_rest, posinf=1e9)

    first = rest(v)
    shares = [np.mean(np.abs(first - rest(v * (1 + part))) > period / 2) for part in APART]
    return np.polyfit(np.log(APART), np.log(shares), 1)[0]


def measured(osc, period, fastest):
    tau, v = launches(period, fastest, 12_000)
    rate = si.ensemble(osc, tau, v, until=(PERIODS + 1) * period).escape_rate(after=12 * period)[0] * period
    return rate, growth(osc, period, tau, v), uncertainty(osc, period, tau[:6000], v[:6000])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("osc", "period", "fastest", "rate"),
    [
        (si.ImpactOscillator("1", "1.9*sin(t)", 0, "1/2"), 2 * np.pi, 3.0, 0.0763),
        (si.linear("3.6", "-0.3", "0.4"), 2 * np.pi / 3.6, 2.0, 0.0415),
    ],
    ids=["ball", "linear"],
)
def test_the_uncertainty_exponent_is_the_rate_over_the_exponent(osc, period, fastest, rate):
    kappa, exponent, alpha = measured(osc, period, fastest)
    assert kappa == pytest.approx(rate, rel=0.06)
    assert alpha == pytest.approx(kappa / exponent, rel=0.15)
    # it is neither the rate itself nor that of twice the growth
    assert alpha != pytest.approx(kappa / (2 * exponent), rel=0.15)


@pytest.mark.slow
def test_a_saddle_that_is_uneven_has_a_smaller_uncertainty_exponent():
    """D_1 <= D_0, and no more: an equality for all models is false."""
    kappa, exponent, alpha = measured(si.linear("7.2", "0.1", "0.4"), 2 * np.pi / 7.2, 2.0)
    assert 0 < alpha < 0.7 * kappa / exponent
