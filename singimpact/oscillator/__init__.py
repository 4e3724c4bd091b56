"""The oscillator x'' + f(x, x') = g(t), x >= c, v -> -r v as data: expressions, exact numbers, a period, a digest.

Not here: points of the tau-axis (`contact`), motion (`flights`), a user's methods (`impact_oscillator`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
