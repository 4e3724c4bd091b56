"""Flights between two walls: against flights of one wall each, scipy's integrator, closed forms, and balls."""

from math import atan2, cos, pi, sin, sqrt, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.algebra import constant
from singimpact.flights import CompiledModel
from singimpact.inputs import InputError
from singimpact.status import Status, Wall

MODELS = {
    "linear": ("x + xdot/10", "3*cos(2.8*t)"),
    "undamped": ("x", "cos(2.8*t)"),
    "resonant": ("4*x", "cos(2*t)"),
    "free": ("xdot/5", "cos(t) + cos(3*t)/2 - 1/10"),
    "unstable": ("-x", "cos(3*t)"),
    "Duffing": ("x + x**3 + xdot/10", "5*cos(1.7*t)"),
    "asymmetric": ("x**2/2 + x/3 + tanh(xdot)/5", "2*cos(2*t) + sin(4*t)"),
    "parametric": ("(1 + cos(2*t)/3)*x + x**3/4", "2*sin(2*t)"),
    "no clock": ("-(1 - x**2)*xdot + x", "0"),
}
RNG = np.random.default_rng


def model(name: str, seed: int = 0, **walls: object) -> si.ImpactOscillator:
    """A model of the table between drawn walls."""
    rng = RNG([len(name), seed])
    low, gap = rng.uniform(-1, 0.3), 10 ** rng.uniform(-2, 0.5)
    given = {"upper": low + gap, "upper_restitution": "0.7"} | walls
    return si.ImpactOscillator(*MODELS[name], low, "0.8", **given)


