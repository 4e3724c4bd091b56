"""The command `singimpact`: its commands are loaded when they are called.

Not here: anything a Python caller could want too (`impact_oscillator`), nor tables and documents (`documents`).
"""

from singimpact.cli.group import main as main
from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
