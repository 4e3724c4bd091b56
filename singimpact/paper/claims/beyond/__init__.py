"""Claims that the paper does not have, apart from its own: `BEYOND` is file -> its claims, imported when called.

Not here: claims of the paper (`claims.sections`). None is printed anywhere, so none is corrected; mutants stand beside.
"""

from collections.abc import Callable

from singimpact.paper.claims.claim import Claim


def _cascade() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import cascade as section

    return section.CLAIMS


def _horseshoe() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import horseshoe as section

    return section.CLAIMS


def _repairs() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import repairs as section

    return section.CLAIMS


def _every_order() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import every_order as section

    return section.CLAIMS


def _gauge() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import gauge as section

    return section.CLAIMS


def _first_order() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import first_order as section

    return section.CLAIMS


def _holder() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import holder as section

    return section.CLAIMS


def _loops() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import loops as section

    return section.CLAIMS


def _foot() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import foot as section

    return section.CLAIMS


def _onset() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import onset as section

    return section.CLAIMS


def _events() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import events as section

    return section.CLAIMS


def _events_harmonic() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import events_harmonic as section

    return section.CLAIMS


def _gamma() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import gamma as section

    return section.CLAIMS


def _hertz() -> tuple[Claim, ...]:
    from singimpact.paper.claims.beyond import hertz as section

    return section.CLAIMS


BEYOND: dict[str, Callable[[], tuple[Claim, ...]]] = {
    "cascade": _cascade,
    "horseshoe": _horseshoe,
    "repairs": _repairs,
    "every_order": _every_order,
    "gauge": _gauge,
    "first_order": _first_order,
    "holder": _holder,
    "foot": _foot,
    "loops": _loops,
    "onset": _onset,
    "events": _events,
    "events_harmonic": _events_harmonic,
    "gamma": _gamma,
    "hertz": _hertz,
}
