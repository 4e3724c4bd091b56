"""A slow impact map in balls of 60 digits that shares no code with `flights`: what the fast one is checked against.

Not here: what is checked and how it is told (`bench.states`), tools that a user would pick instead (`bench.peers`).
Files: `motions` (x - c, x', x'' at a time), `first_hit` (the first root).
"""
