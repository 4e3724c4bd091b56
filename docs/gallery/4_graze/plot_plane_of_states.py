"""
The plane of states near a degenerate graze
===========================================

Where the acceleration at the wall has a double zero, a threshold curve gamma separates chatter that completes from
chatter that does not. The impact map is torn along its discontinuities.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear(2, "0.7", "0.5")
scene = si.Scene(osc, ("discontinuities", "gamma", "foliation"), tau=(-1.2, 1.0), v=(0, 0.3), pixels=600)
figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
scene.draw(axes)
plt.show()

# %%
# Launches above gamma (pink) escape the chatter; those below come to rest. Each thin curve leads to one point of rest.
