"""Contact points of every order j: one ray that carries gamma, a saddle for every r, and on which side it lies.

Before them a bound that section 4(b) needs on its rays, and that the paper does not have.

The model is x'' = s^j; l is the ratio of landing and launch time, and L stands for l^j, so that an identity in l, L and
j holds for every j.  P and Q are the polynomials of `theory.multipliers`.
"""

from typing import Any

import sympy

from singimpact.algebra import At, positive_in, positive_on, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section4b import SLACK
from singimpact.paper.claims.verifiers import every, is_zero, same
from singimpact.paper.routes.implicit import r
from singimpact.theory.multipliers import DG_on_ray, P, Q, lambda_, mu_of_lambda, r_of_lambda

ell, L, j, i, V, W = sympy.symbols("l L j i V W")
CLOSED_P = (j + 1) - (j + 2) * ell + ell**2 * L  # (1 - l)^2 P
CLOSED_Q = 1 - (j + 2) * ell * L + (j + 1) * ell**2 * L  # (1 - l)^2 Q
SHOWN = 12  # orders up to which a sign is decided one by one
TURNED = 15  # orders up to which negative ratios are counted


def closed_forms() -> list[tuple[str, bool]]:
    """(1 - l)^2 P and (1 - l)^2 Q for every j.

    They follow from the motion x = v (s - 1) + (s^(j+2) - 1 - (j+2)(s - 1))/((j+1)(j+2)).
    """
    height = V * (ell - 1) + (ell**2 * L - 1 - (j + 2) * (ell - 1)) / ((j + 1) * (j + 2))
    launch = CLOSED_P / ((1 - ell) * (j + 1) * (j + 2))  # v = (1 - l) P/((j+1)(j+2))
    speed = -(V + (ell * L - 1) / (j + 1))  # -x' at the landing
    landing = CLOSED_Q / ((1 - ell) * (j + 1) * (j + 2))
    substitution(At(height, {V: launch}), sympy.Integer(0))
    substitution(At(speed, {V: launch}), landing)
    tried = all(
        is_zero(sympy.expand(closed.subs(j, order).subs({L: ell**order}) - (1 - ell) ** 2 * derived.subs(lambda_, ell)))
        for order in range(1, SHOWN + 1)
        for closed, derived in ((CLOSED_P, P(order)), (CLOSED_Q, Q(order)))
    )
    coefficient = j + 1 - i  # of l^i in P: second differences vanish, which leaves the ends of (1 - l)^2 P
    second = sympy.expand(coefficient - 2 * coefficient.subs(i, i - 1) + coefficient.subs(i, i - 2))
    reversed_ = coefficient.subs(i, j - i)  # of l^i in Q
    # coefficients of 1, l, l^(j+1) and l^(j+2) in (1 - l)^2 P and (1 - l)^2 Q
    ends = all(
        same(derived, stated)
        for polynomial, closed in ((coefficient, (j + 1, -(j + 2), 0, 1)), (reversed_, (1, 0, -(j + 2), j + 1)))
        for derived, stated in zip(
            (
                polynomial.subs(i, 0),
                polynomial.subs(i, 1) - 2 * polynomial.subs(i, 0),
                polynomial.subs(i, j - 1) - 2 * polynomial.subs(i, j),
                polynomial.subs(i, j),
            ),
            closed,
            strict=True,
        )
    )
    return [
        (
            "(1-l)^2 P = j+1 - (j+2) l + l^(j+2), (1-l)^2 Q = 1 - (j+2) l^(j+1) + (j+1) l^(j+2) for every j, from "
            "x'' = s^j",
            is_zero(height.subs(V, launch)) and same(speed.subs(V, launch), landing),
        ),
        (
            "so P = sum (j+1-i) l^i and Q = sum (i+1) l^i, i <= j, for every j: second differences of the "
            f"coefficients vanish, and the ends are those above; j = 1..{SHOWN} one by one agree",
            is_zero(second) and ends and tried,
        ),
    ]


def _ray(count: int) -> Check:
    """The number of rays l > 0 of flights with one ratio, for each r in (0, 1) and every j."""
    spare = sympy.factor(j * (i + 1) - i * (i + 1))  # coefficient of l^i in j Q - l Q'
    rising = same(spare, (j - i) * (i + 1))
    # the coefficients of P are those of Q in reverse, so P(1) = Q(1)
    ends = same((j + 1 - i).subs(i, j - i), i + 1) and all(
        rate == 1 for rate in (sympy.cancel(r_of_lambda(order)).subs(lambda_, 1) for order in range(1, SHOWN + 1))
    )
    return every(
        [
            *closed_forms(),
            (
                f"j Q - l Q' has the coefficients {spare} >= 0, P and Q positive ones: so l d/dl log(l^(j+1) P/Q) "
                ">= 1 for l > 0",
                rising,
            ),
            ("l^(j+1) P/Q rises from 0 at 0 to 1 at 1: one ray for each r, and it has l < 1", ends and count == 1),
        ]
    )


