"""Statements that are proved, tried on true orbits of two models: by the impact map of the package, and by DOP853.

`singimpact verify` decides them by exact arguments.  Here each is met as a dynamicist would meet it.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from singimpact.algebra.solving import halved, secant
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.surfaces import clearance, flow
from singimpact.paper.trials.true_sheet import foliated, swans, tangencies
from singimpact.status import Status

MODELS = list(true_orbits.MODELS.values())
SEED = 20071
STEP = 1e-5  # of central differences: truncation and rounding are both near 1e-10
START = 0.02  # the distance from tau_* at which orbits beside gamma are launched


def flight_times(place, tau, v):
    step = place.model.impact_map(tau, v)
    assert np.all(np.isin(step.status, (Status.hit, Status.graze)))
    return np.asarray(step.flight_time)


def jumps_on(place, side):
    """How often the flight time jumps on lines sigma = const at the most, and v/(a' sigma^2) there as sigma -> 0."""
    scaled, counts, places = np.linspace(0.02, 1.2, 400), [], []
    for size in (0.02, 0.01, 0.005):
        unit, tau = place.jets()["a_d1"] * size**2, place.tau + side * size
        at = np.flatnonzero(np.abs(np.diff(flight_times(place, tau, scaled * unit))) > size)
        counts.append(len(at))
        for low, high in zip(scaled[at] * unit, scaled[at + 1] * unit, strict=True):
            start = float(flight_times(place, tau, low))

            def before(v, start=start, tau=tau, size=size):
                return abs(float(flight_times(place, tau, v)) - start) <= size

            places.append((size, sum(halved(before, low, high, 1e-9)) / 2 / unit))
    return max(counts), float(true_orbits.extrapolated(places)) if places else None


@pytest.mark.parametrize("place", tangencies(), ids=lambda place: place.name)
def test_the_first_hit_jumps_once_before_a_tangency_and_not_behind_it(place):
    """`s4-P-star`: at v = (3/8) a' sigma^2."""
    count, coefficient = jumps_on(place, -1)
    assert count == 1
    assert coefficient == pytest.approx(3 / 8, abs=1e-3)
    assert jumps_on(place, 1) == (0, None)


def fate(point, factor, impacts=400):
    """Follow impacts until the speed has died out before tau_*, or a flight leaves the neighbourhood of tau_*."""
    tau, v = point.tau - START, factor * point.coefficient * START**2
    first = v
    for _ in range(impacts):
        step = point.model.impact_map(tau, v)
        if float(step.flight_time) > 10 * START:
            return "lost"
        tau, v = float(step.tau), float(step.v)
        if v < 1e-9 * first and tau < point.tau:
            return "chatter"
    return "undecided"


@pytest.mark.parametrize("place", tangencies(), ids=lambda place: place.name)
def test_chatter_completes_below_gamma_and_contact_is_lost_above_it(place):
    """`t:t2-sides`, a tenth beside gamma, far below it, and nearly at P_*."""
    assert [fate(place, factor) for factor in (0.3, 0.9, 1.1, 1.3)] == ["chatter", "chatter", "lost", "lost"]


@pytest.mark.parametrize("point", tangencies(), ids=lambda place: place.name)
def test_orbits_beside_gamma_leave_it(point):
    """`t:t2-unique`: a relative distance of 1e-3 has grown tenfold and more once sigma has shrunk 30-fold."""
    backwards_from = true_orbits.SETTINGS.start[0]
    (sigma, v), offset = (
        true_orbits.backwards(
            true_orbits.scipy_flow(point.model, point.tau),
            point.r,
            -backwards_from,
            point.coefficient * backwards_from**2,
            point.multiplier,
            START,
        )[-1],
        1e-3,
    )
    tau, speed = point.tau + sigma, v * (1 - offset)
    while abs(tau - point.tau) > abs(sigma) / 30:
        step = point.model.impact_map(tau, speed)
        tau, speed = float(step.tau), float(step.v)
    assert abs(speed / (point.coefficient * (tau - point.tau) ** 2) - 1) > 10 * offset


@pytest.mark.parametrize("point", swans(), ids=lambda place: place.name)
def test_all_orbits_near_a_swan_come_to_rest_where_the_wall_acceleration_is_negative(point):
    """`t:t3-others`: launches before and behind tau_*, at 0.2 to 5 times the height of gamma."""
    height = abs(float(point.model.acceleration(point.tau, order=2))) * 0.05**3 / 12
    for sigma in (-0.05, 0.02):
        tau, v = np.full(6, point.tau + sigma), height * np.array([0.2, 0.5, 0.8, 1.3, 2.0, 5.0])
        for _ in range(300):
            step = point.model.impact_map(tau, v)
            assert not np.any(np.asarray(step.flight_time) > 1.0)
            tau, v = np.asarray(step.tau), np.asarray(step.v)
        assert np.all(v < 1e-8 * height)
        assert np.max(point.model.acceleration(tau)) < 0


@pytest.mark.parametrize("point", foliated(), ids=lambda place: place.name)
def test_the_first_hit_has_no_jumps_near_a_tangency_with_falling_acceleration(point):
    """`s4b-continuous`: neighbouring flight times on a grid with |sigma| <= 0.05 and v up to 4 |k| sigma^2 there."""
    sigma = np.linspace(-0.05, 0.05, 81)
    v = np.linspace(0, 4 * abs(point.jets()["k"]) * 0.05**2, 61)[1:]
    times = np.asarray(point.model.impact_map((point.tau + sigma)[:, None], v[None, :]).flight_time)
    assert max(np.abs(np.diff(times, axis=axis)).max() for axis in (0, 1)) < 0.05


@pytest.mark.parametrize("point", foliated(), ids=lambda place: place.name)
def test_chatter_dies_out_on_arcs_near_a_tangency_with_falling_acceleration(point):
    """`s4b-contraction`: arcs p(t = l sigma), 0 < sigma <= 0.05, followed together."""
    for ell in (0.1, 0.5, 2.0):
        sigma = np.linspace(0.002, 0.05, 25)
        tau, v = point.tau + sigma, -point.jets()["k"] * (3 * ell + ell**2) * sigma**2
        start, sizes = v.max(), []
        for _ in range(40):
            step = point.model.impact_map(tau, v)
            tau, v = np.asarray(step.tau), np.asarray(step.v)
            sizes.append(float(v.max()))
        assert sizes[-1] < 1e-6 * start
        assert sizes[-1] < sizes[-2]


def random_states(count):
    """(model, tau, v) of random states of both models."""
    rng = np.random.default_rng(SEED)
    return [
        (model, float(tau), float(v))
        for model in MODELS
        for tau, v in zip(rng.uniform(0, 3, count), rng.uniform(0.2, 1.5, count), strict=True)
    ]


def test_the_gradient_of_a_flight_has_its_identity():
    """`s2-smooth`: x_tau = x-dot - v x_c - A x_v at first hits, A the acceleration at the launch."""
    for model, tau, v in random_states(6):
        at, c, t = flow(model), clearance(model), float(model.first_hit(tau, v).flight_time)

        def slope(*moved, at=at, c=c, t=t, state=(tau, v)):
            ahead, behind = (
                at(state[0] + s * moved[0], c + s * moved[1], state[1] + s * moved[2], t)[0] for s in (1, -1)
            )
            return float(ahead - behind) / (2 * STEP)

        x_tau, x_x, x_v = slope(STEP, 0, 0), slope(0, STEP, 0), slope(0, 0, STEP)
        speed = float(at(tau, c, v, t)[1])
        push = (float(at(tau, c, v, STEP)[1]) - float(at(tau, c, v, -STEP)[1])) / (2 * STEP)
        assert abs(x_tau - (speed - v * x_x - push * x_v)) < 1e-6 * (1 + abs(x_x) + abs(x_v))


def test_flights_from_rest_are_folds_of_phi():
    """`p:phising-fold`: at the landing reversed, the sheet has v_tt = -a(tau)/(t dy/dv)."""
    places = [(model, tau) for model in MODELS for tau in (0.1, 2.9) if model.acceleration(tau) > 0]
    assert len(places) >= 2
    for model, tau in places:
        at, c, h = flow(model), clearance(model), 1e-2
        t = float(model.first_hit(tau, 0.0).flight_time)
        w = float(at(tau, c, 0.0, t)[1])

        def launch(time, at=at, c=c, start=tau + t, w=w):
            return float(secant(lambda speed: float(at(start, c, speed, time)[0]) - c, w, w + 1e-6, 30, 1e-15))

        values = [launch(-t + n * h) for n in (-2, -1, 0, 1, 2)]
        second = float(np.dot([-1, 16, -30, 16, -1], values)) / (12 * h * h)
        rate = (float(at(tau + t, c, w + STEP, -t)[0]) - float(at(tau + t, c, w - STEP, -t)[0])) / (2 * STEP)
        assert second == pytest.approx(-float(model.acceleration(tau)) / rate, rel=1e-4)


def jumps(model, tau, count=1501, least=0.3):
    """Neighbours between which the flight time jumps, of so many velocities."""
    v = np.linspace(0.05, 2.5, count)
    times = np.asarray(model.impact_map(tau, v).flight_time)
    return [(float(v[at]), float(v[at + 1])) for at in np.flatnonzero(np.abs(np.diff(times)) > least)]


def touch(model, tau, low, high):
    """The smaller |x-dot| at the first hit on the two sides of a jump, after bisection to 1e-13."""
    start = float(model.first_hit(tau, low).flight_time)
    ends = halved(lambda v: abs(float(model.first_hit(tau, v).flight_time) - start) <= 0.1, low, high, 1e-13)
    return float(min(abs(float(model.first_hit(tau, v).velocity)) for v in ends))


def test_every_jump_of_the_first_hit_is_a_graze():
    """`s2-discontinuity`, on lines tau = const."""
    lines = [(model, float(tau)) for model in MODELS for tau in np.linspace(0.2, 3.0, 12)]
    touches = [touch(model, tau, *ends) for model, tau in lines for ends in jumps(model, tau)]
    assert len(touches) >= 5
    assert max(touches) < 1e-3


def test_jumps_are_found_between_neighbours_and_smooth_changes_are_not():
    places = np.array([0.3, 1.111, 1.9])

    def impact_map(_tau, v):
        steep = 3 * np.tanh(40 * (v - 0.7))  # changes by 0.05 between neighbours, without a jump
        return SimpleNamespace(flight_time=steep + np.searchsorted(places, v))

    found = jumps(SimpleNamespace(impact_map=impact_map), 0.0, count=6001)
    assert len(found) == len(places)
    for (low, high), place in zip(found, places, strict=True):
        assert low <= place <= high
        assert high - low < 1e-3


def test_the_launch_and_the_landing_of_a_flight_lie_on_one_orbit():
    """`p:corresp`: from p(z) and from phi(z) the free flow reaches the same state at a third time."""
    for model, tau, v in random_states(8):
        at, c, hit = flow(model), clearance(model), model.first_hit(tau, v)
        t, w = float(hit.flight_time), float(hit.velocity)
        assert at(tau, c, v, t + 0.7) == pytest.approx(at(tau + t, c, w, 0.7), abs=1e-9)
