"""The claims in the paper's order, one file a section; `SECTIONS` is file -> its claims, imported when called.

Not here: how they are run (`claims.engine`).  A statement is encoded as printed; mutants stand beside it.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from singimpact.paper.claims.claim import Claim, Trials


def _tried(claims: Iterable[Claim], trials: Mapping[str, Trials]) -> tuple[Claim, ...]:
    """The claims with the trials of those that are corrected."""
    return tuple(replace(claim, trials=trials.get(claim.id)) for claim in claims)


def _section2() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section2 as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section2_maps() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section2_maps as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section3() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section3 as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4 as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4a_arc() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4a_arc as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4a_fold() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4a_fold as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4a_blowup() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4a_blowup as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4a_multipliers() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4a_multipliers as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4b() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4b as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section4b_leaves() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section4b_leaves as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section5() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section5 as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section6() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section6 as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section6_negative() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section6_negative as section

    return _tried(section.CLAIMS, section.TRIALS)


def _section6_regions() -> tuple[Claim, ...]:
    from singimpact.paper.claims.sections import section6_regions as section

    return _tried(section.CLAIMS, section.TRIALS)


SECTIONS: dict[str, Callable[[], tuple[Claim, ...]]] = {
    "section2": _section2,
    "section2_maps": _section2_maps,
    "section3": _section3,
    "section4": _section4,
    "section4a_arc": _section4a_arc,
    "section4a_fold": _section4a_fold,
    "section4a_blowup": _section4a_blowup,
    "section4a_multipliers": _section4a_multipliers,
    "section4b": _section4b,
    "section4b_leaves": _section4b_leaves,
    "section5": _section5,
    "section6": _section6,
    "section6_negative": _section6_negative,
    "section6_regions": _section6_regions,
}
