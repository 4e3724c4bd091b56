"""Pictures of a user's model: orbits over time, scenes of V_c' and of the plane of states, basins, an interactive page.

Not here: what is drawn (`dynamics`, `surface`, `flights`), text with formulas (`documents`), the paper's figures
(`paper.figures`).
"""

from typing import TYPE_CHECKING

from singimpact.handed_on import names_of

if TYPE_CHECKING:
    from singimpact.scenes.drawing import plot as plot
    from singimpact.scenes.scene import Scene as Scene

_FILES = {
    "basins_picture": "class_colors draw_basins draw_first_chatter",
    "branch_picture": "bifurcation_sheet draw_border",
    "clearance_frames": "clearance_film",
    "drawing": "plot",
    "explore": "CURVES explore_page",
    "scene": "LAYERS LONGEST_TEXT Scene",
    "layer_data": "keep recall",
    "style": "BLUE EVENT_PENS LINES MARKS ON_DARK PENS Pen VERMILLION new_axes on_dark orbit_color orbit_width",
}
__getattr__ = names_of(__name__, _FILES)
