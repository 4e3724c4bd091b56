"""Self-tests of a model: nothing is wrong where nothing is, and every row sees a planted mistake."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import singimpact as si
from singimpact.bench import (
    balls,
    digits,
    fixed_steps,
    flown,
    limits,
    motion as plain_steps_motion,
    orbits as orbits_orbits,
    row as basin_pixels_row,
)
from singimpact.bench.selftest import responses, rows, run
from singimpact.contact import TangencyPoints
from singimpact.dynamics import basins_of_attraction
from singimpact.inputs import InputError

DUFFING = si.ImpactOscillator("x + xdot/10 + 3*x**3/10", "cos(omega*t)", "0.3", "0.6", {"omega": "1.7"})
MODELS = {
    "linear": si.linear("2.8", 0, "0.8"),
    "Duffing": DUFFING,
    "friction": si.ImpactOscillator("x + tanh(50*xdot)/10", "cos(t)", 0, "1/2"),
    "swan": si.universal(-1, "1/2"),
    "elastic, rarely back": si.linear("2.8", "-0.9", 1),
    "rebound by an expression": si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.8*v/sqrt(1 + v**2)"),
    "constant force": si.ImpactOscillator("0", "-2", 0, "1/2"),
    "no rebound": si.linear("2.8", "0.1", 0),
    "no rebound, on a table": si.models.luck_mehta(G="3.8", restitution=0),
    "no rebound, Duffing": DUFFING.replace(clearance="-0.3", restitution=0),
    "between walls": si.linear("2.8", "-0.5", "0.8", damping="0.05", amplitude=4, upper=("0.7", "0.6")),
    "between walls, Duffing": DUFFING.replace(clearance="-0.5", upper="0.3", upper_restitution="0.4"),
    "no graze": si.ImpactOscillator("sqrt(4 + x)", "sin(t)**2/(2 + cos(t))", 0, "1/2"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_nothing_is_wrong(name):
    found = si.selftest(MODELS[name], states=30, seed=1)
    assert found.wrong == 0, str(found)
    assert found.rows[1].agree >= 25, str(found)
    assert all(row.tried == row.agree + row.undecided + row.wrong for row in found.rows)
    assert all(row.tried or row.note for row in found.rows)


def test_the_same_seed_draws_the_same_states():
    one, same, other = (flown(DUFFING, 5, seed).tau.tolist() for seed in (3, 3, 4))
    assert one == same != other


def planted(true):
    """An impact map whose flight times are off by a millionth."""

    def impact_map(*given, **keywords):
        step = true(*given, **keywords)
        return replace(step, flight_time=step.flight_time * (1 + 1e-6), tau=step.tau + 1e-6 * step.flight_time)

    return impact_map


class Shifted(si.ImpactOscillator):
    """A model with a wrong impact map."""

    __slots__ = ()
    impact_map = planted(si.ImpactOscillator.impact_map)


def wrong_model(kind):
    return kind(**DUFFING.to_dict())


@pytest.mark.parametrize("row", [responses.round_trip, fixed_steps, digits, balls])
def test_flights_that_are_off_are_wrong(row):
    found = row(flown(wrong_model(Shifted), 40, 0))
    assert found.wrong > found.agree
    assert found.worst > 1
    assert "osc.impact_map(" in found.wrong_states[0]


class Missed(si.ImpactOscillator):
    """An impact map that misses every hit."""

    __slots__ = ()

    def impact_map(self, *state, **keywords):
        step = super().impact_map(*state, **keywords)
        gone = np.full_like(step.status, si.Status.no_return)
        return replace(step, status=gone, flight_time=np.full(gone.shape, np.inf))


def test_missed_hits_are_wrong():
    states = flown(wrong_model(Missed), 20, 0)
    assert fixed_steps(states).wrong == 20
    assert balls(states).wrong == 20
    assert responses.round_trip(states).note


class Wandering(si.ImpactOscillator):
    """Orbits, chatter limits and acceleration that are not those of the impact map."""

    __slots__ = ()

    def orbit(self, *state, **keywords):
        orbit = super().orbit(*state, **keywords)
        return replace(orbit, v=orbit.v * (1 + 1e-9 * np.arange(orbit.v.size)))

    def chatter_limit(self, tau, v, **keywords):
        limit = super().chatter_limit(tau, v, **keywords)
        return replace(limit, tau=limit.tau + 1e-3 * v)


def test_orbits_and_chatter_that_are_off_are_wrong():
    states = flown(wrong_model(Wandering), 100, 0)
    assert orbits_orbits(states).wrong > 10
    assert limits(states).wrong > 5


@pytest.mark.slow
def test_pixels_of_a_wrong_class_are_wrong(monkeypatch):
    states, true = flown(si.linear(2, "0.3", "0.5"), 3, 0), basins_of_attraction.basins
    assert basin_pixels_row(states).agree == 16

    def planted(*given):
        found = true(*given)
        return replace(found, first_chatter_completes=~found.first_chatter_completes)

    monkeypatch.setattr(basins_of_attraction, "basins", planted)
    assert basin_pixels_row(states).wrong > 0


def test_missing_and_misnamed_tangency_points_are_wrong(monkeypatch):
    states, points = flown(DUFFING, 3, 0), si.tangency_points(DUFFING)
    monkeypatch.setattr(run, "tangency_points", lambda _: TangencyPoints(points[:1]))
    assert run.tangency_row(states).wrong == 1
    swapped = TangencyPoints([replace(points[0], kind="gamma"), points[1]])
    monkeypatch.setattr(run, "tangency_points", lambda _: swapped)
    assert run.tangency_row(states).wrong == 1


def test_slow_rows_end_and_say_so(monkeypatch):
    monkeypatch.setattr(rows, "ROWS", replace(rows.ROWS, seconds=0.0))
    found = si.selftest(DUFFING, states=60)
    assert found.wrong == 0
    assert "CPU time" in found.rows[1].note


@pytest.mark.parametrize("f", ["x**-3/8 + sqrt(x**2 + 1)", "x**(1/3)*exp(-xdot**12)", "tanh(x)/(2 + cos(pi*x))"])
def test_plain_acceleration_is_the_text(f):
    from singimpact.algebra import DOUBLES, evaluate

    osc = si.ImpactOscillator(f, "sin(t)*atan(t)", "0.3", "1/2")
    motion = plain_steps_motion(osc, 1.0)
    true = evaluate(osc.forcing(), {"t": 0.7}, DOUBLES) - evaluate(osc.force(), {"x": 0.9, "xdot": 0.4}, DOUBLES)
    assert motion.acceleration(0.7, 0.9, 0.4, motion.parameters) == pytest.approx(true, rel=1e-14)


@pytest.mark.slow
def test_command(singimpact, tmp_path, monkeypatch):
    model = tmp_path / "model.toml"
    model.write_text(DUFFING.to_toml())
    told = singimpact("selftest", model, "--states", 20)
    assert told.exit_code == 0, told.output
    assert "0 wrong" in told.stdout
    monkeypatch.setattr(si.ImpactOscillator, "impact_map", planted(si.ImpactOscillator.impact_map))
    bad = tmp_path / "bad.json"
    told = singimpact("selftest", "--model", model, "--states", 20, "--json", "-o", bad)
    assert told.exit_code == 1
    data = json.loads(bad.read_text())
    assert data["wrong"] == sum(row["wrong"] for row in data["rows"]) > 0


def test_refused(singimpact):
    told = singimpact("selftest", "one.toml", "--model", "other.toml")
    assert told.exit_code == 2
    assert "name two models" in told.stderr
    with pytest.raises(InputError, match="an ImpactOscillator"):
        si.selftest("x")
    with pytest.raises(InputError, match="states"):
        si.selftest(DUFFING, states=0)


def test_it_shows_itself_in_a_notebook():
    row = rows.Row("a row", 2, 1, 0, 1, 3.0, "", ("osc.impact_map(1, 2)",))
    told = rows.SelfTest("model", (row,), 1.0)._repr_html_()
    assert "<td>a row</td>" in told
    assert "osc.impact_map(1, 2)" in told
