"""Periodic orbits, their branches and events over a parameter, border orbits, and manifolds of saddles.

Not here: orbits that are not periodic (`dynamics`), the flights of a family of models (`flights.family`),
pictures (`scenes`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
