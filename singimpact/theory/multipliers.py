"""lambda, mu and the fixed points as functions of r: exactly in lambda, as series at both ends, as algebraic functions.

At contact order j, r = lambda^(j+1) P_j/Q_j.  At r = 0 the variable is w = (r/(j+1))^(1/(j+1)), at r = 1 it is 1 - r;
all series have rational coefficients.
"""

from fractions import Fraction
from typing import Any

import sympy
from flint import fmpq, fmpq_poly, fmpq_series

from singimpact.algebra.derivations import At, motion, substitution
from singimpact.algebra.gathering import remembered
from singimpact.algebra.precision import series_of_any_length
from singimpact.contact.contact import contact_order
from singimpact.inputs import checked_keywords, refuse, require

# The homogeneous models x'' = s^j: the leading part of the theory at contact order j, in closed form.
#
# With launch time sigma and landing time e, the launch velocity is homogeneous of degree j + 1.  On the invariant curve
# e = lambda sigma, and invariance under v -> -r v fixes r as a rational function of the multiplier lambda.

lambda_ = sympy.Symbol("lambda")
_s, _e, _v, _t, _X, _Y = sympy.symbols("s e v t X Y")  # in certificates; _e is the landing time


def launch_velocity(j: int, sigma: Any, e: Any) -> Any:
    """Launch velocity of the flight of x'' = s^j from sigma to e: ((j+2) sigma^(j+1) - h_(j+1))/((j+1)(j+2)).

    h_n is the complete homogeneous polynomial sum sigma^i e^(n-i).  The impact velocity is the same with sigma and e
    exchanged (the involution).
    """
    complete = sum(sigma**i * e ** (j + 1 - i) for i in range(j + 2))
    return ((j + 2) * sigma ** (j + 1) - complete) / ((j + 1) * (j + 2))


@remembered
def P(j: int) -> Any:
    """P_j(lambda) = sum (j+1-i) lambda^i: the launch velocity at (1, lambda) without its factor 1 - lambda."""
    return _without_zero(j, sympy.Integer(1), lambda_)


def _without_zero(j: int, sigma: Any, e: Any) -> Any:
    """The launch velocity times (j + 1)(j + 2) without its factor sigma - e, a polynomial in lambda."""
    ratio = sympy.cancel((j + 1) * (j + 2) * launch_velocity(j, sigma, e) / (sigma - e))
    found = sympy.Poly(ratio, lambda_).as_expr()
    substitution(At((sigma - e) * _X, {_X: found}), At((j + 1) * (j + 2) * _launched(j), {_s: sigma, _e: e}))
    return found


@remembered
def _launched(j: int) -> Any:
    """The launch velocity as a polynomial in s and e, with the motion that it belongs to."""
    found = sympy.expand(launch_velocity(j, _s, _e))
    poly = sympy.Poly((_s + _t) ** j, _t)
    height = _v * _t + sum(value * _t ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in poly.terms())
    back = sympy.expand(found.subs(_e, _s + _t))
    motion((_s, _v, _t), sympy.expand(height), [sympy.Integer(int(n == j)) for n in range(j + 1)], {}, launch=back)
    substitution(At(found, {_e: _s + _t}), back)
    return found


@remembered
def Q(j: int) -> Any:
    """Q_j(lambda): the reversal of P_j, which the involution makes of it."""
    return _without_zero(j, lambda_, sympy.Integer(1))


@checked_keywords
@remembered
def r_of_lambda(j: int) -> Any:
    """The restitution whose invariant curve has multiplier lambda: r = lambda^(j+1) P_j/Q_j.

    Parameters
    ----------
    j : contact order, 1 at a tangency, 2 at a swan.

    Examples
    --------
    >>> r_of_lambda(1)
    lambda**2*(lambda + 2)/(2*lambda + 1)
    """
    ratio = lambda_ ** (j + 1) * sympy.factor(P(j)) / sympy.factor(Q(j))
    again = At(lambda_ ** (j + 1) * _launched(j), {_s: sympy.Integer(1), _e: lambda_})
    landed = _launched(j).subs({_s: _e, _e: _s}, simultaneous=True)  # the involution
    substitution(At(-_X * landed, {_X: ratio, _s: sympy.Integer(1), _e: lambda_}), again)
    return ratio


