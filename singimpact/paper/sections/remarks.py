"""Remarks of the errata on each misprint: its kind, its reason, and what it does not touch.

Their words are data, `remarks.toml`. Verdicts, corrections and numbers are computed by the claims; a claim that is
corrected and has no remark here, or has one and is not corrected, fails a test.
"""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

GRADES = {
    "slip": "slip of the pen",
    "sign": "wrong sign",
    "constant": "wrong constant",
    "argument": "argument to repair",
    "reading": "matter of reading",
}
PLURALS = {
    "slip": "slips of the pen",
    "sign": "wrong signs",
    "constant": "wrong constants",
    "argument": "steps of arguments to repair",
    "reading": "matters of reading",
}


@dataclass(frozen=True)
class Remark:
    """One remark on the paper.

    Attributes
    ----------
    claims : ids of the claims that it is about. grade : a key of `GRADES`. reason : why the printed statement fails.
    survives : what of the paper does not depend on it, or how it is repaired.  Formulas stand between dollar signs.
    """

    claims: tuple[str, ...]
    grade: str
    reason: str
    survives: str


REMARKS = tuple(
    Remark(tuple(fields.pop("claims")), **fields)
    for fields in tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))["remarks"]
)


@cache
def remark_on(claim: str) -> Remark | None:
    """The remark on a claim, by its id; None where there is none.

    Examples
    --------
    >>> remark_on("s4b-ratio").grade, remark_on("e:meq")
    ('constant', None)
    """
    return next((remark for remark in REMARKS if claim in remark.claims), None)
