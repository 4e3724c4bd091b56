"""
Folds, doublings and grazes over two numbers
============================================

Where does a periodic orbit lose its stability? ``si.event_curve`` follows each event of a branch as two numbers of the
model vary, here the amplitude and the frequency of the force.
"""

import matplotlib.pyplot as plt

import singimpact as si

osc = si.linear(1, -1, "0.8", damping="0.1", amplitude="-0.12")
events = si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.3, -0.05)).events
window = ((-0.3, -0.05), (0.9, 1.1))
curves = [si.event_curve(event, ("amplitude", "omega"), window) for event in events]
si.plot(curves)
plt.show()

# %%
# Each curve bounds a region of orbits of one kind. A mark is a point at which two curves touch.
