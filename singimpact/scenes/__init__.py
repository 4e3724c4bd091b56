"""Pictures of a user's model: orbits over time, scenes of V_c' and of the plane of states, basins, an interactive page.

Not here: what is drawn (`dynamics`, `surface`, `flights`), text with formulas (`documents`), the paper's figures
(`paper.figures`).
Files: `drawing` (`plot`: one call for everything that can be drawn), `orbit` (x(t), sections), `scene` (a window and
its layers), `layer_data` (what layers ask for), `layers`, `cached` (results on disk), `style` (colours and lines),
`basins`, `branches`, `manifolds` (W^s and W^u), `both_sides` (of a transition), `label_places` (names beside points),
`clearance_frames` and `explore` (the page).
"""

from singimpact.scenes.drawing import plot as plot
from singimpact.scenes.scene import Scene as Scene
