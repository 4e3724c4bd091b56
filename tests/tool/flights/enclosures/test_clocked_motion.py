"""Boxes of launches at equal times of the clock: members and their derivatives lie within, and the boxes are narrow."""

from __future__ import annotations

from fractions import Fraction

import flint
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from singimpact.algebra import Balls, balls_at, series_of_any_length
from singimpact.flights import CarriedMotion, Refused, Start, centre, equation_of
from singimpact.oscillator import Oscillator

OSC = Oscillator("x + x**3/10 + xdot/20", "cos(2.8*t)", "0.1", "0.8")
LAUNCH, SPREAD = (1.95, 0.35), (4e-3, 1e-3)
BITS = 40


def truth(tau, v, clock):
    """z and z' of the free motion at a time of the clock, and their derivatives by tau and v."""

    def moving(t, y):
        z, w, a, b, c, d = y
        x, slope = z + 0.1, 1 + 0.3 * (z + 0.1) ** 2
        force = np.cos(2.8 * t) - x - x**3 / 10 - w / 20
        return [w, force, b, -slope * a - b / 20, d, -slope * c - d / 20]

    start = np.cos(2.8 * tau) - 0.1 - 1e-4 - v / 20
    y = solve_ivp(moving, (tau, clock), [0, v, -v, -start, 0, 1], "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    return y[:2], y[2:].reshape(2, 2)


def inside(ball, value, slack=1e-9):
    return abs(float(ball.mid()) - value) <= float(ball.rad()) + slack


def launched(spread=SPREAD, clocked=True):
    balls = Balls(BITS + 24)
    box = [balls.interval(Fraction(x - r), Fraction(x + r)) for x, r in zip(LAUNCH, spread, strict=True)]
    equations = equation_of(OSC), equation_of(OSC)
    return CarriedMotion(equations, Start(*box), BITS, coarse=BITS, deviations={}, through=True, clocked=clocked)


def reached(motion, clock):
    """The box at a time of the clock."""
    while True:
        length = motion.tubes()[2]
        left = flint.arb(clock) - motion.middle_tau - motion.time
        if not motion.launched and left < length:
            return motion.met(left)
        motion.advance(centre(length if length < left else left * 0.7))


@pytest.mark.parametrize("clock", [2.2, 3.1, 4.6])
def test_members_and_derivatives_lie_within(clock):
    rng = np.random.default_rng(1)
    with balls_at(BITS + 24), series_of_any_length():
        found = reached(launched(), clock)
        for shift in rng.uniform(-1, 1, (20, 2)):
            at, columns = truth(*(np.array(LAUNCH) + shift * SPREAD), clock)
            for ball, value in zip((found.height, found.speed), at, strict=True):
                assert inside(ball, value)
            for pair, values in zip(found.columns, columns, strict=True):
                for ball, value in zip(pair, values, strict=True):
                    assert inside(ball, value, 1e-8)


def test_the_derivative_by_the_launch_time_is_narrower_than_at_equal_time_since_the_launch():
    with balls_at(BITS + 24), series_of_any_length():
        clocked = reached(launched(), 4.6)
        free = launched(clocked=False).at(flint.arb(4.6) - flint.arb(LAUNCH[0]))
        assert 3 * clocked.columns[0][0].rad() < free.columns[0][0].rad()
        assert clocked.height.rad() < free.height.rad()


def test_first_hits_of_members_lie_within_the_hit():
    from singimpact.flights.impact_map import impact_map

    rng = np.random.default_rng(2)
    with balls_at(BITS + 24), series_of_any_length():
        motion = launched()
        while True:
            height, _, length = motion.tubes()
            if not motion.launched and height(length) < 0:
                break
            motion.advance(length)
        middle = impact_map(OSC, *LAUNCH)
        s = flint.arb(middle.tau) - motion.middle_tau - motion.time + flint.arb(0, 0.02)
        found, wide = motion.hit(s, length), motion.met(s)
        assert found.inside
        assert found.time.rad() < wide.time.rad() / 2
        assert found.speed.rad() < wide.speed.rad()
        for shift in rng.uniform(-1, 1, (30, 2)):
            hit = impact_map(OSC, *(np.array(LAUNCH) + shift * SPREAD))
            assert inside(found.time, float(hit.tau))
            assert inside(found.speed, float(hit.velocity))
        # without a sign change at both ends for every member nothing is narrowed
        away = flint.arb(middle.tau) - motion.middle_tau - motion.time + flint.arb(0.02, 0.003)
        assert motion.hit(away, length).time.overlaps(motion.met(away).time)
        assert motion.hit(away, length).time.rad() == motion.met(away).time.rad()


def test_a_box_longer_than_a_step_is_refused():
    with balls_at(BITS + 24), series_of_any_length():
        motion = launched((0.2, 1e-3))
        length = motion.tubes()[2]
        with pytest.raises(Refused, match="longer than a step"):
            motion.advance(length / 4)
