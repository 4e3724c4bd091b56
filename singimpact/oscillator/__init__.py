"""The oscillator x'' + f(x, x') = g(t), x >= c, v -> -r v as data: expressions, exact numbers, a period, a digest.

Not here: points of the tau-axis and their jets (`contact`), motion (`flights`), a user's methods (`impact_oscillator`).
Files: `model` (the data), `period` (of g), `linear` (linear models recognised), `files` (TOML).
"""
