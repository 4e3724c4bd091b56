"""
Isospikes of a bouncing ball
============================

How many impacts does the motion have until it repeats, for each amplitude of a shaken table and each restitution? Each
colour is one number of impacts and periods: the ball is thrown up with ``v = 1``, and flown until it has settled.
"""

import matplotlib.pyplot as plt

import singimpact as si

ball = si.ImpactOscillator("1", "G*sin(t)", 0, "0.5", {"G": 2})
found = si.regions(ball, ("G", "restitution"), ((1.2, 3.6), (0.1, 0.6)), size=120, start=(0, 1))
si.plot(found)
plt.show()

# %%
# (n, k): n impacts in k periods of the table, over and over. From (1, 1) on they double, (2, 2), (4, 4), up to chaos in
# light grey. (inf, k), black and dark grey, is a ball with infinitely many impacts in k periods: it chatters to rest.
