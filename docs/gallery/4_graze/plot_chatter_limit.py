"""
When does a chatter end?
========================

``osc.chatter_limit`` gives the time at which infinitely many impacts have passed, for arrays of launches: it flies the
first impacts and sums up the others by a series. The status says where a chatter does not complete.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

osc = si.linear(omega=2, clearance="0.3", restitution="0.5")
phase = np.linspace(0.7, 2.5, 400)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for v in (0.02, 0.1, 0.2):
    limit = osc.chatter_limit(phase, v)
    complete = limit.status == si.Status.complete
    axes.plot(phase[complete], (limit.tau - phase)[complete], label=f"launch velocity {v}")
axes.set(xlabel="phase of launch", ylabel="time until the mass rests", ylim=0)
axes.legend(frameon=False)
plt.show()

# %%
# Each curve ends on the right where gamma has this velocity: the force lifts a mass that is launched later off the wall
# before it has come to rest.
