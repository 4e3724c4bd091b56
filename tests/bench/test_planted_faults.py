"""Faults planted where they would sit in the package: the row of the self-test that looks there finds each."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import singimpact as si
from singimpact.bench import (
    derivatives,
    flown,
    grazes,
    lanes,
    limits,
    orbits as orbits_orbits,
    rebounds,
    row as basin_pixels_row,
)
from singimpact.bench.selftest import run
from singimpact.contact import TangencyPoints
from singimpact.dynamics import CHAOS
from singimpact.flights import TIME_BY_V, CompiledModel, allowed, batch_model, scratch_of
from singimpact.flights.compiled_model import compiled_model

LINEAR = si.linear("2.8", "0.1", "0.8")
CHATTERS = si.linear("2", "0.7", "0.5")
PLASTIC = si.models.luck_mehta(G="3.2", restitution=0)
DUFFING = si.ImpactOscillator("x + xdot/10 + 3*x**3/10", "cos(omega*t)", "0.3", "0.6", {"omega": "1.7"})
BETWEEN = si.ImpactOscillator("0.3*xdot", "cos(t)", "-0.2", "0.3", upper="0.2")  # chatters at both walls
BENT = si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.8*v/sqrt(1 + v**2)")
BETWEEN_SEVERAL = si.linear("2.8", "-0.5", "0.8", damping="0.05", amplitude=4, upper="0.5")  # four attractors
ROWS = {
    "orbits": orbits_orbits, "limits": limits, "D G": derivatives, "rebounds": rebounds,
    "batches": lanes, "grazes": grazes, "basins": basin_pixels_row, "tangencies": run.tangency_row,
}  # fmt: skip


@cache
def states(osc):
    return flown(osc, 40, 2)


def plant(monkeypatch, path, wrong):
    """Put `wrong(true)` in the place of the function of a path."""
    room, _, name = path.rpartition(".")
    module = __import__(f"singimpact.{room}", fromlist=[name])
    monkeypatch.setattr(module, name, wrong(getattr(module, name)))


def lift_off(late):
    return "dynamics.orbit.release", lambda true: lambda *given: true(*given) + late


def rest_for_ever():
    return "dynamics.orbit.release", lambda _: lambda *_given: np.inf


def repeats():
    """The cycle from one lift-off to the next, which is repeated and not flown again, lasts too long."""
    return "dynamics.orbit.periods_between", lambda true: lambda *given: (time := true(*given)) and time + 1e-8


def flight_from_rest():
    def wrong(true):
        return lambda *given: replace(true(*given), tau=true(*given).tau + 1e-7)

    return "dynamics.orbit._after_rest", wrong


def rest_of_chatter():
    def wrong(true):
        return lambda *given: (1.001 * true(*given)[0], true(*given)[1])

    return "dynamics.chatter.remaining", wrong


def chatter_that_lifts_off():
    """Each chatter that completes ends as one that lifts off."""

    def wrong(true):
        def limit(*given, **named):
            end = true(*given, **named)
            return replace(end, status=np.where(end.status == si.Status.complete, si.Status.lifts_off, end.status)[()])

        return limit

    return "dynamics.chatter.chatter_limit", wrong


def always_chaotic():
    def wrong(true):
        def classify(*given):
            rows = true(*given)
            rows[:, 0] = CHAOS
            return rows

        return classify

    return "dynamics.basins_of_attraction.classify", wrong


def chatter_too_early():
    """Slow impacts of a mass that lifts off again are taken for a chatter that completes."""
    return "dynamics.settling.chattering", lambda _: lambda study, _tau, v: v < 0.3 * study.fast


def more_periods():
    def wrong(true):
        return lambda *given: (*true(*given)[:2], true(*given)[2] + 1)

    return "dynamics.basins_of_attraction.settled", wrong


def orbits_twice():
    """(n, k) orbits are named (2 n, 2 k)."""

    def wrong(true):
        return lambda *given: tuple(2 * least for least in true(*given))

    return "dynamics.attractors._least", wrong


def sign_in_the_derivative():
    def wrong(true):
        def flights_and_rows(*given):
            hit, rows = true(*given)
            rows = rows.copy()
            rows[TIME_BY_V] *= -1
            return hit, rows

        return flights_and_rows

    return "flights.derivative.flights_and_rows", wrong


def slope_of_rho():
    """D G has the slope of rho at rest at every velocity."""
    return "flights.derivative.rebound_slope", lambda true: lambda osc, velocity: true(osc, 0 * velocity)


def branch_of_rho():
    """Beyond a velocity the law goes on along its tangent at rest."""
    return "flights.impact_map.rebound", lambda true: lambda osc, u: np.where(u < -0.5, -0.8 * u, true(osc, u))


def upper_states_below():
    """States at an upper wall are flown from the lower one, as fast."""
    return "dynamics.settling.signed_iterate", lambda true: lambda osc, tau, v, *more: true(osc, tau, np.abs(v), *more)


def upper_lift_offs_below():
    """The mass lifts off an upper wall where it would lift off the lower one."""
    return "dynamics.basins_of_attraction.lift_offs_of_walls", lambda true: lambda osc: true(osc)[:1] * 2


def lost_point():
    wrong = lambda true: lambda osc: TangencyPoints(true(osc)[1:])  # noqa: E731
    return "bench.selftest.run.tangency_points", wrong


FAULTS = {
    "lift-off late": (lift_off(1e-6), "orbits", CHATTERS),
    "lift-off a little late": (lift_off(1e-9), "orbits", CHATTERS),
    "rest for ever": (rest_for_ever(), "orbits", CHATTERS),
    "repeats too long": (repeats(), "orbits", CHATTERS),
    "flight from rest": (flight_from_rest(), "orbits", CHATTERS),
    "rest of a chatter, in an orbit": (rest_of_chatter(), "orbits", CHATTERS),
    "rest of a chatter": (rest_of_chatter(), "limits", DUFFING),
    "chatter that lifts off": (chatter_that_lifts_off(), "limits", DUFFING),
    "always chaotic": (always_chaotic(), "basins", LINEAR),
    "chatter too early": (chatter_too_early(), "basins", LINEAR),
    "more periods": (more_periods(), "basins", CHATTERS),
    "orbits twice": (orbits_twice(), "basins", LINEAR),
    "lift-off late, without rebound": (lift_off(1e-6), "orbits", PLASTIC),
    "rest for ever, without rebound": (rest_for_ever(), "orbits", PLASTIC),
    "more periods, without rebound": (more_periods(), "basins", PLASTIC),
    "sign in D G": (sign_in_the_derivative(), "D G", CHATTERS),
    "slope of rho": (slope_of_rho(), "D G", BENT),
    "branch of rho": (branch_of_rho(), "rebounds", BENT),
    "lift-off late, between walls": (lift_off(1e-6), "orbits", BETWEEN),
    "rest of a chatter, between walls": (rest_of_chatter(), "limits", BETWEEN),
    "more periods, between walls": (more_periods(), "basins", BETWEEN),
    "upper states below": (upper_states_below(), "basins", BETWEEN_SEVERAL),
    "upper lift-offs below": (upper_lift_offs_below(), "basins", BETWEEN),
    "sign in D G, between walls": (sign_in_the_derivative(), "D G", BETWEEN),
    "lost tangency point": (lost_point(), "tangencies", CHATTERS),
}


@pytest.mark.parametrize("name", FAULTS)
def test_its_row_finds_a_fault(monkeypatch, name):
    (path, wrong), row, osc = FAULTS[name]
    before = states(osc)
    _forgotten()
    plant(monkeypatch, path, wrong)
    faulty = ROWS[row](before._replace(step=osc.impact_map(before.tau, before.v, horizon=before.scales.horizon)))
    monkeypatch.undo()
    _forgotten()
    sound = ROWS[row](before)
    assert faulty.wrong > 0, faulty
    assert faulty.wrong_states
    assert sound.wrong == 0, sound
    assert sound.agree >= 2


def _forgotten():
    """Flights from rest are kept from one orbit to the next."""
    from singimpact.dynamics.orbit import _after_rest

    _after_rest.cache_clear()


def one_lane(true):
    def iterate(*given):
        tau, v, codes, sides = true(*given)
        tau[5::64] += 1e-9
        return tau, v, codes, sides

    return iterate


def missed_grazes(true):
    """An impact at a graze is passed over where the mass goes deeper by a rounding of its path alone."""

    def iterate(self, tau, v, impacts):
        ends = [true(self, tau, v * (1 + part), impacts) for part in (0.0, -1e-5, 1e-5)]
        later = np.argmax([end[0] for end in ends], axis=0)
        return tuple(np.choose(later, [end[row] for end in ends]) for row in range(4))

    return iterate


@pytest.mark.slow
@pytest.mark.parametrize("osc", [pytest.param(LINEAR, id="linear"), pytest.param(DUFFING, id="Duffing")])
def test_a_lane_and_a_missed_graze_are_found(monkeypatch, osc):
    before, true = states(osc), CompiledModel.iterate
    assert lanes(before).wrong == grazes(before).wrong == 0
    monkeypatch.setattr(CompiledModel, "iterate", one_lane(true))
    faulty = lanes(before)
    assert 2 <= faulty.wrong <= 8, faulty
    monkeypatch.setattr(CompiledModel, "iterate", missed_grazes(true))
    assert grazes(before).wrong > 4


@pytest.mark.slow
def test_a_bound_in_the_batch_kernel_is_found(monkeypatch):
    """Compiled batches with a bound of the derivatives that has the wrong sign and is in the wrong units.

    The bound 0 changes no state: a dip within a step has Bernstein coefficients far below 0, and next to an end of a
    step the quintic is exact.
    """
    true, osc = CompiledModel._ready, CHATTERS.replace(clearance="-0.3")

    def ready(self, name, entry):
        entry = true(self, name, entry)
        if name == "batch_entry":
            scratch = self._new_scratch()
            work = scratch_of(scratch, self.sizes)
            self.flat_bound = batch_model(self.flat, scratch, self.sizes, work, 0.0, between=False).table.sixth
            self.flat_bound[...] = -1000 * abs(self.flat_bound)
        return entry

    before = states(osc)
    assert lanes(before).wrong == 0
    monkeypatch.setattr(CompiledModel, "_ready", ready)
    _new_models()
    faulty = lanes(before)
    monkeypatch.undo()
    _new_models()
    assert faulty.wrong > 0, faulty


def _new_models():
    compiled_model.cache_clear()
    allowed.cache_clear()


def drawn_models(seed, count):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        omega, c, r, stiff = rng.uniform(1.2, 4), rng.uniform(-0.4, 0.6), rng.uniform(0.3, 0.9), rng.uniform(0, 0.5)
        yield si.linear(f"{omega:.3f}", f"{c:.3f}", f"{r:.3f}")
        cubic = f"x + xdot/10 + {stiff:.2f}*x**3"
        yield si.ImpactOscillator(cubic, "cos(w*t)", f"{c:.3f}", f"{r:.3f}", {"w": f"{omega:.3f}"})


# without damping and rebound, shallow returns come often: steps of the truth from rest pass over some that balls prove
DAMPED = [osc.replace(restitution=0) for osc in drawn_models(9, 4) if "xdot" in str(osc.f)]


@pytest.mark.slow
@pytest.mark.parametrize("osc", [*drawn_models(8, 4), *DAMPED], ids=str)
def test_nothing_is_wrong_in_drawn_models_and_pixels_are_decided(osc, monkeypatch):
    # a slow machine decides as many pixels as a fast one
    monkeypatch.setattr("singimpact.bench.selftest.rows.process_time", lambda: 0.0)
    before = flown(osc, 40, 3)
    rows = {name: row(before) for name, row in ROWS.items() if name != "batches"}
    assert {name: row.wrong_states for name, row in rows.items() if row.wrong} == {}
    assert rows["basins"].agree >= 14, rows["basins"]


def test_pixels_of_usual_models_are_decided():
    for osc in (CHATTERS, BENT):
        row = basin_pixels_row(states(osc))
        assert (row.agree, row.wrong) == (16, 0), row
