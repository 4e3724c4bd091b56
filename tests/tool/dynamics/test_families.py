"""Models that differ in numbers, flown together, beside each of them alone; and beside scipy."""

from __future__ import annotations

import json
from time import process_time

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Status

DUFFING = si.ImpactOscillator(
    "x + b*x**3 + d*xdot", "A*cos(w*t)", "0.1", "0.5", {"b": 1, "d": "0.1", "A": 2, "w": "1.3"}
)
LAW = si.ImpactOscillator("x + b*x**3", "A*cos(2*t)", "0.1", "-s*v + v**2/50", {"b": 1, "A": 2, "s": "0.8"})
FAMILIES = {
    "linear": (si.linear("2.8", 0, "0.8"), {"omega": (1, 4), "clearance": (-0.3, 0.3), "restitution": (0.3, 0.95)}),
    "damped": (
        si.linear(2, 0, "0.8"),
        {"damping": (0, 1), "stiffness": (0.1, 4), "amplitude": (1, 2), "phase": (0, 6)},
    ),
    "two walls": (si.linear("2.8", "-0.5", "0.8", upper="0.5"), {"omega": (1, 4), "upper": (0.3, 0.9)}),
    "a ball": (si.ImpactOscillator("1", "G*sin(t)", 0, "1/2", {"G": 2}), {"G": (1.2, 4), "restitution": (0.2, 0.8)}),
    "Duffing": (DUFFING, {"b": (0.2, 4), "d": (0, 0.3), "A": (1, 2), "w": (1, 2)}),
    "a law": (LAW, {"b": (0.2, 4), "A": (1, 2), "s": (0.5, 0.8)}),
}


def drawn(name, count):
    """A family, and states: some at rest, slow, and late."""
    (osc, ends), rng = FAMILIES[name], np.random.default_rng([2, count, *name.encode()])
    many = osc.over(**{number: rng.uniform(*pair, count) for number, pair in ends.items()})
    tau, v = rng.uniform(-3, 9, (3, count)), np.abs(rng.normal(0, 1, (3, count)))
    v[0, :3], v[1, :5], tau[2, 0] = 0, 1e-7, 1e9
    return many, tau, v


@pytest.mark.parametrize("name", FAMILIES)
def test_each_model_flies_as_it_does_alone(name):
    many, tau, v = drawn(name, 15)
    # tables of members are shorter: a long flight of a linear model begins again elsewhere, and its last bit is another
    impacts, off = (20, 0.0) if name in ("Duffing", "a law") else (3, 1e-9)
    step, ends = many.impact_map(tau, v), many.iterate(tau, v, impacts)
    assert step.tau.shape == ends.v.shape == (3, 15)
    for row, index in np.ndindex(3, 15):
        alone = many[index].impact_map(tau[row, index], v[row, index])
        assert step.status[row, index] == alone.status
        for field in ("tau", "v", "flight_time", "velocity", "time_error"):
            value, truth = getattr(step, field)[row, index], getattr(alone, field)
            kappa = 1 + np.nan_to_num(alone.condition + alone.velocity_condition)
            assert value == pytest.approx(truth, rel=1e-15 * kappa, abs=1e-15, nan_ok=True)
        last = many[index].iterate(tau[row, index], v[row, index], impacts)
        assert ends.status[row, index] == last.status
        last_states = (ends.tau[row, index], ends.v[row, index])
        assert last_states == pytest.approx((last.tau, last.v), rel=off, abs=0, nan_ok=True)


@pytest.mark.parametrize("name", ["linear", "Duffing"])
def test_first_hits_are_those_of_scipy(name):
    many, _, _ = drawn(name, 6)
    tau, v = np.random.default_rng(2).uniform(0.3, 1, (2, 6))
    step = many.impact_map(tau, v)
    for index in range(6):
        model = many[index]
        numbers = {key: float(value.value) for key, value in model.parameters.items()}
        wall, w = float(model.clearance.value), numbers.get("omega", numbers.get("w"))

        def push(t, y, n=numbers, w=w):
            return n.get("A", 1.0) * np.cos(w * t) - y[0] - n.get("b", 0.0) * y[0] ** 3 - n.get("d", 0.0) * y[1]

        hit = lambda _, y, wall=wall: y[0] - wall  # noqa: E731
        hit.terminal, hit.direction = True, -1
        flown = solve_ivp(
            lambda t, y, push=push: [y[1], push(t, y)], (tau[index], 60), [wall, v[index]], "DOP853", rtol=1e-12,
            atol=1e-13, events=hit,
        )  # fmt: skip
        assert step.tau[index] == pytest.approx(flown.t_events[0][0], abs=1e-9)


