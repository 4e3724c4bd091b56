"""
The mass, moving
================

``si.animate`` moves the mass beside the curve of its displacement. It writes a .gif, an .html page that plays without
a network, or an .mp4 where ffmpeg is installed.
"""

import singimpact as si

osc = si.linear(omega=2, clearance="0.3", restitution="0.5")
film = si.animate(osc.orbit("1.2", "0.3", impacts=40), (3, 9), frames=60)
film.save("bounce.gif")
film  # a notebook plays it

# %%
# Left: the block is the mass, the hatched part is the wall. Right: its displacement over time.
