"""
A cascade at the end of complete chatter
========================================

At a border orbit the chatter of a mass that lifts off ends exactly at its next lift-off. Beside it there are infinitely
many windows of attractors, each with one impact more than the one before.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear("2.8", "0.6", "0.3")
(border,) = osc.border_orbits("clearance", (0.47, 0.475), points=5)
si.plot(border)
plt.show()

# %%
# The windows shrink by a factor that depends on the restitution alone; ``border.cascade.ratios`` has its values.
