"""Section 3: nondegenerate chatter at regular points of Pi_0."""

from typing import Any

import sympy

from singimpact.algebra.certificates import positive_on, value_at
from singimpact.paper.claims.claim import Check, Claim, Statement
from singimpact.paper.claims.sections.section2_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, identity, is_zero, same
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import a_symbol, r, sigma, t
from singimpact.paper.trials import true_orbits
from singimpact.theory.notation import latex

a = a_symbol(0)
NORMALLY_HYPERBOLIC = "the theorem of Hirsch, Pugh and Shub"
_MAP = r"(\sigma,t)\mapsto"


def _image(matrix: sympy.MatrixBase) -> tuple[sympy.Expr, sympy.Expr]:
    return tuple(matrix * sympy.Matrix([sigma, t]))


def _eigenvectors(stated: tuple[tuple[Any, tuple[Any, Any]], ...]) -> Check:
    """Each (eigenvalue, vector) satisfies DG vector = eigenvalue vector, and the two vectors are independent."""
    matrix = route.DG()
    sides = [(matrix * sympy.Matrix(vector), value * sympy.Matrix(vector)) for value, vector in stated]
    return every(
        [
            (
                "DG v = lambda v for both vectors",
                all(same(x, y) for left, right in sides for x, y in zip(left, right, strict=True)),
            ),
            ("they are independent", not is_zero(sympy.Matrix([list(vector) for _, vector in stated]).det())),
        ]
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
        [
            ("the direction is the eigenvector of DG for r", good),
            ("0 < r < 1 contracts across Pi_0, on which G is the identity: Pi_0 is normally hyperbolic", contracting),
        ],
        modulo=(NORMALLY_HYPERBOLIC,),
        tried=trial,
        witness=witness,
    )


def _normally_hyperbolic(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(multiplier along Pi_0, multiplier across): 1, as G is the identity there, and a contraction for every r in (0, 1)."""
    (along, tangent), (across, direction) = route.eigenvectors()
    at_rest = route.y_c(2).subs({t: 0, route.sigma: 0, route.v: 0})
    return every(
        [
            ("a launch with v = 0 is at rest where a < 0: Pi_0 consists of fixed points", is_zero(at_rest)),
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
    return every([(what, all(abs(order - stated) < 0.25 for order in orders))], kind="cited")


CLAIMS = (
    Claim(
        id="s3-Dp",
        section="3.1",
        title="the derivative of p at a point of Pi_0",
        printed=Statement(rf"Dp(z_*):{_MAP}(\sigma,-\tfrac12a_*t)", (sigma, -a * t / 2)),
        verify=identity(lambda: _image(route.Dp())),
        mutants=((sigma, a * t / 2), (sigma + t, -a * t / 2)),
        rests_on=("e:acc",),
    ),
    Claim(
        id="s3-dvdt",
        section="3.1",
        title="dv_c/dt at z_*; the sign printed here contradicts e:acc",
        printed=Statement(r"\frac{\partial v_c}{\partial t}(z_*)=\tfrac12a_*", a / 2),
        verify=identity(route.slope_at_rest),
        corrected=lambda: Statement(
            rf"\frac{{\partial v_c}}{{\partial t}}(z_*)={latex(route.slope_at_rest())}", route.slope_at_rest()
        ),
        mutants=(a, -a),
        rests_on=("e:acc",),
    ),
    Claim(
        id="s3-Dphi",
        section="3.1",
        title="the derivative of phi at a point of Pi_0",
        printed=Statement(rf"D\phi(z_*):{_MAP}(\sigma+t,\tfrac12a_*t)", (sigma + t, a * t / 2)),
        verify=identity(lambda: _image(route.Dphi())),
        mutants=((sigma + t, -a * t / 2), (sigma, a * t / 2)),
        rests_on=("e:phi",),
    ),
    Claim(
        id="s3-DG",
        section="3.1",
        title="the derivative of G at a regular point",
        printed=Statement(r"DG(w_*)=\begin{pmatrix}1&-2/a_*\\0&r\end{pmatrix}", sympy.Matrix([[1, -2 / a], [0, r]])),
        verify=identity(route.DG, "derived as DR Dphi Dp^(-1)"),
        mutants=(sympy.Matrix([[1, 2 / a], [0, r]]), sympy.Matrix([[1, -2 / a], [0, -r]])),
        rests_on=("s3-Dp", "s3-Dphi"),
    ),
    Claim(
        id="s3-eigenvectors",
        section="3.1",
        title="eigenvectors of DG(w_*): along Pi_0, and the direction of chatter",
        printed=Statement(
            r"(1,0)\ \text{for}\ 1,\qquad(2,a_*(1-r))\ \text{for}\ r", ((1, (1, 0)), (r, (2, a * (1 - r))))
        ),
        verify=_eigenvectors,
        mutants=(
            ((1, (1, 0)), (r, (2, a * (r - 1)))),
            ((1, (1, 0)), (r, (1, a * (1 - r)))),
            ((r, (1, 0)), (1, (1, 0))),
        ),
        rests_on=("s3-DG",),
    ),
    Claim(
        id="s3-slope-r",
        section="3.1",
        title="the slope (1-r)a/2 of the chatter direction tends to 0 as r -> 1",
        printed=Statement(r"\lim_{r\to1}\tfrac12(1-r)a_*=0", sympy.Integer(0)),
        verify=_slope_limit(r, 1),
        mutants=(a / 2, sympy.Integer(1)),
        rests_on=("s3-eigenvectors",),
    ),
    Claim(
        id="t:t1",
        section="3.1",
        title="through each (tau, 0) with a < 0 passes a stable manifold tangent to (2, (1-r)a)",
        printed=Statement(r"T_{(\tau,0)}W^s_\tau=\langle(2,(1-r)a(\tau))\rangle", (2, (1 - r) * a)),
        verify=_slope_sign,
        mutants=((2, (1 + r) * a), (1, (1 - r) * a)),
        rests_on=("s3-eigenvectors",),
    ),
    Claim(
        id="t:t1-foliation",
        section="3.1",
        title="W^s_tau consists of the states that converge to (tau, 0), and these curves foliate a neighbourhood continuously",
        printed=Statement(
            r"W^s_\tau=\{u:G^n(u)\to w_\tau\},\quad\text{multipliers}\ 1\ \text{along}\ \Pi_0,\ r\ \text{across}",
            (sympy.Integer(1), r),
        ),
        verify=_normally_hyperbolic,
        mutants=((sympy.Integer(1), 1 / r), (r, sympy.Integer(1)), (sympy.Integer(1), -r)),
        rests_on=("s3-eigenvectors", "t:t1"),
    ),
    Claim(
        id="s3-takens",
        section="3.1",
        title="the stable manifolds form a smooth foliation (theorem of Takens, quoted)",
        printed=Statement(r"\Phi:J\times\mathbf R\to U\ \text{is a}\ C^\infty\ \text{diffeomorphism}", 3),
        verify=_smooth_foliation,
        mutants=(2, 4),
        rests_on=("t:t1",),
    ),
    Claim(
        id="s3-slope",
        section="3.1",
        title="the slope of the stable manifolds at Pi_0 tends to 0 as a -> 0",
        printed=Statement(r"\lim_{a\to0}\tfrac12(1-r)a=0", sympy.Integer(0)),
        verify=_slope_limit(a, 0),
        mutants=((1 - r) / 2,),
        rests_on=("s3-eigenvectors", "t:t1"),
    ),
)
