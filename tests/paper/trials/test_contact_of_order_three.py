"""The border orbit between the swans of a contact of order three: its order over flights, and both limits of r."""

from fractions import Fraction
from math import gamma, isclose

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.paper import elastic

SWAN = 2 / 3**1.5


def cubic(r, q="-0.25"):
    return si.ImpactOscillator("0", "t**3 - t + q", 0, r, {"q": q})


def kappa(r, ends=("-0.3848", "-0.1295"), points=5):
    (found,) = si.border_orbits(cubic(r), "q", ends, points=points)
    return float(found.parameter)


def test_it_falls_with_r_from_the_landing_to_the_swan():
    """As b:three-one says; each is the only one among 40 values of q."""
    values = [kappa(r, points=40) for r in ("0.001", "0.1", "0.3", "0.5", "0.7", "0.9", "0.99")]
    assert (np.diff(values) < 0).all()
    assert -SWAN < values[-1] < values[0] < -56 / 57**1.5


def test_without_rebound_it_is_a_series_in_the_root_of_r():
    """The coefficients of b:three-rest: what they leave falls like r^(3/2)."""
    first, second = -225 * 19**0.5 / 13718, -2625 * 57**0.5 / 260642 - 225 * 38**0.5 / 109744
    left = []
    for exponent in (4, 6, 8):
        (found,) = si.border_orbits(cubic(f"1e-{exponent}"), "q", ("-0.15", "-0.129"), points=5, digits=25)
        root = mpmath.mpf(10) ** (-exponent // 2)
        left.append((found.parameter + 56 / mpmath.mpf(57) ** 1.5 - first * root - second * root**2) / root**3)
    assert abs(left[0] - left[1]) < 0.1 * abs(left[1])
    # another coefficient would leave more and more
    wrong = float(left[2]) + 1e-6 * 1e8
    assert abs(float(left[2]) / float(left[1]) - 1) < 0.2 < abs(wrong / float(left[1]) - 1)


def hop(release, others, sign):
    """The landing of the mass released at a zero of a_c, and its speed over |a_c| there: by numpy's polynomials."""
    push = np.polynomial.Polynomial(np.real(np.polynomial.polynomial.polyfromroots([release, *others]) * sign))
    velocity = push.integ(lbnd=release)
    roots = velocity.integ(lbnd=release).roots()
    # three zeros at the release are of the flight itself
    landed = roots[(abs(roots.imag) < 1e-9) & (roots.real > release + 1e-3)].real.min(initial=1e3)
    return landed, velocity(landed) / push(landed)


def hops(others, sign):
    """Of the releases from far to near before zeros of which a_c < 0 between the first two: those that land there."""
    rows = [hop(others[0].real - gap, others, sign) for gap in np.geomspace(4, 0.02, 200)]
    return np.array([row for row in rows if row[0] < others[1].real]).T


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_hops_land_sooner_and_slower_the_later_they_begin(order):
    """The links of b:border-order, for drawn zeros."""
    rng = np.random.default_rng(order)
    for _ in range(20):
        landed, slow = hops(np.cumsum(rng.uniform(0.2, 1.5, order - 1)), (-1) ** (order - 1))
        assert landed.size > 3
        assert (np.diff(landed) < 0).all()
        assert (np.diff(slow) < 0).all()


def test_where_the_logarithm_is_not_concave_hops_need_not_land_slower():
    """Two zeros that are not real, beside the middle of the two: what the links need of p is not for nothing."""
    landed, slow = hops(np.array([0, 1, 0.5 + 0.05j, 0.5 - 0.05j]), 1)
    assert (np.diff(landed) < 0).all()
    assert not (np.diff(slow) < 0).all()


@pytest.mark.parametrize(("order", "r"), [(4, "0.5"), (5, "0.3"), (6, "0.8")])
def test_one_border_orbit_from_the_lowest_zero_at_every_order(order, r):
    """And at most one from a zero that has others before it, as b:border-order says."""
    rng = np.random.default_rng(order)
    others = np.round(np.cumsum(rng.uniform(0.4, 1.2, order - 1)), 3).tolist()
    product = "*".join(f"(t - {zero})" for zero in others)
    osc = si.ImpactOscillator("0", f"{(-1) ** (order - 1)}*(t - u)*{product}", 0, r, {"u": -1})
    found = si.border_orbits(osc, "u", (others[0] - 4, others[0] - 0.02), points=60)
    first = [orbit for orbit in found if isclose(orbit.release, orbit.parameter, abs_tol=1e-9)]
    assert [round(orbit.end, 6) for orbit in first].count(round(others[1], 6)) == 1
    # the release next to the double zero rests, that far before it passes: neither end of the search does both
    assert all(orbit.side == "above" for orbit in first if isclose(orbit.end, others[1]))


def near_one(u):
    """C of kappa + 2/3^(3/2) = C (1 - r)^(6/7), from the adiabatic invariant u of the elastic ball in a swan.

    With t_2 - t_1 = 2h the invariant v/|a_c|^(1/3) begins as h^(7/3) u/12^(2/3), and it falls by half of 1 - r times
    the integral of |a_c|^(2/3) up to the third zero, that of (x (1 - x)^2)^(2/3); and kappa + 2/3^(3/2) is 27/2 h^2 of
    the value at the swan.
    """
    used = gamma(5 / 3) * gamma(7 / 3) / gamma(4)
    return SWAN * 13.5 * (12 ** (2 / 3) * used / (2 * u)) ** (6 / 7)


def test_where_nothing_is_lost_it_is_the_curve_of_swans():
    """The law of b:three-elastic, to which border orbits tend."""
    low, high = elastic().invariant
    assert Fraction(low) < Fraction(high)
    constant = near_one(float(low))
    assert isclose(constant, 0.284428145, abs_tol=1e-8)
    assert isclose(near_one(float(high)), constant, abs_tol=1e-7)
    assert f"{constant:.7f}" in si.constants("1/2", 16)[-1].at_one
    ratios = [(kappa(r, ("-0.3849", "-0.37")) + SWAN) / (1 - float(r)) ** (6 / 7) / constant for r in ("0.99", "0.999")]
    assert ratios[0] < ratios[1] < 1
    assert 1 - ratios[1] < 0.25 * (1 - ratios[0])
    assert 1 - ratios[1] < 0.002
    # what is left is of the order (1 - r)^(6/7): one of (1 - r)^(3/7) would grow by 2.7 here
    left = [(1 - ratio) / (1 - float(r)) ** (6 / 7) for r, ratio in zip(("0.99", "0.999"), ratios, strict=True)]
    assert 1 < left[1] / left[0] < 1.3


@pytest.mark.parametrize("r", [0.2, 0.5, 0.9])
def test_flights_are_ordered_by_the_place_of_the_first_zero(r):
    """In units of t_3 - t_2 landings are later and flights longer the earlier the first zero is."""
    orbits = []
    for first in (1.30, 1.35, 1.40):
        osc = si.ImpactOscillator("0", f"t*(t + 1)*(t + {first})", 0, repr(r))
        flown = osc.orbit(-first, 0, impacts=6)
        orbits.append(np.array(flown.tau[1:7]))
    for earlier, later in zip(orbits[1:], orbits, strict=False):
        count = min(earlier.size, later.size)
        assert count >= 2
        assert (earlier[:count] > later[:count]).all()
        assert (np.diff(earlier[:count]) > np.diff(later[:count])).all()


OSCILLATORS = {
    "linear": ("x", "cos(1.7*t) + b*sin(3.4*t)"),
    "damped, a spring that hardens": ("x + 0.3*xdot + x**3", "cos(1.7*t) + b*sin(3.4*t)"),
    "damped pendulum": ("sin(x) + 0.1*xdot", "cos(2*t) + b*sin(4*t)"),
}


def coefficient(zeros):
    """q/|p|^(3/2) of the cubic with three zeros."""
    zeros = np.sort(zeros) - np.mean(zeros)
    p = zeros[0] * zeros[1] + zeros[0] * zeros[2] + zeros[1] * zeros[2]
    return -zeros.prod() / abs(p) ** 1.5


@pytest.mark.parametrize("name", OSCILLATORS)
def test_the_curve_of_true_oscillators_tends_to_it(name):
    """Next to their points of order three, whatever f: like the root of p where damping acts, and faster without."""
    f, g = OSCILLATORS[name]
    osc = si.ImpactOscillator(f, g, 0, "1/2", {"b": 0})
    points = si.contact_points(osc, 3, ("clearance", "b"), (("-0.9", "0.9"), (-1, 1)))
    assert points.complete
    point = next(point for point in points if point.sign > 0)
    off = []
    for p in (-0.01, -0.001):
        ends = [point.unfolded(share * abs(p) ** 1.5, p) for share in (-0.36, -0.15)]
        between = sorted(float(Fraction(str(model.clearance))) for model in ends)
        (border,) = si.border_orbits(ends[1], "clearance", between, points=12)
        zeros = sorted((zero.tau for zero in si.tangency_points(border.oscillator)), key=lambda t: abs(t - point.tau))
        off.append(coefficient(np.array(zeros[:3])) + 0.247345775310425)
    assert abs(off[0]) < 2e-3
    assert 2.5 < off[0] / off[1] < 12


def test_the_hop_grazes_once_and_for_every_restitution_at_one_coefficient():
    """(s + 2)^3 (s - 3)^2/20 is the flight from rest at the first zero that touches the wall: kappa = -2 sqrt(2)/27.

    A flight of t^3 + pt + q is a polynomial of degree five without the power four. So two rests of which one is a zero
    of a_c are such a product or its mirror image, which lies below the wall before the later rest; three rests, or two
    that are zeros, have degree six.
    """
    touching = np.polynomial.Polynomial.fromroots([-2, -2, -2, 3, 3]) / 20
    assert touching.coef[4] == 0
    a = touching.deriv(2)
    assert a.coef == pytest.approx([-1, -4.5, 0, 1])
    kappa_ = a.coef[0] / 4.5**1.5
    assert kappa_ == pytest.approx(-2 * 2**0.5 / 27)
    for q, impacts in ((kappa_ - 1e-4, 1), (kappa_ + 1e-4, 0)):
        model = cubic("1/2", q)
        run = model.orbit(si.tangency_points(model)[0].tau, 0, impacts=20)
        assert (run.kind == "impact").sum() == impacts
    mirrored = np.polynomial.Polynomial.fromroots([-3, -3, 2, 2, 2])
    assert mirrored(-1.0) < 0