def first_of(orbit, kind):
    """When an orbit has its first event of a kind."""
    return orbit.tau[orbit.kind == kind][:1]


@pytest.mark.parametrize("name", FAMILIES)
def test_orbits_of_members_are_those_alone(name):
    """Their motion up to the fifth event, chatter and lift-offs; a family sums up more of a chatter than one orbit."""
    many, tau, v = drawn(name, 15)
    tau[2, 0] = 1.0  # of a late state an orbit is known to fewer digits
    orbits = many.orbit(tau, v, 40)
    assert orbits.tau.shape == orbits.kind.shape
    for place in np.ndindex(3, 15):
        one, alone = orbits[place], many[place[1]].orbit(tau[place], v[place], 40)
        last = min(len(one.tau), len(alone.tau), 5) - 1
        assert one.tau[:last] == pytest.approx(alone.tau[:last], abs=1e-7)
        t = np.linspace(alone.tau[0], min(one.tau[last], alone.tau[last]), 50)[1:-1]
        if last and t[-1] > t[0]:
            # next to an impact x' is that before or after it
            assert one.sample(t).x == pytest.approx(alone.sample(t).x, abs=1e-6)
        for kind in ("complete", "release"):
            if {kind} <= {*one.kind[:20]} & {*alone.kind[:20]}:
                assert first_of(one, kind) == pytest.approx(first_of(alone, kind), abs=1e-6)
        assert np.count_nonzero(np.isin(one.kind, ("impact", "graze", "complete"))) <= 40
        assert [phase[1:] for phase in one.phases[: last - 1]] == list(zip(one.tau, one.tau[1:], strict=False))[
            : last - 1
        ]


def test_orbits_of_members_through_rest(tmp_path):
    """A ball on a table that is shaken: it rests, is released, and comes again; a weak table keeps it for ever."""
    ball = si.ImpactOscillator("1", "G*sin(t)", 0, "1/2", {"G": 2})
    orbits = ball.over(G=[0.9, 1.2, 1.9]).orbit(1.0, 0.5, 60)
    assert orbits.status.tolist() == [Status.sticks, 0, 0]
    assert orbits[0].phases[-1][0] == "sticking"
    assert orbits[0].sample(1e4).x == 0
    assert "at rest from there on" in repr(orbits[0])
    for index, G in enumerate((1.2, 1.9), start=1):
        releases = orbits[index].tau[orbits[index].kind == "release"]
        assert np.sin(releases) == pytest.approx(np.full(releases.size, 1 / G), abs=1e-12)
        assert (np.cos(releases) > 0).all()
        assert releases.size > 1
        alone = ball.replace(G=G).orbit(1.0, 0.5, 60)
        t = np.linspace(1, 15, 400)
        assert orbits[index].sample(t).x == pytest.approx(alone.sample(t).x, abs=1e-9)
    with pytest.raises(InputError, match="one place in"):
        orbits[:2]
    one = ball.over(G=1.9).orbit(1.0, 0.5, 60)  # a family of one
    assert one.tau.shape == (61 + np.count_nonzero(one.kind == "release"),)
    assert ball.over(G=1.9).impact_map(1.0, 0.5).tau == ball.replace(G="1.9").impact_map(1.0, 0.5).tau
    assert one[()].tau.tolist() == orbits[2].tau.tolist()
    assert ball.over(G=[]).orbit(1.0, 0.5).tau.shape == (0, 1)
    orbits.to_csv(tmp_path / "orbits.csv")
    heading, names, *rows = (tmp_path / "orbits.csv").read_text().splitlines()
    assert si.ImpactOscillator(**json.loads(heading[2:])) == ball.replace(G=0.9)
    assert names.split(",") == list(orbits.table()) == ["G", "member", "tau", "v", "kind", "status"]
    assert len(rows) == orbits.tau.size
    assert orbits.to_frame().G.unique().tolist() == [0.9, 1.2, 1.9]


