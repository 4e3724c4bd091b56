"""Slow first hits that share no code with `flights`: what the fast ones are checked against.

Not here: what is checked and how it is told (`bench.states`, `bench.steep_states`), other tools (`bench.peers`).
Files: `motions` (x - c, x', x'' at a time, 60 digits), `first_hit` (the first root); `graded_steps` (any acceleration,
fixed steps of order 8 in doubles), `plain_steps` (the same for any model) and `plain_orbits` (impacts, chatter, rest
and lift-off by them); `enclosed_flight` (any analytic f and g
in balls) with `programs` and `sign_pieces`; `drawn_flights` (hits, derivatives and impacts of the states of `bench map`
and `bench orbit`).
"""
