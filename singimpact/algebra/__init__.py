"""Numbers on demand, rings, expression trees and jets: algebra that knows no mechanics.

Not here: germs of maps (`germs`), source code from an expression (`codegen`), anything with an oscillator in it.
Files, numbers: `numbers` (what a caller wrote, to any digits), `rings` (kinds of number: rationals, doubles, mpmath,
sympy), `balls` (enclosures), `precision` (the
one place that sets one), `certified` (a number with its radius), `symbols` (polynomials in symbols as numbers),
`long_sums` (these as sympy objects).
Trees: `expressions` (evaluated over a ring, so one tree serves all kinds of number), `parsing` (a user's text into a
tree), `derivatives` (of a tree by a name), `analytic` (trees with their derivatives as programs over balls, nan beside
a branch cut), `taylor` (elementary functions at a point), `puiseux` (a tree in rational powers of a variable).
Jets: `jets`, `polynomials` (what they are made of), `jet_maps` (inverses,
implicit functions, blow-ups), `univariate` (one variable, level by level), `interpolation`, `horner` (on arrays).
Zeros: `solving` (halving, secants, Newton in balls), `roots` (of polynomials), `zeros` (of functions, by balls),
`isolated_zeros` (of systems, all in a box), `double_zeros` (of functions with a parameter).
Proofs: `certificates` (of signs, roots and values) and `derivations` (of substitutions and motions) make certificates;
`gathering` has the collection that they join; `checking` believes one only once checked, with `checked_identities` and
`checked_motions`; `plain` has the checker's polynomials, `sentences` what a certificate says.
"""

from singimpact.handed_on import names_of

_FILES = {
    "balls": "Balls Zero as_rational ball_of",
    "certificates": (
        "collected definite established identical negative_on positive_in positive_on roots_inside sign_chain value_at"
    ),
    "certified": "Certified from_ends",
    "checking": "accepts",
    "derivations": "At substitution",
    "expressions": "FOLDING Number Root evaluate function_of walk",
    "gathering": "Remembered",
    "horner": "Horner",
    "interpolation": "READING interpolated",
    "jet_maps": "blow_up derivation divided implicit inverse_map",
    "jets": "Jet JetSpace",
    "long_sums": "LongSum Monomials Products order_key",
    "numbers": "as_float as_mpf compare constant exact float_array rational_near sign_of",
    "parsing": "from_sympy parse",
    "plain": "times",
    "polynomials": "Exponents",
    "precision": "balls_at series_of_any_length",
    "puiseux": "NoExpansion expansion",
    "rings": "DOUBLES EXACT Exact Multiprecision SYMBOLIC to_sympy",
    "roots": "real_roots",
    "sentences": "sentence",
    "symbols": "SymbolRing",
    "taylor": "NotSmooth",
    "univariate": "precision_of",
}
__getattr__ = names_of(__name__, _FILES)
