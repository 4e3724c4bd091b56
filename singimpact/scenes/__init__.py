"""Pictures of a user's model: orbits over time, scenes of V_c' and of the plane of states, basins, an interactive page.

Not here: what is drawn (`dynamics`, `surface`, `flights`), text with formulas (`documents`), the paper's figures
(`paper.figures`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
