"""The claims in the paper's order, one file a section; `CLAIMS` is id -> claim.

Not here: how they are run (`claims.engine`).  A statement is encoded as printed; mutants stand beside it.
"""

from singimpact.claims.claim import Claim
from singimpact.claims.sections import (
    section2,
    section2_maps,
    section3,
    section4,
    section4a_arc,
    section4a_blowup,
    section4a_fold,
    section4a_multipliers,
    section4a_rays,
    section4b,
    section5,
    section6,
    section6_negative,
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
CLAIMS: dict[str, Claim] = {claim.id: claim for section in _SECTIONS for claim in section.CLAIMS}
