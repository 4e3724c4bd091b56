"""
A chatter, magnified
====================

The mass comes to rest after infinitely many impacts. Each window shows the end of the window above it; the flights look
alike at every magnification, because each one is shorter than the one before it by nearly the factor r = 0.7.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

osc = si.linear(omega=2, clearance="0.3", restitution="0.7")
end = osc.chatter_limit("1.2", "0.15").tau  # the mass is at rest from here on
impacts = osc.iterate("1.2", "0.15", 40, keep=True)
figure, axes = plt.subplots(3, figsize=(7, 6), layout="constrained")
for first, panel in zip((0, 6, 12), axes):
    for tau, v, later in zip(impacts.tau[first:], impacts.v[first:], impacts.tau[first + 1 :]):
        t = np.linspace(0, later - tau, 30)
        panel.plot(1000 * (tau + t - end), 1000 * (osc.flight(tau, v, t).x - 0.3), color="tab:blue", linewidth=1)
    panel.set(ylabel="1000 (x - c)", title=f"from impact {first} on", ylim=0)
axes[-1].set_xlabel("1000 (time - time of rest)")
plt.show()

# %%
# Height above the wall before the mass comes to rest, at three magnifications: the axes differ by factors of 8 in time
# and 70 in height.
