"""
An orbit that chatters to rest
==============================

The mass hits the wall ever more weakly, infinitely often in a finite time. It then rests until the force lifts it off.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear(omega=2, clearance="0.7", restitution="0.5")  # x'' + x = cos 2t, wall at x = 0.7
orbit = osc.orbit("1.2", "0.3", impacts=300)
si.plot(orbit, sheet=True)
plt.show()

# %%
# Above: displacement over the last six periods, and the phase portrait. Below, left: the velocity after every impact.
# Each falling row of points is a chatter; the bars are times at rest. Right: the hops of the first chatter, on
# logarithmic axes, where they are about equally wide.
