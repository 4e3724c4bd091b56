"""The words of the derivations and of the errata: the paper's derivation retold, equations from the derived objects.

Not here: how a section becomes LaTeX or Markdown (`documents`), what is true (`paper.claims`).
"""
