"""Z, H, P of exact and of real models: vertices on the curve, named points, closed pieces, what is visible."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.surface import ImpactSurface

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


@pytest.fixture(scope="module")
def swan():
    return ImpactSurface(si.universal(-1, "0.5"), (-4, 4), (-6, 6))


@pytest.fixture(scope="module")
def linear():
    return ImpactSurface(si.linear(2, "0.3", "0.5"), (0, "2*pi"), (-6, 6))


def test_zero_set_of_the_unfolded_swan_is_its_conic(swan):
    (curve,) = swan.zero_set
    sigma, t = curve.points.T
    assert curve.closed
    assert np.abs(6 * (sigma**2 - 1) + 4 * sigma * t + t**2).max() < 1e-11
    assert curve.marked("tangency").tolist() in ([[1, 0], [-1, 0]], [[-1, 0], [1, 0]])


def test_named_points_of_the_unfolded_swan(swan):
    (outline,) = swan.outline
    assert sorted(outline.marked("cusp").round(12).tolist()) == [[-3, 64], [3, -64]]
    assert np.abs(np.sort(outline.marked("rest")[:, 0]) - [-np.sqrt(3), np.sqrt(3)]).max() < 1e-13
    (horizon,) = swan.horizon
    assert sorted(horizon.marked("cusp").round(12).tolist()) == [[-3, 4], [3, -4]]


def test_visible_horizon_is_the_arc_from_d_to_a_and_its_shadow(swan):
    """On it the next hit is at t_1 = -4 sigma - 2 t_0."""
    (arc,) = swan.discontinuities
    assert arc.points[:, 0].min() > -3.2
    assert len(arc.marked("cusp")) == 1
    (shadow,) = swan.shadow
    (horizon,) = swan.horizon
    by_launch = {round(sigma, 9): t for sigma, t in horizon.points[horizon.visible]}
    missed = [t_1 + 4 * sigma + 2 * by_launch[round(sigma, 9)] for sigma, t_1 in shadow.points]
    assert np.abs(missed).max() < 1e-7


def exact_height(tau, t):
    """x - c at t of x'' + x = cos 2t, c = 3/10, launched at rest, in closed form."""
    c = mpmath.mpf(3) / 10
    amplitude, slope = c + mpmath.cos(2 * tau) / 3, -2 * mpmath.sin(2 * tau) / 3
    return amplitude * mpmath.cos(t) + slope * mpmath.sin(t) - mpmath.cos(2 * (tau + t)) / 3 - c


def test_vertices_are_on_the_true_curve_to_1e_12(linear):
    """One step of Newton in 40 digits moves no vertex by more."""
    worst = 0.0
    with mpmath.workdps(40):
        for curve in linear.zero_set:
            for tau, t in curve.points[np.abs(curve.points[:, 1]) > 1e-3][::7]:
                tau, t = mpmath.mpf(float(tau)), mpmath.mpf(float(t))
                by_tau = mpmath.diff(lambda s, t=t: exact_height(s, t), tau)
                by_t = mpmath.diff(lambda s, tau=tau: exact_height(tau, s), t)
                worst = max(worst, abs(exact_height(tau, t)) / mpmath.hypot(by_tau, by_t))
    assert worst < 1e-12


@pytest.mark.parametrize("model", [si.linear(2, "0.3", "0.5"), DUFFING])
def test_involution_and_images(model):
    surface = ImpactSurface(model, (0, 4), (-4, 4), 1 / 200)
    for zero, horizon, outline in zip(surface.zero_set, surface.horizon, surface.outline, strict=True):
        assert np.abs(horizon.points.sum(axis=1) - zero.points[:, 0]).max() < 1e-14
        assert np.abs(outline.points[:, 0] - zero.points.sum(axis=1)).max() < 1e-14


@pytest.mark.parametrize("model", [si.linear(2, "0.3", "0.5"), DUFFING])
def test_the_map_jumps_across_the_discontinuities(model):
    surface = ImpactSurface(model, (0, 4), (-5, 5), 1 / 200)
    assert surface.discontinuities
    for arc in surface.discontinuities:
        # across the arc, by its normal: the time of the first hit jumps
        inner = arc.points[len(arc) // 2]
        along = arc.points[len(arc) // 2 + 1] - arc.points[len(arc) // 2 - 1]
        normal = np.array([-along[1], along[0]]) / np.hypot(*along) * 1e-6
        sides = [model.first_hit(*(inner + side * normal)).flight_time for side in (-1, 1)]
        assert abs(float(sides[0]) - float(sides[1])) > 0.05


@pytest.mark.parametrize("clearance", ["0.999", "0.99999"])
def test_a_closed_piece_smaller_than_a_cell_is_found(clearance):
    surface = ImpactSurface(si.linear(2, clearance, "0.5"), ("-1.2", "1.2"), (-2, 2))
    closed = [curve for curve in surface.zero_set if curve.closed]
    assert len(closed) == 1
    assert len(closed[0].marked("tangency")) == 2
    assert np.ptp(closed[0].points[:, 0]) < 0.2


def test_nothing_beyond_the_swan():
    assert ImpactSurface(si.linear(2, "1.01", "0.5"), ("-1.2", "1.2"), (-2, 2)).zero_set == []


def test_a_coarse_picture_costs_a_third_of_a_fine_one():
    small, large = (ImpactSurface(si.linear(2, "0.3", "0.5"), (0, 6), (-6, 6), share) for share in (1 / 400, 1 / 2000))
    assert small.zero_set
    assert large.zero_set
    assert small.flights < large.flights
    assert sum(map(len, small.zero_set)) < sum(map(len, large.zero_set))


def test_what_is_not_asked_for_is_not_flown():
    surface = ImpactSurface(si.universal(-1, "0.5"), (-4, 4), (-6, 6))
    assert surface.flights == 0
    assert surface.zero_set
    before = surface.flights
    assert surface.zero_set
    assert surface.flights == before


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: ImpactSurface(3, (0, 1), (0, 1)), "osc = 3"),
        (lambda: ImpactSurface(DUFFING, (1, 0), (0, 1)), "window of tau"),
        (lambda: ImpactSurface(DUFFING, (0, 1), 4), "window of t"),
        (lambda: ImpactSurface(DUFFING, (0, 1), (0, 1), 0.2), "resolution = 0.2"),
    ],
)
def test_refusals(ask, told):
    with pytest.raises(InputError, match=told):
        ask()


def test_only_what_may_be_a_first_hit_is_asked_for():
    from singimpact.flights import counted

    surface = ImpactSurface(si.ImpactOscillator("x", "cos(2*t)", "0.7", "1/2"), (-1.2, 1.0), (-3, 3), 1 / 400)
    lines = surface.lines
    with counted() as count:
        curves = surface.zero_set
        assert count.flights == 0  # nobody has asked what is visible
        assert any(curve.visible.any() for curve in curves)
    ahead = sum(int((line.points[:, 1] > 0).sum()) for line in lines)
    assert 0 < count.flights <= ahead < sum(len(line.points) for line in lines)
    assert all((curve.points[curve.visible][:, 1] > 0).all() for curve in curves)


def test_vertices_out_of_order_or_not_settled_are_seen():
    """A circle in order; two vertices exchanged; one that Newton's steps still moved."""
    from singimpact.surface.tracing import _in_order

    angle = np.linspace(0, 2, 60)
    points = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    still = np.zeros(60)
    assert _in_order(points, still, 2 * points)
    swapped = points.copy()
    swapped[30] = 0.2 * points[30]
    assert not _in_order(swapped, still, 2 * points)
    moved = still.copy()
    moved[7] = 1e-3
    assert not _in_order(points, moved, 2 * points)


def test_a_part_of_a_closed_curve_is_open():
    from singimpact.surface import Curve

    angle = np.linspace(0, 2 * np.pi, 41)
    loop = Curve("loop", np.stack([np.cos(angle), np.sin(angle)], axis=1), ("x", "y"), closed=True,
                 first_hits=np.ones(41, dtype=bool))  # fmt: skip
    chosen = np.arange(41) < 20
    (part,) = loop.parts(chosen)
    assert not part.closed
    assert len(part) == 20
    (whole,) = loop.parts(np.ones(41, dtype=bool))
    assert whole.closed


def test_a_curve_that_is_not_followed_is_no_mistake_of_the_caller(monkeypatch):
    from dataclasses import replace

    from singimpact.surface import tracing

    monkeypatch.setattr(tracing, "SETTINGS", replace(tracing.SETTINGS, halvings=1, deviation=1e-6))
    with pytest.raises(tracing.Untraced, match="choose a coarser resolution") as found:
        list(ImpactSurface(si.universal(-1, "1/2"), (-3, 2), (-1, 5), 1 / 400).lines)
    assert not isinstance(found.value, InputError)
