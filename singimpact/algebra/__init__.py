"""Numbers on demand, rings, expression trees and jets: algebra that knows no mechanics.

Not here: germs of maps (`germs`), source code from an expression (`codegen`), anything with an oscillator in it.
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
