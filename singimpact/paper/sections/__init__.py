"""The words of the derivations and of the errata: the paper's derivation retold, equations from the derived objects.

Not here: how a section becomes LaTeX or Markdown (`documents`), what is true (`paper.claims`).
Files: `notation` (what the letters mean), `letters` and `words` (shared), `section2`, `section3`, `section4`,
`section4_blowup`, `section4_foliation`, `section4_orbits`, `section5`, `section6`, `beyond` (what the paper does not
have); `derivations` (the sections by name), `marks` (the verdicts of what they show), `cached` (what is kept on disk);
`errata` (what is misprinted), `places` (where it stands in the paper), `remarks` (why, and what survives), `legend`
(letters and models of the errata).
"""
