"""The paper as claims: what is printed, what is derived, a verifier that decides, and the verdict it computes.

Not here: the derivations (`theory`, `paper.routes`), proofs' certificates (`algebra`), the orbits and surfaces on which
claims are tried (`paper.trials`), the words of the derivations and errata (`paper.sections`).
"""

import sys
from collections.abc import Iterator
from types import ModuleType

from singimpact.paper.claims.claim import Claim as Claim, Verdict as Verdict
from singimpact.paper.claims.engine import run as run, select as select
from singimpact.paper.claims.index import BEYOND as BEYOND, CLAIMS as CLAIMS, INDEX as INDEX, entry_of


class Claims(ModuleType):
    """The room as a collection: `singimpact.claims["e:meq"]` is a claim, iteration gives ids."""

    def __getitem__(self, name: str) -> Claim:
        entry_of(name)  # an unknown id is refused with the nearest known ones
        return CLAIMS[name]

    def __iter__(self) -> Iterator[str]:
        return iter(INDEX)

    def __len__(self) -> int:
        return len(INDEX)


sys.modules[__name__].__class__ = Claims
