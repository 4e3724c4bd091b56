"""Section 4.1(a): p, phi, the fold form and h at a tangency point; the blow-up h' and its fixed points for all r in (0, 1)."""

from collections.abc import Callable
from typing import Any

import sympy

from singimpact.algebra import certificates
from singimpact.algebra.certificates import negative_on, positive_on
from singimpact.paper.claims.claim import Check, Encoding, Statement
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS, next_sigma, next_sigma_remainder
from singimpact.paper.claims.verifiers import every, identity, is_zero, sample
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import eta, k, m
from singimpact.paper.routes.implicit import a_symbol, r, sigma, t
from singimpact.theory import cubic_terms, fold_form, generic_sheet, latex

HALF, THREE_HALVES, QUARTERS = sympy.Rational(1, 2), sympy.Rational(3, 2), sympy.Rational(9, 4)
QUARTIC = m**2 * (m - HALF) ** 2
ROOT = sympy.sqrt(r * (2 * m**2 - 3 * m) + QUARTERS * (m - HALF) ** 2)  # of Q_r(1, m)
Q = sympy.Symbol("Q")  # Q_r(1, m), in statements about its sign
ENDS = tuple((12 * r + 9 + sign * 12 * sympy.sqrt(r * (r + 1))) / (16 * r + 18) for sign in (-1, 1))  # m_-, m_+
CUBIC = (m - HALF) ** 2 * (m + THREE_HALVES)
ROOT_SIGNS = ((-sympy.oo, -1), (-THREE_HALVES, 1), (0, 1), (HALF, -1), (sympy.oo, 1))


def _involuted() -> tuple[sympy.Expr, sympy.Expr]:
    """phi at a tangency by the other route: the launch velocity with the involution applied."""
    sheet = generic_sheet(1, 2)
    return sigma + t, fold.in_k(sheet.to_sympy(sheet.xdot))


