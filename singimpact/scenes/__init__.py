"""Pictures of a user's model: orbits over time, scenes of V_c' and of the plane of states, basins, an interactive page.

Not here: what is drawn (`dynamics`, `surface`, `flights`), text with formulas (`documents`), the paper's figures
(`paper.figures`).
Files: `drawing` (`plot`: one call for everything that can be drawn), `orbit` (x(t), sections), `orbit_sheet` (three
panels), `scene` (a window and its layers), `layer_data` (what layers ask for), `layers`, `cached` (results on disk),
`style` (colours and lines), `basins`, `bifurcation`, `branches`, `manifolds` (W^s and W^u), `horseshoe`, `border` (the
cascade of a border orbit), `both_sides` (of a transition), `label_places` (names beside points), `clearance_frames`,
`flown_in_page` and `explore` (the page; what runs in the browser is in the folder `page`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from singimpact.scenes.drawing import plot as plot
    from singimpact.scenes.scene import Scene as Scene


def __getattr__(name: str) -> Any:
    """`plot` and `Scene`, loaded when they are first used: the page needs neither."""
    if name == "plot":
        from singimpact.scenes.drawing import plot

        return plot
    if name == "Scene":
        from singimpact.scenes.scene import Scene

        return Scene
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
