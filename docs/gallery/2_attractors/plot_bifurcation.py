"""
A bifurcation diagram with its periodic orbits
==============================================

The dots are settled orbits of a simulation. The curves are periodic orbits, stable and unstable, followed through
folds, period doublings and grazes.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
settled = si.bifurcation(osc, "clearance", (-0.1, 0.25), points=150, direction="both")
branches = [si.branch(osc.periodic(n, n)[0], "clearance", (-0.1, 0.25)) for n in (1, 3)]
si.plot([settled, *branches], sheet=True)
plt.show()

# %%
# :math:`x'' + x = -\cos 2.8 t`, :math:`r = 0.8`. The simulation goes up and then down over the clearance, so it shows
# both attractors where there are two. Each attractor has a colour; chaos is black, those met at few values are grey.
