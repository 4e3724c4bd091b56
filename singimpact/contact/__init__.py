"""Points of the tau-axis by contact order: the jets of a_c, f and rho there; tangency points; swan points of a family.

Not here: the model itself (`oscillator`), zeros of functions (`algebra`), power series built from the jets (`theory`),
flights (`flights`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
