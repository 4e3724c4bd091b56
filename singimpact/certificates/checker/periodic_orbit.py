"""A periodic orbit, by Krawczyk's operator.

It is a zero of F_i = G(state i) - state i+1, G the map from impact to impact.  With Y about the inverse of D F, the
zero exists and is alone in a box X round a point p if p - Y F(p) + (1 - Y D F(X)) (X - p) lies inside X.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from flint import arb, arb_mat

from .formulas import Formula, Refused, Wrong, ball
from .motion import Model, impact, next_state, size, within
from .periods import require_period
from .told import compared


def periodic_orbit(model: Model, told: dict[str, Any], bits: int) -> None:
    """That one orbit has its states in the balls that are written, and no other is near; and its multipliers."""
    states, k = told["states"], int(told["periods"])
    if k < 1 or not states:
        raise Wrong("an orbit has impacts, and closes after one period or more")
    require_period(model.g, told["period"])
    numbers = [state[name] for state in states for name in ("tau", "v")]
    point, radii = ([ball(Fraction(each[part])) for each in numbers] for part in ("value", "radius"))
    span, unique = Formula(told["period"], model.g.parameters)() * k, ball(Fraction(told["unique_within"]))
    for near in ([unique] * len(point), radii):
        slopes, image = krawczyk(model, point, near, span, bits)
        for part, radius in zip(image, near, strict=True):
            if not abs(part) < radius:
                # more bits help a narrow box alone, and only if there may be a zero in it
                error = Wrong if near is not radii or abs(part) > radius else Refused
                raise error(f"Krawczyk's operator maps a side of {float(radius):.3g} to {float(size(part)):.3g}")
    total = arb_mat([[1, 0], [0, 1]])
    for slope in slopes:  # over the balls of the states
        total = arb_mat(slope) * total
    if told["multipliers"]:
        wanted = [each[part] for each in told["multipliers"] for part in ("real", "imaginary")]
        for found, written in zip(eigenvalues(total), wanted, strict=True):
            compared({"a multiplier": (found, written)})


def krawczyk(
    model: Model, point: list[Any], radii: list[Any], span: Any, bits: int
) -> tuple[list[list[list[Any]]], list[Any]]:
    """The derivatives of the impact map over a box, and what Krawczyk's operator makes of the box less its centre."""
    size_of, n = len(point), len(point) // 2
    box = [x + within(r) for x, r in zip(point, radii, strict=True)]
    slopes = [impact(model, box[2 * i], box[2 * i + 1], bits) for i in range(n)]
    D, missed = arb_mat(size_of, size_of), []
    for i in range(n):
        image, following = next_state(model, point[2 * i], point[2 * i + 1], bits), 2 * ((i + 1) % n)
        missed += [image[0] - point[following] - (span if i == n - 1 else 0), image[1] - point[following + 1]]
        for a in (0, 1):
            for b in (0, 1):
                D[2 * i + a, 2 * i + b] += slopes[i][a][b]
            D[2 * i + a, following + a] -= 1
    middle = arb_mat([[arb(part.mid()) for part in row] for row in D.table()])
    Y = arb_mat([[arb(part.mid()) for part in row] for row in middle.inv().table()])
    one = arb_mat([[int(i == j) for j in range(size_of)] for i in range(size_of)])
    spread_out = (one - Y * D) * arb_mat([[within(r)] for r in radii])
    return slopes, (spread_out - Y * arb_mat([[part] for part in missed])).entries()


def eigenvalues(matrix: Any) -> list[Any]:
    """Real and imaginary part of the larger eigenvalue, and of the other."""
    half, determinant = (matrix[0, 0] + matrix[1, 1]) / 2, matrix.det()
    under = half * half - determinant
    if under > 0:
        far = half + under.sqrt() if half > 0 else half - under.sqrt()
        return [far, arb(0), determinant / far, arb(0)]
    if under < 0:
        return [half, (-under).sqrt(), half, -(-under).sqrt()]
    raise Refused("the multipliers are not told apart")
