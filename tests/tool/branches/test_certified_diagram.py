"""Certified diagrams beside the list of orbits at single clearances, beside branches, and beside the impact map."""

import numpy as np
import pytest

import singimpact as si
from singimpact.branches import ClearanceCurve
from singimpact.inputs import InputError

WINDOW = {"between": ("-0.2", "0.25"), "v": ("0.05", 1)}


@pytest.fixture(scope="module")
def diagram():
    return si.certified_diagram(si.linear("2.8", 0, "0.8"), **WINDOW)


def crossed(diagram, n, k, c):
    """Velocities, and whether they are stable, of the (n, k) orbits of the arcs over a clearance."""
    rows = []
    for arc in diagram.arcs:
        order = np.argsort(arc.clearance)
        if (arc.n, arc.k) == (n, k) and arc.clearance[order[0]] < c < arc.clearance[order[-1]]:
            v = sorted(float(np.interp(c, arc.clearance[order], arc.v[order, i])) for i in range(n))
            rows.append((*v, arc.stable))
    return sorted(rows)


def listed(osc, n, k, low, high):
    """The same of the visible orbits of a model in a window, which are shown to be all."""
    orbits = osc.periodic(n, k)
    assert orbits.complete
    return sorted(
        (*sorted(orbit.v.tolist()), orbit.stable) for orbit in orbits if low < orbit.v.min() <= orbit.v.max() < high
    )


def same(diagram, model, pairs, clearances, window):
    for c in clearances:
        for n, k in pairs:
            drawn, wanted = crossed(diagram, n, k, c), listed(model(repr(c)), n, k, *window)
            assert len(drawn) == len(wanted), (c, n, k, drawn, wanted)
            assert np.allclose(drawn, wanted, rtol=0, atol=5e-3)