def _saddle(power: int) -> Check:
    """mu > l^(-power) for every j and l in (0, 1); the other multiplier is l < 1."""
    difference = sympy.expand((j + 1 - i) - (i + 1))  # coefficient of l^i in P - Q
    odd = same(difference.subs(i, j - i), -difference)
    low = [order for order in (1, 2, 3) if not _positive((mu_of_lambda(order) - lambda_**-power) * lambda_**3)]
    return every(
        [
            *closed_forms(),
            (
                f"P - Q has the coefficients {difference}, odd under i -> j - i: it is sum (j - 2i)(l^i - l^(j-i)) "
                "> 0, 2i < j",
                odd,
            ),
            (f"mu = (P/Q)^2/l, so mu > 1/l; stated: l^-{power}, which fails at j in {low}", power <= 1 and not low),
        ],
        witness=lambda: {"j": str(low[:1]), "mu": f"not above l^-{power} for all l"},
    )


def _positive(expression: sympy.Expr) -> bool:
    return positive_on(sympy.cancel(expression), lambda_, 0, 1)


def _along(expression: sympy.Expr) -> Any:
    """l d/dl, where L stands for l^j."""
    return sympy.expand(ell * sympy.diff(expression, ell) + j * L * sympy.diff(expression, L))


def multipliers() -> list[tuple[str, bool]]:
    """mu = (P/Q)^2/l and det DG = l^(j+1) (P/Q)^2 for every j, with W = (1-l) P of the launch and Z = (1-l) Q of the
    landing: W(l') = r Z(l)/l^(j+1)."""
    launch, landing = CLOSED_P / (1 - ell), CLOSED_Q / (1 - ell)
    slopes = -CLOSED_Q / (1 - ell) ** 2, ((j + 1) * landing - CLOSED_P / (1 - ell) ** 2) / ell
    rates = [sympy.cancel(sympy.diff(w, ell) + j * L / ell * sympy.diff(w, L)) for w in (launch, landing)]
    holds = all(is_zero(rate - slope) for rate, slope in zip(rates, slopes, strict=True))
    if holds:
        moved = {ell: ell + V, L: L * (1 + j * V / ell)}  # l^j at l + V, to first order
        for velocity, slope in zip((launch, landing), slopes, strict=True):
            substitution(At(velocity, moved), velocity + V * slope, order=1, small=[V])
    return [
        (
            "dW/dl = -Q and l dZ/dl - (j+1) Z = -P for every j, so mu = r P/(l^(j+2) Q) = (P/Q)^2/l and "
            "det DG = r P/Q = l^(j+1) (P/Q)^2",
            holds,
        )
    ]


def rising(power: int = 1) -> list[tuple[str, bool]]:
    """l^(j power) (P/Q)^3 rises from 0 to 1 on (0, 1) for every j; it does not for another power than 1.

    l d/dl of its logarithm is E/(P Q) with E = (1-l)^2 q, and q has positive coefficients.
    """
    wronskian = _along(CLOSED_P) * CLOSED_Q - CLOSED_P * _along(CLOSED_Q)
    sparse = sympy.expand(j * power * CLOSED_P * CLOSED_Q + 3 * wronskian)  # (1-l)^4 E
    terms = sympy.Poly(sparse, ell, L).as_dict()
    zeros = all(
        is_zero(sum((value * (n + m * j) ** k for (n, m), value in terms.items()), sympy.Integer(0))) for k in range(6)
    )
    mirrored = all(is_zero(value - terms.get((4 - n, 2 - m), 0)) for (n, m), value in terms.items())
    early = {n: value for (n, m), value in terms.items() if m == 0}  # those that reach l^i, i < j
    bare = sympy.expand(early.get(0, 0) * (i + 5) + early.get(1, 0) * i)
    half = set(early) <= {0, 1} and zeros and mirrored
    k = sympy.Symbol("k")  # i = j - 1 - k
    return [
        (f"(1-l)^4 E has {len(terms)} terms, the same from both ends, and a zero of order 6 at l = 1", half),
        (
            f"so E = (1-l)^2 q, where l^i, i < j, has the coefficient C(i+4, 4) ({sympy.factor(bare)})/5 > 0, and the "
            "others mirror these",
            half and positive_in(bare.subs(i, j - 1 - k), {j: (0, sympy.oo), k: (0, sympy.oo)}),
        ),
        (
            f"E/(P Q) is l d/dl log(l^(j {power}) (P/Q)^3), and l^(j {power}) (P/Q)^3 is 1 at l = 1: below 1 on (0, 1)",
            half and is_zero((CLOSED_P - CLOSED_Q).subs({ell: 1, L: 1})),
        ),
    ]


