"""Certificates from files: each is checked at growing precision, and answered."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from flint import ctx

from .border_orbit import border_orbit
from .chatter_limit import chatter_limit
from .event import event
from .first_impact import first_impact
from .formulas import Refused, Wrong
from .horseshoe import horseshoe
from .invariant_arc import invariant_arc
from .motion import Model
from .periodic_orbit import periodic_orbit
from .told import balls_of

SCHEMA = "singimpact certificate 1"
LEAST = 80  # bits, for bounds that are given with a few digits
TERMS = 10_000  # flint cuts a series after ctx.cap terms without a word
STATEMENTS: dict[str, Callable[[Model, dict[str, Any], int], None]] = {
    "first impact": first_impact,
    "periodic orbit": periodic_orbit,
    "chatter limit": chatter_limit,
    "horseshoe": horseshoe,
    "event": event,
    "border orbit": border_orbit,
    "invariant arc": invariant_arc,
}
"""What a certificate may say, and what shows it at so many bits."""


def digest_of(told: dict[str, Any]) -> str:
    """A digest of all but itself: a larger radius would be true as well, but nobody has certified it."""
    rest = {name: part for name, part in told.items() if name != "digest"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def check(told: dict[str, Any]) -> None:
    """Nothing where the certificate holds.

    Raises
    ------
    Refused : it does not hold, or that is not decided; and why.
    """
    shown = STATEMENTS.get(str(told.get("statement")))
    if told.get("schema") != SCHEMA or shown is None:
        raise Refused(f"only certificates {SCHEMA!r} of these are checked here: {', '.join(STATEMENTS)}")
    if told.get("digest") != digest_of(told):
        raise Refused("the digest is not that of the content: the file was changed")
    before, why = (ctx.prec, ctx.cap), ""
    try:
        numbers = list(balls_of(told))
        narrowest = min(Fraction(each["radius"]) / max(abs(Fraction(each["value"])), Fraction(1)) for each in numbers)
        if narrowest <= 0:
            raise Refused("a radius that is not above 0")
        wanted = narrowest.denominator.bit_length() - narrowest.numerator.bit_length()
        for bits in (max(wanted + 16, LEAST) * 2**k for k in range(4)):
            ctx.prec, ctx.cap = bits + 32, TERMS
            try:
                return shown(Model(told["model"]), told, bits)
            except Wrong:
                raise
            except Refused as reason:
                why = str(reason)
        raise Refused(why)
    except (KeyError, TypeError, ValueError, SyntaxError, ZeroDivisionError, AttributeError) as error:
        raise Refused(f"not a certificate: {error!r}") from error
    finally:
        ctx.prec, ctx.cap = before


def main(paths: Sequence[str]) -> int:
    """0 where all certificates hold, else 1."""
    failed = 0
    for path in paths:
        try:
            with open(path, encoding="utf-8") as file:
                check(json.load(file))
            print(f"{path}: holds")
        except (Refused, OSError, json.JSONDecodeError) as reason:
            print(f"{path}: refused: {reason}")
            failed = 1
    return failed
