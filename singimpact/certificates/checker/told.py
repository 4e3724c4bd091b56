"""Numbers as a certificate writes them, compared with balls."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from .formulas import Formula, Refused, Wrong, ball, need
from .motion import within


def lies_within(found: Any, told: dict[str, Any]) -> bool:
    """Whether a ball lies within the one that is written, as rationals."""
    value, radius = Fraction(told["value"]), Fraction(told["radius"])
    ends = [Fraction(int(m)) * Fraction(2) ** int(e) for m, e in (found.lower().man_exp(), found.upper().man_exp())]
    return value - radius <= ends[0] and ends[1] <= value + radius


def balls_of(told: Any) -> Iterable[dict[str, str]]:
    """All numbers with a radius."""
    if isinstance(told, dict) and set(told) == {"value", "radius"}:
        yield told
    elif isinstance(told, dict | list):
        for part in told.values() if isinstance(told, dict) else told:
            yield from balls_of(part)


def compared(found: dict[str, tuple[Any, dict[str, str]]]) -> None:
    """Refuse the first ball that does not lie within the one that is written."""
    for name, (ball_found, told) in found.items():
        error = Refused if ball_found.overlaps(read(told)) else Wrong
        need("compared", lies_within(ball_found, told), f"{name} is {ball_found.str(30)}", error)


def read(told: dict[str, str]) -> Any:
    """A number with its radius as a ball."""
    return ball(Fraction(told["value"])) + within(ball(Fraction(told["radius"])))


def launched(told: dict[str, Any], moving: bool = False) -> tuple[Any, Any]:
    """tau and v of a launch: from the wall, not into it."""
    tau, v = (Formula(told["launch"][name], {})() for name in ("tau", "v"))
    need("launch", v > 0 or (v == 0 and not moving), "the launch velocity is not shown to be positive")
    return tau, v