def states(size: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = RNG(seed)
    return rng.uniform(0, 7, size), 10 ** rng.uniform(-7, 1, size)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_a_first_hit_is_the_first_of_two_flights_with_one_wall_each(name, wall):
    decided = 0
    for seed in range(4):
        osc = model(name, seed)
        tau, v = states(100, seed)
        near, far = (osc.one_wall(wall), osc.one_wall("upper" if wall == "lower" else "lower"))
        own = near.first_hit(tau, v, horizon=60)
        other = far.launch(-float(near.clearance.value) * np.ones(100), -v, tau, horizon=60)
        hit = osc.first_hit(tau, v, wall=wall, horizon=60)
        # what either flight reaches first; a flight that is not decided, or grazes, is left out
        plain = [Status.hit, Status.no_return, Status.escaped]
        known = np.isin(own.status, plain) & np.isin(other.status, plain)
        times = np.stack([own.flight_time, other.flight_time])[:, known]
        first = np.isfinite(times.min(axis=0))
        at = times.argmin(axis=0)
        assert ((hit.status[known] == Status.hit) == first).all()
        assert np.isin(hit.status[known][~first], plain[1:]).all()
        walls = at if wall == "lower" else 1 - at
        assert (hit.wall[known][first] == walls[first]).all()
        error = 8 * hit.error[known][first] + 1e-14
        assert (np.abs(hit.flight_time[known][first] / times.min(axis=0)[first] - 1) < error).all()
        speeds = np.stack([own.velocity, -other.velocity])[:, known]
        side = 1 if wall == "lower" else -1
        chosen = np.take_along_axis(speeds, at[None], axis=0)[0][first]
        assert (np.abs(hit.velocity[known][first] / (side * chosen) - 1) < error).all()
        decided += int(first.sum())
    assert decided > 150


@pytest.mark.parametrize("gap", [1e-12, 1e-6, 10.0, 1e6])
@pytest.mark.parametrize("name", ["linear", "undamped", "Duffing"])
def test_gaps_and_velocities_of_any_size(name, gap):
    osc, rng = si.ImpactOscillator(*MODELS[name], 0, "0.8", upper=gap), RNG(1)
    tau, v = rng.uniform(0, 6, 60), 10 ** rng.uniform(-150, 3, 60)
    v[:20] = 10 ** rng.uniform(-9, -5, 20)
    own, hit = osc.one_wall().first_hit(tau, v, horizon=60), osc.first_hit(tau, v, horizon=60)
    other = osc.one_wall("upper").launch(0.0, -v, tau, horizon=60)
    times = np.stack([own.flight_time, other.flight_time])
    decided = (own.status != Status.unresolved) & (other.status != Status.unresolved) & np.isfinite(times.min(axis=0))
    assert decided.sum() > 30
    assert (hit.status[decided] == Status.hit).all()
    assert (hit.wall[decided] == times.argmin(axis=0)[decided]).all()
    error = np.abs(hit.flight_time / times.min(axis=0) - 1)[decided]
    assert (error < 8 * hit.error[decided] + 1e-13).all()


def integrated(osc: si.ImpactOscillator, wall: int, tau: float, v: float) -> tuple[int, float, float]:
    """Wall, flight time and x' of a first hit by scipy."""
    f, g = (compile(str(tree).replace("xdot", "u"), "law", "eval") for tree in (osc.force(), osc.forcing()))
    names = {name: getattr(np, name) for name in ("cos", "sin", "tanh")}
    low, high = (float(constant("place", place).value) for place in (osc.clearance, osc.upper))

    def motion(t: float, y: np.ndarray) -> list[float]:
        here = {**names, "t": t, "x": y[0], "u": y[1]}
        return [y[1], eval(g, here) - eval(f, here)]

    def lower(_t: float, y: np.ndarray) -> float:
        return y[0] - low

    def upper(_t: float, y: np.ndarray) -> float:
        return high - y[0]

    for event in (lower, upper):
        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    start = [low, v] if wall == 0 else [high, -v]
    found = solve_ivp(motion, (tau, tau + 60), start, "DOP853", events=(lower, upper), rtol=1e-12, atol=1e-13)
    times = [event[0] if event.size else np.inf for event in found.t_events]
    which = int(np.argmin(times))
    return which, times[which] - tau, found.y_events[which][0][1]


@pytest.mark.parametrize("name", MODELS)
def test_first_hits_are_those_of_another_integrator(name):
    for seed in range(3):
        osc, rng = model(name, seed), RNG(seed)
        tau, v, wall = rng.uniform(0, 7, 6), rng.uniform(0.05, 3, 6), rng.integers(0, 2, 6)
        hit = osc.first_hit(tau, v, wall=wall)
        for k in np.flatnonzero(hit.status == Status.hit):
            which, time, speed = integrated(osc, int(wall[k]), tau[k], v[k])
            if time > 20:
                continue
            assert hit.wall[k] == which
            assert abs(hit.flight_time[k] - time) < 1e-8 * max(time, 1)
            assert abs(hit.velocity[k] - speed) < 1e-7 * max(abs(speed), 1)


@pytest.mark.parametrize(("omega", "c", "r"), [(2.8, 0.5, 0.8), (1.6, 0.8, 0.7), (4.0, 0.1, 0.6)])
def test_symmetric_orbits_are_those_of_masri_and_caughey(omega, c, r):
    # x'' + x = cos(omega t) between -c and c: half a period of the forcing turns the orbit into its mirror image
    h, A = pi / omega, 1 / (1 - omega**2)
    K = (r - 1) / (r + 1) / tan(h / 2)
    size, lag = A * sqrt(K * K + omega**2), atan2(omega, K)
    osc = si.linear(omega, -c, r).replace(upper=c)
    checked = 0
    for sign in (1, -1):
        theta = lag + sign * np.arccos(-c * K / size)
        v = (c + A * cos(theta)) / tan(h / 2) - A * omega * sin(theta)
        if not v > 0:
            continue
        step = osc.impact_map(theta / omega, v)
        if not np.isclose(step.flight_time, h, rtol=1e-9):  # the orbit passes a wall on the way
            continue
        checked += 1
        assert step.wall == Wall.upper
        assert abs(step.tau - theta / omega - h) < 1e-13
        assert abs(step.v - v) < 1e-13 * max(v, 1)
        back = osc.impact_map(step.tau, step.v, wall=step.wall)
        assert back.wall == Wall.lower
        assert abs(back.v - v) < 1e-12
    assert checked


def test_a_wall_that_is_touched_on_the_way_is_a_graze():
    # x'' = -2 from v = 2 rises to 1 exactly
    ball = si.ImpactOscillator("0", "-2", 0, "1/2", upper=1)
    touch = ball.impact_map("0", "2")
    assert (touch.status, touch.wall, touch.tau, touch.v) == (Status.graze, Wall.upper, 1.0, 0.0)
    assert ball.impact_map("0", "2", digits=20).status == Status.graze
    # the mass is pressed away from the wall that it touches, and goes on
    on = ball.impact_map(1.0, 0.0, wall="upper")
    assert (on.wall, on.tau, on.velocity) == (Wall.lower, 2.0, -2.0)
    assert ball.impact_map(0.0, 2.0 - 1e-9).wall == Wall.lower
    beyond = ball.impact_map(0.0, 2.0 + 1e-9)
    assert beyond.wall == Wall.upper
    assert np.isclose(beyond.velocity, sqrt((2 + 1e-9) ** 2 - 4), rtol=1e-7)


@pytest.mark.parametrize("name", ["linear", "undamped", "Duffing", "parametric"])
def test_digits_and_balls_agree_with_doubles(name):
    osc = model(name, 1)
    tau, v, wall = [0.3, 1.7, "2.5", 4.0], ["0.5", 1.25, 0.01, 3.0], ["l", "u", "u", "l"]
    doubles, digits = osc.impact_map(tau, v, wall=wall), osc.impact_map(tau, v, wall=wall, digits=30)
    assert (digits.status == Status.hit).all()
    assert (digits.wall == doubles.wall).all()
    for k, impact in enumerate(digits.certified):
        assert impact is not None
        for field in ("tau", "v", "flight_time", "velocity"):
            exact = getattr(impact, field)
            assert abs(exact.value - getattr(digits, field)[k]) <= 10 * exact.radius + abs(exact.value) * 1e-29
            assert abs(float(exact.value) - getattr(doubles, field)[k]) < 20 * doubles.error[k] * abs(
                float(exact.value)
            )
        assert (impact.velocity.value > 0) == (digits.wall[k] == Wall.upper)


@pytest.mark.parametrize("name", ["linear", "Duffing"])
def test_derivatives_are_those_of_differences(name):
    osc = model(name, 2, upper_restitution="-0.7*v + v**2/50")
    tau, v = states(40, 3)
    v = np.maximum(v, 0.05)
    wall = np.arange(40) % 2
    D, step, h = osc.derivative(tau, v, wall=wall), osc.impact_map(tau, v, wall=wall), 1e-6
    sides = [(osc.impact_map(tau + s * a, v + s * b, wall=wall)) for a, b in ((h, 0), (0, h)) for s in (1, -1)]
    kept = (step.status == Status.hit) & (step.condition < 50) & (np.abs(step.velocity) > 0.1)
    kept &= np.all([side.wall == step.wall for side in sides], axis=0)
    for column in (0, 1):
        plus, minus = sides[2 * column], sides[2 * column + 1]
        for row, field in enumerate(("tau", "v")):
            slope = (getattr(plus, field) - getattr(minus, field)) / (2 * h)
            assert np.allclose(D.matrix[kept, row, column], slope[kept], rtol=2e-4, atol=2e-4)
    assert kept.sum() > 10
    assert {0, 1} == set((step.wall ^ wall)[kept].tolist())


@pytest.mark.parametrize("name", MODELS)
def test_the_inverse_map_returns_to_the_wall_before(name):
    osc = model(name, 3)
    tau, v = states(60, 5)
    wall = np.arange(60) % 2
    step = osc.impact_map(tau, v, wall=wall)
    good = np.flatnonzero((step.status == Status.hit) & (step.condition < 1e4) & (v > 1e-3) & (step.flight_time < 20))
    back = osc.inverse_map(step.tau[good], step.v[good], wall=step.wall[good])
    assert (back.wall == wall[good]).all()
    assert np.allclose(back.tau, tau[good], atol=1e-8)
    assert np.allclose(back.v, v[good], rtol=1e-6)
    assert good.size > 15


@pytest.mark.parametrize("name", ["linear", "Duffing", "asymmetric"])
def test_orbits_and_iterates_are_those_of_the_impact_map(name):
    osc = model(name, 4)
    for wall in Wall:
        orbit = osc.orbit(0.4, 1.1, 60, wall=wall)
        tau, v, at = 0.4, 1.1, int(wall)
        for k in range(1, 12):
            step = osc.impact_map(tau, v, wall=at)
            tau, v, at = float(step.tau), float(step.v), int(step.wall)
            assert orbit.wall[k] == at
            assert np.isclose(orbit.tau[k], tau, rtol=1e-10)
        ends = osc.iterate([0.4, 0.5], 1.1, 11, wall=wall, keep=True)
        assert (ends.wall[:, 0] == orbit.wall[:12]).all()
        assert np.allclose(ends.v[:, 0], orbit.v[:12], rtol=1e-7)
        times = np.linspace(orbit.tau[0], orbit.tau[-1], 500)
        x = orbit.sample(times).x
        low, high = (float(constant("place", place).value) for place in (osc.clearance, osc.upper))
        assert x.min() >= low
        assert x.max() <= high
        at_walls = orbit.sample(orbit.tau[1:]).x
        assert np.allclose(at_walls, np.where(orbit.wall[1:] == 1, high, low), atol=1e-9)


@pytest.mark.parametrize("law", ["0.7", "-0.6*v - v/(10 + v**2)", "1"])
@pytest.mark.parametrize("name", ["linear", "undamped", "resonant", "free", "unstable"])
def test_many_iterates_abreast_are_those_of_the_impact_map(name, law):
    """Impact by impact: the map flies each wall's states through that wall's own model."""
    compared = 0
    for seed, gap in enumerate((None, 1e-7, 0.3, 1e3)):
        osc = model(name, seed, upper_restitution=law)
        if gap is not None:
            osc = osc.replace(clearance="-0.2", upper=gap - 0.2)
        tau, v = states(200, seed)
        before = None
        for n in range(1, 7):
            ends = osc.iterate(tau, v, n)
            step = osc.impact_map(tau, v) if before is None else osc.impact_map(before.tau, before.v, wall=before.wall)
            flew = np.ones(200, bool) if before is None else before.status == Status.hit
            assert (flew | (ends.status == (ends if before is None else before).status)).all()
            hit = flew & (step.status == Status.hit) & (step.condition < 1e6)
            assert (ends.status[hit] == Status.hit).all()
            assert (ends.wall[hit] == step.wall[hit]).all()
            assert np.allclose(ends.tau[hit], step.tau[hit], rtol=1e-9, atol=1e-11)
            assert np.allclose(ends.v[hit], step.v[hit], rtol=1e-8)
            before, compared = ends, compared + int(hit.sum())
    assert compared > 1200


def test_chatter_ends_and_lifts_off_at_either_wall():
    low = si.ImpactOscillator("x + x**3/3", "8*cos(2*t)", "-0.3", "0.3", upper="0.4")
    seen = set()
    for wall in Wall:
        orbit = low.orbit(0.3, 0.8, 400, wall=wall)
        rests = np.flatnonzero(orbit.kind == "complete")
        for k in rests[:4].tolist():
            seen.add(int(orbit.wall[k]))
            here = low if orbit.wall[k] == 0 else low.mirrored
            assert np.isclose(here.release(float(orbit.tau[k])), orbit.tau[k + 1], rtol=1e-12)
            assert orbit.kind[k + 1] == "release"
            before = k - 1
            end = low.chatter_limit(float(orbit.tau[before]), float(orbit.v[before]), wall=int(orbit.wall[before]))
            assert end.wall == orbit.wall[k]
            assert abs(end.tau - orbit.tau[k]) < 1e-11
    assert seen == {0, 1}


def test_the_upper_wall_is_the_lower_one_of_the_mirrored_model():
    osc = model("asymmetric", 5)
    tau, v = states(200, 8)
    above, below = osc.impact_map(tau, v, wall="upper"), osc.mirrored.impact_map(tau, v)
    assert (above.wall == 1 - below.wall).all()
    assert (above.velocity == -below.velocity).all()
    assert (above.tau == below.tau).all()
    assert osc.mirrored.mirrored == osc


def test_interpreted_flights_between_walls_are_the_compiled_ones():
    for name in ("linear", "Duffing"):
        osc = model(name, 1, upper_restitution="-0.7*v + v**2/50")
        tau, v = states(20, 2)
        hit = osc.first_hit(tau, v)
        compiled = CompiledModel(osc, si_allowance(osc))
        rows, codes = np.empty((10, 20)), np.empty(20, np.int8)
        pushes = np.full(20, np.nan)
        compiled.interpreter.hits((tau, v, pushes) if name == "Duffing" else (tau, v), False, rows, codes)
        plain = np.isin(codes, (0, 70)) & (hit.status == Status.hit)
        assert plain.sum() > 10
        assert ((codes == 70) == (hit.wall == 1))[plain].all()
        assert np.allclose(rows[0, plain], hit.flight_time[plain], rtol=1e-13)
        out = np.zeros((8, 12))
        flown, _code = compiled.interpreter.segment(0.4, 1.1, 0.0, compiled.rho, out)
        orbit = osc.orbit(0.4, 1.1, flown)
        assert np.allclose(out[:flown, 1], orbit.v[1:], rtol=1e-9)
        assert (out[:flown, 11] == orbit.wall[1:]).all()


def si_allowance(osc):
    from singimpact.flights import Allowance, steps_of

    return Allowance(60.0, steps=steps_of(osc))


def test_exponents_keep_the_rate_at_which_areas_shrink():
    osc = si.ImpactOscillator("x + xdot/10", "3*cos(2.8*t)", "-0.5", "0.8", upper="0.5", upper_restitution="0.7")
    found = osc.lyapunov(0.1, 1.0, 2000, wall="upper")
    impacts = osc.orbit(*found.start, 400, wall="lower" if found.impacts else "upper")
    upper = np.mean(impacts.wall[1:] == 1)
    losses = 2 * (upper * np.log(0.7) + (1 - upper) * np.log(0.8)) * found.impacts / found.time
    assert abs(found.exponents.sum() - (losses - 0.1)) < 2e-3


@pytest.mark.parametrize(
    ("walls", "words"),
    [
        ({"upper": "-0.5"}, "above the clearance"),
        ({"upper_restitution": "0.5"}, "upper= too"),
        ({"upper": 1, "upper_restitution": "1.5"}, "upper_restitution = '1.5'"),
        ({"upper": "pi*t"}, "upper"),
    ],
)
def test_walls_that_are_none_are_refused(walls, words):
    with pytest.raises(InputError, match=words.replace("*", r"\*")):
        si.ImpactOscillator("x", "cos(t)", "-0.5", "0.8", **walls)


def test_places_and_walls_that_are_none_are_refused():
    osc = model("linear")
    with pytest.raises(InputError, match="between both walls"):
        osc.launch(100.0, 0.0, 0.0)
    for wall in ("left", {}, 2):
        for ask in (lambda wall=wall: osc.impact_map(0.0, 1.0, wall=wall), lambda wall=wall: osc.one_wall(wall)):
            with pytest.raises(InputError, match="'lower' or 'upper'"):
                ask()
    for places in ((), ("0.5",), ("0.5", "0.8", "0.9")):
        with pytest.raises(InputError, match="upper = "):
            si.linear(2, 0, 1, upper=places)
    assert osc.one_wall("u") == osc.one_wall(1) == osc.one_wall("upper") != osc.one_wall("l")
    with pytest.raises(InputError, match="one wall"):
        si.linear(2, 0, 1).impact_map(0.0, 1.0, wall="upper")


def test_arrays_of_the_caller_take_the_results_of_either_wall():
    osc = model("undamped", 2)
    tau, v = states(300, 4)
    for wall in Wall:
        out = {"flight_time": np.empty(300), "velocity": np.empty(300)}
        hit, plain = osc.first_hit(tau, v, out=out, wall=wall), osc.first_hit(tau, v, wall=wall)
        assert np.array_equal(out["velocity"], plain.velocity, equal_nan=True)
        assert (hit.wall == plain.wall).all()
    with pytest.raises(InputError, match="one wall"):
        osc.first_hit(tau, v, out=out, wall=np.arange(300) % 2)


def test_large_arrays_and_threads_give_the_bits_of_small_ones():
    osc = model("linear", 1)
    tau, v = states(140_000, 6)
    wall = np.arange(140_000) % 2
    whole, part = osc.impact_map(tau, v, wall=wall, threads=2), osc.impact_map(tau[:500], v[:500], wall=wall[:500])
    for field in ("tau", "v", "wall", "status"):
        assert np.array_equal(getattr(whole, field)[:500], getattr(part, field), equal_nan=True)
    assert np.isfinite(whole.error[whole.status == Status.hit]).all()


def test_a_chatter_limit_in_digits_is_that_of_doubles_and_of_more_digits():
    osc, rng, seen = si.linear("2.8", "-0.2", "0.5", upper=("0.25", "0.4")), RNG(1), set()
    for _ in range(30):
        tau, v, wall = float(rng.uniform(0, 2.2)), float(rng.uniform(0, 1.5)), int(rng.integers(2))
        rough = osc.chatter_limit(tau, v, wall=wall)
        if rough.status not in (Status.complete, Status.lifts_off):
            continue
        fine, finer = (osc.chatter_limit(tau, v, wall=wall, digits=digits) for digits in (25, 40))
        assert (fine.status, fine.wall, fine.impacts > 0) == (rough.status, rough.wall, True)
        assert abs(float(fine.tau) - rough.tau) < 4 * rough.error
        assert abs(fine.tau - finer.tau) <= fine.error < 1e-23
        assert finer.error < 1e-38
        seen.add((int(rough.status), int(rough.wall), int(rough.wall) != wall))
    assert len(seen) > 5
