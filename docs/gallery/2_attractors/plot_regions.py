"""
Regions over two numbers
========================

What does the motion do in the end, for each frequency and clearance? ``si.regions`` follows one orbit of each of
14 400 models until it has settled.
"""

import matplotlib.pyplot as plt

import singimpact as si

window = ((1.5, 5), (-0.3, 0.5))
found = si.regions(si.linear("2.8", 0, "0.8"), ("omega", "clearance"), window, size=120)
orbit = next(each for each in si.linear("3.6", "0.4", "0.8").periodic(1, 1) if each.stable)
event = si.branch(orbit, "omega", (2.8, 4.8)).events[0]
axes = si.plot(si.event_curve(event, ("omega", "clearance"), window))
si.plot(found, axes)
plt.show()

# %%
# Colours are (n, k) orbits, of n impacts in k periods; grey is chaos, black a mass that comes to rest again and again.
# The curve on which the (1, 1) orbit doubles bounds its region, as in Peterka's diagrams.
