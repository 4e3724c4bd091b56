"""Section 6: how an oscillator near a swan follows the universal model, and by which conditions what holds there persists.

In lengths scaled by H the velocities of an oscillator are those of the model plus H times smooth functions, on bounded
sets.  So a simple zero, a transverse crossing, a nondegenerate cusp and an inequality that is strict on a closed set
persist for small H: each by the implicit function theorem or by compactness, once a number is not 0.  `near_the_swan`
decides these numbers.  Where a quadratic form is definite, nothing else is near the swan either: it outweighs the rest.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import sympy

from singimpact.algebra.certificates import definite
from singimpact.paper.claims.claim import Check
from singimpact.paper.claims.verifiers import every, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import Weights, kappa, sigma, t

Named = Sequence[tuple[str, Any]]


def near_the_swan(check: Check, conditions: Named) -> Check:
    """A check in the model with the conditions by which its statement persists: it fails where one does not hold.

    Parameters
    ----------
    conditions : (what, value): a value that must not be 0 for any kappa but 0, or whether the condition holds.
    """
    conditions_ = [
        (f"{what} holds", value) if isinstance(value, bool) else (f"{what} = {value}", nonzero(value))
        for what, value in conditions
    ]
    failed = [name for name, holds in conditions_ if not holds]
    if not conditions or failed:
        return replace(check, holds=False, evidence=f"{check.evidence}; does not persist near the swan: {failed}")
    persists = f"persists near the swan for small H, since {'; '.join(name for name, _ in conditions_)}"
    return replace(check, evidence=f"{check.evidence}; {persists}", transverse=tuple(name for name, _ in conditions_))


def persisting(
    checks: Sequence[tuple[str, bool]], conditions: Named, witness: Callable[[], dict[str, str]] | None = None
) -> Check:
    """One check in the model from several named ones, with the conditions by which its statement persists.

    Parameters
    ----------
    checks, witness : as of `every`. conditions : as of `near_the_swan`.
    """
    return near_the_swan(every(checks, witness=witness), conditions)


def nonzero(value: sympy.Expr) -> bool:
    """Whether a number times a power of kappa is not 0; other expressions are not decided, and count as 0.

    Examples
    --------
    >>> nonzero(-24 * sympy.sqrt(3) * kappa), nonzero(kappa - kappa), nonzero(kappa + 1)
    (True, False, False)
    """
    terms = sympy.Poly(sympy.expand(value), kappa).terms()
    return len(terms) == 1 and bool(terms[0][1].is_number) and terms[0][1] != 0


def at(expression: Any, point: tuple[sympy.Expr, sympy.Expr]) -> Any:
    """An expression in (sigma, t) at a point."""
    return sympy.expand(sympy.sympify(expression).subs({sigma: point[0], t: point[1]}, simultaneous=True))


def crossing(point: tuple[sympy.Expr, sympy.Expr]) -> Any:
    """The Jacobian of the horizon and the zero set at a point: not 0 where they cross transversely."""
    return at(sympy.Matrix([model.horizon(), model.zero_set()]).jacobian([sigma, t]).det(), point)


def regular_conic() -> bool:
    """Whether the horizon has no singular point, and nothing of it is near a swan outside the region of its ellipse.

    It is a definite form less 6, and sigma d/dsigma + t d/dt takes it to twice this form, which is 12 on the horizon.
    """
    conic = model.horizon()
    grown = sigma * sympy.diff(conic, sigma) + t * sympy.diff(conic, t)
    return same(grown, 2 * conic + 12) and definite(conic + 6, sigma, t) == 1


def scaling_check(stated: tuple[Weights, Any]) -> Check:
    """The powers of H, and the launch velocity to which that of any oscillator tends, as a polynomial in (sigma, t, e)."""
    weights, leading = stated
    try:
        limit, rest = model.scaled(weights)
        near = model.leading_launch(weights)
    except ArithmeticError as error:
        return Check(False, "proved", str(error), {"weights": str(tuple(weights))})
    height = model.y * t - t * model.limit_launch()  # of the model, at t: x - c = t (x' - v) for the launch x'
    checks = every(
        [
            (
                f"x'' = {limit} + H ({rest}) in scaled lengths, with smooth functions alpha, phi_1, phi_2: smooth at H = 0",
                limit == model.limit_acceleration() and sympy.sympify(rest).is_polynomial(model.H),
            ),
            (f"the model's launch velocity is {sympy.factor(leading)}", same(leading, model.limit_launch())),
            ("it is the leading part of v_c of any oscillator, to all jets", same(near, leading)),
        ],
        witness=lambda: {"kappa": "1", "limit": str(limit), "v": str(sympy.factor(near))},
    )
    slope = sympy.diff(sympy.cancel(height / t), model.y)
    return near_the_swan(checks, [("dy/dv of y = (x - c)/t in the model, at every time", slope)])
