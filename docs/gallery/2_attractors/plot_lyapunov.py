"""
Order and chaos over the frequency
==================================

The largest Lyapunov exponent is the rate at which neighbouring orbits part from one another. The motion is chaotic
where it is positive, and periodic where it is negative.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

omega = np.linspace(2.3, 3.1, 300)
orbits = [si.lyapunov(si.linear(frequency, 0, "0.8"), 0.1, 0.5, impacts=1000, transient=300) for frequency in omega]
largest = np.array([orbit.exponents[0] for orbit in orbits])
figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
axes.plot(omega, largest, linewidth=0.8)
axes.fill_between(omega, largest, where=largest > 0, color="tab:red", alpha=0.4, label="chaos")
axes.axhline(0, color="black", linewidth=0.8)
axes.set(xlabel="frequency $\\omega$ of the force", ylabel="largest exponent, per unit of time")
axes.legend(frameon=False)
plt.show()

# %%
# The curve is interrupted where the mass comes to rest again and again: the exponent is then minus infinity.