def test_a_wrong_number_of_one_member_is_seen():
    many = si.linear("2.8", 0, "0.8").over(omega=[2.0, 3.0])
    other = si.linear("2.8", 0, "0.8").over(omega=[2.0, 3.0 + 1e-9])
    assert many.impact_map(0.1, 0.5).tau[0] == other.impact_map(0.1, 0.5).tau[0]
    assert many.impact_map(0.1, 0.5).tau[1] != other.impact_map(0.1, 0.5).tau[1]


def test_exponents_of_a_family_are_those_of_its_orbits():
    many = si.linear(4, 0, "0.5").over(omega=[3.9, 4.0, 4.1], restitution=[[0.4], [0.5]])
    found = many.osc.over(**many.numbers)
    exponents = si.lyapunov(found, 0.1, 0.5, 2000)
    assert exponents.exponents.shape == (2, 3, 2)
    for index in np.ndindex(2, 3):
        orbit, omega = many[index].periodic(1, 2)[0], float(many.numbers["omega"][index])
        truth = np.sort(np.log(np.abs(orbit.multipliers)))[::-1] / (4 * np.pi / omega)
        assert exponents.exponents[index] == pytest.approx(truth, abs=2e-3)


def test_no_members_and_no_states_have_empty_results():
    for osc, tau in ((si.linear("2.8", 0, "0.8").over(omega=[]), 0.1), (DUFFING.over(b=[1, 2]), np.zeros((0, 1)))):
        empty = np.broadcast_shapes(osc.shape, np.shape(tau))
        assert osc.impact_map(tau, 0.5).tau.shape == osc.iterate(tau, 0.5, 3).v.shape == empty
        found = si.ensemble(osc, tau, 0.5, until=9)
        assert found.tau.shape == si.lyapunov(osc, tau, 0.5, 100).impacts.shape == empty
        assert found.survival.share.tolist() == [1.0]
        with pytest.raises(InputError, match="where orbits go on"):
            found.escape_rate()


def test_what_a_family_is_and_what_it_refuses():
    osc = si.linear("2.8", 0, "0.8")
    many = osc.over(omega=[2, 3, 4], clearance=[[0], [0.1]])
    assert (many.shape, many.size, len(many)) == ((2, 3), 6, 2)
    assert many[1, 2] == osc.replace(omega=4, clearance=0.1)
    assert many[1].shape == (3,)
    assert len(list(many)) == 6
    assert "6 models" in repr(many)
    for numbers, words in (
        ({"omega": [2, np.nan]}, "finite numbers only"),
        ({"omega": [2, 3], "clearance": [1, 2, 3]}, "give arrays that broadcast"),
        ({"restitution": [0.5, 1.5]}, "numbers above 0, at most 1"),
        ({"mass": [1, 2]}, "unknown number of the model"),
        ({}, "names no number of the model"),
    ):
        with pytest.raises(InputError, match=words):
            osc.over(**numbers)
    with pytest.raises(InputError, match="numbers above the clearance"):
        si.linear(2, 0, "0.5", upper=1).over(upper=[0.5, -0.5])
    with pytest.raises(InputError, match="do not broadcast"):
        many.impact_map([0.1, 0.2], 0.5)
    with pytest.raises(InputError, match="at which the model has a period"):
        osc.over(omega=[2, 0]).impact_map(0.1, 0.5)
    assert (many.impact_map(0.1, 0.5).status == Status.hit).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["linear", "Duffing"])
def test_orbits_of_a_family_cost_those_of_one_model(name):
    """At most 1.5 times as much an impact, in turn, for a busy machine changes its speed."""
    osc, ends = FAMILIES[name]
    number, pair = next(iter(ends.items()))
    many, ratios = osc.over(**{number: np.linspace(*pair, 500)}), []
    many.orbit(0.3, 0.7, 5)
    for _ in range(5):
        times = [process_time()]
        for call in (lambda: many.orbit(0.3, 0.7, 200), lambda: [osc.orbit(0.3, 0.7, 200) for _ in range(100)]):
            call()
            times.append(process_time())
        ratios.append((times[1] - times[0]) / 5 / (times[2] - times[1]))
    assert np.median(ratios) < 1.5
