"""Orbits of two impacts in k periods of a linear model, all of them: isolated by balls.

x - c of a flight is u(tau, t) + v B(t), so the two conditions on velocities,

    r (v_1 B'(t) + u'(tau, t)) + v_2 = 0,   r (v_2 B'(s) + u'(tau + t, s)) + v_1 = 0,     t + s = k P,

give v_1 and v_2, and the two on heights are equations in tau and t alone. They hold at t = 0 and at s = 0 for every
tau. By Rolle's theorem another zero on the way there needs one of the derivative, so a box whose hull with t = 0 has
none holds no orbit; nor does one over which v_1 or v_2 is negative.
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
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.linear_flight import TAU, T, linear_flight
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
