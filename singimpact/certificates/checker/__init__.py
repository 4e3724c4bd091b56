"""The second program: `python checker FILE.json ...` checks certificates.

This folder stands alone.  It imports python-flint and the standard library, reads the model as text, and encloses the
motion again with its own code.  It accepts a certificate when its enclosure lies within what the certificate says.

A first impact needs `files` (chooses the precision, answers), `schema` (reads a file; the keys, types and ranges of
all that it may say; what it says, in words), `formulas` (texts over balls, series and numbers with derivatives; that
g has a period; `need`, by which every condition refuses) and `motion` (a flight in balls up to its first hit; numbers
as they are written). What else a certificate may say: `periodic_orbit`, which has the derivative of the impact map,
`event` and `horseshoe`; `chatter_limit`, which has border orbits too; `invariant_arc` by `gravity` (a linear model as
a ball under gravity, and what follows the contact) or `nonlinear` (others, by power series). `__main__` runs the
program.
"""

from .files import SECONDS, check, digest_of, main
from .formulas import Refused
from .schema import BETWEEN, IN_TIME, KINDS, SCHEMA, TOUCHING, read, sentence

__all__ = [
    "BETWEEN",
    "IN_TIME",
    "KINDS",
    "SCHEMA",
    "SECONDS",
    "TOUCHING",
    "Refused",
    "check",
    "digest_of",
    "main",
    "read",
    "sentence",
]
