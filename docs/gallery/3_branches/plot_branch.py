"""
A branch of periodic orbits through its graze
=============================================

At a graze the impact map has an infinite derivative, and a continuation of states at fixed phases stops. Here the
branch is smooth and goes on: the orbits of its dotted part would pass through the wall.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
once = si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.6, -0.3))
(doubling, graze) = once.events
twice = si.branch(doubling.others()[0], "amplitude", (-0.6, -0.3))
free = si.branch(graze.others()[0], "amplitude", (-0.6, -0.3))
si.plot([once, twice, free])
plt.show()

# %%
# The graze, the fold and the doublings are located to rounding; ``branch.events`` holds them with their orbits.
