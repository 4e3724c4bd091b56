"""Homoclinic orbits that are proved: against a closed form in digits, flights, drawn arcs; nothing false passes."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import balls_at
from singimpact.branches import Cones, Crossings, EnclosedCrossing, enclosed_crossing as room, local_arc
from singimpact.branches.enclosed_crossing import enclosed_crossing
from singimpact.flights import Refused
from singimpact.inputs import InputError

OSC = si.linear("2.8", 0, "0.8")
BITS = 256


@pytest.fixture(scope="module")
def saddle():
    return OSC.periodic(1, 1)[0]


@pytest.fixture(scope="module")
def found(saddle) -> Crossings:
    return si.homoclinic_points(saddle, v=1)


@pytest.fixture(scope="module")
def proved(found) -> EnclosedCrossing:
    return found[0].certified(30)


def landed(tau, v, time):
    """x at a time after a launch of x'' + x = cos 2.8 t, and what leaves an impact there, in closed form."""
    omega, r = mpmath.mpf("2.8"), mpmath.mpf("0.8")
    forced = 1 / (1 - omega**2)
    a, b = -forced * mpmath.cos(omega * tau), v + forced * omega * mpmath.sin(omega * tau)
    x = a * mpmath.cos(time) + b * mpmath.sin(time) + forced * mpmath.cos(omega * (tau + time))
    speed = -a * mpmath.sin(time) + b * mpmath.cos(time) - forced * omega * mpmath.sin(omega * (tau + time))
    return x, -r * speed


@pytest.mark.slow
def test_every_impact_leads_to_the_next_one_in_closed_form(proved):
    with mpmath.workdps(60):
        period, wall = 2 * mpmath.pi / mpmath.mpf("2.8"), mpmath.mpf(10) ** -28
        for (tau, v), (after, speed) in zip(proved.states[8:-8], proved.states[9:-7], strict=True):
            known = float(OSC.first_hit(float(tau.value), float(v.value)).flight_time)
            turns = round((float(tau.value) + known - float(after.value)) / float(period))
            x, leaving = landed(tau.value, v.value, after.value + turns * period - tau.value)
            assert abs(x) < wall
            assert abs(leaving - speed.value) < wall


@pytest.mark.slow
def test_it_is_the_orbit_of_newtons_method(found, proved):
    assert float(proved.tau.value) == pytest.approx(found[0].tau, abs=1e-13)
    assert float(proved.v.value) == pytest.approx(found[0].v, abs=1e-13)
    assert float(proved.angle.value) == pytest.approx(found[0].angle, abs=1e-11)
    assert max(proved.tau.radius, proved.v.radius) < mpmath.mpf(10) ** -30
    assert proved.angle.value > proved.angle.radius
    assert proved.unique_within > Fraction(1, 10**5)
    assert proved.kind == "homoclinic"
    assert float(proved.slowest.value) == pytest.approx(found[0].weakest, abs=1e-12)
    assert max(proved.slopes) < Fraction(1, 10**8)


@pytest.mark.slow
def test_flights_in_60_digits_come_to_the_saddle_from_the_point_and_not_from_one_beside_it(saddle, proved):
    """After k impacts the distance is that of W^s; from 1e-20 beside it an unstable part of 1e-20 2.958^k is there."""
    turns = 26
    centre = saddle.certified(50)

    def distance(shift):
        with mpmath.workdps(70):
            tau, v = proved.tau.value + shift, proved.v.value
            period = 2 * mpmath.pi / mpmath.mpf("2.8")
            for _ in range(turns):
                step = OSC.impact_map(tau, v, digits=60)
                tau, v = step.tau, step.v
            tau -= period * mpmath.nint((tau - centre.tau[0].value) / period)
            return float(abs(tau - centre.tau[0].value) + abs(v - centre.v[0].value))

    on = distance(0)
    assert on < 10 * 0.2163554536**turns
    assert distance(mpmath.mpf(10) ** -20) > 1e3 * on


@pytest.mark.slow
def test_a_lower_precision_contains_a_higher_one(found, proved):
    rough = found[0].certified(8)
    for one, other in ((rough.tau, proved.tau), (rough.v, proved.v), (rough.angle, proved.angle)):
        assert abs(one.value - other.value) <= one.radius + other.radius
    assert rough.impacts < proved.impacts


@pytest.mark.parametrize("stable", [True, False])
def test_wedges_contain_the_arcs_of_doubles(saddle, stable):
    arc, reach = local_arc(saddle, stable), Fraction(1, 2**15)
    with balls_at(BITS):
        cones = Cones(saddle, 40, BITS)
        wedge = cones.wedge(reach)
    slope = float(wedge.stable if stable else wedge.unstable)
    inverse = np.array([[float(part) for part in row] for row in cones.coordinates])
    other = local_arc(saddle, not stable)

    def deviation(curve, size):
        state = curve.points(np.array([size * 2.0**-16]))[0] - [float(part) for part in cones.centre]
        along, across = inverse @ state if not stable else (inverse @ state)[::-1]
        assert max(abs(along), abs(across)) < float(reach)
        return abs(across) - slope * abs(along)

    for size in (1.0, 0.5, 0.1, -0.3, -0.9):
        assert deviation(arc, size) < 1e-15
        assert deviation(other, size) > 1e-9
    assert wedge.expansion > 1 > wedge.contraction


def test_wedges_narrow_with_the_box_and_wide_boxes_are_refused(saddle):
    with balls_at(BITS):
        cones = Cones(saddle, 40, BITS)
        near, nearer = cones.wedge(Fraction(1, 2**20)), cones.wedge(Fraction(1, 2**30))
        assert nearer.stable * 500 < near.stable
        assert nearer.unstable * 500 < near.unstable
        with pytest.raises(Refused):
            cones.wedge(Fraction(1, 8))


def test_a_stable_orbit_has_no_cones():
    (orbit,) = [each for each in si.linear(4, 0, "0.5").periodic(1, 2) if each.stable]
    with balls_at(BITS), pytest.raises(Refused):
        Cones(orbit, 30, BITS).wedge(Fraction(1, 2**20))


@pytest.mark.slow
def test_states_beside_the_orbit_are_refused(found):
    moved = found[0].states.copy()
    moved[found[0].index] += 0.02
    with pytest.raises(InputError, match="is not certified: Newton's method leaves the states"):
        replace(found[0], states=moved).certified(12)


@pytest.mark.slow
def test_an_orbit_that_stays_at_the_saddle_is_no_homoclinic_one(saddle):
    staying = np.repeat([[float(saddle.tau[0]), float(saddle.v[0])]], 12, axis=0)
    staying[0] += 1e-6 * np.array([1.0, -0.49])
    staying[-1] += 1e-6 * np.array([1.0, 0.69])
    assert isinstance(enclosed_crossing((saddle, saddle), staying, 6, 10), str)


@pytest.mark.slow
def test_a_forged_miss_does_not_pass(monkeypatch, found):
    honest, forgeries = room._Between.miss, []

    def forged(self, at):
        miss = honest(self, at)
        if any(each is self for each in forgeries):  # the first one of each attempt alone
            return miss
        forgeries.append(self)
        return miss * 0

    monkeypatch.setattr(room._Between, "miss", forged)
    moved = found[0].states.copy()
    moved[found[0].index] += 1e-4
    orbit = found[0]
    assert isinstance(enclosed_crossing((orbit.unstable, orbit.unstable), moved, orbit.index, 12), str)


@pytest.mark.slow
def test_the_wedges_are_in_the_radius(monkeypatch, found):
    """Wedges that are said to be wider make the proved states wider."""
    honest, orbit = Cones.wedge, found[0]
    narrow = orbit.certified(8)

    def wider(self, reach):
        return replace(honest(self, reach), unstable=Fraction(1, 10), stable=Fraction(1, 10))

    monkeypatch.setattr(Cones, "wedge", wider)
    wide = orbit.certified(8)
    for k in (0, -1):
        assert wide.states[k][0].radius > 10 * narrow.states[k][0].radius
    assert wide.tau.radius > 10 * narrow.tau.radius


@pytest.mark.slow
def test_drawn_over_its_manifolds(found, proved):
    axes = si.plot(list(found.manifolds))
    limits = axes.get_xlim(), axes.get_ylim()
    assert si.plot(proved, axes) is axes
    assert (axes.get_xlim(), axes.get_ylim()) == limits
    assert [text.get_text() for text in axes.texts] == ["1", "2", "3"]
    assert [text.xy[0] for text in axes.texts] == pytest.approx([0.13424366, 1.77284318, 0.24480574], abs=1e-7)
    assert axes.get_legend().get_texts()[-1].get_text() == (
        "impacts of a certified homoclinic orbit, angle 1.2964 at 2"
    )
    assert si.plot(proved).get_xlim()[0] == 0


def test_too_many_digits_are_refused(found):
    with pytest.raises(InputError, match="at most 500 digits"):
        found[0].certified(501)
    with pytest.raises(InputError, match="digits"):
        found[0].certified(0)


@pytest.mark.slow
def test_heteroclinic(saddle):
    other = next(orbit for orbit in OSC.periodic(2, 2) if not orbit.stable)
    crossing = si.homoclinic_points(saddle, other, length=3)[0].certified(8)
    assert (crossing.kind, crossing.unstable.stable, crossing.stable.stable) == ("heteroclinic", False, False)
    assert repr(crossing).startswith("<certified heteroclinic point (0.0974750")


@pytest.mark.slow
@pytest.mark.parametrize(
    "osc", [OSC, si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(2.8*t)", 0, "0.9")], ids=["linear", "Duffing"]
)
def test_of_saddles_of_three_impacts(osc):
    three = next(orbit for orbit in osc.periodic(3, 3) if not orbit.stable)
    doubles = si.homoclinic_points(three, length=5)[0]
    certified = doubles.certified(8)
    assert float(certified.angle.value) == pytest.approx(doubles.angle, abs=1e-8)
    assert float(certified.tau.value) == pytest.approx(doubles.tau, abs=1e-10)