def _z_line(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(t on the branch of v_c = 0 other than t = 0, sigma on the line that phi takes to the v-axis)."""
    _, velocity = fold.p()
    line, to_axis = stated
    first, _ = fold.phi()
    return every(
        {
            "v_c vanishes on it to second order": is_zero(velocity.subs(t, line)),
            "it is not Pi_0": not is_zero(line),
            "phi takes the second line to sigma = 0": is_zero(first.subs(sigma, to_axis)),
        }
    )


def _identity_order(order: int) -> Check:
    """Diffeomorphisms whose terms up to `order` are those of the identity remove the O(3) terms of psi o p.

    With k(3) the cubic terms: a source change eta + q with q of degree `order` + 1 >= 2 changes psi o p by -2 k eta q,
    a target change by a polynomial in (sigma, eta^2).  So with order 2 only sigma^3 can be removed.
    """
    stuck = {key: value for key, value in cubic_terms().items() if key != (3, 0) and not is_zero(value)}
    left = stuck if order >= 2 else {}
    reached = order >= 1 and fold_form(4).residual_vanishes
    shown = ", ".join(f"({value}) sigma^{i} eta^{j}".replace("*", " ") for (i, j), value in list(stuck.items())[:1])
    return every(
        [
            (f"no cubic term is left that changes of degree > {order} cannot remove", not left),
            ("explicit changes of this form reach the fold form to order 4", reached),
            (
                "and they are the identity to no higher order, since a quadratic term is needed",
                bool(stuck) == (order < 2),
            ),
        ],
        witness=lambda: {"term that stays": shown},
    )


def _fold_form(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """Source and target changes take psi o p to (sigma, stated): computed to order 5, smooth by one quotient.

    With the horizon moved to eta = 0 and its image to 0, psi o p has the factor eta^2 (Hadamard's lemma, twice).
    """
    form = fold_form(5)
    bend = sympy.diff(fold.psi_p()[1], eta, 2).subs({sigma: 0, eta: 0})
    return every(
        [
            identity(lambda: form.normal, "the normal form reached")(stated),
            (
                f"d^2/d eta^2 of psi o p is {bend}, not 0: so it is -k eta^2 u with u smooth, u = 1 at w_*, and eta sqrt(u) for eta "
                "removes what is left; both changes are computed to order 5",
                is_zero(bend + 2 * k),
            ),
            ("psi o p composed with the changes leaves no term up to order 5", form.residual_vanishes),
            (
                "the changes are invertible: d(eta)/dt = 1 and the target change is the identity to first order",
                form.invertible,
            ),
        ],
        witness=lambda: {"fails": "the residual"},
    )


def first_component(stated: sympy.Expr, order: Any) -> list[tuple[str, bool]]:
    """Whether the next sigma is `stated` + O(order) in the coordinates of e:pdef that keep the phase sigma.

    Parameters
    ----------
    order : the lowest degree of what is left out, oo for a statement without remainder; it must be the true one.
    """
    lowest, terms = next_sigma_remainder(stated)
    shown = ", ".join(str(sympy.factor(value) * sigma**i * eta**n) for (i, n), value in terms.items())
    both_squares = all(terms.get(key, 0) != 0 for key in ((2, 0), (0, 2)))
    return [
        (
            f"in the coordinates of e:pdef, lengths in units of k, the terms of lowest degree beside it have degree {lowest}: {shown or 'none'}",
            order == lowest,
        ),
        ("those in sigma^2 and eta^2 stay for every eta that keeps the phase sigma and the fold form", both_squares),
    ]


def bent(stated: sympy.Expr) -> dict[str, str]:
    """Numbers at which the next sigma in the coordinates of e:pdef, to degree 2, is not what is stated."""
    return sample(stated, next_sigma()) | {"coordinates": "those of e:pdef, to degree 2, lengths in units of k"}


def _psi_q(stated: tuple[Any, Any, Any]) -> Check:
    """(first component, second component to degree 2, lowest degree of what the first leaves out)."""
    first, second, order = stated
    check = identity(fold.psi_q)((first, second))
    same = "equal to" if check.holds else "not"
    return every(
        [
            (
                f"in (sigma, 3 sigma/2 + t), where psi o p has cubic terms, it is {same} what is derived from the equation of motion, the first component exactly",
                check.holds,
            ),
            *first_component(first, order),
        ],
        witness=lambda: dict(check.witness or bent(first)),
    )


def _h(stated: tuple[Any, Any, Any]) -> Check:
    """h maps the visible part of V' (first hits, sigma < 0) into itself: p(h) = q, and h lands before the horizon."""
    new_sigma, new_eta, order = stated
    folded = fold.psi_p()
    closes = [
        component.subs({sigma: new_sigma, eta: new_eta}, simultaneous=True) - goal
        for component, goal in zip(folded, fold.psi_q(), strict=True)
    ]
    closes.append(new_eta**2 - fold.h()[1] ** 2)
    point = {sigma: sympy.Integer(-1), eta: -sympy.Rational(11, 10), r: HALF}  # t = eta + 3/2 > 0, before the horizon
    landed = {"sigma'": new_sigma.subs(point), "eta'": new_eta.subs(point)}
    launched = landed["sigma'"] < 0 and bool(sympy.N(landed["eta'"], 30) < 0)
    return every(
        [
            ("psi o p(h) = psi o q to second order, h as it is derived", all(map(is_zero, closes))),
            (
                "from the visible point sigma = -1, eta = -11/10 at r = 1/2 it lands on the visible part eta' < 0, sigma' < 0",
                launched,
            ),
            *first_component(new_sigma, order),
        ],
        witness=lambda: (
            {"sigma": "-1", "eta": "-11/10", "r": "1/2"}
            | {key: str(sympy.N(x, 5)) for key, x in landed.items()}
            | {"why": "a first hit comes before the horizon, where eta < 0"}
        ),
    )


def sign_chain(expression: sympy.Expr, signs: tuple[tuple[Any, int], ...]) -> bool:
    """The polynomial in m has the stated sign at each place, for every r in (0, 1); the places may be infinite."""
    return certificates.sign_chain(expression, m, signs, {r: (0, 1)})


def _blow_up(stated: tuple[Any, Any, Any]) -> Check:
    """(s'/s at s = 0, m' at s = 0, power of s in what s' leaves out): with sigma = s, eta = s m degree n becomes s^n."""
    rate, image, power = stated
    derived = identity(fold.h_blown_up, "derived from h with s < 0 and the root that lands before the horizon")
    return every(
        [
            derived((rate, image)),
            *first_component(eta + (rate - m) * sigma, power),
            (
                "the square of the new eta begins with Q_r at degree 2, so over s^2 it is Q_r(1, m) and a smooth multiple of s",
                _square_begins_with_Q(),
            ),
        ],
        witness=lambda: bent(eta + (rate - m) * sigma),
    )


def _square_begins_with_Q() -> bool:
    """Whether k eta'^2 = P(sigma') - v', in the jets, has no term of degree below 2 and k Q_r in degree 2.

    A change of coordinates (sigma, t) -> (sigma, eta + O(2)) keeps both; on (s, s m) a term of degree n has the factor s^n.
    """
    sheet = generic_sheet(1, 4)
    outline = fold_form(4).outline_of_p.subs(sigma, sigma + t)
    square = sympy.Poly(sympy.cancel(outline + r * sheet.to_sympy(sheet.xdot)), sigma, t)
    leading = sum(value * sigma**i * t**n for (i, n), value in square.terms() if i + n == 2)
    none_below = all(value == 0 for key, value in square.terms() if sum(key) < 2)
    quadratic = a_symbol(1) / 6 * fold.Q_r().subs(eta, fold.fold_coordinate())
    return none_below and is_zero(sympy.expand(leading - quadratic))


def _q_zeros(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """Q_r(1, m) has its zeros in (stated[0], stated[1]) and (stated[1], stated[2]); both tend to stated[1]."""
    low, middle, high = stated
    polynomial = fold.Q_at_one()
    at_zero = sympy.factor(polynomial.subs(r, 0))
    chain = sign_chain(polynomial, ((-sympy.oo, 1), (low, 1), (middle, -1), (high, 1), (sympy.oo, 1)))
    return every(
        [
            (f"signs + + - + + at -oo, {low}, {middle}, {high}, oo for every r in (0, 1)", chain),
            (
                "it is quadratic, so there is one zero in each gap and it is positive outside",
                sympy.degree(polynomial, m) == 2,
            ),
            (
                f"at r = 0 both zeros are {middle}",
                is_zero(at_zero.subs(m, middle)) and is_zero(at_zero.diff(m).subs(m, middle)),
            ),
        ]
    )


def _q_positive(stated: Any) -> Check:
    """Q_r(1, m) satisfies the stated relation to 0 on the closed set E_r; the closed ends are the zeros themselves."""
    polynomial = fold.Q_at_one()
    outside = sign_chain(polynomial, ((-sympy.oo, 1), (0, 1), (HALF, -1), (THREE_HALVES, 1), (sympy.oo, 1)))
    end = sympy.Poly(polynomial.subs(r, HALF), m).nroots(n=6)[1]
    zeros = all(is_zero(polynomial.subs(m, zero)) for zero in ENDS)
    return every(
        {
            "positive outside [m_-, m_+] for every r in (0, 1)": outside,
            "the relation holds there": bool(stated.subs(Q, 1)),
            "the ends m_-, m_+ of E_r are zeros, and it holds at 0": zeros and bool(stated.subs(Q, 0)),
        },
        witness=lambda: {"r": "1/2", "m_+": str(end), "Q_r(1, m_+)": "0"},
    )


def _domain(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """Near s = 0 the equation Q_r(1, m) + O(s) = 0 has smooth solutions through the zeros, which are simple."""
    discriminant = sympy.discriminant(fold.Q_at_one(), m)
    simple = sign_chain(fold.Q_at_one(), ((-sympy.oo, 1), (HALF, -1), (sympy.oo, 1)))
    below, above = stated
    return every(
        {
            "the discriminant of Q_r(1, m) is positive for every r in (0, 1), so dQ/dm is not 0 at m_-, m_+ "
            "and the implicit function theorem gives delta_-, delta_+": simple and positive_on(discriminant, r, 0, 1),
            "delta_-(0) and delta_+(0) are zeros of Q_r(1, m), at which the root leaves the reals": all(
                is_zero(fold.Q_at_one().subs(m, end)) for end in stated
            ),
            "and they are the smaller and the larger one": bool(below.subs(r, HALF) < above.subs(r, HALF)),
        }
    )


def _converse(stated: Callable[[Any], Any]) -> Check:
    """Solutions of Q = m^2 (m - 1/2)^2 in the stated set satisfy m = (m - 1/2)^(-1) sqrt(Q).

    There sqrt(Q) = |m (m - 1/2)|, so the equation holds where m/(m - 1/2) >= 0 and m is not 0; the solutions have places
    m1 < -3/2, 0 < m2 < 1/2 < m3 and 3/2.
    """
    places = {"m1": (-sympy.Integer(5), -THREE_HALVES), "m2": (sympy.Integer(0), HALF), "m3": (HALF, THREE_HALVES)}
    root = sympy.Poly((CUBIC - 2 * r * m).subs(r, HALF), m).nroots(n=20)[1]
    image = sympy.sqrt(fold.Q_at_one()) / (m - HALF)
    failing = [
        name
        for name, (low, high) in places.items()
        if stated((low + high) / 2) and not positive_on(m * (m - HALF), m, low, high)
    ]
    missing = [
        name
        for name, (low, high) in places.items()
        if not stated((low + high) / 2) and not negative_on(m * (m - HALF), m, low, high)
    ]
    return every(
        {
            "m (m - 1/2) has one sign on the place of each root": sign_chain(CUBIC - 2 * r * m, ROOT_SIGNS),
            "it is positive for each root in the stated set": not failing,
            "no root with m (m - 1/2) > 0 is left out": not missing,
        },
        witness=lambda: {
            "r": "1/2",
            "m2": str(root),
            "(m2-1/2)^(-1) sqrt(Q)": str(sympy.N(image.subs({m: root, r: HALF}), 15)),
        },
    )


def _fixed_points(stated: sympy.Expr) -> Check:
    """m' = m squared and cleared: the polynomial equation is the stated one."""
    rate, new = fold.h_blown_up()
    cleared = sympy.cancel(sympy.expand((new * rate) ** 2 - (m * rate) ** 2))
    return every(
        {
            "squaring m = (m - 1/2)^(-1) sqrt(Q) gives it": is_zero(stated - cleared),
            "m = 1/2 is not lost: it lies outside E_r": negative_on(fold.Q_at_one().subs(m, HALF), r, 0, 1),
        },
        witness=lambda: {
            "m": "2",
            "r": "1/2",
            "stated": str(stated.subs({m: 2, r: HALF})),
            "derived": str(cleared.subs({m: 2, r: HALF})),
        },
    )


def _root_places(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """Three real roots: one below stated[0], one in (stated[1], stated[2]), one above stated[2]."""
    low, left, right = stated
    cubic = fold.fixed_point_factors()[1]
    chain = ((-sympy.oo, -1), (low, 1), (left, 1), (right, -1), (sympy.oo, 1))
    return every(
        {
            f"signs - + + - + at -oo, {low}, {left}, {right}, oo for every r in (0, 1)": sign_chain(cubic, chain),
            "it is a cubic, so these are all": sympy.degree(cubic, m) == 3,
        }
    )


def _trivial_root(stated: sympy.Expr) -> Check:
    """m = 3/2 solves e:fixm for those r at which the stated polynomial vanishes: 0 for every r."""
    value = certificates.value_at(fold.fixed_point_equation(), m, THREE_HALVES)
    cubic = certificates.value_at(fold.fixed_point_factors()[1], m, THREE_HALVES)
    always = value == 0
    return every(
        [
            (
                "m = 3/2 solves e:fixm for every r" if always else "m = 3/2 does not solve e:fixm for every r",
                is_zero(value - stated) or (not always and is_zero(sympy.rem(value, stated, r))),
            ),
            (
                "it is a root of the cubic e:meq only for r = 1",
                sympy.Poly(cubic, r).all_roots() == [1] and positive_on(cubic, r, 0, 1),
            ),
        ],
        witness=lambda: {"r": "1/2", "m": "3/2", "Q_r(1,m) - m^2(m-1/2)^2": str(value)},
    )


CLAIMS = {
    "e:pnew": Encoding(
        (sigma, -k * (3 * sigma * t + t**2)),
        identity(fold.p),
        ((sigma, k * (3 * sigma * t + t**2)), (sigma, -k * (3 * sigma * t + 2 * t**2))),
    ),
    "e:phinew": Encoding(
        (sigma + t, -k * (3 * sigma * t + 2 * t**2)),
        identity(_involuted, "the launch velocity after the involution"),
        ((sigma + t, k * (3 * sigma * t + t**2)), (sigma, k * (3 * sigma * t + 2 * t**2))),
        lambda: Statement(
            f"\\phi:(\\sigma,t)\\mapsto\\bigl({latex(fold.phi()[0])},\\ {latex(sympy.factor(fold.phi()[1]))}+O(3)\\bigr)",
            fold.phi(),
        ),
    ),
    "s4-Z-line": Encoding((-3 * sigma, -t), _z_line, ((-3 * sigma / 2, -t), (-3 * sigma, t), (sympy.Integer(0), -t))),
    "s4-fold-form": Encoding(
        (3 * sigma / 2 + t, (sigma, -k * eta**2 + QUARTERS * k * sigma**2), (sigma, -k * eta**2)),
        identity(lambda: (fold.fold_coordinate(), fold.p_folded(), fold.psi_p())),
        (
            (3 * sigma / 2 + t, (sigma, -k * eta**2 - QUARTERS * k * sigma**2), (sigma, -k * eta**2)),
            (3 * sigma + t, (sigma, -k * eta**2 + QUARTERS * k * sigma**2), (sigma, -k * eta**2)),
        ),
    ),
    "s4-normal-id2": Encoding(
        2,
        _identity_order,
        (0, 3),
        lambda: Statement(
            f"\\text{{the changes agree with the identity up to terms of order }}{fold_form(4).identity_order}",
            fold_form(4).identity_order,
        ),
    ),
    "e:pdef": Encoding((sigma, -k * eta**2), _fold_form, ((sigma, k * eta**2), (sigma, -k * eta**2 + sigma * eta))),
    "e:defq": Encoding(
        (eta - sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, sympy.oo),
        _psi_q,
        (
            (eta - sigma / 2, r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, 2),
            (eta - sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta + sigma / 2) ** 2, 2),
            (eta - sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, 3),
            (eta + sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, 1),
        ),
        lambda: (*fold.psi_q(), 2),
    ),
    "e:hdef": Encoding(
        (eta - sigma / 2, sympy.sqrt(r * (2 * eta**2 - 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2), sympy.oo),
        _h,
        (
            (eta - sigma / 2, eta, 2),
            (eta + sigma / 2, -sympy.sqrt(2 * r * eta**2 + QUARTERS * sigma**2), 2),
            (*fold.h(), 3),
            (*fold.h(), sympy.oo),
        ),
        lambda: (*fold.h(), 2),
    ),
    "e:qdef": Encoding(
        r * (2 * eta**2 - 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2,
        identity(fold.Q_r),
        (
            r * (2 * eta**2 + 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2,
            -r * (2 * eta**2 - 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2,
        ),
    ),
    "s4-blowup": Encoding(
        (m - HALF, ROOT / (m - HALF), sympy.oo),
        _blow_up,
        (
            (m - HALF, -ROOT / (m - HALF), 2),
            (m + HALF, ROOT / (m - HALF), 1),
            (m - HALF, ROOT / (m - HALF), 1),
            (m - HALF, ROOT / (m - HALF), 3),
        ),
        lambda: (*fold.h_blown_up(), 2),
    ),
    "s4-Qr-zeros": Encoding(
        (sympy.Integer(0), HALF, THREE_HALVES),
        _q_zeros,
        ((sympy.Integer(0), sympy.Integer(1), THREE_HALVES), (HALF, THREE_HALVES, sympy.Integer(2))),
    ),
    "s4-Er-closed": Encoding(Q > 0, _q_positive, (Q < 0, Q <= 0), lambda: Q >= 0),
    "s4-domain": Encoding(ENDS, _domain, (ENDS[::-1], (HALF, THREE_HALVES), (ENDS[0], ENDS[0]))),
    "e:fixm-converse": Encoding(
        lambda _place: True,
        _converse,
        (lambda place: place < 0, lambda place: place < HALF),
        lambda: lambda place: place * (place - HALF) > 0,
    ),
    "e:fixm": Encoding(
        r * (2 * m**2 - 3 * m) + QUARTERS * (m - HALF) ** 2 - QUARTIC,
        _fixed_points,
        (
            r * (2 * m**2 - 3 * m) + QUARTERS * (m - HALF) ** 2 - m**2 * (m + HALF) ** 2,
            r * (2 * m**2 - 3 * m) + QUARTERS * (m - HALF) ** 2 - m * (m - HALF) ** 2,
        ),
    ),
    "e:meq": Encoding(
        CUBIC - 2 * r * m,
        identity(lambda: fold.fixed_point_factors()[1]),
        (CUBIC + 2 * r * m, CUBIC - r * m, (m - HALF) ** 2 * (m - THREE_HALVES) - 2 * r * m),
    ),
    "s4-root-places": Encoding(
        (-THREE_HALVES, sympy.Integer(0), HALF),
        _root_places,
        ((-HALF, HALF, THREE_HALVES), (-sympy.Integer(3), sympy.Integer(0), HALF)),
    ),
    "s4-m32-r1": Encoding(r - 1, _trivial_root, (r, r - 2), lambda: sympy.Integer(0)),
}
