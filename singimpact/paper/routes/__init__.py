"""The paper's own steps in sympy, each made from the one before: a second route to what `theory` computes over rings.

Not here: the solvers of `theory`, which these steps never import; the statements compared with them (`paper.claims`).
Files: `implicit` (sections 2 and 3: y_c, then v_c by the implicit function), `variations` (section 2: derivatives of a
flight by its launch, for any f and g), `fold` (section 4: a tangency), `fold_series` (the same steps on rationals, to
any order), `swan` (section 5), `ratios` (sections 4 and 5: successive flights by ratios of their times), `scaling`
(section 6: what an unfolded swan tends to), `unfolding` (that model, x'' = 12 kappa (s^2 - 1)), `first_order` (a change
of time and height beyond the paper), `equations` (which equation was derived from which).
"""
