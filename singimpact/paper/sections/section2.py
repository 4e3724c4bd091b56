"""Section 2: from the equation of motion to the sheet v_c and the two maps p_c and phi_c."""

from __future__ import annotations

from singimpact.documents.arranging import by_degree
from singimpact.documents.steps import Section, Step
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import sigma, t, v
from singimpact.paper.sections.letters import rows, with_b
from singimpact.theory.notation import joined, latex


def told() -> Section:
    """The steps of section 2."""
    return Section("section2", "2. The impact surface near the launches at rest", (*_flight(), *_sheet(), *_maps()))


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
            ("e:yeq",),
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
