"""The claims in the paper's order, one file a section; `CLAIMS` is id -> claim.

Not here: how they are run (`claims.engine`).  A statement is encoded as printed; mutants stand beside it.
"""

from dataclasses import replace

from singimpact.claims.claim import Claim
from singimpact.claims.sections import (
    section2,
    section2_maps,
    section2_trials,
    section3,
    section4,
    section4_trials,
    section4a_arc,
    section4a_blowup,
    section4a_fold,
    section4a_multipliers,
    section4a_rays,
    section4b,
    section4b_trials,
    section5,
    section5_trials,
    section6,
    section6_negative,
    section6_trials,
)

_SECTIONS = (
    section2,
    section2_maps,
    section3,
    section4,
    section4a_arc,
    section4a_fold,
    section4a_blowup,
    section4a_rays,
    section4a_multipliers,
    section4b,
    section5,
    section6,
    section6_negative,
)
_TRIALS = (
    section2_trials.TRIALS
    | section4_trials.TRIALS
    | section4b_trials.TRIALS
    | section5_trials.TRIALS
    | section6_trials.TRIALS
)
CLAIMS: dict[str, Claim] = {
    claim.id: replace(claim, trials=_TRIALS.get(claim.id)) for section in _SECTIONS for claim in section.CLAIMS
}
