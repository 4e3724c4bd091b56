"""Section 3: nondegenerate chatter at regular points of Pi_0."""

from typing import Any

import sympy

from singimpact.algebra.certificates import positive_on, value_at
from singimpact.paper.claims.claim import Check, Encoding, Statement
from singimpact.paper.claims.sections.section2_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import agree, every, identity, is_eigenvector, is_zero, same, sample
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import a_symbol, r, sigma, t
from singimpact.paper.trials import true_orbits
from singimpact.theory.notation import latex

a = a_symbol(0)
NORMALLY_HYPERBOLIC = "the theorem of Hirsch, Pugh and Shub"


def _image(matrix: sympy.MatrixBase) -> tuple[sympy.Expr, sympy.Expr]:
    return tuple(matrix * sympy.Matrix([sigma, t]))


def _eigenvectors(stated: tuple[tuple[Any, tuple[Any, Any]], ...]) -> Check:
    """Each (eigenvalue, vector) satisfies DG vector = eigenvalue vector, and the two vectors are independent."""
    return every(
        {
            "DG v = lambda v for both vectors": all(
                is_eigenvector(route.DG(), value, vector) for value, vector in stated
            ),
            "they are independent": not is_zero(sympy.Matrix([list(vector) for _, vector in stated]).det()),
        }
    )


def _is_slope_at_rest(stated: sympy.Expr) -> Check:
    """dv_c/dt at z_*: with it y_c vanishes to first order on v = t dv_c/dt."""
    return every(
        {
            "with this slope v_c makes y_c vanish to first order": agree(
                route.y_c(1), {sigma: 0, route.v: stated * t}, 0
            )
        },
        witness=lambda: sample(stated, route.slope_at_rest()),
    )


def _slope_limit(variable: sympy.Expr, point: int) -> Any:
    """A verifier: the slope of the contracting eigendirection has the stated limit as `variable` tends to `point`."""

    def limit() -> Any:
        value, vector = route.eigenvectors()[1]
        if not is_zero(value - r):
            raise ArithmeticError(f"the direction of chatter belongs to the eigenvalue {value}, not r")
        return value_at(vector[1] / vector[0], variable, point)

    return identity(limit, "the limit of the slope of the eigenvector derived")


def _slope_sign(stated: tuple[int, sympy.Expr]) -> Check:
    """The direction is the eigenvector, its slope is negative for a < 0, and chatter on true orbits follows it."""
    value, vector = route.eigenvectors()[1]
    slope = sympy.cancel(vector[1] / vector[0])
    good = is_zero(stated[1] / stated[0] - slope)
    contracting = is_zero(value - r) and positive_on(r, r, 0, 1) and positive_on(1 - r, r, 0, 1)

    def trial() -> tuple[str, bool]:
        found = true_orbits.chatter_slopes()
        worst = max(abs(case.found / float(slope.subs({a: case.a, r: case.r})) - 1) for case in found)
        return f"orbits on {len(found)} models reach Pi_0 along it, worst relative error {worst:.1e}", worst < 1e-4

    def witness() -> dict[str, str]:
        case = true_orbits.chatter_slopes()[0]
        return {
            "model": case.name,
            "found slope": f"{case.found:.10f}",
            "stated": f"{float((stated[1] / stated[0]).subs({a: case.a, r: case.r})):.10f}",
        }

    return every(
        {
            "the direction is the eigenvector of DG for r": good,
            "0 < r < 1 contracts across Pi_0, on which G is the identity: Pi_0 is normally hyperbolic": contracting,
        },
        modulo=(NORMALLY_HYPERBOLIC,),
        tried=trial,
        witness=witness,
    )


def _normally_hyperbolic(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(multiplier along Pi_0, multiplier across): 1, as G is the identity there, and a contraction for every r in (0, 1)."""
    (along, tangent), (across, direction) = route.eigenvectors()
    return every(
        [
            (
                "a launch with v = 0 is at rest where a < 0: Pi_0 consists of fixed points",
                agree(route.y_c(2), {t: 0, route.v: 0}, 0),
            ),
            (f"the multiplier along it is {along}", same(along, stated[0]) and is_zero(tangent[1])),
            (
                f"that across it is {across}, in (0, 1) for every r in (0, 1), and its direction is not along Pi_0",
                same(across, stated[1])
                and positive_on(across, r, 0, 1)
                and positive_on(1 - across, r, 0, 1)
                and not is_zero(direction[1]),
            ),
        ],
        modulo=(NORMALLY_HYPERBOLIC,),
    )


def _smooth_foliation(stated: int) -> Check:
    """Off its expansion to v^2, smooth in tau, tau_inf on true orbits differs by a term of the stated order."""
    orders = true_orbits.completion_orders()
    shown = ", ".join(f"{order:.2f}" for order in orders)
    what = f"theorem quoted; on true orbits tau_inf differs from a smooth expansion to v^2 by order {shown}"
    return every({what: all(abs(order - stated) < 0.25 for order in orders)}, kind="cited")


CLAIMS = {
    "s3-Dp": Encoding(
        (sigma, -a * t / 2), identity(lambda: _image(route.Dp())), ((sigma, a * t / 2), (sigma + t, -a * t / 2))
    ),
    "s3-dvdt": Encoding(
        a / 2,
        _is_slope_at_rest,
        (a, -a),
        lambda: Statement(
            f"\\frac{{\\partial v_c}}{{\\partial t}}(z_*)={latex(route.slope_at_rest())}", route.slope_at_rest()
        ),
    ),
    "s3-Dphi": Encoding(
        (sigma + t, a * t / 2), identity(lambda: _image(route.Dphi())), ((sigma + t, -a * t / 2), (sigma, a * t / 2))
    ),
    "s3-DG": Encoding(
        sympy.Matrix([[1, -2 / a], [0, r]]),
        identity(route.DG, "derived as DR Dphi Dp^(-1)"),
        (sympy.Matrix([[1, 2 / a], [0, r]]), sympy.Matrix([[1, -2 / a], [0, -r]])),
    ),
    "s3-eigenvectors": Encoding(
        ((1, (1, 0)), (r, (2, a * (1 - r)))),
        _eigenvectors,
        (((1, (1, 0)), (r, (2, a * (r - 1)))), ((1, (1, 0)), (r, (1, a * (1 - r)))), ((r, (1, 0)), (1, (1, 0)))),
    ),
    "s3-slope-r": Encoding(sympy.Integer(0), _slope_limit(r, 1), (a / 2, sympy.Integer(1))),
    "t:t1": Encoding((2, (1 - r) * a), _slope_sign, ((2, (1 + r) * a), (1, (1 - r) * a))),
    "t:t1-foliation": Encoding(
        (sympy.Integer(1), r),
        _normally_hyperbolic,
        ((sympy.Integer(1), 1 / r), (r, sympy.Integer(1)), (sympy.Integer(1), -r)),
    ),
    "s3-takens": Encoding(3, _smooth_foliation, (2, 4)),
    "s3-slope": Encoding(sympy.Integer(0), _slope_limit(a, 0), ((1 - r) / 2,)),
}
