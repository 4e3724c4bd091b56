"""Regions over two numbers: their classes beside orbits, their seams beside curves of events."""

from __future__ import annotations

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError

LINEAR = si.linear("2.8", 0, "0.8")


def class_at(found, row, column):
    run = found.attractors[found.codes[row, column]]
    return run.kind, run.n, run.k


def test_the_seam_of_a_region_is_the_curve_of_doublings_to_a_pixel():
    window = ((3.5, 4.2), (0.28, 0.5))
    found = si.regions(LINEAR, ("omega", "clearance"), window, size=(50, 40))
    orbit = next(each for each in si.linear("3.6", "0.4", "0.8").periodic(1, 1) if each.stable)
    (event,) = (each for each in si.branch(orbit, "omega", (2.8, 4.8)).events if each.kind == "period-doubling")
    omega, clearance = si.event_curve(event, ("omega", "clearance"), window).parameters.T
    order, seen = np.argsort(omega), 0
    for column in range(50):
        own = [class_at(found, row, column) == ("orbit", 1, 1) for row in range(40)]
        if not (0 < sum(own) < 40 and omega.min() < found.x[column] < omega.max()):
            continue
        seam = found.y[own.index(True)]  # (1, 1) orbits lie above the curve
        curve = np.interp(found.x[column], omega[order], clearance[order])
        assert abs(seam - curve) < 1.5 * (found.y[1] - found.y[0])
        seen += 1
    assert seen > 30


def test_seams_are_halved_as_often_as_asked():
    # stable (1, 1) orbits of the ball end at a closed form in G
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.3"})
    end = np.hypot(np.pi * (1 - 0.5) / (1 + 0.5), 2 * (1 + 0.5**2) / (1 + 0.5) ** 2)
    orbit = next(each for each in ball.periodic(1, 1) if each.stable)
    window, start = ((1.25, 1.58), (0.5, 0.500001)), (float(orbit.tau[0]), float(orbit.v[0]))
    found = si.regions(ball, ("G", "restitution"), window, size=(9, 2), start=start, refine=12)
    doubling = found.seams[np.abs(found.seams[:, 0] - end).argmin(), 0]
    assert doubling == pytest.approx(end, abs=5e-4)  # an orbit next to it settles slowly


@pytest.mark.parametrize(
    ("osc", "over", "between"),
    [
        (LINEAR, ("omega", "clearance"), ((1.5, 2.4), (0, 0.3))),
        (si.ImpactOscillator("1", "G*sin(t)", 0, "0.3", {"G": 2}), ("G", "restitution"), ((1.2, 3), (0.2, 0.3))),
        (si.linear(2, "0.3", 0), ("omega", "clearance"), ((1.5, 4), (-0.2, 0.5))),
        (si.linear("2.8", "-0.4", "0.7", upper="0.4"), ("omega", "clearance"), ((2, 3.9), (-0.5, -0.2))),
        (
            si.ImpactOscillator("x + x**3 + 0.1*xdot", "A*cos(w*t)", "0.1", "0.7", {"A": 2, "w": "1.3"}),
            ("w", "clearance"),
            ((0.8, 2), (0, 0.3)),
        ),
    ],
)
def test_classes_are_those_of_a_diagram(osc, over, between):
    found, equal = si.regions(osc, over, between, size=(12, 2)), 0
    for row in (0, 1):
        moved = osc.replace(**{over[1]: float(found.y[row])})
        diagram = si.bifurcation(moved, over[0], between[0], 12)
        for column, run in enumerate(diagram.attractors):
            kind = class_at(found, row, column)
            equal += kind == (run.kind, run.n, run.k) or (kind[0] == run.kind == "chatter" and kind[2] == 0)
    assert equal >= 22


def test_numbers_over_two_numbers():
    window, size = ((2.0, 3.5), (-0.1, 0.3)), (6, 4)
    exponents = si.regions(LINEAR, ("omega", "clearance"), window, of="lyapunov", size=size)
    impacts = si.regions(LINEAR, ("omega", "clearance"), window, of="impacts", size=size)
    classes = si.regions(LINEAR, ("omega", "clearance"), window, size=size)
    for row, column in np.ndindex(4, 6):
        kind, n, k = class_at(classes, row, column)
        if kind == "orbit":
            assert exponents.values[row, column] < 1e-3
            assert impacts.values[row, column] == pytest.approx(n / k, rel=0.02)
    share = si.regions(
        si.ImpactOscillator("1", "G*sin(t)", 0, "0.3", {"G": 2}), ("G", "restitution"), ((1.2, 1.4), (0.2, 0.3)),
        of="rest", size=2,
    )  # fmt: skip
    assert ((share.values > 0.2) & (share.values < 0.9)).all()
    mine = si.regions(LINEAR, ("omega", "clearance"), window, of=lambda osc: float(osc.clearance.value), size=2)
    assert mine.values.shape == (2, 2)
    assert mine.undecided == impacts.undecided == 0


def test_a_second_run_goes_on_and_results_go_to_files(tmp_path):
    ask = {"over": ("omega", "clearance"), "between": ((2, 3), (0, 0.2)), "size": (10, 6)}
    first = si.regions(LINEAR, **ask, output=tmp_path / "regions.npz")
    second = si.regions(LINEAR, **ask, output=tmp_path / "regions.npz")
    assert (first.codes == second.codes).all()
    first.to_npz(tmp_path / "found.npz")
    assert np.load(tmp_path / "found.npz", allow_pickle=False)["omega"].size == 10
    first.to_csv(tmp_path / "found.csv")
    assert (tmp_path / "found.csv").read_text(encoding="utf-8").count("\n") == 62
    axes = si.plot(first)
    assert axes.get_xlabel() == "omega"
    assert axes.images[0].get_array().shape == (6, 10, 3)


def test_an_orbit_whose_velocity_grows_without_bound_is_unresolved():
    osc = si.ImpactOscillator("x", "A*cos(2*t)", 0, "-0.8*v + v**2/20", {"A": 1})  # it gains where v > 4
    found = si.regions(osc, ("A", "clearance"), ((0.5, 1.2), (-0.2, 0.5)), size=3, start=("pi/2", 5))
    assert "unresolved" in {run.kind for run in found.attractors}


def test_an_orbit_that_goes_to_a_graze_ends():
    # at omega = 5 free turns are five periods: the velocity falls by 0.8 a flight, for ever
    found = si.regions(LINEAR, ("omega", "clearance"), ((5, 5.001), (-0.2849, -0.2848)), size=2)
    assert found.codes.shape == (2, 2)


def test_bad_input_is_refused_in_a_sentence():
    window = ((2, 3), (0, 0.2))
    for change, words in (
        ({"over": ("omega", "omega")}, "two different numbers"),
        ({"between": None}, "two intervals"),
        ({"of": "colour"}, "period, lyapunov, rest, impacts"),
        ({"size": 1}, "a whole number from 2"),
        ({"threads": 2}, "executor or output"),
    ):
        with pytest.raises(InputError, match=words):
            si.regions(LINEAR, **{"over": ("omega", "clearance"), "between": window, "size": 3, **change})
    with pytest.raises(InputError, match="one with a period"):
        si.regions(si.ImpactOscillator("x", "-1", 0, 1), ("clearance", "restitution"), window, size=3)
