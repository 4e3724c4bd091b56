"""Pictures: orbits over time, scenes of V_c' and of the plane of states, the paper's figures, basins.

Not here: what is drawn (`dynamics`, `surface`, `flights`), text with formulas (`documents`).
Files: `drawing` (`plot`: one call for everything that can be drawn), `orbit` (x(t)), `scene` (a window and its layers),
`needs` (what layers ask for), `layers`, `kept` (results on disk), `looks` (colours and lines), `figures/` 1 to 17,
`clearance_frames` and `explore` (the page).
"""

from singimpact.scenes.drawing import plot as plot
from singimpact.scenes.scene import Scene as Scene
