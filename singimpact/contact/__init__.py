"""Points of the tau-axis by contact order: the jets of a_c, f and rho there; tangency points; swan points of a family.

Not here: the model itself (`oscillator`), power series built from the jets (`theory`), flights (`flights`).
Files: `contact` (the jets at a point), `zeros` (real zeros isolated by balls), `points` (tangency and swan points).
"""
