"""Orbits of many impacts: rest, chatter, gamma and W^s, basins, bifurcation diagrams.

Not here: one flight (`flights`), periodic orbits (`branches`), power series of the chatter limit (`theory`), pictures
(`scenes`).
Files: `orbit` (impacts, rest and chatter in order), `sampling` (x and x' of an orbit at times), `lyapunov` (its
exponents), `gamma_proof` (gamma proved, a folder), `release` (when a mass lifts off), `chatter`
(when impacts end), `completion` (its map), `remaining` (its terms in doubles),
`fractional_chatter` (for rho that is not smooth at rest), `gathered` (results of many states),
`threshold` (the velocity between complete and incomplete chatter), `enclosed` (both in balls, of linear models),
`guide` (a velocity on gamma in many digits, not proved),
`growth` (an invariant curve of a map, cut at discontinuities),
`invariant_arcs` (gamma and the stable manifolds, grown), `swan_configuration` (the named points of an unfolded swan),
`attractors`, `nearby_orbit` (beside a state that almost returns), `settling` (which one is reached), `basins`,
`long_run` (what follows a rest), `bifurcation`.
"""
