"""The self-test of `singimpact selftest` and `si.selftest`: random states of a model, beside independent computations.

Not here: the independent flights and orbits (`bench.truth`), random states of many models (`bench.random_states`,
`bench.steep_states`).
"""
