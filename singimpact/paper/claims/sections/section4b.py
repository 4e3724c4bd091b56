"""Section 4.1(b): tangency points with a' < 0; k = a'/6 < 0 and rays t = l sigma."""

import sympy

from singimpact.algebra import At, negative_on, positive_in, positive_on, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import agree, every, identity, is_zero
from singimpact.paper.routes import fold, implicit as route
from singimpact.paper.routes.fold import k
from singimpact.paper.routes.implicit import X, Y, a_symbol, r, sigma, t
from singimpact.theory.impact_sheet import generic_sheet

ell, slope, mu, nu = sympy.symbols("ell p mu nu")
THIRD, HALF = sympy.Rational(1, 3), sympy.Rational(1, 2)


def on_ray() -> tuple[sympy.Expr, sympy.Expr]:
    """p and q on t = l sigma: v of p over sigma^2, and v of q over the square of its own first component, at sigma = 0."""
    first, second = fold.phi()
    launch = sympy.factor(sympy.cancel(fold.p()[1].subs(t, ell * sigma) / sigma**2))
    landed = sympy.factor(sympy.cancel((-r * second / first**2).subs(t, ell * sigma)))
    ray = {t: ell * sigma}
    substitution(At(fold.p()[1], ray), At(sigma**2 * X, {X: launch}))
    substitution(At(-r * second, ray), At(X * Y**2, {X: landed, Y: first.subs(ray)}))
    return launch, landed


