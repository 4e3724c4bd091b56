"""Every public numerical function towards each of its bad places, judged against 60 digits in units of rounding.

Not here: the slow impact map (`bench.truth`), random states (`bench.states`), run time (`bench.groups`).
Files: `table` (what is run, and how it is shown), `judging` (units, the worst trial), `launches` (states towards each
place), `layered` (impacts of steep models in balls), then the functions by what they need: `flown`, `chattered`,
`everyday` (starts off the wall, Lyapunov exponents), `repeated` (periodic orbits), `traced` (curves), `expanded`
(series), `named` (points and constants).
"""
