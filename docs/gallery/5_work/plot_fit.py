"""
Fit restitution and clearance to measured impacts
=================================================

Measured impacts are pairs of a state and the next one. Least squares finds the numbers whose impact map takes each
state to the next. Here the "measurements" are those of a model with c = 0.1 and r = 0.8, with an error of 1/1000.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares

import singimpact as si

model = si.linear("2.8", "0.1", "0.8", amplitude=-1)
orbit = model.orbit("0.3", "0.4", impacts=60)
tau, v = np.array([orbit.tau, orbit.v]) + np.random.default_rng(1).normal(0, 1e-3, (2, 61))


def misses(numbers):
    step = model.replace(clearance=float(numbers[0]), restitution=float(numbers[1])).impact_map(tau[:-1], v[:-1])
    return np.nan_to_num(np.concatenate([step.tau - tau[1:], step.v - v[1:]]), nan=1.0)


fit = least_squares(misses, [0.15, 0.7], loss="soft_l1", f_scale=3e-3)  # a rounded loss, so that no graze decides
print(f"c = {fit.x[0]:.4f}, r = {fit.x[1]:.4f}")
for start, marker in ([0.15, 0.7], "x"), (fit.x, "."):
    plt.plot(v[1:], v[1:] + misses(start)[60:], marker, label=f"c = {start[0]:.3f}, r = {start[1]:.3f}")
plt.plot([0, v.max()], [0, v.max()], color="black", linewidth=0.8)
plt.gca().set(xlabel="measured velocity after an impact", ylabel="velocity of the model")
plt.legend(frameon=False)
plt.show()

# %%
# Crosses: the model before the fit. Points: after it, they lie on the diagonal.
