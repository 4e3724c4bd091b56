"""Lemmas that corrected statements of the paper need and the paper does not have."""

from typing import Any

from singimpact.algebra.certificates import positive_on
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section4b import SLACK
from singimpact.paper.claims.verifiers import every, same
from singimpact.paper.routes.implicit import r


def _below_one(stated: tuple[Any, Any]) -> Check:
    """(A, B), A < B on (0, 1): A/B is r times the ratio of the corrected bounds of q~ and p~ without M."""
    small, large = stated
    return every(
        {
            "A/B = r (1 + e)/(1 - e), e = (1 - r)/3 the slack of both bounds": same(
                small / large, r * (1 + SLACK) / (1 - SLACK)
            ),
            "B - A is positive on (0, 1)": positive_on(large - small, r, 0, 1),
        }
    )


CLAIMS = {
    "b:ratio-bound": Encoding(
        (r * (4 - r), 2 + r),
        _below_one,
        ((r * (5 - r), 2 + r), (r * (1 + 2 * r), 2 + r), (2 * r * (4 - r), 2 * (2 + r) - 3)),
    )
}
