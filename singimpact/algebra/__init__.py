"""Numbers on demand, rings, expression trees and jets: algebra that knows no mechanics.

Not here: germs of maps (`germs`), source code from an expression (`codegen`), anything with an oscillator in it.
"""

from singimpact.handed_on import names_of

_FILES = {
    "balls": "Balls Zero as_rational ball_of",
    "certificates": (
        "collected definite identical left_behind negative_on positive_in positive_on sign_chain value_at"
    ),
    "certified": "Certified from_ball from_ends",
    "derivations": "At substitution",
    "expressions": "FOLDING Number Root evaluate function_of walk",
    "gathering": "Remembered",
    "horner": "Horner",
    "interpolation": "READING interpolated",
    "jets": "Jet JetSpace",
    "long_sums": "LongSum Monomials Products order_key primed",
    "numbers": "Array EPSILON as_float as_mpf compare constant exact float_array rational_near sign_of",
    "parsing": "DEFINITIONS from_sympy parse",
    "polynomials": "Exponents",
    "precision": "balls_at series_of_any_length",
    "puiseux": "NoExpansion expansion",
    "rings": "DOUBLES EXACT Exact Multiprecision SYMBOLIC SymbolRing to_sympy",
    "taylor": "NotSmooth",
    "univariate": "precision_of real_roots",
}
__getattr__ = names_of(__name__, _FILES)
