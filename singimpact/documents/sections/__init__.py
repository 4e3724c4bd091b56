"""The paper's derivation retold, one file a section: steps in order, equations from `theory`.

Not here: how a section becomes LaTeX or Markdown (`documents.rendering`), what is true (`claims`).
`SECTIONS` names them in the paper's order, `OTHER_NAMES` by number and by subject; `NOTATION` goes before them.
"""

from collections.abc import Callable

from singimpact.documents.sections import section2, section3, section4, section5, section6
from singimpact.documents.sections.notation import NOTATION as NOTATION
from singimpact.documents.steps import Section

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
