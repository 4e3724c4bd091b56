"""The second program: `python checker FILE.json ...` checks certificates.

This folder stands alone.  It imports python-flint and the standard library, reads the model as text, and encloses the
motion again with its own code.  It accepts a certificate when its enclosure lies within what the certificate says.

Files: `formulas` (texts over balls, series and numbers with derivatives), `told` (numbers as they are written),
`motion` (a flight in balls up to its first hit, and its derivatives); `periods` (that g has a period);
`first_impact`, `periodic_orbit`, `chatter_limit`, `horseshoe`, `event`, `border_orbit`, `invariant_arc`: what each kind
of certificate says; for an arc `gravity` (a linear model as a ball under gravity), `nonlinear` (others, by power series
made by `growing`) and `after_contact`; `files` (reads one, chooses the precision, answers), `__main__`.
"""

from .files import SCHEMA, check, digest_of, main
from .formulas import Refused, Wrong

__all__ = ["SCHEMA", "Refused", "Wrong", "check", "digest_of", "main"]
