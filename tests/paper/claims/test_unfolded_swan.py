"""Section 6 beside numbers: what polynomials decide of the universal model, on flights and on models near a swan."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import sympy

from singimpact.contact import tangency_points
from singimpact.impact_oscillator import ImpactOscillator, universal
from singimpact.paper import (
    CLAIMS,
    WEIGHTS,
    A,
    E,
    Weights,
    cofactor,
    crossing,
    e,
    kappa,
    limit_launch,
    nonzero,
    scaling_check,
    t,
    u,
)
from singimpact.paper.claims.sections import section6_exact as exact
from singimpact.paper.routes.unfolding import sigma


def test_the_loop_is_that_of_true_flights():
    """Random points with v > 0: visible when the first hit from (sigma, v) comes at t, against the arcs to the left."""
    rng = np.random.default_rng(20072)
    place, time = rng.uniform(-4, 2, 400), rng.uniform(0.01, 6, 400)
    v = time * (6 * (place**2 - 1) + 4 * place * time + time**2)
    keep = v > 1e-6
    hit = np.asarray(universal(-1, "1/2").first_hit(place[keep], v[keep]).flight_time)
    seen = np.abs(hit - time[keep]) < 1e-7 * (1 + time[keep])
    points = [{sigma: sympy.Rational(x), t: sympy.Rational(y)} for x, y in zip(place[keep], time[keep], strict=True)]
    inside = np.array([sum(exact._left_of(point, arc) for arc in exact.ADCBA) % 2 for point in points], bool)
    assert inside.sum() > 20
    assert np.array_equal(seen, ~inside)


@pytest.mark.parametrize("changed", [0, 1, 2])
def test_a_loop_with_another_conic_is_rejected(changed):
    arcs = [arc._replace(conic=arc.conic + int(n == changed)) for n, arc in enumerate(exact.ADCBA)]
    check = exact.visible_check((arcs, 0))
    assert not check.holds
    assert check.witness


def test_cells_have_a_point_in_each_sign_pattern():
    circle, line = sigma**2 + (t - 2) ** 2 - 1, sigma - t / 2
    patterns = {(circle.subs(p) > 0, line.subs(p) > 0) for p in exact._cells([circle, line])}
    assert len(patterns) == 4


@pytest.mark.parametrize("rate", ["1/20", "1/2", "19/20"])
def test_chatter_from_A_rests_beyond_phi_C(rate):
    """G(A) = (3, 64 r) for kappa = -1; flights are shorter by r at least, so X is not beyond 3 + t/(1 - r)."""
    r = Fraction(rate)
    osc = universal(-1, rate)
    first = float(osc.first_hit(3.0, 64 * float(r)).flight_time)
    found = osc.chatter_limit(3, 64 * r)
    assert 3 < float(found.tau) < 3 + first / (1 - float(r))


def test_R_phi_AE_meets_the_outline_once_on_true_flights():
    """Launched at rest from sigma in (E', A): where r x' is above p(BE), the next flight is a long one."""
    osc, rate = universal(1, "1/2"), 0.5
    launch = np.linspace(-1.72, -1.02, 60)
    time = -2 * launch - np.sqrt(6 - 2 * launch**2)
    place = launch + time
    z = place / np.sqrt(18 - 2 * place**2)
    over = np.abs(z) < 0.249
    above = (1 - 4 * z) ** 2 * (1 + 2 * z) < rate * (1 + 4 * z) ** 2 * (1 - 2 * z)
    step = osc.first_hit(launch, 0.0)
    assert np.allclose(step.flight_time, time, atol=1e-9)
    after = np.asarray(osc.first_hit(np.asarray(place), -rate * np.asarray(step.velocity)).flight_time)
    returns = after < 4
    assert np.count_nonzero(np.diff(above[over].astype(int))) == 1
    assert np.array_equal(returns[over], ~above[over])


@pytest.mark.parametrize(("damping", "cubic"), [("1/5", "0"), ("0", "3/10"), ("2", "-1/4")])
def test_launches_near_a_swan_tend_to_those_of_the_model(damping, cubic):
    """v_c(H sigma, H t)/H^3 of x'' + x + b x' + h x^3 = c + (c^3 h) + 12 kappa (sigma^2 - H^2) + sigma^3, c = 1/3."""
    errors = []
    for length in (0.1, 0.05, 0.025):
        g = f"1/3 + ({cubic})/27 - 12*(t**2 - {length}**2) + t**3"
        osc = ImpactOscillator(f"x + ({damping})*xdot + ({cubic})*x**3", g, "1/3", "1/2")
        place, time = 1.2, 2.5
        v = float(limit_launch().subs({kappa: -1, e: -1, sigma: place, t: time}))
        shot = osc.first_hit(place * length, v * length**3)
        errors.append(abs(float(shot.flight_time) / length - time))
    assert errors[0] < 1
    assert [one / two for one, two in pairwise(errors)] == pytest.approx([2, 2], rel=0.4)


def test_zeros_near_the_swan_are_at_the_distance_of_the_model():
    for below in ("0.99", "0.9999"):
        first, second = tangency_points(ImpactOscillator("x", "cos(2*t)", below, "1/2")).tau
        half = np.sqrt(
            (1 - float(below)) / 2
        )  # a_c = cos 2t - c: 12 kappa = -2, 12 kappa e = 1 - c, so H^2 = (1 - c)/2
        assert min(first, np.pi - second) == pytest.approx(half, rel=3 * (1 - float(below)))


@pytest.mark.parametrize(
    "weights", [Weights(1, 2, 4, 2), Weights(1, 2, 3, 2), Weights(1, 1, 4, 3), Weights(2, 2, 4, 2), Weights(1, 2, 5, 4)]
)
def test_other_weights_have_no_limit_or_another(weights):
    leading = CLAIMS["s6-scaling"].printed.value[1]
    assert scaling_check((WEIGHTS, leading)).holds
    assert not scaling_check((weights, leading)).holds


def test_crossings_and_numbers():
    assert [crossing(point) for point in (A, E)] == [-48, 48]
    assert crossing((sympy.Integer(0), sympy.Integer(0))) == 0
    assert nonzero(sympy.sqrt(3) * kappa**2)
    assert not nonzero(sympy.sqrt(3) * kappa - sympy.sqrt(12) * kappa / 2)
    assert cofactor().subs(u, 0).subs({sigma: 1, t: 0}) == 0
