"""Certificates from files: each is checked at growing precision, and answered."""

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

from flint import ctx

from .chatter_limit import border_orbit, chatter_limit
from .event import event
from .formulas import Clock, Refused, Wrong
from .horseshoe import horseshoe, horseshoes
from .invariant_arc import invariant_arc
from .motion import Flight, Model, balls_of, compared, landed, launched
from .periodic_orbit import periodic_orbit
from .schema import read, require_form, require_statement

LEAST = 80  # bits, for bounds that are given with a few digits
SECONDS, ORDINARY = 9, 640  # of CPU for a certificate of at most so many bits; more bits have more, by their square
TERMS = 10_000  # flint cuts a series after ctx.cap terms without a word
PARTS = ("flight_time", "velocity", "tau", "v")


def first_impact(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that the motion from the launch meets the wall first where and as fast as it is written."""
    (tau, v), wall = launched(content), content["launch"].get("wall")
    model = model.from_wall(wall)
    motion = Flight(model, tau, v, bits)
    time, velocity, _ = motion.first_hit()
    there, side = landed(model, motion)
    speed = velocity * (-1 if wall == "upper" else 1)
    found = zip(PARTS, (time, speed, tau + time, there.rebound(velocity * side)), strict=True)
    compared({name: (each, content[name]) for name, each in found})


# What shows each statement at so many bits.
STATEMENTS: dict[str, Callable[[Model, dict[str, Any], int], None]] = {
    "first impact": first_impact,
    "periodic orbit": periodic_orbit,
    "chatter limit": chatter_limit,
    "horseshoe": horseshoe,
    "horseshoes": horseshoes,
    "event": event,
    "border orbit": border_orbit,
    "invariant arc": invariant_arc,
}


def digest_of(content: dict[str, Any]) -> str:
    """A digest of all but itself: a larger radius would be true as well, but nobody has certified it."""
    rest = {name: part for name, part in content.items() if name != "digest"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def check(content: dict[str, Any], seconds: float = SECONDS) -> None:
    """Nothing where the certificate holds.

    Raises
    ------
    Refused : it does not hold, or that is not decided within so many seconds of CPU; and why.
    """
    before = ctx.prec, ctx.cap
    with answered():
        try:
            require_statement(content)
            if content.get("digest") != digest_of(content):
                raise Refused("the digest is not that of the content: the file was changed")
            require_form(content)
            numbers = list(balls_of(content))
            narrowest = min(
                Fraction(number["radius"]) / max(abs(Fraction(number["value"])), Fraction(1)) for number in numbers
            )
            wanted = max(narrowest.denominator.bit_length() - narrowest.numerator.bit_length() + 16, LEAST)
            Clock.start(seconds * max(1.0, wanted / ORDINARY) ** 2)
            decide(content, wanted)
        finally:
            Clock.stop()
            ctx.prec, ctx.cap = before


def decide(content: dict[str, Any], wanted: int) -> None:
    """Try with more and more bits: what is wrong in its first digits is refused by few."""
    why = Refused()
    for bits in (*(LEAST * 4**k for k in range(4) if LEAST * 4**k * 2 < wanted), wanted, 2 * wanted, 4 * wanted):
        ctx.prec, ctx.cap = bits + 32, TERMS
        try:
            STATEMENTS[content["statement"]](Model(content["model"]), content, bits)
        except Wrong:
            raise
        except Refused as reason:
            why = reason
        else:
            return
    raise why


@contextmanager
def answered() -> Iterator[None]:
    """Whatever goes wrong with a file is a refusal of one line."""
    try:
        yield
    except Exception as error:
        kind = "" if isinstance(error, Refused | OSError) else f"not a certificate: {type(error).__name__} "
        raise Refused(" ".join(f"{kind}{error}".split())[:400]) from error


def main(arguments: Sequence[str]) -> int:
    """0 where all certificates hold, else 1; `--seconds N` before the files is the CPU time of each."""
    failed, seconds, paths = 0, float(SECONDS), list(arguments)
    if paths[:1] == ["--seconds"]:
        seconds, paths = float(paths[1]), paths[2:]
    for path in paths:
        try:
            with answered():
                content = read(path)
            check(content, seconds)
            print(f"{path}: holds")
        except Refused as reason:
            print(f"{path}: refused: {reason}")
            failed = 1
    return failed
