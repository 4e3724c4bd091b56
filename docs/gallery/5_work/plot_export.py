"""
Numbers to a table, formulas to LaTeX
=====================================

Every result writes its columns to a .csv file and its arrays to a .npz file; a series is an expression of sympy, which
prints LaTeX.
"""

import matplotlib.pyplot as plt
import numpy as np
import sympy

import singimpact as si

osc = si.linear(2, "0.3", "0.5")
osc.orbit("1.2", "0.3", impacts=40).to_csv("orbit.csv")
table = np.genfromtxt("orbit.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
print(table[:3])
gamma = si.theory.gamma(order=3, at="tangency", model=osc)
formula = sympy.latex(gamma.as_expr().evalf(5))
print(formula)

plt.semilogy(table["tau"], table["v"], "o", markersize=4)
plt.gca().set(xlabel="time", ylabel="velocity after the impact", title=f"$\\gamma(\\sigma) = {formula}$")
plt.show()

# %%
# The velocities of ``orbit.csv``. The title is the formula as LaTeX typesets it.
