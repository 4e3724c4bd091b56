"""Section 4.1(a), first part: p and phi at a tangency point, the fold form, h and Q_r."""

from typing import Any

import sympy

from singimpact.paper.claims.claim import Check, Claim, Statement
from singimpact.paper.claims.next_sigma import next_sigma, next_sigma_remainder
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, identity, is_zero, sample
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import eta, k
from singimpact.paper.routes.implicit import r, sigma, t
from singimpact.theory.impact_sheet import generic_sheet
from singimpact.theory.notation import latex
from singimpact.theory.plane_forms import cubic_terms, fold_form

HALF, QUARTERS = sympy.Rational(1, 2), sympy.Rational(9, 4)


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
        [
            ("v_c vanishes on it to second order", is_zero(velocity.subs(t, line))),
            ("it is not Pi_0", not is_zero(line)),
            ("phi takes the second line to sigma = 0", is_zero(first.subs(sigma, to_axis))),
        ]
    )


def _identity_order(order: int) -> Check:
    """Diffeomorphisms whose terms up to `order` are those of the identity remove the O(3) terms of psi o p.

    With k(3) the cubic terms: a source change eta + q with q of degree `order` + 1 >= 2 changes psi o p by -2 k eta q,
    a target change by a polynomial in (sigma, eta^2).  So with order 2 only sigma^3 can be removed.
    """
    cubic = cubic_terms()
    stuck = {key: value for key, value in cubic.items() if key != (3, 0) and not is_zero(value)}
    left = stuck if order >= 2 else {}
    reached = order >= 1 and fold_form(4).residual_vanishes
    shown = ", ".join(f"{latex(value)} sigma^{i} eta^{j}" for (i, j), value in list(stuck.items())[:1])
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
    target = fold.psi_q()
    closes = [
        component.subs({sigma: new_sigma, eta: new_eta}, simultaneous=True) - goal
        for component, goal in zip(folded, target, strict=True)
    ]
    point = {sigma: sympy.Integer(-1), eta: -sympy.Rational(11, 10), r: HALF}  # t = eta + 3/2 > 0, before the horizon
    landed = {"sigma'": new_sigma.subs(point), "eta'": new_eta.subs(point)}
    launched = landed["sigma'"] < 0 and bool(sympy.N(landed["eta'"], 30) < 0)
    return every(
        [
            ("psi o p(h) = psi o q to second order", all(is_zero(component) for component in closes)),
            (
                "from the visible point sigma = -1, eta = -11/10 at r = 1/2 it lands on the visible part eta' < 0, sigma' < 0",
                launched,
            ),
            *first_component(new_sigma, order),
        ],
        witness=lambda: (
            {"sigma": "-1", "eta": "-11/10", "r": "1/2"}
            | {key: str(sympy.N(x, 15)) for key, x in landed.items()}
            | {"why": "a first hit comes before the horizon, where eta < 0"}
        ),
    )


