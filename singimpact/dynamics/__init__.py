"""Orbits of many impacts: rest, chatter, gamma and W^s, ensembles, basins, diagrams, regions over two numbers, fits.

Not here: one flight (`flights`), periodic orbits (`branches`), power series of the chatter limit (`theory`), pictures
(`scenes`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