def test_between_the_joints_the_orbits_are_those_of_the_list(diagram):
    assert diagram.complete
    same(
        diagram,
        lambda c: si.linear("2.8", c, "0.8"),
        diagram.orbits,
        (-0.19, -0.105, -0.08, -0.05, 0.05, 0.2),
        (0.05, 1),
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_drawn_models(seed):
    """Damped or not, with constant loads, both signs of the phase, and windows down to a graze."""
    rng = np.random.default_rng(seed)
    omega, k, r, phase = (round(float(rng.uniform(*ends)), 2) for ends in ((1.3, 4), (0.5, 1.5), (0.4, 0.95), (-2, 2)))
    damping, load, low = (round(float(rng.uniform(*ends)), 2) for ends in ((0, 0.4), (-0.5, 0.5), (-0.6, 0.3)))
    f, g = f"{k}*x + {damping * (seed % 2)}*xdot", f"cos({omega}*t + {phase}) + 0.4*sin({omega}*t) + {load}"
    pairs, floor = ((1, 1), (1, 2), (2, 1), (2, 2), (2, 3)), (0.0 if seed < 2 else 0.03)

    def model(c):
        return si.ImpactOscillator(f, g, c, repr(r))

    found = si.certified_diagram(model("0"), pairs, between=(low, low + 0.3), v=(floor, 2))
    open_ends = [end for part in found.open_parts for end in part.between]
    tried = [
        c for c in np.round(rng.uniform(low, low + 0.3, 4), 4).tolist() if all(abs(c - end) > 1e-3 for end in open_ends)
    ]
    assert tried
    same(found, model, pairs, tried, (floor, 2))


def test_joints_are_the_events_of_branches(diagram):
    (orbit,) = [each for each in si.linear("2.8", "0.1", "0.8").periodic(1, 1) if each.stable]
    events = si.branch(orbit, "clearance", (-0.1, 0.2)).events
    (doubling,) = [event for event in events if event.kind == "period-doubling"]
    double = [joint for joint in diagram.joints if joint.kind == "period-doubling"]
    assert abs(float(double[0].clearance.value) - doubling.parameter) < 1e-10
    # the orbit that is born there begins at the same place
    born = [joint for joint in double if joint.n == 2 and abs(joint.v[0].value - joint.v[1].value) < 1e-12]
    assert [abs(float(joint.clearance.value) - doubling.parameter) < 1e-10 for joint in born] == [True]


def test_orbits_end_where_a_flight_touches_the_wall():
    """A (2, 2) orbit whose second impact has no velocity is the (1, 2) orbit that touches the wall."""
    found = si.certified_diagram(si.linear("2.8", 0, "0.8"), [(1, 2), (2, 2)], between=("-0.06", "-0.05"), v=(0, 1))
    (graze,) = [joint for joint in found.joints if joint.kind == "graze"]
    (hidden,) = [joint for joint in found.joints if joint.kind == "hidden impact" and joint.n == 1]
    assert abs(graze.clearance.value - hidden.clearance.value) < 1e-14
    assert min(abs(v.value - hidden.v[0].value) for v in graze.v) < 1e-14


def test_states_of_arcs_close(diagram):
    """Every state leads to the next one, by the impact map; not with another restitution."""
    for arc in diagram.arcs:
        for c, tau, v in list(zip(arc.clearance, arc.tau, arc.v, strict=True))[1:-1:8]:
            for r, closes in (("0.8", True), ("0.79", False)):
                state = tau[0], v[0]
                for _ in range(arc.n):
                    step = si.linear("2.8", repr(float(c)), r).impact_map(*state)
                    state = float(step.tau), float(step.v)
                off = abs(state[1] - v[0]) + abs(state[0] - tau[0] - arc.k * 2 * np.pi / 2.8)
                assert (off < 1e-9) == closes


def test_windows_at_a_graze_leave_parts_open():
    found = si.certified_diagram(si.linear("2.8", 0, "0.8"), [(1, 2)], between=("-0.2", "0.2"), v=(0, 1))
    assert not found.complete
    assert all(part.v[1] < 1e-6 for part in found.open_parts)
    assert [arc.ends[0] is None or arc.ends[1] is None for arc in found.arcs].count(True) == 1


def test_a_wrong_motion_gives_other_joints(monkeypatch, diagram):
    """With the flight of x'' + 1.01 x the doubling is somewhere else: the joints do hang on the motion."""
    true = ClearanceCurve.__init__

    def stiffer(curve, *values):
        true(curve, *values)
        curve.motion = type(curve.motion)(curve.r * 0, curve.stiffness * 101 / 100, curve.rate)

    monkeypatch.setattr(ClearanceCurve, "__init__", stiffer)
    wrong = si.certified_diagram(si.linear("2.8", 0, "0.8"), [(1, 1)], **WINDOW)
    there, here = (next(j for j in each.joints if j.kind == "period-doubling") for each in (wrong, diagram))
    assert abs(there.clearance.value - here.clearance.value) > 1e-3


@pytest.mark.parametrize(
    ("model", "values", "sentence"),
    [
        (si.linear("2.8", 0, "0.8"), {"orbits": [(3, 1)]}, "n = 3 is not accepted: give a whole number from 1 to 2"),
        (si.linear("2.8", 0, "0.8"), {"orbits": [1]}, r"orbits = \[1\] is not accepted: give pairs \(n, k\)"),
        (si.linear("2.8", 0, "0.8"), {"orbits": []}, r"orbits = \[\] is not accepted: give pairs \(n, k\)"),
        (si.linear("2.8", 0, "0.8"), {"orbits": 5}, r"orbits = 5 is not accepted: give pairs \(n, k\)"),
        (si.linear(1, 0, "0.8"), {}, r"orbits = \(1, 1\) is not accepted: the two conditions on one impact depend"),
        (si.linear("2.8", 0, "0.8"), {"between": (1, 0)}, "between = .* give two rational numbers low < high"),
        (si.linear("2.8", 0, "0.8"), {"v": (-1, 1)}, "v = .* give two rational numbers 0 <= low < high"),
        (si.ImpactOscillator("x**3", "cos(t)", 0, 1), {}, "model = .* give a linear model with one harmonic"),
        (si.ImpactOscillator("x", "cos(2*t) + cos(3*t)", 0, 1), {}, "give a linear model with one harmonic"),
        (si.ImpactOscillator("xdot", "cos(2*t)", 0, 1), {}, "give a linear model with one harmonic"),
        (si.ImpactOscillator("x", "cos(2*t)", 0, "-v/(1-v)"), {}, "give a linear model with one harmonic"),
    ],
)
def test_refusals(model, values, sentence):
    with pytest.raises(InputError, match=sentence):
        si.certified_diagram(model, **({"between": (0, 1), "v": (0, 1)} | values))


def test_where_the_motion_gains_energy_no_orbit_attracts():
    """Elastic impacts and negative damping: the multipliers have a product above 1."""
    model = si.linear("2.8", 0, 1, damping="-0.02")
    found = si.certified_diagram(model, [(1, 1)], between=("-0.2", "0.3"), v=("0.05", 2))
    assert found.complete
    assert found.arcs
    assert not any(arc.stable for arc in found.arcs)


def test_elastic_impacts_without_damping_leave_one_impact_undetermined():
    with pytest.raises(InputError, match="do not give v and c: give other pairs"):
        si.certified_diagram(si.linear("2.8", 0, 1), [(1, 1)], **WINDOW)
