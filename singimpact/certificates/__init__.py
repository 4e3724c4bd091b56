"""Certified results as files, and the second programs that check them and the proofs of claims.

Not here: how a result is certified (`flights`), how certificates of polynomials are made (`algebra`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
