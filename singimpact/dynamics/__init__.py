"""Flights after flights: orbits, sticking, chatter, gamma and W^s, basins, bifurcation diagrams.

Not here: one flight (`flights`), orbits that close (`branches`), power series of the chatter's end (`theory`), pictures
of an orbit (`scenes`).
Files: `orbit` (impacts, rest and chatter in order), `sampling` (x and x' of an orbit at times), `lyapunov` (its
exponents), `release` (when a mass lifts off), `chatter` (when impacts end), `completion` (its map), `remaining` (its
terms in doubles), `gathered` (results of many states), `threshold` (the velocity between complete and incomplete
chatter), `enclosed` (both in balls, of linear models), `guide` (a velocity on gamma in many digits, not proved),
`growth` (a curve that a map carries over itself, cut where it is torn),
`invariant_arcs` (gamma and the stable manifolds, grown), `swan_configuration` (the named points of an unfolded swan),
`attractors`, `basins`, `long_run` (what orbits do for ever), `bifurcation`.
"""
