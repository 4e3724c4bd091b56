"""Numbers as a certificate writes them, compared with balls."""

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from .formulas import Formula, Refused, Wrong, ball, need
from .motion import within


def lies_within(enclosure: Any, written: dict[str, Any]) -> bool:
    """Whether a ball lies within the one that is written, as rationals."""
    value, radius = Fraction(written["value"]), Fraction(written["radius"])
    ends = [
        Fraction(int(m)) * Fraction(2) ** int(e) for m, e in (enclosure.lower().man_exp(), enclosure.upper().man_exp())
    ]
    return value - radius <= ends[0] and ends[1] <= value + radius


def balls_of(content: Any) -> Iterable[dict[str, str]]:
    """All numbers with a radius."""
    if isinstance(content, dict) and set(content) == {"value", "radius"}:
        yield content
    elif isinstance(content, dict | list):
        for entry in content.values() if isinstance(content, dict) else content:
            yield from balls_of(entry)


def compared(pairs: dict[str, tuple[Any, dict[str, str]]]) -> None:
    """Refuse the first ball that does not lie within the one that is written."""
    for name, (enclosure, written) in pairs.items():
        error = Refused if enclosure.overlaps(read(written)) else Wrong
        need("compared", lies_within(enclosure, written), f"{name} is {enclosure.str(30)}", error)


def read(written: dict[str, str]) -> Any:
    """A number with its radius as a ball."""
    return ball(Fraction(written["value"])) + within(ball(Fraction(written["radius"])))


def launched(content: dict[str, Any], moving: bool = False) -> tuple[Any, Any]:
    """tau and v of a launch: from the wall, not into it."""
    tau, v = (Formula(content["launch"][name], {})() for name in ("tau", "v"))
    need("launch", v > 0 or (v == 0 and not moving), "the launch velocity is not shown to be positive")
    return tau, v
