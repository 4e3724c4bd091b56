"""Short flights in balls: the same first hits as the expansion of each flight, and none where that has none."""

from fractions import Fraction

import flint
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import balls_at
from singimpact.flights import GROWTH, LinearFlow, ShortFlights

MODELS = {
    "plain": si.linear("2.8", 0, "0.8"),
    "damped": si.linear(2, "0.3", "0.6", damping="0.3", phase="1/7"),
    "driven": si.linear("1.3", "0.1", "0.5", damping="-0.1", stiffness=3, amplitude="0.5"),
    "two waves": si.ImpactOscillator("x", "cos(2*t) + sin(6*t)/9", "0.4", "0.5"),
    "stiff": si.linear("2.8", 0, "0.8", stiffness=1000, damping=30),
    "ball": si.ImpactOscillator("0", "-9.81", 0, "0.9"),
}


def expanded(flow, tau, v):
    """The first hit by the expansion of its flight alone."""
    flow._short.hit = lambda _tau, _v: None
    return flow.first_hit(tau, v)


@pytest.mark.parametrize("bits", [100, 300, pytest.param(900, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", MODELS)
def test_hits_overlap_those_of_the_expansion(name, bits):
    random, short_ones = np.random.default_rng(bits), 0
    with balls_at(bits):
        flow, plain = LinearFlow(MODELS[name], bits), LinearFlow(MODELS[name], bits)
        for _ in range(40):
            tau = flow.number(Fraction(float(random.uniform(-8, 8))))
            v = flow.number(Fraction(float(10 ** random.uniform(-12, 0.3))))
            found, known = flow._short.hit(tau, v), expanded(plain, tau, v)
            if found is None or known is None:
                continue
            short_ones += 1
            assert found[0].overlaps(known.time)
            assert found[1].overlaps(known.velocity)
            assert found[0].rel_accuracy_bits() > bits - 40
            nearly = found[0] * (1 + flow.number(Fraction(1, 2 ** (bits - 45))))
            assert not nearly.overlaps(known.time)
    assert short_ones > 5


def test_a_wide_launch_gives_a_hit_that_holds_those_of_its_ends():
    with balls_at(200):
        flow = LinearFlow(MODELS["damped"], 200)
        for width in (Fraction(1, 10**20), Fraction(1, 10**6)):
            tau, v = Fraction(11, 10), Fraction(1, 100)
            wide = flow._short.hit(flow.number(tau).union(flow.number(tau + width)),
                                   flow.number(v).union(flow.number(v + width)))  # fmt: skip
            for one in (tau, tau + width):
                for speed in (v, v + width):
                    time, velocity = flow._short.hit(flow.number(one), flow.number(speed))
                    assert wide[0].contains(time)
                    assert wide[1].contains(velocity)


def test_a_flight_beyond_a_limit_has_no_hit():
    with balls_at(200):
        flow = LinearFlow(MODELS["plain"], 200)
        tau, v = flow.number(Fraction(1)), flow.number(Fraction(1, 100))
        time = flow.first_hit(tau, v).time
        assert flow.first_hit(tau, v, time / 2).time is None
        assert flow.first_hit(tau, v, time * 2).time.overlaps(time)


def test_a_degree_that_is_too_low_widens_the_hit_and_does_not_move_it(monkeypatch):
    """The tail is in the ball: with fewer terms the hit is less sharp, and still contains the true one."""
    with balls_at(300):
        flow = LinearFlow(MODELS["two waves"], 300)
        tau, v = flow.number(Fraction(6, 5)), flow.number(Fraction(1, 50))
        sharp = flow._short.hit(tau, v)
        for degree in (8, 10, 14):
            few = ShortFlights(flow)
            monkeypatch.setattr(few, "_enough", lambda _reach, _v, few=few, degree=degree: few._cut(degree)[0])
            rough = few.hit(tau, v)
            assert rough[0].contains(sharp[0])
            assert rough[0].rad() > 1000 * sharp[0].rad()
            assert rough[1].contains(sharp[1])


def test_the_rest_of_a_polynomial_is_no_larger_than_its_bound():
    """y at the end of a window, beside twice as many terms."""
    with balls_at(300):
        flow = LinearFlow(MODELS["driven"], 300)
        short = ShortFlights(flow)
        tau, v, reach = flow.number(Fraction(9, 5)), flow.number(Fraction(1, 20)), flow.number(Fraction(1, 5))
        pairs = short._phases(tau)

        def sums(degree):
            cut = short._cut(degree)[0]
            y = cut.impulse * v + cut.steady * flow.rest
            for (c, s), (p, q) in zip(cut.waves, pairs, strict=True):
                y += c * p + s * q
            bound = GROWTH * (v * cut.by_v + cut.alone + reach * cut.forced) * reach ** (degree - 1)
            return y(reach), bound

        for degree in (8, 12, 16):
            (few, bound), (many, _) = sums(degree), sums(60)
            assert abs(few - many) < bound
            assert bound < 1e5 * abs(few - many) + flint.arb(2) ** -250