def _smaller(power: int) -> Check:
    """mu < r^(-1) for every j, stated as l^(j power) (P/Q)^3 < 1."""
    product = L * V**3  # r mu, with V for P/Q: (l L V)(V^2/l)
    return every(
        [*multipliers(), ("r mu = l^j (P/Q)^3", same(ell * L * V * V**2 / ell, product)), *rising(power)],
        witness=lambda: {"power": str(power)},
    )


def _exponents(power: int) -> Check:
    """In (tau, v) DG multiplies by l^j (P/Q)^power < 1 across gamma, for every j: both exponents are negative."""
    scaled = all(is_zero(DG_on_ray(n).det() - lambda_ ** (n + 1) * (P(n) / Q(n)) ** power) for n in (1, 2, 3))
    return every(
        [
            *multipliers(),
            (f"det DG = l^(j+1) (P/Q)^{power} on gamma, along it the multiplier is l; from DG at j = 1, 2, 3", scaled),
            *rising(),
            ("l^j (P/Q)^2 is smaller than l^j (P/Q)^3 as P > Q", scaled and _saddle(1).holds),
        ],
        witness=lambda: {"det DG": f"not l^(j+1) (P/Q)^{power}"},
    )


def _parity(stated: tuple[int, int]) -> Check:
    """The number of negative solutions of l^(j+1) P = r Q for every r: (for odd j, for even j), for j up to TURNED."""
    counts: dict[int, set[int]] = {0: set(), 1: set()}
    monotone = True
    for order in range(1, TURNED + 1):
        top, below = sympy.Poly(P(order), lambda_), sympy.Poly(Q(order), lambda_)
        slope = (order + 1) * top * below + sympy.Poly(lambda_, lambda_) * (top.diff() * below - top * below.diff())
        monotone &= slope.count_roots(None, 0) == 0
        # for odd j P has a zero z < -1 and Q = l^j P(1/l) has 1/z: r takes each value > 0 once on (1/z, 0), once on
        # (-oo, z), and is negative between; for even j neither has a zero, and r < 0 for l < 0
        counts[order % 2].add(2 * top.count_roots(None, -1))
        monotone &= top.count_roots(-1, 0) == 0
    return every(
        [
            (f"r(l) has no critical point for l < 0, j = 1..{TURNED} (Sturm)", monotone),
            (
                f"negative roots: {counts[1]} for odd j, {counts[0]} for even j",
                (counts[1], counts[0]) == tuple({n} for n in stated),
            ),
        ]
    )


def _sides(stated: tuple[int, int]) -> Check:
    """(sign of sigma on gamma, sign of the wall acceleration there)."""
    sigma, a = sympy.symbols("sigma a_j")
    before = -1  # time increases from sigma to l sigma, 0 < l < 1, for sigma < 0 alone
    shrinks = all(bool((value * (sympy.Rational(1, 2) - 1) > 0) == (value < 0)) for value in (-1, 1))
    speed = a * sigma ** (j + 1)  # v of gamma over (1 - l) P/((j+1)(j+2)) > 0
    pressed = a * sigma**j  # the wall acceleration
    return every(
        [
            (
                "the factor (1 - l) P of the velocity is positive, as the coefficients of P are for every j",
                all(_positive((1 - lambda_) * P(order)) for order in (1, 2, 3)),
            ),
            ("a landing at l sigma is later than the launch for sigma < 0 alone", shrinks and stated[0] == before),
            (
                "v = sigma a_j sigma^j times a positive factor, so v > 0 where the wall acceleration a_j sigma^j is "
                "negative",
                sympy.powsimp(pressed * sigma) == speed and stated[0] * stated[1] == 1,
            ),
        ]
    )


def _below_one(stated: tuple[Any, Any]) -> Check:
    """(A, B), A < B on (0, 1): A/B is r times the ratio of the corrected bounds of q~ and p~ without M."""
    small, large = stated
    return every(
        {
            "A/B = r (1 + e)/(1 - e), e = (1 - r)/3 the slack of both bounds": same(
                small / large, r * (1 + SLACK) / (1 - SLACK)
            ),
            "B - A is positive on (0, 1)": positive_on(large - small, r, 0, 1),
        }
    )


CLAIMS = {
    "b:ratio-bound": Encoding(
        (r * (4 - r), 2 + r),
        _below_one,
        ((r * (5 - r), 2 + r), (r * (1 + 2 * r), 2 + r), (2 * r * (4 - r), 2 * (2 + r) - 3)),
    ),
    "b:order-ray": Encoding(1, _ray, (0, 2)),
    "b:order-saddle": Encoding(1, _saddle, (2, 3)),
    "b:order-expansion": Encoding(1, _smaller, (0, -1)),
    "b:order-exponents": Encoding(2, _exponents, (3, 1)),
    "b:order-parity": Encoding((2, 0), _parity, ((0, 2), (1, 1))),
    "b:order-sides": Encoding((-1, -1), _sides, ((1, -1), (-1, 1))),
}
