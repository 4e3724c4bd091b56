"""Claims that the paper does not have, apart from its own: `BEYOND` is file -> its claims, imported when called.

Not here: claims of the paper (`claims.sections`). None is printed anywhere, so none is corrected; mutants stand beside.
"""

from collections.abc import Callable
from functools import partial

from singimpact.handed_on import names_of
from singimpact.paper.claims.claim import Claim


def _claims(file: str) -> tuple[Claim, ...]:
    claims: tuple[Claim, ...] = names_of(__name__, {file: "CLAIMS"})("CLAIMS")
    return claims


FILES = (
    "cascade",
    "horseshoe",
    "repairs",
    "every_order",
    "gauge",
    "first_order",
    "holder",
    "foot",
    "loops",
    "onset",
    "events",
    "events_harmonic",
    "gamma",
    "hertz",
)
BEYOND: dict[str, Callable[[], tuple[Claim, ...]]] = {file: partial(_claims, file) for file in FILES}
