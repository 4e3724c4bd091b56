"""Claims that the paper does not have, apart from its 132: `BEYOND` is file -> its claims, imported when called.

Not here: claims of the paper (`claims.sections`). None is printed anywhere, so none is corrected; mutants stand beside.
Files: `cascade` (border orbits and the cascade beside them), `horseshoe` (a certified homoclinic orbit).
"""

from __future__ import annotations

from collections.abc import Callable

from singimpact.paper.claims.claim import Claim


def _cascade() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import cascade as section

    return section.CLAIMS


def _horseshoe() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import horseshoe as section

    return section.CLAIMS


BEYOND: dict[str, Callable[[], tuple[Claim, ...]]] = {"cascade": _cascade, "horseshoe": _horseshoe}
