"""The paper's own steps in sympy, each made from the one before: a second route to what `theory` computes over rings.

Not here: the solvers of `theory`, which these steps never import; the statements compared with them (`paper.claims`).
"""
