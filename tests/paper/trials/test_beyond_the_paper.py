"""Trials of claims that the paper does not have, beside other routes: balls, true orbits in many digits."""

from fractions import Fraction
from itertools import pairwise
from math import log

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.paper import MODELS, STARTS, SWANS, beside, clearance, generations, heights, inner_start, measured
from singimpact.paper.trials import first_order_feet, loop_heights, universal_foot


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


def test_the_holder_exponent_at_j_1():
    found = beside(STARTS[0], "1/2")
    assert abs(log(1 / found.lambda_) / log(found.mu) - 0.603031) < 1e-6
    assert abs(found.slope - 0.603031) < 1e-5


def test_the_holder_exponent_in_many_digits():
    """In balls, 1e-9 to 3e-11 from gamma, by the public functions."""
    osc = si.linear(2, "0.3", "0.5")
    at = si.fixed_points.multipliers(1, "1/2", 30)
    edge = si.threshold(osc, "5.4", digits=30).v
    gaps = []
    for power in (26, 31):
        with mpmath.workdps(35):
            v = mpmath.mpf(edge) * (1 - mpmath.mpf(at.mu.value) ** -power)
            limit = osc.chatter_limit("5.4", mpmath.nstr(v, 32), digits=25)
            zero = 2 * mpmath.pi - mpmath.acos(mpmath.mpf(3) / 10) / 2
            gaps.append(float(zero - mpmath.mpf(limit.tau)))
    slope = log(gaps[0] / gaps[1]) / (5 * log(float(at.mu.value)))
    assert abs(slope - log(1 / float(at.lambda_.value)) / log(float(at.mu.value))) < 1e-5


@pytest.mark.slow
@pytest.mark.parametrize("rate", ["3/10", "1/2", "4/5"])
@pytest.mark.parametrize("start", STARTS, ids=[start.name for start in STARTS])
def test_orbits_beside_gamma_end_by_the_exponent_and_gain_an_impact_for_each_factor(start, rate):
    orbits = beside(start, rate)
    assert orbits.slope == pytest.approx(log(1 / orbits.lambda_) / log(orbits.mu), abs=1e-5)
    assert orbits.impacts[1] - orbits.impacts[0] == orbits.steps


@pytest.mark.slow
@pytest.mark.parametrize("rate", first_order_feet.RATES)
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


def test_heights_are_ordered_about_their_tears():
    for r in (0.1, 0.3, 0.5, 0.8, 0.95):
        outer, tears, inner = (generations(start, r, 6) for start in (0.5, 0.375, inner_start(r)))
        falling = [w for triple in zip(outer, tears, inner, strict=True) for w in triple]
        assert all(one > two for one, two in pairwise(falling))
        rate = float(si.fixed_points.tangency(str(r)).lambda_.value)
        assert falling[-1] > (1 - rate) * (2 + rate) / 6


@pytest.mark.slow
def test_heights_on_true_orbits_agree_with_the_known_ones():
    """r = 1/2 in the universal model: (true - limit)/h at the first crossings, to four digits."""
    found = heights(SWANS[0], "1/2")
    limits = [*generations(0.5, 0.5), *generations(inner_start(0.5), 0.5)]
    slopes = (np.array(found.found[0]) - limits) / found.lines[0]
    assert np.allclose(slopes[[0, 1, 4, 5]], [0.1191, 0.0843, 0.1378, 0.0805], atol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("rate", loop_heights.RATES)
@pytest.mark.parametrize("swan", SWANS, ids=[swan.name for swan in SWANS])
def test_heights_on_true_orbits_differ_from_those_of_the_limit_to_first_order(swan, rate):
    r = float(Fraction(rate))
    found = heights(swan, rate)
    assert found.left < 1e-12
    errors = np.array(found.found) - [*generations(0.5, r), *generations(inner_start(r), r)]
    orders = np.log(np.abs(errors[0] / errors[1])) / log(found.lines[0] / found.lines[1])
    assert np.all(np.abs(orders - 1) < 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("rate", loop_heights.RATES)
@pytest.mark.parametrize("swan", SWANS, ids=[swan.name for swan in SWANS])
def test_feet_beside_gamma_shrink_by_the_square_of_lambda(swan, rate):
    """Foot - X where ln delta/ln mu takes four phases in three successive periods, over one line above gamma."""
    at, both = loop_heights._setting(swan, rate), si.fixed_points.tangency(rate)
    tau, mu = at.A - 0.05 * (at.B - at.A) / 2, float(both.mu.value)
    edge = float(si.threshold(at.osc, tau).v)
    distances = [1e-3 * mu ** -(period + np.array([0.0, 0.25, 0.5, 0.75])) for period in range(3)]
    rows = np.array(
        [loop_heights._feet(at.osc, at.B, np.full(4, tau), edge * (1 + delta)) - at.X for delta in distances]
    )
    off = np.abs(rows[1:] / rows[:-1] / float(both.lambda_.value) ** 2 - 1)
    assert np.all(off < 0.02)
    assert np.all(off[1] < off[0])
    assert (rows[0] > 0).any()
    assert (rows[0] < 0).any()


@pytest.mark.parametrize("depth", [4, 5, 6])
def test_osc_orbit_shows_the_orbit_that_is_born(depth):
    osc = si.linear(2, clearance(depth), "0.8")
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
