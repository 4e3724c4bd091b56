"""
A figure for a journal
======================

``si.plot`` draws on axes that you give, with your fonts, your width and your colours: matplotlib's settings apply. This
figure is one column wide (86 mm), with letters of 8 points.
"""

import matplotlib.pyplot as plt

import singimpact as si

style = {"font.family": "serif", "mathtext.fontset": "cm", "font.size": 8, "axes.linewidth": 0.6, "figure.dpi": 200}
with plt.style.context(style):
    figure, axes = plt.subplots(2, figsize=(3.39, 3.4), layout="constrained")
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    si.plot(osc.orbit(0.3, 0.4, impacts=10), axes[0], color="black", linewidth=0.8)
    si.plot(si.bifurcation(osc, "clearance", (-0.1, 0.25), points=120), axes[1], color="black", markersize=0.5)
    for panel, letter in zip(axes, "ab"):
        if panel.get_legend():
            panel.get_legend().remove()
        panel.set_title(f"({letter})", loc="left", fontsize=8)
    figure.savefig("figure.pdf")
    plt.show()

# %%
# (a) An orbit. (b) Settled velocities after an impact over the clearance. ``figure.pdf`` has the lines as vectors.
