"""Section 3: the derivative of G at a regular point, and the direction along which chatter comes to rest."""

from typing import Any

from singimpact.documents.arranging import factored
from singimpact.documents.document_steps import Section, Step
from singimpact.paper.routes import implicit as route
from singimpact.theory.notation import latex


def told() -> Section:
    """The steps of section 3."""
    return Section("section3", "3. Chatter at a regular point", (*_derivatives(), *_directions()))


def _derivatives() -> tuple[Step, ...]:
    return (
        Step(
            "At a regular point $z_*$ of $\\Pi_0$, where $a \\ne 0$, the linear parts of the two maps are read off "
            "from the first-order terms of $v_c$ and of the impact velocity, as matrices in $(\\sigma, t)$:",
            rf"Dp(z_*) = {latex(route.Dp())}",
            "s3-Dp",
            ("s3-Dp", "s3-dvdt"),
        ),
        Step("and", rf"D\phi(z_*) = {latex(route.Dphi())}", "s3-Dphi", ("s3-Dphi",)),
        Step(
            "Since $a \\ne 0$ the first one can be inverted, so $p$ is a local diffeomorphism and $G = R \\circ "
            "\\phi \\circ p^{-1}$ is smooth near $w_* = p(z_*)$, with $DG = DR\\, D\\phi\\, (Dp)^{-1}$:",
            rf"DG(w_*) = {latex(route.DG())}",
            "s3-DG",
            ("s3-DG",),
        ),
    )


def _directions() -> tuple[Step, ...]:
    along, across = route.eigenvectors()
    slope = across[1][1] / across[1][0]
    return (
        Step(
            "The matrix is triangular, so its eigenvalues stand on the diagonal. One eigenvector lies along "
            "$\\Pi_0$, whose points $G$ leaves where they are; the other crosses it and is contracted by $r$:",
            rf"{_vector(along)}, \qquad {_vector(across)}",
            "s3-eigenvectors",
            ("s3-eigenvectors",),
        ),
        Step(
            "For $a < 0$ the wall holds the mass, and $\\Pi_0$ is a normally attracting line of fixed points. "
            "Through each of them passes a stable manifold, all of whose orbits chatter to rest at that phase; it "
            "leaves $\\Pi_0$ with the slope of the second eigenvector. That slope goes to zero as $r \\to 1$ and as "
            "$a \\to 0$: towards a tangency point the stable manifolds lie down on $\\Pi_0$, and the linear part no "
            "longer decides.",
            rf"\frac{{dv}}{{d\sigma}} = {factored(slope)}",
            "s3-slope",
            ("t:t1", "t:t1-foliation", "s3-slope", "s3-slope-r", "s3-takens"),
        ),
    )


def _vector(pair: tuple[Any, Any]) -> str:
    value, vector = pair
    return rf"{latex(vector.applyfunc(_in_factors))}\ \text{{for}}\ {latex(value)}"


def _in_factors(entry: Any) -> Any:
    import sympy

    return sympy.factor(entry)
