"""The self-test of `singimpact selftest` and `si.selftest`: random states of a model, beside independent computations.

Not here: the independent flights (`bench.truth`), random states of many models (`bench.states`, `bench.steep_states`).
Files: `run` (all rows in turn), `rows` (counts and the table), `draws` (states of a model), then the rows: `flights`,
`round_trip`, `truths`, `orbits`, `basin_pixels`, `tangencies`.
"""
