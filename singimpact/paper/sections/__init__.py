"""The words of the derivations and of the errata: the paper's derivation retold, equations from the derived objects.

Not here: how a section becomes LaTeX or Markdown (`documents`), what is true (`paper.claims`).
Files: `notation` (what the letters mean), `letters` (shared by sections), `section2`, `section3`, `section4`,
`section4_blowup`, `section5`, `section6`; `derivations` (the sections by name), `marks` (the verdicts of what they
show), `cached` (sections that are kept); `errata` (what is misprinted).
"""
