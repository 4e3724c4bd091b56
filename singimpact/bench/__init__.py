"""Run time against error beside what a user would pick instead; stress sweeps; reference values as package data.

Not here: what is measured (`flights`, `surface`, `dynamics`), claims of the paper (`paper`), pictures (`scenes`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
