"""Pictures: orbits over time, later the surface V_c' and its curves, the figures, the interactive page.

Not here: what is drawn (`dynamics`, `surface`, `flights`), text with formulas (`documents`).
Files: `drawing` (`plot`: one call for everything that can be drawn), `orbit` (x(t) with its impacts).
"""

from singimpact.scenes.drawing import plot as plot
