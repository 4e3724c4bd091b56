"""The self-test of `singimpact selftest` and `si.selftest`: random states of a model, beside independent computations.

Not here: the independent flights and orbits (`bench.truth`), random states of many models (`bench.states`,
`bench.steep_states`).
Files: `run` (all rows in turn), `rows` (counts and the table), `draws` (states of a model), then the rows, whose
docstrings say which truth they have and what it shares with the package: `round_trip` (none: the package against
itself), `truths` (fixed steps, balls, digits), `orbits` (events of orbits, chatter limits), `responses` (D G, rho),
`batches` (all states of arrays, both sides of grazes), `basin_pixels` with `fates` (one orbit followed by itself),
`tangencies` (signs of a_c).
"""
