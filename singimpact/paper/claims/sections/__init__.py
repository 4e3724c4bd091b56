"""The claims in the paper's order, one file a section; `SECTIONS` is file -> its claims, imported when called.

Not here: how they are run (`claims.engine`).  A statement is encoded as printed; mutants stand beside it.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from singimpact.handed_on import names_of
from singimpact.paper.claims.claim import Claim


def _claims(file: str) -> tuple[Claim, ...]:
    """The claims of a file, with the trials of those that are corrected."""
    section = names_of(__name__, {file: "CLAIMS TRIALS"})
    trials = section("TRIALS")
    return tuple(replace(claim, trials=trials.get(claim.id)) for claim in section("CLAIMS"))


FILES = (
    "section2",
    "section2_maps",
    "section3",
    "section4",
    "section4a_arc",
    "section4a_blowup",
    "section4a_multipliers",
    "section4b",
    "section4b_leaves",
    "section5",
    "section6",
    "section6_negative",
    "section6_regions",
)
SECTIONS: dict[str, Callable[[], tuple[Claim, ...]]] = {file: partial(_claims, file) for file in FILES}
