"""Bifurcation diagrams over any number of a model, and with the last state carried over."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError


@pytest.mark.parametrize(("over", "value"), [("amplitude", 1.3), ("damping", 0.2), ("stiffness", 1.5), ("phase", 0.4)])
def test_a_number_that_the_model_does_not_name(over, value):
    with ThreadPoolExecutor(1) as pool:
        found = si.bifurcation(si.linear(2, 0, "0.5"), over, (value / 2, value), 2, impacts=60, kept=4, executor=pool)
    told = si.linear(2, 0, "0.5", **{over: value}).orbit(0, "0.1", impacts=60)
    assert found.events[-1, :, 1] == pytest.approx(told.v[-4:], rel=1e-12)


def test_an_orbit_of_one_impact_scales_with_the_amplitude():
    # at clearance 0 a linear model has no length but the amplitude
    found = si.bifurcation(si.linear(4, 0, "0.5"), "amplitude", (1, 2), 3, impacts=80, kept=1, direction="both")
    assert found.values.tolist() == [1, 1.5, 2, 2, 1.5, 1]
    # cos(4 t), one impact in two periods: v = 8/15, see `si.linear(4, 0, "0.5").periodic(1, 2)`
    assert found.events[:, 0, 1] == pytest.approx(8 / 15 * found.values, rel=1e-12)
    assert "up and down" in repr(found)


@pytest.mark.slow
def test_a_motion_without_impact_is_carried_until_it_meets_the_wall():
    osc = si.linear("0.8", -1, "0.8", damping="0.05", amplitude="-0.45")
    found = si.bifurcation(osc, "clearance", ("-1.6", "-1"), 25, start=("0.1", 1), impacts=200, kept=1, direction="up")
    size = 0.45 / np.hypot(1 - 0.64, 0.05 * 0.8)  # the amplitude of the settled motion without a wall
    # the first orbit starts at the wall, and has impacts before it leaves it
    assert np.isnan(found.events[1:, 0, 1]).tolist() == (found.values[1:] < -size).tolist()


def test_each_way_alone_is_its_half_of_both():
    osc = si.linear(2, "0.3", "0.5")
    given = {"impacts": 40, "kept": 3}
    both = si.bifurcation(osc, "omega", ("1.9", "2.1"), 4, direction="both", **given)
    up = si.bifurcation(osc, "omega", ("1.9", "2.1"), 4, direction="up", **given)
    down = si.bifurcation(osc, "omega", ("1.9", "2.1"), 4, direction="down", **given)
    assert up.events.tolist() == both.events[:4].tolist()
    assert down.values.tolist() == both.values[4:].tolist()
    assert down.events[-1] == pytest.approx(both.events[-1], abs=1e-8)  # settled orbits of one attractor


def test_both_ways_are_drawn_and_written(tmp_path):
    found = si.bifurcation(si.linear(2, "0.3", "0.5"), "clearance", (0.2, 0.3), 3, impacts=30, kept=2, direction="both")
    axes = si.plot(found)
    assert axes.get_xlim() == (0.2, 0.3)
    found.to_csv(tmp_path / "both.csv")
    assert len((tmp_path / "both.csv").read_text().splitlines()) == 13


def test_what_cannot_be_used_is_refused_in_a_sentence():
    osc = si.linear(2, "0.3", "0.5")
    with pytest.raises(InputError, match="direction = 'left' is not accepted: give 'up', 'down' or 'both'"):
        si.bifurcation(osc, "clearance", (0, 1), direction="left")
    with pytest.raises(InputError, match="without executor= and output="):
        si.bifurcation(osc, "clearance", (0, 1), direction="up", output="kept.npz")
    with pytest.raises(InputError, match="unknown number of the model 'mass'"):
        si.bifurcation(osc, "mass", (0, 1))


@pytest.mark.parametrize(
    ("omega", "r", "doubling"),
    [("2.805", "0.84", 0.071221561), ("2.314", "0.34", -0.170632980), ("2.22", "0.7", -0.224021839)],
)
def test_events_beside_a_doubling_are_settled_on_the_stable_orbit(omega, r, doubling):
    """The multiplier is -0.9998 at the second value: events that still came nearer by every second one were settled."""
    orbit = next(each for each in si.linear(omega, repr(doubling + 1e-3), r).periodic(1, 1) if each.stable)
    start = float(orbit.tau[0]), float(orbit.v[0])
    ends = doubling - 1e-5, doubling + 1e-5
    found = si.bifurcation(si.linear(omega, 0, r), "clearance", ends, 2, start=start, kept=8)
    spread = np.ptp(found.events[:, :, 1], axis=1)
    assert found.settled[0]
    assert spread[0] > 1e-5
    assert not found.settled[1] or spread[1] < 2e-6


def test_events_of_a_slow_passage_beside_a_fold_are_not_settled():
    """1e-7 beyond the fold of the (1, 1) orbits: (c - K v)^2 + (L v)^2 = gamma^2, see `test_basins`."""
    generator = np.random.default_rng(7)
    for _ in range(8):
        omega, r = round(generator.uniform(2.1, 3.8), 3), round(generator.uniform(0.3, 0.8), 2)
        gamma, sharp, flat = 1 / (1 - omega**2), (1 + r) / (2 * r) / np.tan(np.pi / omega), (1 - r) / (2 * r * omega)
        c = np.sign(sharp) * abs(gamma) * np.hypot(1, sharp / flat) * (1 + 1e-7)
        v = c * sharp / (sharp**2 + flat**2)
        tau = np.arctan2(flat * v / gamma, (c - sharp * v) / gamma) / omega
        found = si.bifurcation(si.linear(str(omega), 0, str(r)), "clearance", (c, c * (1 + 1e-9)), 2, start=(tau, v))
        last = found.events[:, -1]
        beside = (np.abs(last[:, 1] - v) < 1e-2) & (np.ptp(found.events[:, -2:, 1], axis=1) < 1e-6)
        assert not (beside & found.settled).any()


def test_an_orbit_that_ends_in_an_unresolved_flight_is_not_settled():
    model = si.ImpactOscillator("x + sqrt(x**2)", "cos(2*t)", "-0.3", "0.8")
    found = si.bifurcation(model, "restitution", ("0.7", "0.8"), 3)
    ends = [model.replace(restitution=str(r)).orbit(0, "0.1", impacts=200).phases[-1][0] for r in found.values.tolist()]
    assert "unresolved" in ends
    assert [end == "unresolved" for end in ends] == (~found.settled).tolist()


def test_the_impacts_that_are_named_are_those_that_were_flown():
    """With settle=0 a diagram of 200 impacts said "in 0 impacts"."""
    found = si.bifurcation(si.linear("3.3", "0.03", "0.95"), "clearance", ("0.029", "0.031"), 3, settle=0, impacts=150)
    assert not found.settled.any()
    assert "3 without a period seen in at most 150 impacts" in repr(found)


def test_events_have_the_label_of_their_attractor_and_orbits_a_rotation_number():
    """Two orbits attract at c = 0.1: on the way up and on the way down the events are those of different ones."""
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    found = si.bifurcation(osc, "clearance", ("0.1", "0.14"), 9, start=("0.3", "0.4"), kept=12, direction="both")
    names = [run.name for run in found.attractors]
    assert len({(label, name) for label, name in zip(found.labels, names, strict=True)}) == len(set(names))
    assert np.allclose(found.rotation, [run.k / run.n for run in found.attractors])
    assert found.table()["attractor"].tolist() == np.repeat(found.labels, 12).tolist()
    rest = si.bifurcation(si.linear(2, 0, "0.5"), "clearance", ("0.7", "1.5"), 2, kept=4)
    assert np.isnan(rest.rotation).all()


def test_attractors_have_colours_and_names_in_the_picture():
    """A (3, 3) orbit that is met on the way up alone beside a (1, 1) orbit that attracts on both ways."""
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    found = si.bifurcation(osc, "clearance", ("0.12", "0.14"), 8, start=("0.65", "0.5"), kept=6, direction="both")
    dots = {line.get_label(): line for line in si.plot(found).lines if line.get_label().startswith("(")}
    assert list(dots) == ["(1, 1) orbit", "(3, 3) orbit, on the way up"]
    assert len({line.get_color() for line in dots.values()}) == 2
    for label, line in zip(np.argsort(-np.bincount(found.labels)), dots.values(), strict=True):
        assert sorted(line.get_ydata()) == sorted(found.events[found.labels == label, :, 1].ravel())


def test_attractors_met_at_few_values_are_drawn_in_one_colour():
    found = si.bifurcation(si.linear("2.8", 0, "0.8"), "clearance", ("0.02", "0.04"), 24, settle=400, kept=8)
    lines = {line.get_label(): line for line in si.plot(found).lines}
    assert len(set(found.labels)) > 6
    assert lines["other attractors"].get_xdata().size
    drawn = sum(line.get_xdata().size for name, line in lines.items() if not name.startswith(("_", "end")))
    assert drawn == np.count_nonzero(found.events[..., 2] != 1)
