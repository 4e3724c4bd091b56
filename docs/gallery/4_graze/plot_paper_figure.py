"""
A figure of the paper, computed again
=====================================

``si.figure`` draws the 17 figures of the paper on degenerate grazes, and nine more, from computed data of real
oscillators. Figure 17 shows what appears when the force begins to lift a mass off that it has always pressed down.
"""

import singimpact as si

figure = si.figure(17)
figure.savefig("figure17.pdf")
figure  # a notebook shows it

# %%
# The plane of launch phase and velocity. Dots are points of periodic and singular motions, named as in the paper.
