"""Section 2: from the equation of motion to the sheet v_c and the two maps p_c and phi_c."""

from typing import Any

import sympy

from singimpact.documents.arranging import by_degree
from singimpact.documents.document_steps import Section, Step
from singimpact.documents.rendering import PAGE, lines_of, width
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import f_symbol, sigma, t, v
from singimpact.theory.notation import joined, latex

# Lines and letters that section 4 takes over.


def with_b(expression: Any) -> Any:
    """The damping in the paper's letter: f_01 = -b."""
    return sympy.expand(expression.subs(f_symbol(0, 1), -sympy.Symbol("b")))


def rows(left: str, parts: list[str], remainder: int | None = None) -> tuple[str, ...]:
    """``left = parts[0] + parts[1] + ... + O(remainder)``, one part a line, the signs under the first part.

    Examples
    --------
    >>> rows("v", ["a", "-b"], 3)
    ('v ={}& a', '& - b + O(3)')
    """
    first, *rest = parts
    signed = [first, *(f"- {entry[1:]}" if entry.startswith("-") else f"+ {entry}" for entry in rest)]
    if remainder is not None:
        signed[-1] += f" + O({remainder})"
    room = PAGE.line - width(left) - PAGE.sign
    lines = [
        rf"& \quad {line}" if at else f"& {line}" for entry in signed for at, line in enumerate(lines_of(entry, room))
    ]
    return (f"{left} ={{}}{lines[0]}", *lines[1:])


def told() -> Section:
    """The steps of section 2."""
    return Section(
        "section2", "2. The impact surface near the launches at rest", (*_flight(), *_sheet(), *_maps(), *_singular())
    )


def _flight() -> tuple[Step, ...]:
    parts = by_degree(with_b(route.y_c(3)), v, sigma, t)
    return (
        Step(
            "Let $x_c(\\tau, v; t)$ be the height at time $\\tau + t$ of the mass launched at $(\\tau, v)$. The "
            "equation of motion fixes its Taylor coefficients in $t$ one after the other: the first two are $c$ and "
            "$v$, and each further one comes from the earlier ones put into $g - f$. So $x_c - c$ can be divided by "
            "$t$: $x_c = c + t y_c$, and the quotient is smooth.",
            rows(r"y_c(\tau_* + \sigma, v; t)", parts, 4),
            "e:yeq",
            ("e:yeq", "s2-ivp"),
        ),
    )


def _sheet() -> tuple[Step, ...]:
    return (
        Step(
            "The division has removed the launch itself, $t = 0$, from the zeros of $x_c - c$; what is left of the "
            "impact surface is the set $y_c = 0$. On $t = 0$ the series reduces to one term:",
            rf"y_c(\tau, v; 0) = {latex(route.y_c(3).subs(t, 0))}",
            "e3",
            ("e3",),
        ),
        Step(
            "Hence $\\partial y_c/\\partial v = 1$ there, and by the implicit function theorem $y_c = 0$ is the "
            "graph of a smooth $v = v_c(\\tau, t)$. Solving degree by degree, with one new degree gained at every "
            "turn of $v \\leftarrow v - y_c$:",
            rows(r"v_c(\tau_* + \sigma, t)", by_degree(with_b(route.v_c(2)), sigma, t), 3),
            "e:imp",
            ("s2-two-sheets", "s2-smooth"),
        ),
        Step(
            "The first term says how steeply the sheet leaves $\\Pi_0$. It holds at every phase, as $\\tau_*$ was any:",
            rf"\frac{{\partial v_c}}{{\partial t}}(\tau, 0) = {latex(route.slope_at_rest())}_c(\tau)",
            "e:acc",
            ("e:acc",),
        ),
    )


def _maps() -> tuple[Step, ...]:
    launch, impact = (joined(by_degree(with_b(images[1]), sigma, t)) for images in (route.p_c(2), route.phi_c(2)))
    when = route.phi_c(2)[0]
    return (
        Step(
            "A point $(\\tau, t)$ of the sheet is a flight between two impacts. Two maps read off where it begins "
            "and how it ends. The first gives launch phase and launch velocity:",
            rf"p_c : (\sigma, t) \mapsto \bigl({latex(sigma)},\ {launch} + O(3)\bigr)",
            "e:proj",
        ),
        Step(
            "The second gives impact phase and impact velocity, the derivative of $c + t y_c$ by $t$ taken at $v = "
            "v_c$. Read backwards in time the same flight is launched at $\\tau + t$ and lasts $-t$, so the velocity "
            "is also $v_c$ after the exchange $(\\sigma, t) \\to (\\sigma + t, -t)$; the verdict rests on both ways "
            "giving one series.",
            rf"\phi_c : (\sigma, t) \mapsto \bigl({latex(when)},\ {impact} + O(3)\bigr)",
            "e:phi",
            ("e:phi",),
        ),
        Step(
            "With the bounce $R : (\\tau, v) \\mapsto (\\tau, -r v)$ the dynamics is $G_c$, defined by $G_c \\circ "
            "p_c = R \\circ \\phi_c$ on the flights whose landing is the first one."
        ),
    )


def _singular() -> tuple[Step, ...]:
    """Where the two maps are singular, the first hit, and the correspondence of launches and landings."""
    return (
        Step(
            "Where $y_c = 0$ the velocity is $\\dot x_c = t\\, \\partial y_c/\\partial t$, and implicit "
            "differentiation turns it into the slope of the sheet:",
            r"\dot x_c = -t\, \frac{\partial y_c}{\partial v}\, \frac{\partial v_c}{\partial t}",
            "s2-xdot",
            ("s2-horizon",),
        ),
        Step(
            "So $p_c$ is singular on the horizon $H_c$, the flights that graze at their end, and of $\\Pi_0$ at the "
            "tangency points alone. At folds and cusps it has Whitney's normal forms. Of $\\phi_c$ the same holds "
            "after the involution, which takes $H_c$ to the set $Z_c$ of flights launched at rest:",
            r"\det D\phi_c(\tau, t) = -\frac{\partial v_c}{\partial t}(\tau + t, -t)",
            "s2-det-phi",
            ("p:phising-set", "p:phising-fold", "p:phising-cusp", "s2-fold-cusp-forms"),
            "figure1",
        ),
        Step(
            "A mass meets the wall at the first zero of $x_c - c$, which defines $F_c$, the map from states to "
            "flights. At rest it lifts off where $x_c > c$ for small $t > 0$, and stays otherwise. $F_c$ jumps only "
            "where that first hit is a graze.",
            "",
            "",
            ("s2-lift-off-sign", "s2-first-hit-rest", "s2-discontinuity"),
        ),
        Step(
            "Read backwards in time a flight that ends at rest is one that begins at rest. So $p_c$ and $\\phi_c$ "
            "exchange $H_c$ and $Z_c$ off $\\Pi_0$: what the outline $P_c = p_c(H_c)$ shows at a launch, $\\Pi_0$ "
            "shows at the landing. At visible points $G_c \\circ p_c = R \\circ \\phi_c$.",
            "",
            "",
            ("s2-corr-sets", "p:corresp", "s2-G-semiconj"),
        ),
        Step(
            "Flights of any length may rest at infinitely many phases that are not alike. In the undamped model with "
            "an irrational frequency their outline is dense in a region; where all is periodic in $t$, or $t$ is "
            "bounded, it is not.",
            "",
            "",
            ("s2-dense",),
        ),
    )
