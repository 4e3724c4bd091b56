"""Chatter limits of arrays: the compiled loop against the plain one state by state, and against enclosures."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import DOUBLES
from singimpact.dynamics import ENDING, chatter_limit
from singimpact.dynamics.chatter import _abreast
from singimpact.dynamics.remaining import remaining
from singimpact.flights import Search, States, linear_model, listed, orbit_segment, over_floats
from singimpact.flights.compiled_model import compiled_model
from singimpact.status import Cause, Status

MODELS = {
    "r = 0.5": si.linear("2.8", 0, "0.5"),
    "r = 0.8": si.linear("2.8", 0, "0.8"),
    "r = 0.001": si.linear("2.8", 0, "0.001"),
    "damped": si.linear(2, "0.3", "0.6", damping="0.3", phase="1/7"),
    "driven": si.linear("1.3", "-0.2", "0.5", damping="-0.1", stiffness=3, amplitude="0.5"),
    "two waves": si.ImpactOscillator("x", "cos(2*t) + sin(6*t)/9", "0.4", "0.5"),
    "no spring": si.ImpactOscillator("0.1*xdot", "cos(t) - 0.2", 0, "0.7"),
    "ball": si.ImpactOscillator("0", "-9.81", 0, "0.9"),
}


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """What all linear models share; without it arrays are flown state by state."""
    model = compiled_model(MODELS["ball"])
    for name in (model.main, "search_entry"):
        model.machine.compile_here(name)


def plain(osc, tau, v, impacts=10**6):
    return next(_abreast(osc, States.of(osc, tau, v), impacts, [0])).ended()


def drawn(count, seed, fastest=0.3):
    """Random states, from pressed at once to long flights, over several periods."""
    random = np.random.default_rng(seed)
    return random.uniform(-8, 8, count), 10 ** random.uniform(-5, fastest, count)


def assert_same(osc, found, tau, v, index, impacts=10**6):
    one = plain(osc, tau[index], v[index], impacts)
    if one.cause == Cause.settled:  # they look for a repetition at other impacts
        assert found.cause[index] in (Cause.settled, Cause.impacts_exhausted)
    else:
        assert (found.status[index], found.cause[index], found.impacts[index]) == (one.status, one.cause, one.impacts)
    if one.status in (Status.complete, Status.lifts_off):
        assert abs(found.tau[index] - one.tau) <= one.error
        assert 0.5 < found.error[index] / one.error < 2
    else:
        assert np.isnan([found.tau[index], found.error[index]]).all()


@pytest.mark.parametrize("name", MODELS)
def test_the_compiled_loop_is_the_plain_one(name):
    osc, (tau, v) = MODELS[name], drawn(40, 7)
    found = chatter_limit(osc, tau, v, impacts=3000)
    for index in range(tau.size):
        assert_same(osc, found, tau, v, index, 3000)


@pytest.mark.parametrize("r", ["0.99", "0.999"])
def test_the_compiled_loop_near_restitution_one(r):
    """More impacts than the first scratch has rows for."""
    osc, tau, v = si.linear("2.8", 0, r), np.array([0.9, 1.1, 1.3]), np.array([1e-4, 1e-5, 1e-3])
    found = chatter_limit(osc, tau, v)
    assert found.impacts.max() > (1000 if r == "0.99" else 5000)
    for index in range(3):
        assert_same(osc, found, tau, v, index)


@pytest.mark.parametrize("name", MODELS)
def test_errors_of_arrays_hold_the_true_error(name):
    osc, (tau, v) = MODELS[name], drawn(300, 11)
    found = chatter_limit(osc, tau, v, impacts=3000)
    ended = np.flatnonzero(np.isin(found.status, (Status.complete, Status.lifts_off)))
    wrong = 0
    for index in ended[:6].tolist():
        true = chatter_limit(osc, tau[index], v[index], digits=22)
        assert true.status == found.status[index]
        off = abs(true.tau - mpmath.mpf(float(found.tau[index])))
        assert off <= found.error[index] < 1e-9 * max(abs(found.tau[index]), 1)
        wrong += off > 0
    assert wrong > 0


def test_a_scalar_is_an_array_of_one_state():
    osc, (tau, v) = MODELS["r = 0.8"], drawn(30, 3)
    found = chatter_limit(osc, tau.reshape(5, 6), v.reshape(5, 6))
    for name in ("tau", "impacts", "error", "status", "cause", "certified"):
        assert getattr(found, name).shape == (5, 6)
    for index in range(30):
        one = chatter_limit(osc, tau[index], v[index])
        for name in ("tau", "impacts", "error", "status", "cause"):
            assert getattr(one, name) == getattr(found, name).ravel()[index]
        assert one.certified is None


def test_states_at_rest_and_written_states_among_others():
    osc = MODELS["r = 0.8"]
    given = [("0.9", "0.005"), (1.0, 0), ("3*pi/5.6", 0), (2.0, 0.0), (1e12, 0.005), (1.2, 1e-300)]
    found = chatter_limit(osc, [tau for tau, _ in given], [v for _, v in given])
    assert {Status.sticks, Status.complete, Status.lifts_off} <= set(found.status.tolist())
    for index, (tau, v) in enumerate(given):
        one = plain(osc, tau, v)
        assert (found.status[index], found.impacts[index]) == (one.status, one.impacts)
        assert np.isnan(one.tau) or abs(found.tau[index] - one.tau) <= one.error


@pytest.mark.parametrize("impacts", [1, 3, 20])
def test_impacts_run_out(impacts):
    osc, (tau, v) = MODELS["r = 0.8"], drawn(60, 5)
    found = chatter_limit(osc, tau, v, impacts=impacts)
    exhausted = found.cause == Cause.impacts_exhausted
    assert exhausted.any()
    assert (found.status[exhausted] == Status.unresolved).all()
    assert (found.impacts <= impacts).all()
    for index in np.flatnonzero(~exhausted).tolist():
        assert_same(osc, found, tau, v, index)


def test_nothing_is_summed_up_without_losses():
    for osc, tau in ((si.linear("2.8", 0, 1), [0.9, 0.2]), (si.ImpactOscillator("0", "-9.81", 0, 1), [0.9, 0.2])):
        found = chatter_limit(osc, tau, 0.005, impacts=700)
        for index in range(2):
            assert_same(osc, found, np.array(tau), np.array([0.005] * 2), index, 700)
        assert not (found.status == Status.complete).any()
    assert found.cause.tolist() == [Cause.impacts_exhausted] * 2


def test_contact_is_lost_at_an_impact_from_which_the_mass_never_returns():
    """x'' = x + 0.3 cos t: after the first impact at which a_c presses no more the mass may run away."""
    osc, tau, v = si.ImpactOscillator("-x", "0.3*cos(t)", "0.1", "0.5"), np.linspace(3, 4.3, 14), np.full(14, 0.02)
    found = chatter_limit(osc, tau, v)
    at = np.flatnonzero(found.status == Status.lifts_off)
    assert (osc.acceleration(found.tau[at]) >= 0).all()
    flown = [orbit_segment(osc, tau[index], v[index], 200) for index in at.tolist()]
    never = [n for n, rows in enumerate(flown) if rows.tau.size == found.impacts[at[n]]]
    assert never  # the flight after the last impact of the sequence meets none
    assert {int(plain(osc, tau[index], v[index]).status) for index in at[never].tolist()} == {Status.lifts_off}


def test_many_states_are_flown_in_blocks():
    osc, (tau, v) = MODELS["r = 0.5"], drawn(3000, 2)
    found = chatter_limit(osc, tau, v)
    for part in (slice(0, 3), slice(1500, 1503), slice(2997, 3000)):
        few = chatter_limit(osc, tau[part], v[part])
        assert few.tau.tolist() == found.tau[part].tolist()
        assert few.error.tolist() == found.error[part].tolist()


def test_the_kernel_sums_what_the_plain_series_sums():
    """Both are the same terms, those of a linear model without the jets that it does not have."""
    osc = MODELS["damped"]
    model, space = compiled_model(osc), over_floats()
    numbers = listed(linear_model(model.flat, model.sizes)).numbers
    for tau in (0.9, 1.0, 1.2):
        a = float(osc.acceleration(tau))
        launch = [DOUBLES.call("cos", 2 * tau + 1 / 7), DOUBLES.call("sin", 2 * tau + 1 / 7)]
        kernel = space["chatter_left"](0.01, a, 0.6, numbers, launch)
        series = [float(part[0]) for part in remaining(osc, np.array([tau]), np.array([0.01]))]
        assert kernel == pytest.approx(series, rel=1e-12)
        assert kernel[1] > 1e-12


def test_the_kernel_over_lists_is_the_compiled_one():
    osc = MODELS["r = 0.5"]
    model, space = compiled_model(osc), over_floats()
    views = model.interpreter.model
    work, _ = model.interpreter.work()
    search = Search([ENDING.near, 1e6, ENDING.trust], model.rho.tolist())
    rows = [[0.0] * 6 for _ in range(100)]
    code, end, error, impacts = space["chatter_end"](0.9, 0.005, search, views, work, rows)
    found = chatter_limit(osc, 0.9, 0.005)
    assert (code, impacts) == (60, found.impacts)
    assert abs(end - found.tau) <= 1e-15
    assert error == pytest.approx(found.error, rel=1e-9)
    few = space["chatter_end"](0.9, 0.005, search, views, work, rows[:5])
    assert few[0] == 64


def test_a_limit_near_restitution_one_holds_its_enclosure():
    found = chatter_limit(si.linear(2, "0.3", "0.9"), [1.2, 1.2], ["0.01", "0.02"])
    true = chatter_limit(si.linear(2, "0.3", "0.9"), 1.2, "0.01", digits=30).certified.value
    assert abs(Fraction(float(found.tau[0])) - Fraction(str(true))) <= Fraction(float(found.error[0]))


@pytest.mark.parametrize(
    ("osc", "omega"),
    [
        (si.ImpactOscillator("x + xdot/5", "cos(1.3*t)", "1/5", "4/5"), 1.3),
        (si.ImpactOscillator("x + xdot/10 + x**3", "3*cos(1.7*t)/5", "1/10", "4/5"), 1.7),
    ],
)
def test_an_orbit_that_repeats_itself_is_given_up(osc, omega):
    """It was flown for a million impacts: 1000 states of the second model took minutes, and the answer was the same."""
    draw = np.random.default_rng(3)
    tau, v = draw.uniform(0, 6, 12), draw.uniform(0.3, 1, 12)
    ends = osc.chatter_limit(tau, v)
    settled = np.flatnonzero(ends.cause == si.Cause.settled)
    assert settled.size >= 3
    assert ends.impacts[settled].max() < 2000
    assert np.isnan(ends.tau[settled]).all()
    assert np.all(ends.status[settled] == si.Status.unresolved)
    for index in settled[:2]:
        # the impacts of an orbit flown beside it, by their phases and velocities
        orbit = osc.orbit(tau[index], v[index], impacts=int(ends.impacts[index]) + 300)
        phases, speeds = np.exp(1j * omega * orbit.tau[-300:]), orbit.v[-300:]
        apart = np.abs(phases[:-1] - phases[-1]) + np.abs(speeds[:-1] - speeds[-1])
        assert apart.min() < 1e-11
        # it never chatters: velocities do not shrink
        assert speeds.min() > 1e-3
    assert ends.sentence[settled[0]].startswith("the impacts repeat themselves")


@pytest.mark.parametrize("f", ["x + 0.1*xdot + 0.3*x**3", "x + 0.2*tanh(5*xdot)"])
def test_states_of_other_models_abreast_are_those_one_by_one(f):
    """Starts at rest, lift-offs, chatters of many lengths and orbits that are given up, in blocks of several sizes."""
    osc = si.ImpactOscillator(f, "cos(1.7*t)", "0.3", "0.8")
    random = np.random.default_rng(7)
    tau, v = random.uniform(0, 3.7, 40), np.append(10 ** random.uniform(-6, 0.2, 37), [0.0, 0.0, 0.0])
    found = osc.chatter_limit(tau, v, impacts=300)
    assert {Status.complete, Status.lifts_off} <= set(found.status.tolist())
    for index in range(tau.size):
        one = osc.chatter_limit(float(tau[index]), float(v[index]), impacts=300)
        assert (one.status, one.cause, one.impacts) == tuple(
            getattr(found, name)[index] for name in ("status", "cause", "impacts")
        )
        assert np.array_equal([one.tau, one.error], [found.tau[index], found.error[index]], equal_nan=True)
