"""
The surface of launches that return
===================================

A launch at a phase that is to return after a time t has one velocity: so the launches form a surface over phase and t.
The impact map is torn where this surface, seen along t, turns back.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear(2, "0.3", "0.5")
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
si.plot(si.Scene(osc, ("horizon", "zero-set", "visible"), tau=(0, "pi"), t=(-3, 3), pixels=400), left)
si.plot(si.Scene(osc, ("outline", "discontinuities", "gamma"), tau=(0, "pi"), v=(0, 1.5), pixels=400), right)
left.set_title("phase and flight time")
right.set_title("phase and velocity")
plt.show()

# %%
# Left: on the horizon H the surface turns back; on the zero set Z the velocity is 0. Right: what an observer sees of H.
