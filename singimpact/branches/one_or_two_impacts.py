"""Orbits of one impact and of two impacts in k periods of a linear model, all of them.

Two impacts, isolated by balls: x - c of a flight is u(tau, t) + v B(t), so the two conditions on velocities,

    r (v_1 B'(t) + u'(tau, t)) + v_2 = 0,   r (v_2 B'(s) + u'(tau + t, s)) + v_1 = 0,     t + s = k P,

give v_1 and v_2, and the two on heights are equations in tau and t alone. They hold at t = 0 and at s = 0 for every
tau. By Rolle's theorem another zero on the way there needs one of the derivative, so a box whose hull with t = 0 has
none holds no orbit; nor does one over which v_1 or v_2 is negative.

One impact, in closed form: with T = k P fixed, x(T) - c and x'(T) are linear in v and in the cosines and sines of the
launch phase,

    v B + L_1(tau) = 0,   v (B' + 1/r) + L_2(tau) = 0,      so L_2 B - L_1 (B' + 1/r) = 0,

a trigonometric polynomial in tau, whose roots are eigenvalues.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, Power, add, evaluate, multiply, number, substitute, subtract
from singimpact.algebra.isolated_zeros import SETTINGS as BOXES
from singimpact.algebra.isolated_zeros import IsolatedZeros, isolated_zeros
from singimpact.algebra.numbers import as_float
from singimpact.algebra.precision import balls_at
from singimpact.flights.family import LinearFamily, family
from singimpact.flights.model_numbers import linear_waves
from singimpact.oscillator.linear import TAU, T, linear_flight, linear_form
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]
SEARCH = replace(BOXES, bits=64, least=Fraction(1, 2**18))
EDGE = Fraction(1, 16)
"""Of the window of tau beyond each end of a period: no zero is on an edge."""


class TwoFlights(NamedTuple):
    """x - c at the ends of both flights and the velocities after the impacts, as formulas in tau and t; k P."""

    heights: tuple[Expression, Expression]
    speeds: tuple[Expression, Expression]
    span: Expression


def two_impacts(osc: Oscillator, k: int) -> tuple[list[Array], IsolatedZeros] | None:
    """All solutions as points (tau_1, tau_2, v_1, v_2), and the boxes that are left; None without the formulas.

    Parameters
    ----------
    osc : a linear model with a period and a number for restitution.

    Examples
    --------
    >>> found, boxes = two_impacts(Oscillator("x", "-cos(2.8*t)", "1/10", "4/5"), 2)
    >>> len(found), boxes.complete
    (5, True)
    """
    flights = _formulas(osc, k)
    if flights is None:
        return None
    assert osc.period is not None
    period = as_float(osc.period)
    with balls_at(SEARCH.bits):
        end = evaluate(flights.span, {}, Balls(SEARCH.bits))
        window = (-Fraction(period) * EDGE, Fraction(period) * (1 + EDGE)), (Fraction(0), Fraction(k * period))
        excluded = _Excluded(flights, end)
        zeros = isolated_zeros(flights.heights, ("tau", "t"), window, excluded=excluded, settings=SEARCH)
        points = []
        for tau, t in zeros.found:
            v, after = excluded.speeds({"tau": tau, "t": t})
            points.append(np.array([float(number.mid()) for number in (tau, tau + t, v, after)]))
    return points, zeros


def _formulas(osc: Oscillator, k: int) -> TwoFlights | None:
    form = linear_form(osc)
    assert form is not None
    assert osc.period is not None
    flight = linear_flight(form, osc.clearance)
    if flight is None:
        return None
    r, span = osc.restitution, multiply(number(k), osc.period)
    later = {"tau": add(TAU, T), "t": subtract(span, T)}
    u, B = (
        (flight.from_rest, substitute(flight.from_rest, later)),
        (flight.by_speed, substitute(flight.by_speed, later)),
    )
    slope, rate = derivative(flight.from_rest, "t"), derivative(flight.by_speed, "t")
    du, dB = (slope, substitute(slope, later)), (rate, substitute(rate, later))
    # Cramer's rule for v_1 and v_2; 1 - r^2 B' B' is the determinant
    shared = Power(subtract(number(1), multiply(r, r, *dB)), number(-1))
    speeds = tuple(multiply(shared, subtract(multiply(r, r, dB[1 - i], du[i]), multiply(r, du[1 - i]))) for i in (0, 1))
    heights = tuple(add(u[i], multiply(speeds[i], B[i])) for i in (0, 1))
    return TwoFlights((heights[0], heights[1]), (speeds[0], speeds[1]), span)


class _Excluded:
    """Whether a box of (tau, t) is proved to hold no orbit."""

    def __init__(self, flights: TwoFlights, end: Any) -> None:
        recorder = Recorder()
        slopes = [derivative(height, "t") for height in flights.heights]
        self.speeds = recorder.program([recorder.record(tree) for tree in flights.speeds]).prepared({})
        self.slopes = recorder.program([recorder.record(tree) for tree in slopes]).prepared({})
        self.end = end

    def __call__(self, place: tuple[Any, ...]) -> bool:
        tau, t = place
        if any(speed < 0 for speed in self.speeds({"tau": tau, "t": t})):
            return True
        sides = ((0, 0), (1, self.end))  # which height vanishes there for every tau
        near = [(which, edge) for which, edge in sides if abs(t - edge).upper() < abs(self.end) / 8]
        return any(not self.slopes({"tau": tau, "t": t.union(edge)})[which].contains(0) for which, edge in near)


# ---- one impact, in closed form


def phases_and_speeds(osc: Oscillator, k: int) -> tuple[Array, Array] | None:
    """Phases in [0, period) and velocities of all solutions, virtual ones too; None where there is a continuum.

    Parameters
    ----------
    osc : a linear model with a period and a number for restitution.

    Examples
    --------
    >>> tau, v = phases_and_speeds(Oscillator("x", "cos(4*t)", 0, "0.5"), 2)
    >>> [round(float(each), 12) for each in v]
    [-0.533333333333, 0.533333333333]
    """
    flights = family(osc)
    assert isinstance(flights, LinearFamily)
    assert osc.period is not None
    period, r = as_float(osc.period), as_float(osc.restitution)
    time = k * period
    flow = flights.flow({}, time)[:2]
    by_v = np.array([flow[0, 1], flow[1, 1] + 1 / r])
    waves = linear_waves(osc)
    degrees = [round(abs(as_float(wave.rate)) * period / (2 * np.pi)) for wave in waves]
    size = max(degrees, default=0)
    # the coefficients of e^{i m omega tau}, m = -size ... size, of L_1 and L_2
    series = np.zeros((2, 2 * size + 1), dtype=complex)
    series[:, size] = flow[:, 2]
    for j, (wave, degree) in enumerate(zip(waves, degrees, strict=True)):
        sign = 1 if as_float(wave.rate) > 0 else -1
        turned = (flow[:, 3 + 2 * j] - 1j * flow[:, 4 + 2 * j]) / 2 * np.exp(1j * as_float(wave.phase))
        series[:, size + sign * degree] += turned
        series[:, size - sign * degree] += np.conj(turned)
    total = series[1] * by_v[0] - series[0] * by_v[1]
    scale = np.abs(series).max() * np.abs(by_v).max()
    if np.abs(total).max() <= 1e-13 * scale:
        return None
    angles = _refined(_near(total), total, size)
    tau = np.mod(angles, 2 * np.pi) * period / (2 * np.pi)
    powers = np.exp(1j * np.outer(angles, np.arange(-size, size + 1)))
    parts = (powers @ series.T).real
    row = int(np.argmax(np.abs(by_v)))
    return tau, -parts[:, row] / by_v[row]


def _near(total: Array) -> Array:
    """Real roots of a real trigonometric polynomial and near them, from its coefficients of e^{i m angle}."""
    if len(total) == 3:  # a + b cos(angle + shift)
        share = -total[1].real / (2 * abs(total[2])) if total[2] else np.inf
        if abs(share) > 1 + 1e-9:
            return np.zeros(0)
        turn = np.arccos(np.clip(share, -1, 1))
        return np.asarray(np.array([turn, -turn]) - np.angle(total[2]))
    roots = np.roots(np.trim_zeros(np.where(np.abs(total) < 1e-15 * np.abs(total).max(), 0, total))[::-1])
    return np.asarray(np.angle(roots[np.abs(np.abs(roots) - 1) < 1e-6]))


def _refined(angles: Array, total: Array, size: int) -> Array:
    """Real roots of a real trigonometric polynomial near these angles, each once; the others were none."""
    orders = 1j * np.arange(-size, size + 1)
    at = angles.copy()
    with np.errstate(all="ignore"):
        for _ in range(50):
            waves = np.exp(np.outer(at, orders))
            step = (waves @ total).real / (waves @ (orders * total)).real
            at = at - np.clip(step, -0.1, 0.1)
            if not (np.abs(step) > 1e-15).any():
                break
    waves = np.exp(np.outer(at, orders))
    good = np.abs((waves @ total).real) <= 1e-13 * np.abs(total).sum()
    roots: list[float] = []
    for angle in np.sort(np.mod(at[good], 2 * np.pi)).tolist():
        if all(min(abs(angle - other), 2 * np.pi - abs(angle - other)) > 1e-9 for other in roots):
            roots.append(angle)
    return np.array(roots)
