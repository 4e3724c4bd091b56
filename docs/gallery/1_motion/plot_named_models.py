"""
Systems of the literature
=========================

``si.models`` has twelve published systems by name, each with its source. Keywords replace their numbers, as in
``si.models.shaw_holmes(omega="2.5")``.
"""

import matplotlib.pyplot as plt

import singimpact as si

figure, axes = plt.subplots(3, figsize=(8, 8), layout="constrained")
for name, panel in zip(("shaw_holmes", "pendulum", "luck_mehta"), axes):
    osc = si.models[name]()
    si.plot(osc.orbit("0.2", "0.5", impacts=30), panel)
    panel.set_title(name)
plt.show()

# %%
# A linear oscillator with a stop, a driven pendulum beside a wall, and a ball on a vibrating table.
