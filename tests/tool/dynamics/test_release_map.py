"""The map of release phases against closed forms, scipy and orbits; studies of models with restitution 0."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Status

TURN = 2 * np.pi


def table(G):
    """A ball on a vibrating table: x'' = -1 + G cos t in the frame of the table."""
    return si.models.luck_mehta(G=G, restitution=0)


def of_ball(G, start):
    """The next release of the ball, and the landing before it: a parabola above a cosine, in 30 digits."""
    with mpmath.workdps(30):
        G, start = mpmath.mpf(G), mpmath.mpf(start)
        lift = 2 * mpmath.pi - mpmath.acos(1 / G)

        def leaves(t):
            turns = mpmath.floor(t / (2 * mpmath.pi))
            phase = t - 2 * turns * mpmath.pi
            if G * mpmath.cos(phase) > 1:
                return t
            return lift + 2 * turns * mpmath.pi

        begin = leaves(start)

        def height(t):
            s = t - begin
            return -s * s / 2 + G * (mpmath.cos(begin) - mpmath.cos(t)) - G * mpmath.sin(begin) * s

        step = mpmath.mpf(1) / 100
        t = begin + step
        while height(t) > 0:
            t += step
        landing = mpmath.findroot(height, (t - step, t), solver="anderson")
        return float(landing), float(leaves(landing))


@pytest.mark.parametrize("G", ["2", "3.25", "3.5", "4.5", "9"])
def test_a_ball_on_a_table_against_the_closed_form(G):
    starts = np.random.default_rng(3).uniform(0, TURN, 40)
    found = table(G).release_map(starts)
    truth = np.array([of_ball(G, start) for start in starts.tolist()])
    assert (found.status == Status.hit).all()
    np.testing.assert_allclose(found.landing, truth[:, 0], rtol=0, atol=2e-14 * 40)
    np.testing.assert_allclose(found.tau, truth[:, 1], rtol=0, atol=2e-14 * 40)
    np.testing.assert_allclose(found.phase, np.mod(truth[:, 1], TURN), rtol=0, atol=1e-12)


DRAWN = [
    ("x + 0.1*xdot + 0.3*x**3", "A*cos(w*t)", "0.1"),
    ("sin(x) + 0.2*xdot", "A*cos(w*t) + cos(2*w*t)/3", "-0.2"),
    ("(1 + cos(w*t)/5)*x + 0.3*xdot", "A*sin(w*t)", "-0.1"),
]


def drawn(number):
    f, g, clearance = DRAWN[number % len(DRAWN)]
    A, w = np.random.default_rng(number).uniform((0.5, 0.8), (2.0, 2.5)).round(3)
    return si.ImpactOscillator(f, g, clearance, 0, {"A": A, "w": w})


def by_scipy(osc, number, start):
    """Landing and next release of a mass at rest, by scipy alone; the right side is written out again."""
    A, w = (float(osc.parameters[name].value) for name in ("A", "w"))
    c, period = float(osc.clearance.value), TURN / w
    pushes = [
        lambda t, x, u: A * np.cos(w * t) - x - 0.1 * u - 0.3 * x**3,
        lambda t, x, u: A * np.cos(w * t) + np.cos(2 * w * t) / 3 - np.sin(x) - 0.2 * u,
        lambda t, x, u: A * np.sin(w * t) - (1 + np.cos(w * t) / 5) * x - 0.3 * u,
    ]
    push = pushes[number % len(DRAWN)]

    def leaves(t):
        if push(t, c, 0) > 0:
            return t
        times = np.linspace(t, t + period, 4001)
        rise = np.flatnonzero((push(times[:-1], c, 0) <= 0) & (push(times[1:], c, 0) > 0))[0]
        return brentq(push, times[rise], times[rise + 1], (c, 0), xtol=1e-15)

    begin = leaves(start)

    def slopes(t, y):
        return [y[1], push(t, y[0], y[1])]

    def event(_t, y):
        return y[0] - c

    event.terminal, event.direction = True, -1
    flight = solve_ivp(
        slopes, (begin, begin + 60), [c, 0.0], "DOP853", events=event, rtol=1e-13, atol=1e-15, max_step=0.05
    )
    return flight.t[-1], leaves(flight.t[-1])


@pytest.mark.parametrize("number", range(6))
def test_drawn_models_against_scipy(number):
    osc = drawn(number)
    starts = np.random.default_rng(number).uniform(0, TURN / float(osc.parameters["w"].value), 6)
    found = osc.release_map(starts)
    for at, start in enumerate(starts.tolist()):
        if found.status[at] == Status.hit:
            landing, leaves = by_scipy(osc, number, start)
            assert found.landing[at] == pytest.approx(landing, abs=1e-8)
            assert found.tau[at] == pytest.approx(leaves, abs=1e-8)
    assert (found.status == Status.hit).sum() >= 4


@pytest.mark.parametrize("number", range(4))
def test_slopes_are_those_of_differences_and_flat_pieces_are_exact(number):
    osc, h = drawn(number), 1e-5
    starts = np.linspace(0, 2 * TURN, 400)
    here, before, after = (osc.release_map(starts + step) for step in (0, -h, h))
    rising = ~(here.flat | before.flat | after.flat) & (np.abs(after.tau - before.tau) < 0.1)
    difference = (after.tau - before.tau)[rising] / (2 * h)
    np.testing.assert_allclose(here.slope[rising], difference, rtol=1e-4, atol=1e-5)
    flat = here.flat & (here.status == Status.hit)
    assert flat.any()
    assert set(here.slope[flat].tolist()) == {0.0}
    exact = {osc.release_map(time).phase for time in starts[flat][:3].tolist()}
    assert exact <= set(here.phase[flat].tolist())
    assert len(set(here.phase[flat].tolist())) <= 2  # one for each lift-off of a period


def test_the_map_goes_on_as_the_orbit_does():
    osc = table("4.3")
    at = 5.4
    events = osc.orbit(at, 0, 12)
    kinds = [*events.kind.tolist(), "impact"]
    times = [time for n, time in enumerate(events.tau.tolist()) if n and kinds[n + 1] != "release"]
    phase, turns, reached = at, 0.0, []
    for _ in times:
        step = osc.release_map(phase)
        reached.append(turns + float(step.tau))
        turns, phase = turns + float(step.tau) - float(step.phase), float(step.phase)
    np.testing.assert_allclose(reached, times, rtol=0, atol=1e-9)


def test_a_mass_that_is_pressed_for_ever_stays():
    found = si.linear(2, 2, 0).release_map([0.1, 3.0])
    assert found.status.tolist() == [Status.sticks] * 2
    assert np.isinf(found.tau).all()
    assert np.isnan(found.landing).all()
    assert np.isnan(found.phase).all()


def test_the_picture_shows_the_flat_pieces_and_the_diagonal():
    found = table("4.3").release_map()
    names = {line.get_label(): line.get_xdata().size for line in si.plot(found).lines}
    assert names == {"diagonal": 2, "leaves at once": (~found.flat).sum(), "rests: flat": found.flat.sum()}


def test_release_maps_need_the_restitution_0_and_a_period():
    with pytest.raises(InputError, match=r"restitution = 0\.5 is not accepted: give 0"):
        si.linear(2, 0, "0.5").release_map()
    with pytest.raises(InputError, match="one with a period"):
        si.universal(1, 0).release_map()


# ---- studies with restitution 0


def test_iterates_rest_where_the_force_presses():
    osc = table("3.5")
    ends = osc.iterate([0.2, 5.2], [1.0, 0.0], 30)
    assert ends.status.tolist() == [Status.sticks, Status.hit]
    assert ends.v.tolist() == [0.0, 0.0]
    assert osc.acceleration(ends.tau[0]) < 0
    kept = osc.iterate([0.2, 5.2], [1.0, 0.0], 30, keep=True)
    assert kept.tau[-1].tolist() == ends.tau.tolist()
    assert osc.iterate([0.2, 5.2], [1.0, 0.0], 30, threads=2).tau.tolist() == ends.tau.tolist()
    flown = osc.orbit(5.2, 0, 30)
    np.testing.assert_allclose(flown.tau[-1], ends.tau[1], rtol=1e-14)


@pytest.mark.parametrize("digits", [None, 25])
def test_a_chatter_limit_is_the_first_impact(digits):
    osc = si.linear("2", "0.3", 0)
    hit, end = osc.impact_map("1.2", "0.05", digits=digits), osc.chatter_limit("1.2", "0.05", digits=digits)
    assert (int(end.status), end.tau, end.impacts) == (Status.complete, hit.tau, 1)
    assert end.error < (1e-14 if digits is None else 1e-23)
    lifted = table("3.5").chatter_limit("5.2", 0, digits=digits)
    assert int(lifted.status) == Status.lifts_off
    assert hit.v == 0
    if digits:
        assert abs(end.tau - float(osc.chatter_limit("1.2", "0.05").tau)) < 1e-14
        with pytest.raises(InputError, match="a certificate needs impacts that rebound"):
            si.certify(end)


@pytest.mark.parametrize(
    ("G", "name"),
    [("3.2", "(inf, 1) chatter for ever"), ("3.5", "(1, 1) orbit"), ("3.8", "(2, 2) orbit"), ("0.9", "rest for ever")],
)
def test_basins_name_the_attractors_that_the_circle_map_has(G, name):
    """Mehta and Luck: rest below 1, lift-off each period up to G_1 = sqrt(1 + pi^2), then one orbit, which doubles."""
    osc = table(G)
    found = osc.basins(size=12)
    assert [each for _, each, _ in found.classes] == [name]


def test_a_mass_that_rests_and_then_flies_for_ever_has_no_impact():
    found = si.ImpactOscillator("sin(x) + 0.2*xdot", "0.6*cos(2.1*t)", "-0.4", 0).basins(size=8)
    assert {each.kind for each in found.attractors} == {"no impact"}


def test_a_diagram_settles_by_release_phases():
    found = si.models.luck_mehta(restitution=0).bifurcation("G", ("1.5", "6"), 40, impacts=60, kept=8)
    assert found.settled.all()
    assert (np.nan_to_num(found.events[:, :, 1]) == 0).all()
    period_one = (found.values > np.sqrt(1 + np.pi**2)) & (found.values < np.sqrt(4 + np.pi**2))
    assert period_one.sum() >= 3
    phases = TURN - np.arcsin(np.pi / found.values[period_one])
    np.testing.assert_allclose(found.events[period_one, -1, 0], phases, atol=1e-5)


def test_exponents_are_the_growth_of_the_map_and_minus_infinity():
    found = table("3.5").lyapunov(0.1, 1, 400)
    truth = np.log(abs(1 - np.sqrt(3.5**2 - np.pi**2))) / TURN
    assert found.exponents[0] == pytest.approx(truth, rel=1e-10)
    assert found.exponents[1] == -np.inf
    resting = table("3.2").lyapunov(0.1, 1, 400)
    assert resting.superstable
    assert resting.exponents.tolist() == [-np.inf, -np.inf]


def test_a_clock_with_plastic_impacts_has_the_cycle_of_its_orbits():
    """Every impact leaves the same state: the cycle of one impact is the flight from rest."""
    clock = si.ImpactOscillator("-(1 - x**2)*xdot + x", "0", -1, 0)
    (cycle,) = si.basins(clock, size=4).attractors
    flight = solve_ivp(
        lambda _, s: [s[1], (1 - s[0] ** 2) * s[1] - s[0]], (0, 10), [-1, 0], rtol=1e-12, atol=1e-13, dense_output=True
    )
    period = brentq(lambda t: flight.sol(t)[0] + 1, 3, 7)
    assert (cycle.kind, cycle.n) == ("orbit", 1)
    assert abs(cycle.period - period) < 1e-9
    found = clock.lyapunov(0, 1, 500)
    assert abs(found.exponents[0]) <= found.error[0] < 1e-14
    assert found.exponents[1] == -np.inf
    (still,) = si.basins(clock.replace(clearance="0.1"), size=4).attractors
    assert still.kind == "rest"


@pytest.mark.parametrize("clearance", ["0.1", "-0.3", "0.6"])
@pytest.mark.parametrize("restitution", [0, "0.3"])
def test_rests_under_a_forcing_that_never_repeats_are_no_rest_for_ever(clearance, restitution):
    osc = si.ImpactOscillator("x + 0.1*xdot", "cos(2*t) + cos(sqrt(2)*t)/2", clearance, restitution)
    orbit = osc.orbit(0.1, 0.5, 300)
    rests = int(np.count_nonzero(orbit.kind == "release"))
    (response,) = si.basins(osc, size=4).attractors
    assert response.kind == ("chatter" if rests else "quasi-periodic")
    assert osc.lyapunov(0.1, 0.5, 200).superstable == (rests > 0)
