"""Singular points listed with their germs: exact ones of the universal model, and what a swan does to the names."""

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.surface import classify


@pytest.mark.parametrize("kappa", [-1, 1])
def test_universal_model(kappa):
    found = classify(si.universal(kappa, "0.5"))
    kinds = ("gamma", "foliation") if kappa < 0 else ("foliation", "gamma")
    told = [(p.name, p.maps, p.kind, round(p.tau, 12), round(p.t, 12)) for p in found.points]
    assert told == [
        ("cusp", "p", "", -3, 4),
        ("tangency", "p, phi", kinds[0], -1, 0),
        ("cusp", "phi", "", -1, 4),
        ("cusp", "phi", "", 1, -4),
        ("tangency", "p, phi", kinds[1], 1, 0),
        ("cusp", "p", "", 3, -4),
    ]
    assert np.abs(np.array(found.points[0].image) - (-3, -64 * kappa)).max() < 1e-11
    assert len(found.folds) == 4
    assert {line.bounds for line in found.folds} == {("cusp", "cusp")}
    assert (found.swans, len(found.notes)) == ((), 1)  # f is free of x: said, not left out


def test_cusps_of_p_and_phi_correspond():
    found = classify(si.linear(2, "0.3", "0.5"))
    sides = {maps: {p.image for p in found.points if p.maps == maps} for maps in ("p", "phi")}
    assert len(sides["p"]) == 2
    assert sides["p"] == sides["phi"]
    assert [(s.kind, s.clearance) for s in found.swans] == [("negative", 1.0), ("positive", -1.0)]


def test_points_above_a_swan_are_swallowtails():
    duffing = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(w*t)", 0, "0.6", parameters={"w": "1.7"})
    model = classify(duffing).swans[0].oscillator("0.6")
    found = classify(model, ("-0.5", "0.5"), (-6, 6))
    names = {(p.name, p.maps) for p in found.points}
    assert ("swan", "p, phi") in names
    assert all(p.name == "swallowtail" for p in found.points if p.t)


@pytest.mark.parametrize(
    ("shift", "count"), [("", 1), (" + 1e-4", 0), pytest.param(" - 1e-4", 0, marks=pytest.mark.slow)]
)
def test_where_the_surface_itself_is_singular(shift, count):
    """x'' + x = cos wt at c = A cos(w pi/2), A = 1/(1 - w^2): rest at tau = -pi/2 leads to rest after pi, dx/dv = 0."""
    level = "cos(1.1*pi)/(1 - 2.2**2)"
    found = classify(si.linear("2.2", level + shift, "0.5"), (-2, "1.2"), ("0.5", 6))
    singular = [(point.tau, point.t) for point in found.points if point.name == "singular"]
    assert len(singular) == count
    assert len([note for note in found.notes if "V_c' is singular" in note]) == count
    assert all(np.abs(np.array(place) - (-np.pi / 2, np.pi)).max() < 1e-7 for place in singular)


def test_nothing_there():
    found = classify(si.linear(2, "1.5", "0.5"), (0, 1), ("-0.5", "0.5"))
    assert (found.points, found.folds) == ((), ())


@pytest.mark.parametrize("tau", [(1, 0), (0,), ("a", 1)])
def test_windows_that_are_none(tau):
    with pytest.raises(InputError, match="tau"):
        classify(si.linear(2, "0.3", "0.5"), tau)


def test_what_is_no_model():
    with pytest.raises(InputError, match="model = 3"):
        classify(3)
