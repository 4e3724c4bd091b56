"""The paper as claims: what is printed, what is derived, a verifier that decides, and the verdict it computes.

Not here: the derivations (`theory`), proofs' certificates (`algebra`), how a verdict is shown (`cli`, `documents`).
`sections/` follow the paper's order; `claim` is the data, `verifiers` the ways to decide, `engine` runs them.
"""

import sys
from collections.abc import Iterator
from types import ModuleType

from singimpact.claims.claim import Claim as Claim
from singimpact.claims.claim import Verdict as Verdict
from singimpact.claims.engine import run as run
from singimpact.claims.engine import select as select
from singimpact.claims.sections import CLAIMS as CLAIMS


class Claims(ModuleType):
    """The room as a collection: `singimpact.claims["e:meq"]` is a claim, iteration gives ids."""

    def __getitem__(self, name: str) -> Claim:
        return select([name])[-1]

    def __iter__(self) -> Iterator[str]:
        return iter(CLAIMS)

    def __len__(self) -> int:
        return len(CLAIMS)


sys.modules[__name__].__class__ = Claims
