"""Short flights in balls: the same first hits as steps of their own give, and none where the flight is not short."""

from fractions import Fraction

import flint
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import balls_at, series_of_any_length
from singimpact.flights import AnalyticFlow, Discs, coefficients

MODELS = {
    "plain": si.linear("2.8", 0, "0.8"),
    "damped": si.linear(2, "0.3", "0.6", damping="0.3", phase="1/7"),
    "driven": si.linear("1.3", "0.1", "0.5", damping="-0.1", stiffness=3, amplitude="0.5"),
    "two waves": si.ImpactOscillator("x", "cos(2*t) + sin(6*t)/9", "0.4", "0.5"),
    "stiff": si.linear("2.8", 0, "0.8", stiffness=1000, damping=30),
    "ball": si.ImpactOscillator("0", "-9.81", 0, "0.9"),
    "cubic": si.ImpactOscillator("x + x**3 + xdot/10", "cos(2*t)", "0.4", "0.5"),
    "pole": si.ImpactOscillator("x/(1 + x**2)", "1/(2 - cos(2*t))", "0.7", "0.5"),
}


def hit_of(flow, tau, v):
    with series_of_any_length():
        return flow.short.hit(tau, v)


def stepped(flow, tau, v):
    """The first hit by the steps of its flight alone."""
    flow.short.hit = lambda *_: None
    return flow.first_hit(tau, v)


@pytest.mark.parametrize("bits", [100, 300, pytest.param(900, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", MODELS)
def test_hits_overlap_those_of_steps(name, bits):
    random, short_ones = np.random.default_rng(bits), 0
    with balls_at(bits):
        flow, plain = AnalyticFlow(MODELS[name], bits), AnalyticFlow(MODELS[name], bits)
        for _ in range(40):
            tau = flow.number(Fraction(float(random.uniform(-8, 8))))
            v = flow.number(Fraction(float(10 ** random.uniform(-12, 0.3))))
            found = hit_of(flow, tau, v)
            if found is None:
                continue
            short_ones, known = short_ones + 1, stepped(plain, tau, v)
            assert found[0].overlaps(known.time)
            assert found[1].overlaps(known.velocity)
            assert found[0].rel_accuracy_bits() > bits - 40
            nearly = found[0] * (1 + flow.number(Fraction(1, 2 ** (bits - 45))))
            assert not nearly.overlaps(known.time)
    assert short_ones > 5


@pytest.mark.parametrize("name", ["damped", "cubic"])
def test_a_wide_launch_gives_a_hit_that_holds_those_of_its_ends(name):
    with balls_at(200):
        flow = AnalyticFlow(MODELS[name], 200)
        for width in (Fraction(1, 10**20), Fraction(1, 10**6)):
            tau, v = Fraction(11, 10), Fraction(1, 100)
            wide = hit_of(flow, flow.number(tau).union(flow.number(tau + width)),
                          flow.number(v).union(flow.number(v + width)))  # fmt: skip
            for one in (tau, tau + width):
                for speed in (v, v + width):
                    time, velocity = hit_of(flow, flow.number(one), flow.number(speed))
                    assert wide[0].contains(time)
                    assert wide[1].contains(velocity)


def test_a_flight_beyond_a_limit_has_no_hit():
    with balls_at(200):
        flow = AnalyticFlow(MODELS["plain"], 200)
        tau, v = flow.number(Fraction(1)), flow.number(Fraction(1, 100))
        time = flow.first_hit(tau, v).time
        assert flow.first_hit(tau, v, time / 2).time is None
        assert flow.first_hit(tau, v, time * 2).time.overlaps(time)


@pytest.mark.parametrize(("name", "degrees"), [("two waves", (20, 24, 28)), ("cubic", (8, 10, 14))])
def test_a_degree_that_is_too_low_widens_the_hit_and_does_not_move_it(name, degrees, monkeypatch):
    """The cut-off is in the ball: with fewer terms the hit is less sharp, and still contains the true one."""
    with balls_at(300):
        flow = AnalyticFlow(MODELS[name], 300)
        tau, v = flow.number(Fraction(6, 5)), flow.number(Fraction(1, 50))
        sharp = hit_of(flow, tau, v)
        for degree in degrees:
            monkeypatch.setattr(Discs, "degree", lambda *_, degree=degree: degree)
            rough = hit_of(flow, tau, v)
            assert rough[0].contains(sharp[0])
            assert rough[0].rad() > 1000 * sharp[0].rad()
            assert rough[1].contains(sharp[1])


@pytest.mark.parametrize("name", MODELS)
def test_coefficients_are_below_the_bound_that_their_discs_give(name):
    """Cauchy's estimate M R^(2 - k)/(k (k - 1)), at launches all over the box that the discs serve."""
    with balls_at(300):
        flow = AnalyticFlow(MODELS[name], 300)
        discs = flow.short._around(flow.number(Fraction(9, 5)), flow.number(Fraction(1, 20)), 0.01)
        radius, bound = flint.arb(discs.radius), discs.bound
        for tau in (discs.tau.lower(), flow.number(Fraction(9, 5)), discs.tau.upper()):
            for v in (discs.v / 10**6, discs.v):
                with series_of_any_length():
                    X = coefficients(flow.equation, (tau, flint.arb(0), v), 60)
                for k in range(2, 61):
                    assert abs(X[k]) <= bound * radius ** (2 - k) / (k * (k - 1))


def test_discs_that_are_made_for_one_launch_serve_the_next_and_no_far_one():
    with balls_at(200):
        flow = AnalyticFlow(MODELS["plain"], 200)
        tau, v = flow.number(Fraction(9, 10)), flow.number(Fraction(1, 200))
        discs = flow.short._around(tau, v, 0.01)
        assert flow.short._around(tau + flow.number(Fraction(1, 100)), v / 2, 0.01) is discs
        assert flow.short._around(tau, v * 100, 0.01) is not discs
        assert flow.short._around(tau + 4, v, 0.01) is not discs
