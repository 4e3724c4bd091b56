"""One flight: first hit F, impact map G, x and x' along the way; statuses, conditions, any number of digits.

`impact_map` (F and G), `off_wall` (starts above the wall), `derivative` (D G), `inverse_map`, `path`, `orbits` (impacts
in a row; many orbits) are asked by users; `states` are read once, `results` come back. `compiled_model` holds all that
a model needs and is the one caller of the kernels: `kernels/` are plain modules, `bind` puts them over numbers,
`machine` keeps them compiled, `compiler_process` compiles them, `interpreted` runs them until then; `model_numbers`,
`phase`, `limits` are what it is made from. `undecided` decides flights that end in no plain hit: `no_return/` proves
that none returns, `closing` that one touches, `causes` says why one is open. `in_digits` flies states with many digits:
`certified_flights` proves them by closed forms (`balls`, `short_balls`) or in `enclosures/`, `enclosed_impact` boxes of
them; `multiprecision` flies the rest.
`horizons` says when a flight is given up. `response` and `rebound_law` are derivatives at a hit and what the impact
makes of them, `determinant` that of D G; `counted` counts flights,
`together` makes many flights at rest at once on arrays, `family` flies models with derivatives by their numbers,
`blocks` cuts large arrays, `interruptible` makes long calls hear Ctrl-C.
Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
"""
