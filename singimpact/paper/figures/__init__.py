"""The paper's figures 1 to 17, from computed data of real oscillators.

Not here: what they show (`surface`, `dynamics`), what is claimed of it (`claims`).  One file a group of figures that
share an idea; each figure is data (`panel.Picture`), drawn by `rendering`.
"""

from singimpact.paper.figures.registry import FIGURES as FIGURES
from singimpact.paper.figures.registry import figure as figure
from singimpact.paper.figures.registry import picture as picture
