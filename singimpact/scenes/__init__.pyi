"""Names that `scenes` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.scenes.basins_picture import (
    class_colors as class_colors,
    draw_basins as draw_basins,
    draw_first_chatter as draw_first_chatter,
    draw_regions as draw_regions,
)
from singimpact.scenes.branch_picture import bifurcation_sheet as bifurcation_sheet, draw_border as draw_border
from singimpact.scenes.clearance_frames import clearance_film as clearance_film
from singimpact.scenes.drawing import plot as plot
from singimpact.scenes.explore import CURVES as CURVES, explore_page as explore_page
from singimpact.scenes.label_places import place_labels as place_labels
from singimpact.scenes.layer_data import keep as keep, recall as recall
from singimpact.scenes.orbit_picture import orbit_sheet as orbit_sheet
from singimpact.scenes.scene import DPI as DPI, LAYERS as LAYERS, LONGEST_TEXT as LONGEST_TEXT, Scene as Scene
from singimpact.scenes.style import (
    BLACK as BLACK,
    BLUE as BLUE,
    EVENT_PENS as EVENT_PENS,
    GREY as GREY,
    HATCH as HATCH,
    LINES as LINES,
    MARKS as MARKS,
    ON_DARK as ON_DARK,
    PENS as PENS,
    SURFACE as SURFACE,
    VERMILLION as VERMILLION,
    WHITE as WHITE,
    Pen as Pen,
    darken as darken,
    new_axes as new_axes,
    on_dark as on_dark,
    orbit_color as orbit_color,
    orbit_width as orbit_width,
)
