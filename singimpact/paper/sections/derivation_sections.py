"""The derivations by name.

`SECTIONS` names them in the paper's order, then what is beyond it, `OTHER_NAMES` by number and by subject; `NOTATION`
follows them.
"""

from collections.abc import Callable, Sequence
from functools import partial

from singimpact.documents.document_steps import Section
from singimpact.inputs import unknown
from singimpact.paper.sections import NOTATION
from singimpact.paper.sections.beyond_formulas import beyond
from singimpact.paper.sections.section_formulas import section2, section3, section4, section5, section6
from singimpact.paper.sections.section_templates import section_of

FORMULAS = (section2, section3, section4, section5, section6, beyond)
SECTIONS: dict[str, Callable[[], Section]] = {
    formulas.__name__: partial(section_of, formulas.__name__, formulas) for formulas in FORMULAS
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
