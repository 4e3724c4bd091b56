"""Errors of every public numerical function near its singular points and parameters, against 60 digits.

Not here: the slow impact map (`bench.truth`), random states (`bench.random_states`), run time (`bench.groups`).
"""
