"""The derivations by name, with the verdicts of what they show.

`SECTIONS` names them in the paper's order, `OTHER_NAMES` by number and by subject; `NOTATION` goes before them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from singimpact.documents.steps import Mark, Section, claims_of
from singimpact.inputs import unknown
from singimpact.paper.sections import section2, section3, section4, section5, section6
from singimpact.paper.sections.notation import NOTATION

SECTIONS: dict[str, Callable[[], Section]] = {
    "section2": section2.told,
    "section3": section3.told,
    "section4": section4.told,
    "section5": section5.told,
    "section6": section6.told,
}
OTHER_NAMES = {
    "2": "section2", "3": "section3", "4": "section4", "5": "section5", "6": "section6",
    "surface": "section2", "regular": "section3", "tangency": "section4", "swan": "section5",
    "unfolding": "section6",
}  # fmt: skip


def sections(names: Sequence[str] = ()) -> list[Section]:
    """The notation, then the sections named, or all, in the paper's order.

    Parameters
    ----------
    names : names, numbers or subjects: ``section4``, ``4`` and ``tangency`` are one.

    Raises
    ------
    InputError : an unknown name; the nearest known ones are named.
    """
    wanted = [OTHER_NAMES.get(name, name) for name in names]
    for name, given in zip(wanted, names, strict=True):
        if name not in SECTIONS:
            raise unknown("section", given, [*SECTIONS, *OTHER_NAMES])
    return [NOTATION, *(build() for name, build in SECTIONS.items() if not wanted or name in wanted)]


def marks_of(shown: Iterable[Section], on_start: Callable[..., None] | None = None) -> dict[str, Mark]:
    """Claim id -> its mark, for every claim that sections show; a kept verdict is not computed again."""
    ids = claims_of(shown)
    if not ids:
        return {}
    from singimpact.paper.claims import run, select

    return {
        found.id: Mark(found.kind, found.effective, found.printed if found.corrected else "")
        for found in run(select(ids), on_start=on_start, kept=True)
    }
