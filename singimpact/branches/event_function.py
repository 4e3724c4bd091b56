"""The function that vanishes at an event of the return map, and its rate along a curve of orbits, over boxes.

With M the derivative of the return map, the product of the D G of all flights, t its trace and d its determinant, a
kind of event (`events`) gives what vanishes, 1 - t + d at a fold, and its rate. The curve has the tangent u with
D F u = 0, the held component 1. Along it D G changes by D^2 G u.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from singimpact.branches.ball_closing import BallClosing
from singimpact.branches.events.table import kind_of
from singimpact.branches.krawczyk import Krawczyk, Point


def event_function(kind: str, total: Any) -> Any:
    """The function of the derivative of the return map that vanishes at the event."""
    return kind_of(kind).of_return_map(total)


def rate_of(kind: str, total: Any, change: Any) -> Any:
    """The rate of the test, where M changes at a rate."""
    return kind_of(kind).rate_of_return_map(total, change)


def rate_over(kind: str, closing: BallClosing, operator: Krawczyk, point: Point, radius: Fraction) -> Any:
    """The rate of the test along the curve of orbits by the held unknown, over a box.

    Raises
    ------
    Refused : a flight over the box is not enclosed. ZeroDivisionError : D F may be singular on it.
    """
    import flint

    hits = closing.bends(point, radius)
    tangent = operator.tangent_over(closing.matrix(closing.slopes(point, radius)))
    total, change = flint.arb_mat([[1, 0], [0, 1]]), flint.arb_mat([[0, 0], [0, 0]])
    for i, hit in enumerate(hits):
        slopes = flint.arb_mat([row[:2] for row in hit.slopes()])
        moved = flint.arb_mat(hit.along((tangent[2 * i], tangent[2 * i + 1], tangent[-1])))
        total, change = slopes * total, moved * total + slopes * change
    return rate_of(kind, total, change)
