"""One flight: first hit F, impact map G, x and xdot along the way; statuses, conditions, any number of digits.

Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
Files: `hits` (F and G), `launch` (states, v = 0), `march`, `first_root` (kernel text), `flow/` (how x moves).
"""
