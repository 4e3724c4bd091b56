"""Slow first hits that share no code with `flights`: what the fast ones are checked against.

Not here: what is checked and how it is told (`bench.random_states`, `bench.steep_states`), other tools (`bench.peers`).
"""
