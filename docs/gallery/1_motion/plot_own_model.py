"""
Your own model, from Python functions
=====================================

f and g may be Python functions: the package calls each of them once, with letters in place of numbers, and knows the
formula from then on. Here the spring stiffens, a smooth dry friction acts, and the force has two frequencies.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

osc = si.ImpactOscillator(
    f=lambda x, xdot: x + 0.3 * x**3 + 0.1 * np.tanh(5 * xdot),
    g=lambda t, omega: np.cos(omega * t) + 0.4 * np.cos(2 * omega * t),
    clearance="-0.2",  # the wall is at x = -1/5
    restitution="0.7",
    parameters={"omega": "1.7"},
)
si.plot(osc.orbit(0, 1, impacts=16))
plt.show()

# %%
# Displacement over time. Each mark on the wall is an impact, after which the mass leaves with 0.7 of its speed.
