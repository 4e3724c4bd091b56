"""
A formula, and the orbit that confirms it
=========================================

``si.theory`` gives the end of a chatter as an exact power series in the velocity. Its error against the flown limit
shows that it is right: a series cut at order n has slope n + 1.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

osc = si.linear(2, "0.3", "0.5")
v = np.geomspace(1e-3, 0.1, 15)
flown = osc.chatter_limit("1.2", v).tau - 1.2
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for order, marker in zip((1, 2, 3, 4), "os^D"):
    series = si.theory.chatter_limit(order, model=osc, tau="1.2")
    errors = [abs(float(series(float(speed))) - time) for speed, time in zip(v, flown)]
    axes.loglog(v, errors, marker + "-", label=f"order {order}")
axes.set(xlabel="velocity $v$ after the first impact", ylabel="error of the time of rest")
axes.legend(frameon=False)
plt.show()

# %%
# The flown orbits and the series share no code.
