"""The test of a fold, period doubling or torus, and its rate along a curve of orbits, over boxes.

With M the derivative of the return map, the product of the D G of all flights, t its trace and d its determinant,

    fold   1 - t + d,      period-doubling   1 + t + d,      torus   1 - d.

The curve has the tangent u with D F u = 0, the held component 1. Along it D G changes by D^2 G u.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from singimpact.branches.ball_closing import BallClosing
from singimpact.branches.krawczyk import Krawczyk, Point

SIGNS = {"fold": -1, "period-doubling": 1, "torus": 0}
"""The factor of the trace."""


def event_function(kind: str, total: Any) -> Any:
    """What vanishes at the event, of the derivative of the return map."""
    trace, determinant = total[0, 0] + total[1, 1], total.det()
    return 1 - determinant if kind == "torus" else 1 + SIGNS[kind] * trace + determinant


def rate_of(kind: str, total: Any, change: Any) -> Any:
    """The rate of the test, where M changes at a rate."""
    trace = change[0, 0] + change[1, 1]
    determinant = (change[0, 0] * total[1, 1] + total[0, 0] * change[1, 1]
                   - change[0, 1] * total[1, 0] - total[0, 1] * change[1, 0])  # fmt: skip
    return -determinant if kind == "torus" else SIGNS[kind] * trace + determinant


def rate_over(kind: str, closing: BallClosing, operator: Krawczyk, point: Point, radius: Fraction) -> Any:
    """The rate of the test along the curve of orbits by the held unknown, over a box.

    Raises
    ------
    Refused : a flight over the box is not enclosed. ZeroDivisionError : D F may be singular on it.
    """
    import flint

    hits, longer = closing.bends(point, radius)
    matrix = closing.matrix(([hit.slopes() for hit in hits], longer))
    tangent = operator.tangent_over(matrix)
    total, change = flint.arb_mat([[1, 0], [0, 1]]), flint.arb_mat([[0, 0], [0, 0]])
    for i, hit in enumerate(hits):
        slopes = flint.arb_mat([row[:2] for row in hit.slopes()])
        moved = flint.arb_mat(hit.along((tangent[2 * i], tangent[2 * i + 1], tangent[-1])))
        total, change = slopes * total, moved * total + slopes * change
    return rate_of(kind, total, change)
