"""The paper as claims: what is printed, what is derived, a verifier that decides, and the verdict it computes.

Not here: the derivations (`theory`), proofs' certificates (`algebra`), how a verdict is shown (`cli`, `documents`).
`sections/` follow the paper's order; `claim` is the data, `verifiers` the ways to decide, `engine` runs them.
"""

from singimpact.claims.claim import Claim as Claim
from singimpact.claims.claim import Verdict as Verdict
from singimpact.claims.engine import run as run
from singimpact.claims.engine import select as select
from singimpact.claims.sections import CLAIMS as CLAIMS
