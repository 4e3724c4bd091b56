"""The determinant of D G by Liouville's formula, to full relative accuracy where the entries of D G nearly cancel.

    |det D G| = -rho'(u) (v/|u|) exp(-int_0^T f_v(x, x') dt)

A flight that contracts by e^(-70) leaves two equal columns of D G in doubles; this product knows its determinant.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import evaluate, names_in, substitute
from singimpact.algebra.numbers import as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.flight_path import many_paths
from singimpact.flights.rebound_law import rebound_slope
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class QuadratureSettings:
    """Gauss's rule for the integral of a damping that varies along a flight."""

    # nodes of a piece; on a piece of one unit of time 16 nodes are exact to degree 31
    nodes: int = 16
    # pieces per period of the forcing, or per unit of time without one
    pieces: float = 4.0


SETTINGS = QuadratureSettings()


def log_determinant(osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array) -> Array:
    """ln |det D G| of impacts: flights from (tau, v), v > 0, that hit after `time` with x' = velocity < 0.

    Parameters
    ----------
    osc : the model. tau, v, time, velocity : shape (n,).

    Examples
    --------
    >>> osc = Oscillator("3*xdot", "-2", 0, "1/2")
    >>> from singimpact.flights.impact_map import first_hit
    >>> hit = first_hit(osc, np.zeros(1), np.ones(1))
    >>> log_determinant(osc, np.zeros(1), np.ones(1), hit.flight_time, hit.velocity).round(9).tolist()
    [-2.206788838]
    """
    loss = _integral_of_damping(osc, tau, v, time)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.log(np.abs(rebound_slope(osc, velocity)) * v / np.abs(velocity)) - loss)


def _integral_of_damping(osc: Oscillator, tau: Array, v: Array, time: Array) -> Array:
    """The integral of f_v along each flight."""
    slope = derivative(osc.f, "xdot")
    if not names_in(slope) & {"x", "xdot"}:
        return as_float(substitute(slope, osc.parameters)) * time
    slope = derivative(osc.force(), "xdot")
    nodes, weights = np.polynomial.legendre.leggauss(SETTINGS.nodes)
    unit = 1.0 if osc.period is None else as_float(osc.period)
    counts = np.maximum(1, np.ceil(SETTINGS.pieces * time / unit)).astype(int)
    widths = time / counts
    ticks = [
        ((np.arange(n)[:, None] + (1 + nodes) / 2) * width).ravel() for n, width in zip(counts, widths, strict=True)
    ]
    clearance, integrals = as_float(osc.clearance), []
    for way, width in zip(many_paths(osc, tau, v, ticks), widths, strict=True):
        values = evaluate(slope, {"x": clearance + way[:, 0], "xdot": way[:, 1]}, DOUBLES) + np.zeros(len(way))
        integrals.append(width / 2 * (values.reshape(-1, SETTINGS.nodes) @ weights).sum())
    return np.array(integrals)
