"""
A homoclinic tangle
===================

Where the stable and the unstable manifold of one saddle cross, an orbit leaves the saddle and comes back to it. Such a
crossing makes the motion chaotic beside it.
"""

import matplotlib.pyplot as plt

import singimpact as si

saddle = si.linear("2.8", 0, "0.8").periodic(1, 1)[0]
crossings = si.homoclinic_points(saddle)
si.plot(crossings)
plt.show()

# %%
# Both manifolds and the points at which they cross; ``crossings[0].states`` are the impacts of the first such orbit.
