"""The paper's derivation retold, one file a section: steps in order, equations from `theory`.

Not here: how a section becomes LaTeX or Markdown (`documents.rendering`), what is true (`claims`).
`SECTIONS` names them in the paper's order.
"""

from collections.abc import Callable

from singimpact.documents.steps import Section

SECTIONS: dict[str, Callable[[], Section]] = {}
