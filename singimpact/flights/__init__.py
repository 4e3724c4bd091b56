"""One flight: first hit F, impact map G, x and xdot along the way; statuses, conditions, any number of digits.

Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
Files: `hits` (F and G), `inverse`, `tangent` (D G), `sequences` (impacts in a row), `grids` (many orbits), `escape`,
`launch` (states, v = 0); kernel text: `march`, `first_root`, `strides`, `pull`, `chains`, `lanes`, `lane_walk`,
`lane_roots`, `variation`; `polish`, `counted`; `flow/` (how x moves).
"""
