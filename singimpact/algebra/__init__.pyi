"""Names that `algebra` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.algebra.analytic import Recorder as Recorder
from singimpact.algebra.balls import (
    BITS_A_DIGIT as BITS_A_DIGIT,
    Balls as Balls,
    Zero as Zero,
    as_rational as as_rational,
    ball_of as ball_of,
)
from singimpact.algebra.certificates import (
    Box as Box,
    collected as collected,
    definite as definite,
    identical as identical,
    negative_on as negative_on,
    positive_in as positive_in,
    positive_on as positive_on,
    sign_chain as sign_chain,
    value_at as value_at,
)
from singimpact.algebra.certified import (
    Certified as Certified,
    from_ball as from_ball,
    from_ends as from_ends,
    text_of as text_of,
)
from singimpact.algebra.derivations import At as At, motion as motion, substitution as substitution
from singimpact.algebra.derivatives import derivative as derivative
from singimpact.algebra.expressions import (
    FOLDING as FOLDING,
    Expression as Expression,
    Name as Name,
    Number as Number,
    Power as Power,
    Root as Root,
    add as add,
    evaluate as evaluate,
    function_of as function_of,
    multiply as multiply,
    names_in as names_in,
    negate as negate,
    number as number,
    substitute as substitute,
    subtract as subtract,
    walk as walk,
)
from singimpact.algebra.gathering import Remembered as Remembered, left_behind as left_behind
from singimpact.algebra.horner import Horner as Horner
from singimpact.algebra.interpolation import READING as READING, interpolated as interpolated
from singimpact.algebra.isolated_zeros import IsolatedZeros as IsolatedZeros
from singimpact.algebra.jets import Jet as Jet, JetSpace as JetSpace
from singimpact.algebra.long_sums import (
    LongSum as LongSum,
    Monomials as Monomials,
    Products as Products,
    order_key as order_key,
    primed as primed,
)
from singimpact.algebra.numbers import (
    EPSILON as EPSILON,
    Array as Array,
    as_float as as_float,
    as_fraction as as_fraction,
    as_mpf as as_mpf,
    compare as compare,
    constant as constant,
    exact as exact,
    float_array as float_array,
    near_rational as near_rational,
    rational_ends as rational_ends,
    rational_near as rational_near,
    sign_of as sign_of,
)
from singimpact.algebra.parsing import DEFINITIONS as DEFINITIONS, from_sympy as from_sympy, parse as parse
from singimpact.algebra.polynomials import Exponents as Exponents
from singimpact.algebra.precision import (
    Ladder as Ladder,
    balls_at as balls_at,
    digits_at as digits_at,
    for_user as for_user,
    series_of_any_length as series_of_any_length,
)
from singimpact.algebra.puiseux import NoExpansion as NoExpansion, expansion as expansion
from singimpact.algebra.rings import (
    DOUBLES as DOUBLES,
    EXACT as EXACT,
    SYMBOLIC as SYMBOLIC,
    Exact as Exact,
    Multiprecision as Multiprecision,
    SymbolRing as SymbolRing,
    to_sympy as to_sympy,
)
from singimpact.algebra.solving import halved as halved, newton_in_balls as newton_in_balls, secant as secant
from singimpact.algebra.taylor import NotSmooth as NotSmooth
from singimpact.algebra.univariate import precision_of as precision_of, real_roots as real_roots