def _on_rays(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """p and q on t = l sigma to second order, and the monomial stated[4] that divides all that is left out.

    v_c(sigma, 0) = 0, so v_c and the impact velocity have the factor t, which is l sigma here: the factor l stays.
    """
    *parts, monomial = stated
    check = identity(
        lambda: (
            fold.p()[0],
            fold.p()[1].subs(t, ell * sigma),
            fold.phi()[0].subs(t, ell * sigma),
            (-r * fold.phi()[1]).subs(t, ell * sigma),
        )
    )(tuple(parts))
    sheet = generic_sheet(1, 4)
    lowest, divided = [], True
    for jet, factor, leading in ((sheet.v, 1, parts[1]), (sheet.xdot, -r, parts[3])):
        series = factor * sheet.to_sympy(jet)
        left = sympy.expand(series.subs(t, ell * sigma) - leading.subs(k, a_symbol(1) / 6))
        powers = [key for key, value in sympy.Poly(left, sigma, ell).terms() if value != 0]
        lowest.append(tuple(min(key[n] for key in powers) for n in (0, 1)))
        quotient = sympy.cancel(left / monomial)
        if sympy.fraction(quotient)[1].has(sigma, ell):
            divided = False
        else:
            rest = At(leading.subs(k, a_symbol(1) / 6) + monomial * X, {X: sympy.expand(quotient)})
            substitution(At(series, {t: ell * sigma}), rest)
    return every(
        [
            check,
            ("y_c = v at t = 0, so v_c(sigma, 0) = 0 and both velocities have the factor t", vanish_at_launch()),
            (
                f"to degree 4 what is left out has the factor {monomial} and no higher power",
                divided and set(lowest) == {tuple(sympy.Poly(monomial, sigma, ell).monoms()[0])},
            ),
        ],
        witness=lambda: {"factor of what is left out": f"sigma^{lowest[0][0]} l^{lowest[0][1]}"},
    )


def vanish_at_launch() -> bool:
    """Whether y_c(sigma, v; 0) = v, so that v_c(sigma, 0) = 0 whatever the higher terms are."""
    return agree(route.y_c(4), {t: 0}, route.v)


def _positive_for_all(expression: sympy.Expr, *, rate: bool = True) -> bool:
    """A rational function of (l, r) is positive for l > 0 and 0 < r < 1; one of l alone, for l > 0."""
    return positive_in(expression, {ell: (0, sympy.oo)} | ({r: (0, 1)} if rate else {}))


def _continuous(side: int) -> Check:
    """v on the horizon has the stated sign off w_*, and F has no jump near a tangency with a' < 0.

    dv/dt = -k l(sigma, t) + O(2) with l linear and positive on both edges of the sector 3 sigma + t >= 0, t >= 0, so on
    all of it but 0, where it is above a multiple of |(sigma, t)|: no graze, and F is continuous.
    """
    _, outline = fold.horizon()
    height = sympy.cancel(outline / k / sigma**2)
    launch = sympy.cancel(fold.p()[1] / -k)
    rise = sympy.expand(sympy.diff(launch, t))
    edges = [{sigma: 1, t: 0}, {sigma: -1, t: 3}]
    bounds = all(agree(launch, edge, 0) for edge in edges)
    return every(
        [
            (f"v on the horizon is {height} k sigma^2 + O(3) with k < 0", height.is_positive and side == -1),
            (
                f"dv/dt = -k ({rise}), positive on both edges of the sector, where v = 0",
                bounds and all(rise.subs(edge) > 0 for edge in edges) and sympy.Poly(rise, sigma, t).is_homogeneous,
            ),
        ]
    )


def _sector(stated: tuple[int, int]) -> Check:
    """F lands where v >= 0 and t >= 0: for k < 0 that is stated[0] sigma + t >= 0, t >= 0."""
    factor, least = stated
    launch = sympy.cancel(fold.p()[1] / (-k * t))
    rise = sympy.cancel(sympy.diff(fold.p()[1], t) / -k)
    return every(
        [
            (
                f"v = -k t ({launch}), so for k < 0 and t > 0 v >= 0 where {launch} >= 0",
                agree(X * t, {X: factor * sigma + t}, sympy.expand(launch * t)) and least == 0,
            ),
            (
                f"dv/dt = -k ({launch} + t) > 0 inside, so there p is one to one for each sigma",
                agree(X + t, {X: launch}, rise),
            ),
        ]
    )


def _image_bounds(bound: sympy.Expr) -> Check:
    """phi of the sector: with p = t/(sigma + t) in [0, 3/2], v/(sigma + t)^2 = k (3p - p^2) runs from 0 to bound a'."""
    ratio, edge = image_of_sector()
    return every(
        [
            (
                f"v/(k s^2) = {ratio}, s = sigma + t, increases on 0 <= p <= 3/2, the sector",
                positive_on(sympy.diff(ratio, slope), slope, 0, sympy.Rational(3, 2)),
            ),
            (
                f"from 0 to {edge}, that is to v = {edge / 6} a' s^2",
                ratio.subs(slope, 0) == 0 and is_zero(edge / 6 - bound),
            ),
        ]
    )


def image_of_sector() -> tuple[sympy.Expr, sympy.Expr]:
    """(v/(k s^2) of phi as a function of p = t/s, s = sigma + t; its value at the edge p = 3/2, where 3 sigma + t = 0)."""
    first, second = fold.phi()
    by_slope = {sigma: t * (1 - slope) / slope}
    ratio = sympy.expand(sympy.cancel((second / (k * first**2)).subs(by_slope)))
    substitution(At(second, by_slope), At(k * X * (t / slope) ** 2, {X: ratio}))
    return ratio, ratio.subs(slope, sympy.Rational(3, 2))


def _half_plane(stated: int) -> Check:
    """The sign of v on T'', between the edge of phi's image and 0, a' < 0: the half-plane it lies in."""
    return every(
        [
            (
                "both bounds are <= 0 for a' < 0, so it lies in v <= 0",
                negative_on(image_of_sector()[1] / 6 * a_symbol(1), a_symbol(1), -sympy.oo, 0) and stated == -1,
            )
        ],
        witness=lambda: {"a'": "-1", "sigma": "1", "v between": "-3/8 and 0"},
    )


def _range(stated: sympy.Expr) -> Check:
    """Rays 0 <= l <= stated(k, r) reach the upper edge v = -(9/4) r k sigma^2 of R T'' under p."""
    launch, _ = on_ray()
    short = sympy.factor(sympy.cancel((launch / -k).subs(ell, stated)) - sympy.Rational(9, 4) * r)
    small = short.subs(k, -sympy.Rational(1, 100)) if short.has(k) else short
    return every(
        {f"3l + l^2 - (9/4) r at the last ray is {short}, positive for every k < 0": positive_on(small, r, 0, 1)},
        witness=lambda: {
            "k": "-1/100",
            "r": "1/2",
            "last l": str(stated.subs({k: -sympy.Rational(1, 100), r: sympy.Rational(1, 2)})),
            "needed 3l + l^2": "9/8",
            "reached": str((small + sympy.Rational(9, 4) * r).subs(r, sympy.Rational(1, 2))),
        },
    )


SLACK = (1 - r) / 3  # by how much the bounds of p~ and q~ leave their limits, relative to these
# The paper's conditions on delta: K delta < FOR_K, L delta < FOR_L, where l mu sigma^3 and l nu sigma^3 are what p and
# q leave out on a ray (s4b-rays), |mu| <= K, |nu| <= L.  As l -> 0 they tend to -k (1 - r) and -r k (1 - r), not to 0.
FOR_K, FOR_L = (sympy.factor(part * SLACK) for part in (-k * (3 + ell), -r * k * (3 + 2 * ell) * (1 + ell)))


def _conditions(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(K_0, L_0): with K delta < K_0 and L delta < L_0 the bounds of p~ and q~ hold on 0 < sigma <= delta, and no earlier."""
    launch, landed = on_ray()
    low = _P * (2 + r) * THIRD * sigma**2
    high = _Q / (1 + ell) ** 2 * (4 - r) * THIRD * sigma**2
    left = {
        "p~ - bound = l sigma^2 (K_0 + mu sigma), mu >= -K": (
            X * sigma**2 + ell * sigma**3 * mu - Y,
            {X: launch, Y: low},
            ell * sigma**2 * (stated[0] + mu * sigma),
        ),
        "bound - q~ = l sigma^2 (L_0 - nu sigma)/(1 + l)^3, nu <= L": (
            Y - X * sigma**2 - ell * sigma**3 * nu / (1 + ell) ** 3,
            {X: landed, Y: high},
            ell * sigma**2 * (stated[1] - nu * sigma) / (1 + ell) ** 3,
        ),
    }
    box = {ell: (0, sympy.oo), r: (0, 1), k: (-sympy.oo, 0)}
    return every(
        [
            *((wording, agree(*sides)) for wording, sides in left.items()),
            (
                "K_0 and L_0 are positive for every l > 0, so a delta exists",
                all(positive_in(condition, box) for condition in stated),
            ),
        ]
    )


def _bound_p(stated: sympy.Expr) -> Check:
    """p~ > stated for 0 <= sigma <= delta, k < 0: the leading part of p~ - stated at sigma = 0 and just after."""
    launch, _ = on_ray()
    gap = sympy.expand(launch * sigma**2 - stated)
    lowest = min(degree for (degree,), _ in sympy.Poly(gap, sigma).terms())
    leading = sympy.cancel(sympy.Poly(gap, sigma).coeff_monomial(sigma**lowest) / -k)
    return every(
        [
            (
                f"p~ - bound = -k ({sympy.factor(leading)}) sigma^{lowest} + ..., positive for l > 0, 0 < r < 1",
                _positive_for_all(leading),
            ),
            (
                f"p~ - bound = l sigma^2 ({FOR_K} + mu sigma), so it is positive where K delta < {FOR_K}, for all l at once",
                is_zero(launch * sigma**2 + ell * sigma**3 * mu - stated - ell * sigma**2 * (FOR_K + mu * sigma))
                and _positive_for_all((FOR_K + k * (1 - r)) / -k)
                and positive_in(FOR_K, {ell: (0, sympy.oo), r: (0, 1), k: (-sympy.oo, 0)}),
            ),
        ],
        witness=lambda: {
            "sigma": "0",
            "k": "-1",
            "l": "1",
            "r": "1/2",
            "p~": "0",
            "bound": str(stated.subs({sigma: 0, k: -1, ell: 1, r: sympy.Rational(1, 2)})),
        },
    )


def _bound_q(stated: sympy.Expr) -> Check:
    """q~ < stated for small sigma > 0, k < 0: leading coefficients of sigma^2."""
    _, landed = on_ray()
    gap = sympy.cancel((stated / sigma**2 - landed) / -k)
    point = {k: -1, ell: 1, r: sympy.Rational(1, 2)}
    return every(
        [
            (
                f"(bound - q~)/(-k sigma^2) -> {sympy.factor(gap)}, positive for l > 0, 0 < r < 1",
                _positive_for_all(gap),
            ),
            ("with the slack (1 - r)/3 of the limit, as below p~", is_zero(stated / sigma**2 / landed - 1 - SLACK)),
            (
                f"bound - q~ = l sigma^2 ({FOR_L} - nu sigma)/(1 + l)^3, so it is positive where L delta < {FOR_L}, for all l at once",
                is_zero(
                    stated
                    - landed * sigma**2
                    - ell * sigma**3 * nu / (1 + ell) ** 3
                    - ell * sigma**2 * (FOR_L - nu * sigma) / (1 + ell) ** 3
                )
                and _positive_for_all((FOR_L + r * k * (1 - r)) / -k)
                and positive_in(FOR_L, {ell: (0, sympy.oo), r: (0, 1), k: (-sympy.oo, 0)}),
            ),
        ],
        witness=lambda: {
            "k": "-1",
            "l": "1",
            "r": "1/2",
            "q~/sigma^2": str(landed.subs(point)),
            "bound/sigma^2": str((stated / sigma**2).subs(point)),
        },
    )


M = (3 + 2 * ell) / ((3 + ell) * (1 + ell) ** 2)


def _ratio(stated: sympy.Expr) -> Check:
    """q~/p~ < stated for small sigma: the limit of q~/p~ is r M."""
    launch, landed = on_ray()
    limit = sympy.cancel(landed / launch)
    point = {ell: 1, r: sympy.Rational(1, 2)}
    return every(
        [
            ("q~/p~ -> r M", is_zero(limit - r * M)),
            ("which is below the bound for l > 0, 0 < r < 1", _positive_for_all(stated - limit)),
            ("the quotient of the bounds of q~ and p~", is_zero(stated / limit - (1 + SLACK) / (1 - SLACK))),
            (
                "and the bound is below 1, since M < 1 and 2 + r - r (4 - r) = (1 - r)(2 - r) > 0",
                _positive_for_all(1 - stated) and positive_on(2 + r - r * (4 - r), r, 0, 1),
            ),
        ],
        witness=lambda: {
            "l": "1",
            "r": "1/2",
            "limit of q~/p~": str(limit.subs(point)),
            "bound": str(stated.subs(point)),
        },
    )


def _below_one(stated: sympy.Expr) -> Check:
    return every(
        [
            (
                "1 - M over its positive denominator has positive coefficients in l",
                is_zero(stated - M) and _positive_for_all(1 - stated, rate=False),
            )
        ],
        witness=lambda: {"l": "1", "M": str(stated.subs(ell, 1))},
    )


def _r_inequality(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    small, large = stated
    return every(
        {"the difference is positive on (0, 1) (no root inside, by Sturm)": positive_on(large - small, r, 0, 1)},
        witness=lambda: {
            "r": "1/2",
            "left": str(small.subs(r, sympy.Rational(1, 2))),
            "right": str(large.subs(r, sympy.Rational(1, 2))),
        },
    )


def _contracted(stated: sympy.Expr) -> Check:
    """The least upper bound over l > 0 and r in (0, 1) of lim q~/p~ = r M; for one r and l a constant below it serves."""
    launch, landed = on_ray()
    limit = sympy.cancel(landed / launch)
    return every(
        {
            "0 < lim q~/p~ < 1 for l > 0, 0 < r < 1": _positive_for_all(limit) and _positive_for_all(stated - limit),
            "1 is reached as l -> 0, r -> 1, and no smaller bound serves all": limit.subs({ell: 0, r: 1}) == stated,
        }
    )


_P = -k * (3 * ell + ell**2)
_Q = -r * k * (3 * ell + 2 * ell**2)

CLAIMS = {
    "s4b-continuous": Encoding(-1, _continuous, (1,)),
    "s4b-sector": Encoding((3, 0), _sector, ((2, 0), (3, 1))),
    "s4b-T2-bounds": Encoding(sympy.Rational(3, 8), _image_bounds, (sympy.Rational(1, 8), sympy.Rational(3, 4))),
    "s4b-T2-place": Encoding(1, _half_plane, (0,), lambda: -1),
    "s4b-rays": Encoding(
        (sigma, _P * sigma**2, sigma * (1 + ell), _Q * sigma**2, ell * sigma**3),
        _on_rays,
        (
            (sigma, -_P * sigma**2, sigma * (1 + ell), _Q * sigma**2, ell * sigma**3),
            (sigma, _P * sigma**2, sigma * (1 - ell), _Q * sigma**2, ell * sigma**3),
            (sigma, _P * sigma**2, sigma * (1 + ell), _Q * sigma**2, ell**2 * sigma**3),
            (sigma, _P * sigma**2, sigma * (1 + ell), _Q * sigma**2, ell * sigma**4),
            (sigma, _P * sigma**2, sigma * (1 + ell), _Q * sigma**2, sigma**3),
        ),
    ),
    "s4b-l-range": Encoding(-sympy.Rational(9, 4) * k * r, _range, (r / 4, -k * r), lambda: sympy.Rational(3, 4) * r),
    "s4b-p-bound": Encoding(
        _P * (2 + r) * THIRD,
        _bound_p,
        (_P * sigma**2, _P * (4 - r) * THIRD * sigma**2),
        lambda: _P * (2 + r) * THIRD * sigma**2,
    ),
    "s4b-q-bound": Encoding(
        _Q / (1 + ell) ** 2 * (1 + 2 * r) * THIRD * sigma**2,
        _bound_q,
        (
            _Q / (1 + ell) ** 2 * sigma**2,
            _Q / (1 + ell) ** 2 * (2 + r) * THIRD * sigma**2,
            _Q / (1 + ell) ** 2 * (5 - r) * THIRD * sigma**2,
        ),
        lambda: _Q / (1 + ell) ** 2 * (4 - r) * THIRD * sigma**2,
    ),
    "s4b-conditions": Encoding((FOR_K, FOR_L), _conditions, ((FOR_K / 2, FOR_L), (FOR_K, FOR_L * 2), (FOR_K, -FOR_L))),
    "s4b-ratio": Encoding(
        M * r * (1 + 2 * r) / (2 + r),
        _ratio,
        (M * r, M * r * r, M * r * (9 - r) / (2 + r)),
        lambda: M * r * (4 - r) / (2 + r),
    ),
    "s4b-M": Encoding(M, _below_one, ((3 + 2 * ell) / (3 + ell), (9 + 2 * ell) / ((3 + ell) * (1 + ell) ** 2))),
    "s4b-r-ineq": Encoding(
        (r * (1 + 2 * r), 2 + r), _r_inequality, ((r * (2 + 2 * r), 2 + r), (2 + r, r * (1 + 2 * r)))
    ),
    "s4b-Np": Encoding(sympy.Integer(1), _contracted, (sympy.Integer(0), HALF, sympy.Integer(2))),
}
