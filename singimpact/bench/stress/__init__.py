"""Errors of every public numerical function near its singular points and parameters, against 60 digits.

Not here: the slow impact map (`bench.truth`), random states (`bench.states`), run time (`bench.groups`).
Files: `table` (the list of runs and their table), `judging` (units, the worst trial), `launches` (states towards each
place), `layered` (impacts of steep models in balls), then the functions by subject: `flown`, `chattered`,
`everyday` (starts off the wall, Lyapunov exponents), `repeated` (periodic orbits), `traced` (curves), `expanded`
(series), `named` (points and constants).
"""
