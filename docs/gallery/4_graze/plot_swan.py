"""
Towards a swan point
====================

At the clearance 1 the acceleration at the wall has a double zero, a swan point, and from there on the force presses the
mass against the wall at all phases. ``si.swan_points`` finds the clearance.
"""

import matplotlib.pyplot as plt

import singimpact as si

(swan, _) = si.swan_points("x", "cos(2*t)")
figure, axes = plt.subplots(1, 3, figsize=(10, 4.2), layout="constrained", sharey=True)
for clearance, panel in zip(("0.6", "0.7", "0.8"), axes):
    layers = ("discontinuities", "gamma", "foliation")
    scene = si.Scene(si.linear(2, clearance, "0.5"), layers, tau=(-1.2, 1), v=(0, 0.3), pixels=300)
    si.plot(scene, panel)
    panel.set_title(f"c = {clearance}, swan at c = {swan.clearance}")
    panel.get_legend().remove()
plt.show()

# %%
# Below gamma (pink) a mass comes to rest; each blue curve leads to one point of rest. At the black curve the impact map
# jumps. The phases at which the force lifts the mass off, between the two families of blue curves, shrink to a point.
