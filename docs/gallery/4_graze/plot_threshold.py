"""
How fast must a launch be to escape?
====================================

``osc.threshold`` gives the velocity on gamma for each phase of launch: slower masses chatter to rest before the force
lifts them off, faster ones do not. Each value has an error bound.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

phase = np.linspace(1, 2.5, 60)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for restitution in ("0.3", "0.5", "0.7", "0.9"):
    osc = si.linear(2, "0.3", restitution)
    axes.plot(phase, osc.threshold(phase).v, label=f"r = {restitution}")
axes.set(xlabel="phase of launch", ylabel="velocity on gamma", ylim=0)
axes.legend(frameon=False)
plt.show()

# %%
# The threshold falls as the restitution rises, and meets zero quadratically at the lift-off.
