"""The model as the reader of a paper would write it, in LaTeX."""

from __future__ import annotations

from collections.abc import Mapping

from singimpact.algebra.expressions import Expression
from singimpact.algebra.rings import to_sympy
from singimpact.oscillator.rebound import rho_of


def equation(
    f: Expression, g: Expression, clearance: Expression, restitution: Expression, parameters: Mapping[str, Expression]
) -> str:
    """x'' + f = g, the wall, the rebound, and the numbers that the letters stand for.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> osc = Oscillator("x + x**3", "t*omega", 1, "1/2", {"omega": 2})
    >>> print(equation(osc.f, osc.g, osc.clearance, osc.restitution, osc.parameters))
    \\ddot x + x^{3} + x = \\omega t,\\quad x \\ge 1,\\quad v \\mapsto - \\frac{v}{2},\\quad \\omega = 2
    """
    force = "" if to_sympy(f) == 0 else f" + {latex(f)}".replace("+ -", "-")
    parts = [rf"\ddot x{force} = {latex(g)}", rf"x \ge {latex(clearance)}"]
    parts.append(rf"v \mapsto {latex(rho_of(restitution))}")
    parts += [f"{latex_name(name)} = {latex(value)}" for name, value in parameters.items()]
    return r",\quad ".join(parts)


def latex(tree: Expression) -> str:
    """LaTeX of an expression of a model; x' has its dot."""
    import sympy

    return str(sympy.latex(to_sympy(tree), symbol_names={sympy.Symbol("xdot"): r"\dot x"}))


def latex_name(name: str) -> str:
    """LaTeX of the name of a parameter."""
    import sympy

    return str(sympy.latex(sympy.Symbol(name)))
