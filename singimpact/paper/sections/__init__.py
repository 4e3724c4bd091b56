"""The words of the derivations and of the errata: the paper's derivation retold, equations from the derived objects.

Not here: how a section becomes LaTeX or Markdown (`documents`), what is true (`paper.claims`).

Words are templates, one TOML file a section; the formulas in them are those of the Python file of the section.
`NOTATION` has the meanings of the letters, which follow the sections.
"""

from singimpact.paper.sections.section_templates import section_of

NOTATION = section_of("notation")
