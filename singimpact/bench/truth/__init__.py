"""Slow first hits that share no code with what they judge.

Doubles are judged by closed forms (`first_hit`), fixed steps (`graded_steps`, `plain_orbits`) and
enclosures; enclosures by the program that checks certificates (`hit_in_balls`).
Not here: which states are judged (`bench.random_states`, `bench.steep_states`, `bench.selftest`), other tools
(`bench.peers`).
"""
