"""Trials of claims that the paper does not have, beside other routes: balls, true orbits in many digits."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from first_order_feet import MODELS, RATES, measured

import singimpact as si
from singimpact.paper.trials import universal_foot


@pytest.mark.slow
def test_bounds_of_the_foot_hold_the_chatter_limit_in_balls():
    for rate in ("1/10", "3/10", "1/2", "4/5", "9/10"):
        low, high = universal_foot.foot(Fraction(rate), 1e-4)
        limit = si.universal(-1, rate).chatter_limit(3, str(64 * Fraction(rate)), digits=20).certified
        assert float(low) < float(limit.value) < float(high)
        assert high - low < Fraction(1, 10**6)


def test_the_covering_holds_every_r_between():
    boxes = universal_foot.covering(Fraction(1, 20), Fraction(19, 20))
    assert all(one.r[1] == two.r[0] for one, two in pairwise(boxes))
    for rate in (Fraction(1, 3), Fraction(17, 20), Fraction(947, 1000)):
        (box,) = [each for each in boxes if each.r[0] <= rate < each.r[1]]
        low, high = universal_foot.foot(rate, 1e-3)
        assert box.low <= low < high <= box.high


def test_balls_that_grow_too_wide_are_refused(monkeypatch):
    monkeypatch.setattr(universal_foot, "EFFORT", universal_foot.Effort(bits=64))
    with pytest.raises(ArithmeticError, match="too wide"):
        universal_foot.foot.__wrapped__(Fraction(999, 1000))


def test_the_elastic_invariant_is_that_of_a_longer_orbit(monkeypatch):
    low, high = universal_foot.elastic().invariant
    monkeypatch.setattr(universal_foot, "EFFORT", universal_foot.Effort(impacts=1600, elastic_bits=512))
    inner = universal_foot.elastic.__wrapped__().invariant
    assert low < inner[0] < inner[1] < high


def test_chi_of_a_model_by_hand():
    """x'' + x'/2 + x = cos 2t: a''' = 0 at t = 0, so chi is the damping."""
    found = measured(MODELS[1], "1/2")
    assert abs(found.chi - 0.5) < 1e-12
    assert abs(found.limit - 4.0476562833) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("model", MODELS, ids=[model.name for model in MODELS])
def test_feet_of_swans_differ_from_the_universal_ones_to_first_order(model, rate):
    """By the order 1 in H, and by the order 2 once -chi (X^2 - 1) H/10 is taken off; not with 1/9 for 1/10."""
    feet = measured(model, rate)

    def order(share):
        weight = -share * (feet.limit**2 - 1) * feet.chi
        return feet.order([off - weight * size for size, off in zip(feet.sizes, feet.offsets, strict=True)])

    assert feet.order(feet.offsets) == pytest.approx(1, abs=0.1)
    assert order(0.1) == pytest.approx(2, abs=0.1)
    assert abs(order(1 / 9) - 2) > 0.1


@pytest.mark.parametrize("depth", [4, 5, 6])
def test_osc_orbit_shows_the_orbit_that_is_born(depth):
    osc = si.linear(2, "0." + "9" * depth, "0.8")
    run = osc.orbit(1, 0, 200)
    releases = run.tau[run.kind == "release"]
    assert len(releases) > 3
    assert np.allclose(np.diff(releases), np.pi, rtol=0, atol=1e-12)
    half = np.pi - releases[0] % np.pi
    first = run.tau[np.flatnonzero(run.kind == "release")[0] + 1]
    assert abs((first - releases[0]) / half - 4) < 1e-7
    # nothing moves on the other side of the swan
    still = si.linear(2, "1.0001", "0.8").orbit(1, 0, 200)
    assert still.phases[-1][0] == "sticking"
