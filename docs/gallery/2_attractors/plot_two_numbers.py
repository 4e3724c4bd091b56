"""
A map over two numbers
======================

Where is the motion chaotic? ``si.sweep`` calls a function for each case, here for 900 pairs of a frequency and a
clearance. Threads share the work; on a cluster the same call takes a client of Dask.
"""

from concurrent.futures import ThreadPoolExecutor

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

omega, clearance = np.linspace(2.2, 3.2, 36), np.linspace(-0.2, 0.2, 25)


def exponent(pair):
    return si.lyapunov(si.linear(*pair, "0.8"), 0.1, 0.5, impacts=200, transient=200).exponents[0]


pairs = [(frequency, distance) for distance in clearance for frequency in omega]
largest = si.sweep(exponent, pairs, executor=ThreadPoolExecutor(2)).reshape(25, 36)
figure, axes = plt.subplots(figsize=(7, 4.4), layout="constrained")
colours = axes.pcolormesh(omega, clearance, largest, cmap="RdBu_r", vmin=-0.3, vmax=0.3)
figure.colorbar(colours, label="largest Lyapunov exponent", extend="min")
axes.set(xlabel="frequency $\\omega$ of the force", ylabel="clearance $c$")
plt.show()

# %%
# Red: chaos. Blue: periodic motion, the darker the faster an orbit settles on it. White: an exponent near
# zero, or a mass that comes to rest again and again.