CLAIMS = (
    Claim(
        id="e:pnew",
        section="4.1(a)",
        title="p at a tangency point",
        printed=Statement(
            r"p:(\sigma,t)\mapsto(\sigma,-k(3\sigma t+t^2)+O(3)),\ k=\tfrac16a'", (sigma, -k * (3 * sigma * t + t**2))
        ),
        verify=identity(fold.p),
        mutants=((sigma, k * (3 * sigma * t + t**2)), (sigma, -k * (3 * sigma * t + 2 * t**2))),
        rests_on=("e:degen",),
    ),
    Claim(
        id="e:phinew",
        section="4.1(a)",
        title="phi at a tangency point; the sign of the second component is misprinted",
        printed=Statement(
            r"\phi:(\sigma,t)\mapsto(\sigma+t,-k(3\sigma t+2t^2)+O(3))", (sigma + t, -k * (3 * sigma * t + 2 * t**2))
        ),
        verify=identity(_involuted, "the launch velocity after the involution"),
        corrected=lambda: Statement(
            rf"\phi:(\sigma,t)\mapsto\bigl({latex(fold.phi()[0])},\ {latex(sympy.factor(fold.phi()[1]))}+O(3)\bigr)",
            fold.phi(),
        ),
        mutants=((sigma + t, k * (3 * sigma * t + t**2)), (sigma, k * (3 * sigma * t + 2 * t**2))),
        rests_on=("e:phi", "e:degen"),
    ),
    Claim(
        id="s4-Z-line",
        section="4.1(a)",
        title="Z is 3 sigma + t = 0 to first order; phi takes sigma + t = 0 to the v-axis",
        printed=Statement(r"Z:\ 3\sigma+t=0+O(2),\qquad\phi(\{\sigma+t=0\})\subset\{\sigma=0\}", (-3 * sigma, -t)),
        verify=_z_line,
        mutants=((-3 * sigma / 2, -t), (-3 * sigma, t), (sympy.Integer(0), -t)),
        rests_on=("e:pnew", "e:phinew"),
    ),
    Claim(
        id="s4-fold-form",
        section="4.1(a)",
        title="in (sigma, eta) p is a fold up to O(3), and psi straightens its outline",
        printed=Statement(
            r"p=(\sigma,-k\eta^2+\tfrac94k\sigma^2+O(3)),\quad\psi\circ p=(\sigma,-k\eta^2+O(3)),\quad\eta=\tfrac32\sigma+t",
            (3 * sigma / 2 + t, (sigma, -k * eta**2 + QUARTERS * k * sigma**2), (sigma, -k * eta**2)),
        ),
        verify=identity(lambda: (fold.fold_coordinate(), fold.p_folded(), fold.psi_p())),
        mutants=(
            (3 * sigma / 2 + t, (sigma, -k * eta**2 - QUARTERS * k * sigma**2), (sigma, -k * eta**2)),
            (3 * sigma + t, (sigma, -k * eta**2 + QUARTERS * k * sigma**2), (sigma, -k * eta**2)),
        ),
        rests_on=("e:pnew", "s4-horizon-line"),
    ),
    Claim(
        id="s4-normal-id2",
        section="4.1(a)",
        title="the diffeomorphisms that remove the O(3) terms are the identity to second order",
        printed=Statement(r"\text{the changes agree with the identity up to terms of order }2", 2),
        verify=_identity_order,
        corrected=lambda: Statement(
            rf"\text{{the changes agree with the identity up to terms of order }}{fold_form(4).identity_order}",
            fold_form(4).identity_order,
        ),
        mutants=(0, 3),
        rests_on=("s4-fold-form",),
    ),
    Claim(
        id="e:pdef",
        section="4.1(a)",
        title="changes of source and target remove the higher-order terms of psi o p",
        printed=Statement(r"\psi\circ p:(\sigma,\eta)\mapsto(\sigma,-k\eta^2)", (sigma, -k * eta**2)),
        verify=_fold_form,
        mutants=((sigma, k * eta**2), (sigma, -k * eta**2 + sigma * eta)),
        rests_on=("s4-fold-form",),
    ),
    Claim(
        id="e:defq",
        section="4.1(a)",
        title="psi o q, q = R o phi; in the coordinates of e:pdef its first component has quadratic terms",
        printed=Statement(
            r"\psi\circ q=(\eta-\tfrac12\sigma,\,-rk(2\eta^2-3\sigma\eta)-\tfrac94k(\eta-\tfrac12\sigma)^2+O(3))",
            (
                eta - sigma / 2,
                -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2,
                sympy.oo,
            ),
        ),
        verify=_psi_q,
        corrected=lambda: Statement(
            r"\psi\circ q=(\eta-\tfrac12\sigma+O(2),\,-rk(2\eta^2-3\sigma\eta)-\tfrac94k(\eta-\tfrac12\sigma)^2+O(3))",
            (*fold.psi_q(), 2),
        ),
        mutants=(
            (eta - sigma / 2, r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, 2),
            (eta - sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta + sigma / 2) ** 2, 2),
            (eta - sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, 3),
            (eta + sigma / 2, -r * k * (2 * eta**2 - 3 * sigma * eta) - QUARTERS * k * (eta - sigma / 2) ** 2, 1),
        ),
        rests_on=("e:phinew", "e:pdef"),
    ),
    Claim(
        id="e:hdef",
        section="4.1(a)",
        title="h = p^{-1} o q on the visible part in the coordinates of e:pdef: the root is the negative one, + O(2) is missing",
        printed=Statement(
            r"h=\bigl(\eta-\tfrac12\sigma,\sqrt{Q_r(\sigma,\eta)+O(3)}\,\bigr)",
            (
                eta - sigma / 2,
                sympy.sqrt(r * (2 * eta**2 - 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2),
                sympy.oo,
            ),
        ),
        verify=_h,
        corrected=lambda: Statement(
            r"h=\bigl(\eta-\tfrac12\sigma+O(2),-\sqrt{Q_r(\sigma,\eta)+O(3)}\,\bigr),\quad\sigma<0", (*fold.h(), 2)
        ),
        mutants=(
            (eta - sigma / 2, eta, 2),
            (eta + sigma / 2, -sympy.sqrt(2 * r * eta**2 + QUARTERS * sigma**2), 2),
            (*fold.h(), 3),
            (*fold.h(), sympy.oo),
        ),
        rests_on=("e:pdef", "e:defq", "e:qdef"),
    ),
    Claim(
        id="e:qdef",
        section="4.1(a)",
        title="Q_r, the square of the new eta",
        printed=Statement(
            r"Q_r(\sigma,\eta)=r(2\eta^2-3\sigma\eta)+\tfrac94(\eta-\tfrac12\sigma)^2",
            r * (2 * eta**2 - 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2,
        ),
        verify=identity(fold.Q_r),
        mutants=(
            r * (2 * eta**2 + 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2,
            -r * (2 * eta**2 - 3 * sigma * eta) + QUARTERS * (eta - sigma / 2) ** 2,
        ),
        rests_on=("s4-fold-form", "e:defq"),
    ),
)