@remembered
def mu_of_lambda(j: int) -> Any:
    """The transverse multiplier of the blown-up map at its fixed point: (P_j/Q_j)^2/lambda.

    Examples
    --------
    >>> mu_of_lambda(1)
    (lambda + 2)**2/(lambda*(2*lambda + 1)**2)
    """
    ratio = sympy.factor((P(j) / Q(j)) ** 2 / lambda_)
    y = sympy.Symbol("y")  # a flight from 1 to lambda + y is followed by one to (lambda + y)(lambda + mu y)
    landing = lambda_ + y
    landed = _launched(j).subs({_s: _e, _e: _s}, simultaneous=True)
    again = At(_launched(j), {_s: landing, _e: landing * (lambda_ + ratio * y)})
    reset = At(-_X * landed, {_X: r_of_lambda(j), _s: sympy.Integer(1), _e: landing})
    substitution(again, reset, order=1, small=[y])
    return ratio


@remembered
def leading_coefficient(j: int) -> Any:
    """gamma: v = a_j (1-lambda) P_j/((j+1)(j+2)) sigma^(j+1) + ..., a_j = a^(j)/j!; the factor beside a_j."""
    found = sympy.factor((1 - lambda_) * P(j) / ((j + 1) * (j + 2)))
    substitution(At(_launched(j), {_s: sympy.Integer(1), _e: lambda_}), At(_X, {_X: found}))
    return found


@remembered
def DG_on_ray(j: int) -> Any:
    """DG of the homogeneous model at sigma = 1 on its invariant ray, in (tau, v), as a function of lambda.

    G takes (s, nu(s, e)) to (e, -r nu(e, s)).  At the point sigma of the ray the entries scale with powers of sigma
    that leave trace and determinant alone, so the eigenvalues are the same all along gamma to leading order.

    Examples
    --------
    >>> sympy.factor(DG_on_ray(1).det())
    lambda**2*(lambda + 2)**2/(2*lambda + 1)**2
    """
    s, e = sympy.symbols("s e")
    launch, impact = launch_velocity(j, s, e), -r_of_lambda(j) * launch_velocity(j, e, s)
    before = sympy.Matrix([s, launch]).jacobian([s, e])
    after = sympy.Matrix([e, impact]).jacobian([s, e])
    matrix = (after * before.inv()).subs({s: 1, e: lambda_}).applyfunc(sympy.cancel)
    x, y = sympy.symbols("x y")  # G takes (s, nu(s, e)) to (e, -r nu(e, s)): so it does to first order at (1, lambda)
    moved = {_s: 1 + x, _e: lambda_ + y}
    before = [_s - 1, _launched(j) - leading_coefficient(j)]
    landed = _launched(j).subs({_s: _e, _e: _s}, simultaneous=True)
    after = [_e - lambda_, -r_of_lambda(j) * (landed - landed.subs({_s: 1, _e: lambda_}))]
    for row, entry in zip(matrix.tolist(), after, strict=True):
        linear = At(row[0] * before[0] + row[1] * before[1], moved)
        substitution(linear, At(entry, moved), order=1, small=[x, y])
    return matrix


@remembered
def eigenvalues_on_gamma(j: int) -> tuple[Any, Any]:
    """(larger, smaller) eigenvalue of DG(w) as w tends to the contact point along gamma, in lambda."""
    matrix = DG_on_ray(j)
    trace, determinant = sympy.cancel(matrix.trace()), sympy.cancel(matrix.det())
    root = sympy.sqrt(sympy.factor(trace**2 - 4 * determinant))
    return (sympy.factor(trace) + root) / 2, (sympy.factor(trace) - root) / 2


Series = list[Fraction]
OFFSETS = {"m3": fmpq(1, 2), "m_star": fmpq(-1), "lambda": fmpq(0)}


def of_m(at: str | int = "tangency") -> dict[str, Any]:
    """r, lambda and mu as rational functions of m: m3 = lambda + 1/2 at a tangency, m_* = lambda - 1 elsewhere.

    Examples
    --------
    >>> of_m("tangency")["r"]
    (2*m - 1)**2*(2*m + 3)/(16*m)
    """
    j, m = _order(at), sympy.Symbol("m")
    rate = m - (sympy.Rational(1, 2) if j == 1 else -1)
    functions = {"r": r_of_lambda(j), "lambda": lambda_, "mu": mu_of_lambda(j)}
    return {name: sympy.factor(value.subs(lambda_, rate)) for name, value in functions.items()}


