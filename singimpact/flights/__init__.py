"""One flight: first hit F, impact map G, x and xdot along the way; statuses, conditions, any number of digits.

Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
Files: `hits` (F and G), `inverse`, `tangent` (D G), `sequences` (impacts in a row), `escape`, `launch` (states, v = 0),
`march`, `first_root`, `strides`, `chains`, `variation` (kernel text), `counted`, `flow/` (how x moves).
"""
