"""The derivations by name.

`SECTIONS` names them in the paper's order, then what is beyond it, `OTHER_NAMES` by number and by subject; `NOTATION`
follows them.
"""

from collections.abc import Callable, Sequence

from singimpact.documents.document_steps import Section
from singimpact.inputs import unknown
from singimpact.paper.sections import (
    NOTATION,
    beyond_words,
    section2_words,
    section3_words,
    section4_words,
    section5_words,
    section6_words,
)

SECTIONS: dict[str, Callable[[], Section]] = {
    "section2": section2_words.told,
    "section3": section3_words.told,
    "section4": section4_words.told,
    "section5": section5_words.told,
    "section6": section6_words.told,
    "beyond": beyond_words.told,
}
OTHER_NAMES = {
    "2": "section2",
    "3": "section3",
    "4": "section4",
    "5": "section5",
    "6": "section6",
    "surface": "section2",
    "regular": "section3",
    "tangency": "section4",
    "swan": "section5",
    "unfolding": "section6",
}


def sections(names: Sequence[str] = ()) -> list[Section]:
    """The sections named, or all, in the paper's order, and the notation last.

    Parameters
    ----------
    names : names, numbers or subjects: ``section4``, ``4`` and ``tangency`` are one; ``notation`` stands alone.

    Raises
    ------
    InputError : an unknown name; the nearest known ones are named.
    """
    wanted = [OTHER_NAMES.get(name, name) for name in names]
    for name, name_ in zip(wanted, names, strict=True):
        if name not in (*SECTIONS, NOTATION.name):
            raise unknown("section", name_, [*SECTIONS, NOTATION.name, *OTHER_NAMES])
    return [*(build() for name, build in SECTIONS.items() if not wanted or name in wanted), NOTATION]
