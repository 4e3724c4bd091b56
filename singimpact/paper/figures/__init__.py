"""The paper's figures 1 to 17, and B1 to B9 beyond it, from computed data of real oscillators.

Not here: what they show (`surface`, `dynamics`), what is claimed of it (`paper.claims`), pictures of a user's model
(`scenes`).
"""

from singimpact.paper.figures.registry import BEYOND as BEYOND, FIGURES as FIGURES, figure as figure, picture as picture
