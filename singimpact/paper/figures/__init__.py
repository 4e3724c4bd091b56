"""The paper's figures 1 to 17, and B1 to B9 beyond it, from computed data of real oscillators.

Not here: what they show (`surface`, `dynamics`), what is claimed of it (`paper.claims`), pictures of a user's model
(`scenes`).
Files: `registry` (number -> function), then one file a group that shares an idea: `outlines` (1, 2), `contact`
(3 to 8), `sections` (9, 10), `swans` (11, 12, 14, 15), `unfolded` (13, 16, 17), `corrections` (B1 to B3), `loops`
(B4 to B6), `met` (B7, B8), `hertz` (B9); `sheet` (p and phi at points of V'),
`panel` (a figure as data), `rendering` (drawn by matplotlib), `cached` (on disk).
"""

from singimpact.paper.figures.registry import BEYOND as BEYOND
from singimpact.paper.figures.registry import FIGURES as FIGURES
from singimpact.paper.figures.registry import figure as figure
from singimpact.paper.figures.registry import picture as picture
