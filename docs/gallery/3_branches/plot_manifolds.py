"""
What bounds a basin
===================

The stable manifold of a saddle bounds the basins on its two sides; the unstable one leads to the attractors.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
saddle = next(orbit for orbit in osc.periodic(3, 3) if not orbit.stable)
both = [si.manifold(saddle, stable, v=1) for stable in (True, False)]
basins = si.basins(osc, window=((0, "2*pi/2.8"), (0, 1)), size=200)
si.plot(both, ax=si.plot(basins))
plt.show()

# %%
# The map is discontinuous, so both manifolds consist of pieces that end where a flight grazes the wall.
