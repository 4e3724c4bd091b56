"""
A strange attractor, seen once a period
=======================================

``orbit.section`` gives displacement and velocity once in each period of the force. The states of a chaotic orbit lie on
a set with infinitely many layers.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear("2.8", 0, "0.8")
orbit = osc.orbit(0.1, 0.5, impacts=20_000)
si.plot(orbit.section(phase="pi/2.8"), color="tab:purple")
plt.show()

# %%
# 20 000 impacts of one orbit; each point is the state of the mass at one half of a period.
