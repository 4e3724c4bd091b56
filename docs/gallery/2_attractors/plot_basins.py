"""
Basins of attraction
====================

The program flies each state of a grid until its orbit has settled. The colour of the state is that of its attractor.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
si.plot(si.basins(osc, size=250))
plt.show()

# %%
# There are two attractors, of one and of three impacts in as many periods; the legend has their shares of the plane.
