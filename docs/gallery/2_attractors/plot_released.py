"""
A ball that is released from rest
=================================

After how many periods does a ball come to rest again, for each amplitude and restitution? It begins at rest on a shaken
table, and leaves it where the table falls faster than the ball.
"""

import matplotlib.pyplot as plt

import singimpact as si

ball = si.ImpactOscillator("1", "G*sin(t)", 0, "0.5", {"G": 2})
found = si.regions(ball, ("G", "restitution"), ((1.1, 3), (0.1, 0.7)), size=120, start=(0, 0))
si.plot(found)
plt.show()

# %%
# (inf, k): the ball chatters to rest once in k periods, for ever. Chatter without k lasts so long between two rests
# that rounding decides when the next one comes.
