"""Branches and events against what others published: each number has a closed form, or a series derived here.

Not here: the doubling and the fold of the bouncing ball of Luck and Mehta 1993 (`test_branch`, `test_event_curve`).
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from closed_forms import OneImpact

import singimpact as si


def events(branch, kind: str):
    return [event for event in branch.events if event.kind == kind]


# ---- COCO, Recipes for Continuation, 15.2


def test_grazes_of_the_linear_oscillator() -> None:
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.37")
    (graze,) = events(si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.5, -0.3)), "graze")
    curve = si.event_curve(graze, ("amplitude", "omega"), ((-1.1, -0.05), (0.6, 1.4)))
    A, w = curve.parameters.T
    assert (w.min(), w.max()) == pytest.approx((0.6, 1.4))
    assert len(w) > 60
    assert pytest.approx(np.hypot(1 - w * w, 0.1 * w), rel=1e-12) == -A
    assert "closed" not in str(curve.notes)


@pytest.mark.slow
@pytest.mark.parametrize("over", [("clearance", "damping"), ("stiffness", "omega"), ("clearance", "omega")])
def test_the_same_grazes_in_other_pairs_of_numbers(over) -> None:
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.37")
    (graze,) = events(si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.5, -0.3)), "graze")
    at = {"amplitude": graze.parameter, "clearance": -1.0, "damping": 0.1, "stiffness": 1.0, "omega": 0.8}
    between = [(at[name] - 0.09, at[name] + 0.09) for name in over]
    curve = si.event_curve(graze, over, between)
    assert len(curve) > 20
    for values in curve.parameters:
        p = at | dict(zip(over, values, strict=True))
        A = -p["clearance"] * np.hypot(p["stiffness"] - p["omega"] ** 2, p["damping"] * p["omega"])
        assert -p["amplitude"] == pytest.approx(A, rel=1e-12)


# ---- Budd and Dux 1994


@pytest.mark.slow
@pytest.mark.parametrize(
    ("w", "r", "k"),
    [("2.8", "0.8", 1), ("4.3", "0.6", 2)]
    + [pytest.param(*case, marks=pytest.mark.slow) for case in (("2.6", "0.5", 1), ("5.2", "0.7", 3))],
)
def test_response_ellipse_with_its_folds_and_doublings(w: str, r: str, k: int) -> None:
    """x'' + x = cos(w t), over the clearance; both halves of the ellipse, that of v < 0 is virtual."""
    truth = OneImpact(0, r, k)
    w1, w2, E12, trace, _, R = (float(part) for part in truth.parts(mpmath.mpf(w)))
    W, r_ = float(w), float(r)
    osc = si.linear(w, "0.001", r)
    (orbit, *_) = osc.periodic(1, k)
    found = si.branch(orbit, "clearance", (-2, 2))
    assert found.notes == ("closed: the branch comes back to where it began",)
    c, v = found.parameter, found.v[:, 0]
    assert (c - w1 * v) ** 2 + (w2 * v / W) ** 2 == pytest.approx(np.full(len(c), R * R), rel=1e-11)
    # both ends in c, at opposite velocities, with c dc/dv = 0
    at = R * w1 * W / abs(w2) / np.sqrt((w2 / W) ** 2 + w1**2)
    folds = sorted((event.parameter, event.orbit.v[0]) for event in events(found, "fold"))
    high = R * np.sqrt(1 + (w1 * W / w2) ** 2)
    assert np.array(folds) == pytest.approx(np.array([[-high, -at], [high, at]]), rel=1e-11)
    grazes = sorted(event.parameter for event in events(found, "graze"))
    assert grazes == pytest.approx([-R, R], rel=1e-12)
    # 1 + sum + product of the multipliers = 0, with g - c = -w^2 c - (1 - w^2) w1 v, is a line through the middle
    ratio = (1 - r_ * trace + r_ * r_ + r_ * (1 + r_) * E12 * (1 - W * W) * w1) / (-r_ * (1 + r_) * E12 * W * W)
    size = R / np.sqrt((ratio - w1) ** 2 + (w2 / W) ** 2)
    doublings = sorted((event.orbit.v[0], event.parameter) for event in events(found, "period-doubling"))
    assert np.array(doublings) == pytest.approx(np.array([[-size, -ratio * size], [size, ratio * size]]), rel=1e-10)


# ---- Shaw and Holmes 1983


@pytest.mark.parametrize("r", ["0.3", "1"])
def test_areas_shrink_by_the_velocities(r: str) -> None:
    osc = si.linear("2.8", "0.02", r)
    rng = np.random.default_rng(5)
    tau, v = rng.uniform(0, 2 * np.pi / 2.8, 200), rng.uniform(0.05, 1, 200)
    step = osc.impact_map(tau, v)
    matrices = osc.derivative(tau, v).matrix
    det = np.linalg.det(np.moveaxis(matrices, (-2, -1), (-2, -1)))
    good = step.v > 0.02
    assert det[good] == pytest.approx((float(r) ** 2 * v / step.v)[good], rel=1e-10)
    # so the multipliers of any orbit of n impacts have product r^2n, also along branches and through grazes
    for n, k in ((1, 1), (2, 2), (3, 3)):
        for orbit in osc.periodic(n, k)[:1]:
            found = si.branch(orbit, "clearance", (-0.1, 0.1), step=0.1)
            product = np.prod(found.multipliers, axis=1)
            finite = np.isfinite(product) & (np.abs(found.v).min(axis=1) > 1e-3)
            assert product[finite] == pytest.approx(np.full(finite.sum(), float(r) ** (2 * n)), rel=1e-7)


# ---- Nordmark 1991; Chin, Ott, Nusse and Grebogi 1994


DAMPING, FREQUENCY = 2.6, 1.963
GRAZE = float(np.hypot(1 - FREQUENCY**2, DAMPING * FREQUENCY))
LARGER = float(np.exp((-DAMPING + np.sqrt(DAMPING**2 - 4)) / 2 * 2 * np.pi / FREQUENCY))


def beyond_the_graze(share: float) -> si.ImpactOscillator:
    return si.linear(FREQUENCY, -1, "0.8", damping=DAMPING, amplitude=-GRAZE * (1 + share))


def window(k: int, share: float) -> tuple[float, float]:
    """Where the (1, k) orbit is stable and visible, as parts of the amplitude of the graze."""
    (orbit,) = (each for each in beyond_the_graze(share).periodic(1, k) if each.stable)
    found = si.branch(orbit, "amplitude", (-GRAZE * 1.6, -GRAZE * (1 - 1e-9)))
    ends = {event.kind: -event.parameter / GRAZE - 1 for event in found.events if event.orbit.visible}
    assert set(ends) == {"hidden impact", "period-doubling", "graze"}
    assert ends["graze"] == pytest.approx(0, abs=1e-12)
    return ends["period-doubling"], ends["hidden impact"]


@pytest.fixture(scope="module")
def windows() -> dict[int, tuple[float, float]]:
    return {k: window(k, 0.07 * LARGER ** (2 * (k - 2))) for k in range(2, 8)}


@pytest.mark.slow
def test_periods_are_added_towards_a_graze(windows) -> None:
    assert pytest.approx(0.2226, abs=1e-4) == LARGER < 0.25
    for low, high in windows.values():
        assert 0 < low < high
    # each next window begins inside or just below the one before: no room for chaos between
    for k in range(2, 7):
        assert windows[k + 1][1] > windows[k][0]
    widths = np.array([high - low for low, high in windows.values()])
    misses = np.abs(widths[:-1] / widths[1:] * LARGER**2 - 1)
    assert (misses[2:] < 0.01).all()
    # the ratio is reached with errors that shrink by the multiplier too
    assert (misses[1:-1] / misses[2:] > 3).all()
    for edge in np.array(list(windows.values())).T:
        assert edge[-2] / edge[-1] == pytest.approx(LARGER**-2, rel=1e-3)


@pytest.mark.slow
def test_what_is_flown_has_the_periods_of_the_windows(windows) -> None:
    for k, (low, high) in list(windows.items())[:4]:
        osc = beyond_the_graze(np.sqrt(low * high))
        orbit = osc.orbit(0, "0.1", impacts=400)
        last = orbit.tau[orbit.kind == "impact"][-20:]
        assert np.diff(last) == pytest.approx(np.full(19, k * 2 * np.pi / FREQUENCY), rel=1e-6)


# ---- Simpson and Ghosh 2026


@pytest.fixture(scope="module", params=[
    ("0.1", "0.8", 1, 2),
    ("0.2", "0.5", 1, 1),
    *(pytest.param(each, marks=pytest.mark.slow)
      for each in (("0.3", "0.5", 1, 2), ("0.1", "0.6", 2, 4), ("0.1", "0.8", 1, 3))),
])  # fmt: skip
def resonance(request):
    """Curves of folds, grazes and doublings next to a frequency of which k periods are m half turns without forcing."""
    b, r, k, m = request.param
    truth = OneImpact(b, r, k)
    with mpmath.workdps(30):
        at = mpmath.sqrt(1 - mpmath.mpf(b) ** 2 / 4) * 2 * k / m
        graze = truth.grazing(at, -1)
    between = ((-1.05 * float(graze), -0.97 * float(graze)), (0.995 * float(at), 1.005 * float(at)))
    found = {}
    for shift in (-0.001, 0.001):
        osc = si.linear(float(at) * (1 + shift), -1, r, damping=b, amplitude=-0.98 * float(graze))
        (touching,) = si.branch(osc.periodic(0, k)[0], "amplitude", between[0]).events
        for event in si.branch(touching.others()[0], "amplitude", between[0]).events:
            if event.kind in ("fold", "graze", "period-doubling"):
                found.setdefault(event.kind, event)
    return truth, (2 * k, m), {kind: si.event_curve(event, ("amplitude", "omega"), between)
                              for kind, event in found.items()}  # fmt: skip


@pytest.mark.slow
def test_folds_and_doublings_are_those_of_the_closed_form(resonance) -> None:
    truth, _, curves = resonance
    assert {"fold", "graze", "period-doubling"} <= set(curves)
    for kind in ("fold", "period-doubling"):
        for (A, w), v in zip(curves[kind].parameters, curves[kind].v[:, 0], strict=True):
            with mpmath.workdps(30):
                speed = (truth.fold if kind == "fold" else truth.doubling)(mpmath.mpf(float(w)), -1)
                assert v == pytest.approx(float(speed), abs=1e-9)
                assert pytest.approx(float(truth.amplitude(mpmath.mpf(float(w)), -1, speed)), rel=1e-10) == -A


@pytest.mark.slow
def test_folds_and_doublings_leave_the_grazes_quadratically(resonance) -> None:
    """A - A_graze = coefficient (w - w_0)^2 + O(3): a series of the closing conditions against a fit to the curves."""
    truth, (turns, halves), curves = resonance
    for kind, speed in (("fold", truth.fold), ("period-doubling", truth.doubling)):
        with mpmath.workdps(40):
            middle = mpmath.sqrt(1 - mpmath.mpf(truth.b) ** 2 / 4) * turns / halves

            def above(w, speed=speed):
                return truth.amplitude(w, -1, speed(w, -1)) - truth.grazing(w, -1)

            series = [float(part) for part in mpmath.taylor(above, middle, 3)]
            assert series[:2] == pytest.approx([0, 0], abs=1e-15)
        A, w = curves[kind].parameters.T
        d = w - float(middle)
        near = np.abs(d) > 1e-6
        excess = -A - np.hypot(1 - w * w, float(truth.b) * w)
        fit = np.polynomial.Polynomial.fit(d[near], excess[near] / d[near] ** 2, min(8, near.sum() // 3),
                                           w=d[near] ** 2)  # fmt: skip
        assert near.sum() > 12
        assert fit(0) == pytest.approx(series[2], rel=1e-4), kind
