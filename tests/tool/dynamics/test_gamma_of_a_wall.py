"""Thresholds and gamma of one wall of two: where chatter meets the other wall first, that is the answer."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Status
from singimpact.surface import ImpactSurface

NARROW = si.linear("2.8", "-0.3", "0.8", upper=("-0.299", "0.7"))
WIDE = si.linear("2.8", "-0.3", "0.8", upper=("0.5", "0.7"))
CUT = si.linear("2.8", "-0.3", "0.8", upper=("-0.29", "0.7"))


@pytest.mark.parametrize("height", ["0.36", "1e-6", "1e4"])
def test_a_ball_below_a_ceiling_meets_it_from_a_speed_in_closed_form(height):
    ball = si.ImpactOscillator("0", "-2", "0", "1/2", upper=height)
    found = si.threshold(ball, 0)
    assert found.status == Status.other_wall
    assert abs(found.v - 2 * np.sqrt(float(height))) <= found.error < 1e-9 * found.v
    assert si.threshold(ball.one_wall(), 0).status == Status.none
    assert "other wall" in Status.other_wall.sentence


def graze_speed(tau, start):
    """v of the flight from x = -0.3 that grazes -0.299, of x'' + x = cos 2.8t, in 30 digits."""
    with mpmath.workdps(30):
        rate, c, u = mpmath.mpf("2.8"), mpmath.mpf("-0.3"), mpmath.mpf("-0.299")
        size, tau = 1 / (1 - rate**2), mpmath.mpf(tau)

        def state(v, t):
            cosine, sine = c - size * mpmath.cos(rate * tau), v + size * rate * mpmath.sin(rate * tau)
            x = cosine * mpmath.cos(t) + sine * mpmath.sin(t) + size * mpmath.cos(rate * (tau + t))
            slope = -cosine * mpmath.sin(t) + sine * mpmath.cos(t) - size * rate * mpmath.sin(rate * (tau + t))
            return x - u, slope

        push = mpmath.cos(rate * tau) - c
        return mpmath.findroot(state, (start, -start / push))[0]


@pytest.mark.parametrize("tau", [0.75, 0.8, 0.85])
def test_the_speed_at_which_the_other_wall_is_met_first_has_its_error(tau):
    found = NARROW.threshold(tau)
    assert found.status == Status.other_wall
    assert found.v < NARROW.one_wall().threshold(tau).v
    assert abs(found.v - float(graze_speed(tau, float(found.v)))) <= found.error < 1e-12
    below, above = (NARROW.orbit(tau, found.v * (1 + side), 60) for side in (-1e-9, 1e-9))
    end = min(point.tau for point in si.tangency_points(NARROW) if point.kind == "gamma")
    assert not below.wall[below.tau < end].any()
    assert above.wall[above.tau < end].any()


@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_a_threshold_below_the_other_wall_is_that_of_one_wall(wall):
    foot = next(point.tau for point in si.tangency_points(WIDE, wall=wall) if point.kind == "gamma")
    found, alone = WIDE.threshold(foot - 0.4, wall=wall), WIDE.one_wall(wall).threshold(foot - 0.4)
    assert (found.v, found.error, found.status) == (alone.v, alone.error, Status.complete)
    assert si.threshold(WIDE, repr(foot - 0.4), digits=20, wall=wall).certified is None


def test_a_threshold_of_many_phases_names_what_comes_first_at_each():
    found = NARROW.threshold([0.8, 1.0])
    assert found.status.tolist() == [Status.other_wall, Status.complete]


def test_gamma_of_a_wall_ends_at_the_cut():
    window = (-1, 1), (0, 0.2)
    (curve,) = si.grown_gamma(CUT, window, wall="upper")
    alone = si.grown_gamma(CUT.one_wall("upper"), window)[0].points
    tau, v = curve.points[np.argmin(curve.points[:, 0])]
    assert alone[:, 0].min() < tau - 0.1
    assert np.abs(np.interp(curve.points[1:, 0], *alone[::-1].T) - curve.points[1:, 1]).max() < 1e-4
    surface = ImpactSurface(CUT, (-1, 1), (-3, 3), wall="upper")
    cut = np.vstack([piece.points for piece in surface.discontinuities if piece.name == "cut"])
    assert np.hypot(*(cut - [tau, v]).T).min() < 0.01
    step = CUT.impact_map(*curve.points[1:-1].T, wall="upper")
    assert (step.wall == 1).all()


def test_a_wall_that_is_not_there_is_refused():
    for call in (si.threshold, si.grown_gamma, si.tangency_points):
        with pytest.raises(InputError, match="wall"):
            call(WIDE.one_wall(), *([0.8] if call is si.threshold else []), wall="upper")
