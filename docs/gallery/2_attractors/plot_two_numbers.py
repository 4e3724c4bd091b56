"""
A map over two numbers
======================

Where is the motion chaotic? ``osc.over`` makes a family of 14 400 models, one for each frequency and clearance, and one
call flies them all.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

omega, clearance = np.linspace(1.5, 5, 140), np.linspace(-0.3, 0.5, 100)
many = si.linear("2.8", 0, "0.8").over(omega=omega, clearance=clearance[:, None])
largest = si.lyapunov(many, 0, 0.1, impacts=300, transient=300).exponents[..., 0]
figure, axes = plt.subplots(figsize=(7, 4.4), layout="constrained")
colours = axes.pcolormesh(omega, clearance, largest, cmap="RdBu_r", vmin=-0.4, vmax=0.4)
figure.colorbar(colours, label="largest Lyapunov exponent", extend="min")
axes.set(xlabel="frequency $\\omega$ of the force", ylabel="clearance $c$")
plt.show()

# %%
# Red: chaos. Blue: periodic motion, the darker the faster an orbit settles on it. White: an exponent near
# zero, or a mass that comes to rest again and again.
