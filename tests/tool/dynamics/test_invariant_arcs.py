"""gamma and stable manifolds beyond their series: carried into themselves by the map, torn only where flights graze."""

import itertools

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import before, grown_gamma, held, model_step, stable_manifold
from singimpact.surface import Window

SWAN = si.universal(-1, "0.5")
DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


def distance(points, curves):
    """Of each point from the polylines, relative to their frame."""
    best = np.full(len(points), np.inf)
    for curve in curves:
        a, b = curve.points[:-1], curve.points[1:]
        along = b - a
        share = ((points[:, None] - a) * along).sum(axis=2) / np.maximum((along**2).sum(axis=1), 1e-300)
        foot = a + np.clip(share, 0, 1)[..., None] * along
        best = np.minimum(best, np.hypot(*(points[:, None] - foot).transpose(2, 0, 1)).min(axis=1))
    return best


@pytest.mark.parametrize(
    ("model", "frame", "tau"),
    [(si.linear(2, "0.3", "0.5"), Window((0.3, 4), (0, 1.0)), None), (DUFFING, Window((0.5, 5), (0, 1.5)), None),
     (si.universal(1, "0.5"), Window((-2, 1.2), (0, 25)), 1)],
)  # fmt: skip
def test_gamma_is_carried_into_itself(model, frame, tau):
    (curve, *_) = grown_gamma(model, frame, tau)
    inner = curve.points[curve.points[:, 1] > 1e-3 * frame.y[1]][::5]
    assert len(inner) > 10
    assert distance(model_step(model, inner), [curve]).max() < 2e-3 * frame.y[1]
    off = inner + np.array([0, 0.02 * frame.y[1]])  # beside the curve the map leads away from it
    assert np.nanmax(distance(model_step(model, off), [curve])) > 2e-3 * frame.y[1]


def test_gamma_of_the_unfolded_positive_swan_meets_the_axis_again():
    (curve, *_) = grown_gamma(si.universal(1, "0.5"), Window((-2, 1.2), (0, 25)), 1)
    assert abs(curve.points[-1, 0] + 1.3851) < 1e-4
    slope = np.diff(curve.points[-3:], axis=0)
    assert abs(slope[0, 1] / slope[0, 0] - 12 * (1.3851**2 - 1)) < 0.2


def test_stable_manifolds_of_the_negative_swan_are_torn_to_the_right_of_a():
    """Between B and X each W^s has pieces of several hit histories; beyond X none is torn locally."""
    frame = Window((-6, 9), (0, 120))
    assert len(stable_manifold(SWAN, frame, "3.2")) > 3
    torn = stable_manifold(SWAN, frame, "3.2")
    for first, second in itertools.pairwise(torn):
        assert first.name != second.name or not np.allclose(first.points[-1], second.points[0])
    for curve in torn:
        inner = curve.points[curve.points[:, 1] > 1][::6]
        image = model_step(SWAN, inner)
        inside = held(frame, image)
        assert distance(image[inside], torn).max(initial=0) < 0.3


def test_before_undoes_the_map():
    points = np.array([[0.5, 0.3], [1.0, 0.1], [2.0, 0.4]])
    for model in (si.linear(2, "0.3", "0.5"), si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.5*v + 0.1*v**2")):
        assert np.abs(before(model, model_step(model, points)) - points).max() < 1e-10


@pytest.mark.parametrize("tau", [None, 0, 0.0])
def test_gamma_of_a_swan_is_found_by_its_exact_time(tau):
    """a_c vanishes at a swan as at a tangency: a_c' tells them apart, however tau is given."""
    (curve, *_) = grown_gamma(si.linear(2, 1, "0.5"), Window((-1.3, 3), (0, 2)), tau)
    assert np.isfinite(curve.points).all()
    assert np.array_equal(curve.points[0], [0, 0])


@pytest.mark.parametrize(("clearance", "tau", "told"), [("0.3", 1, "does not vanish"), (-1, "pi/2", "positive one")])
def test_no_gamma_at_a_regular_point_or_a_positive_swan(clearance, tau, told):
    with pytest.raises(si.InputError, match=told):
        grown_gamma(si.linear(2, clearance, "0.5"), Window((-1.3, 3), (0, 2)), tau)