def minimal_polynomial(quantity: str, at: str | int = "tangency") -> Any:
    """The minimal polynomial over Q(r) of lambda or mu, in x and r.

    Examples
    --------
    >>> minimal_polynomial("lambda", "tangency")
    Poly(x**3 + 2*x**2 - 2*x*r - r, x, r, domain='ZZ')
    """
    j = _order(at)
    x, r = sympy.symbols("x r")
    above = sympy.fraction(sympy.together(r_of_lambda(j) - r))[0]
    if quantity == "lambda":
        return sympy.Poly(above.subs(lambda_, x), x, r)
    require(quantity == "mu", "quantity", quantity, "'lambda' or 'mu'")
    numerator, denominator = sympy.fraction(mu_of_lambda(j))
    resultant = sympy.resultant(above, sympy.expand(x * denominator - numerator), lambda_)
    factors = [factor for factor, _ in sympy.factor_list(resultant, x, r)[1] if factor.has(x) and factor.has(r)]
    half = sympy.Rational(1, 2)
    root = next(z for z in sympy.Poly(above.subs(r, half), lambda_).nroots(n=30) if z.is_real and 0 < z < 1)
    value = mu_of_lambda(j).subs(lambda_, root)
    (factor,) = [f for f in factors if abs(f.subs({r: half, x: value})) < 1e-15]
    return sympy.Poly(factor, x, r)


def series(quantity: str, end: int, order: int, at: str | int = "tangency") -> Series:
    """Coefficients of a power series of lambda, m3, m_star or mu at an end of 0 < r < 1.

    Parameters
    ----------
    quantity : "lambda", "m3" (tangency), "m_star" (other contacts), or "mu"; at r = 0 mu has a pole, and the series
        is that of w mu.
    end : 0 for powers of w = (r/(j+1))^(1/(j+1)), 1 for powers of 1 - r. order : the last power.

    Examples
    --------
    >>> [str(c) for c in series("lambda", 1, 2)]
    ['1', '-3/5', '-3/25']
    """
    j = _order(at)
    require(end in (0, 1), "end", end, "0 or 1")
    if isinstance(order, bool) or not isinstance(order, int) or not 0 <= order <= 200:
        raise refuse("order", order, "a whole number from 0 to 200")
    if quantity not in (*OFFSETS, "mu") or (quantity == "m3") > (j == 1) or (quantity == "m_star") > (j != 1):
        raise refuse("quantity", quantity, "'lambda', 'mu', 'm3' at a tangency or 'm_star' elsewhere")
    with series_of_any_length():
        rate = (_at_zero if end == 0 else _at_one)(j, order + 1)
        if quantity == "mu":
            return _numbers(_mu(j, rate, end, order), order + 1)
        return _numbers(rate + fmpq_series([OFFSETS[quantity]], prec=order + 2), order + 1)


def _numbers(values: fmpq_series, count: int) -> Series:
    return [Fraction(int(values[n].p), int(values[n].q)) for n in range(count)]


def _order(at: str | int) -> int:
    j = contact_order(at)
    require(j >= 1, "at", at, "'tangency', 'swan' or a contact order from 1 on")
    return j


def _coefficients(polynomial: Any) -> fmpq_poly:
    """A polynomial in lambda with whole coefficients."""
    return fmpq_poly([int(value) for value in reversed(sympy.Poly(polynomial, lambda_).all_coeffs())])


def _at_zero(j: int, order: int) -> fmpq_series:
    """lambda in powers of w, from lambda ((P/Q)/(j+1))^(1/(j+1)) = w."""
    p, q = (fmpq_series(_coefficients(part), prec=order + 1) for part in (P(j), Q(j)))
    root = ((p / q / (j + 1)).log() / (j + 1)).exp()
    return (root * fmpq_series([0, 1], prec=order + 1)).reversion()


def _at_one(j: int, order: int) -> fmpq_series:
    """lambda in powers of 1 - r: 1 - u with 1 - r(1 - u) a series in u that begins with a linear term."""
    p, q = (_coefficients(part)(fmpq_poly([1, -1])) for part in (lambda_ ** (j + 1) * P(j), Q(j)))
    rate = fmpq_series(p, prec=order + 1) / fmpq_series(q, prec=order + 1)
    return 1 - (1 - rate).reversion()


def _mu(j: int, rate: fmpq_series, end: int, order: int) -> fmpq_series:
    """(P/Q)^2/lambda along a series of lambda; at r = 0 times w."""
    p, q = (
        sum((fmpq_series([c]) * rate**n for n, c in enumerate(_coefficients(part).coeffs())), 0 * rate)
        for part in (P(j), Q(j))
    )
    return p * p / (q * q * (fmpq_series(rate.coeffs()[1:], prec=order + 1) if end == 0 else rate))
