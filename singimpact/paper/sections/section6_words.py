"""Section 6: the unfolded swan in its universal form, where every curve is algebraic."""

from typing import Any

import sympy

from singimpact.documents.arranging import factored, in_powers
from singimpact.documents.document_steps import Section, Step
from singimpact.paper.claims.sections.section6_exact import LANDING, OUTLINE, z
from singimpact.paper.routes import unfolding as swan
from singimpact.paper.routes.unfolding import (
    WEIGHTS,
    A,
    B,
    C,
    D,
    E,
    alpha,
    limit_acceleration,
    limit_launch,
    phi_1,
    phi_2,
    r,
    scaled,
    sigma,
    t,
    y,
)
from singimpact.theory.notation import latex, name_of


def told() -> Section:
    """The steps of section 6."""
    return Section("section6", "6. An unfolded swan", (*_model(), *_curves(), *_positive(), *_negative()))


def _scaled() -> str:
    """The equation of motion in scaled lengths: its limit, then what has the factor H."""
    limit, rest = scaled(WEIGHTS)
    names = {alpha: sympy.Symbol(r"\alpha"), phi_1: sympy.Symbol(r"\varphi_1"), phi_2: sympy.Symbol(r"\varphi_2")}
    names |= {y: sympy.Symbol("x'")}
    return rf"x'' = {latex(limit)} + H\left({latex(rest.subs(names))}\right)"


def _model() -> tuple[Step, ...]:
    push = -limit_acceleration().subs(sigma, sympy.Symbol("s"))  # -a at s
    return (
        Step(
            "As $c$ passes the value $c_0$ of a swan point, where $a_c = a_c' = 0$ at $\\tau_*$, two zeros $A$, $B$ of "
            "$a_c$ are born on one side. For $c$ near $c_0$ the function $a_c$ has one extremum near $\\tau_*$. "
            "$\\sigma$ is measured from there, $24\\kappa$ is $a_c''$ there and $12\\kappa e$ is $a_c$ there, so that "
            "the zeros exist where $e < 0$. Hadamard's lemma writes the rest of the equation of motion with smooth "
            "functions, $a_c = 12\\kappa(e + \\sigma^2) + \\sigma^3\\alpha$ and $f(c + x, x') - f(c, 0) = x\\varphi_1 "
            "+ x'\\varphi_2$. With $\\sigma, t, e, x, x'$ multiplied by $H, H, H^2, H^4, H^3$ it becomes",
            _scaled(),
            "s6-scaled",
            ("s6-d", "s6-c-side", "s6-a0-typo"),
        ),
        Step(
            "The right side is smooth in $H$ at $H = 0$. So are the flights and, since the slope of $(x - c)/t$ by the "
            "launch velocity is 1 at $H = 0$, this velocity. On bounded sets it is, with all its derivatives,",
            rf"v_c(H\sigma, Ht) = H^3\left({factored(limit_launch())} + O(H)\right)",
            "s6-scaling",
            ("s6-scaling",),
        ),
        Step(
            "In the plane of all flights those from rest, $R(\\cdot; s)$, form a curve. It has the direction of "
            "$T - s$ everywhere, and stops at the zeros of $a_c$: they are its cusps. Two are born with one crossing, "
            "at $s^2 = -3e$, in a swallowtail, which $P$ shows wherever such a flight was launched with $v > 0$:",
            rf"\frac{{\partial R}}{{\partial s}}(T; s) = {factored(push)}\,(T - s)",
            "s6-front",
            ("s6-swallowtail",),
        ),
        Step(
            "What holds in the limit by simple zeros, transverse crossings and strict inequalities holds near the swan "
            "for small $H$. With half the distance of the zeros for $H$ it is $e = -1$, and one model is left:",
            rf"a(\sigma) = {latex(swan.acceleration())}",
            "s6-model",
        ),
        Step(
            "with $\\kappa > 0$ at a positive swan and $\\kappa < 0$ at a negative one. Two integrations give the "
            "launch velocity of the flight that lands after $t$,",
            rf"v(\sigma, t) = {factored(swan.launch_velocity())}",
            "s6-launch",
            ("s6-sections",),
        ),
        Step(
            "and the involution the velocity at its landing:",
            rf"\dot x(\sigma, t) = {factored(swan.impact_velocity())}",
            "s6-impact",
        ),
    )


def _curves() -> tuple[Step, ...]:
    return (
        Step(
            "So the horizon and the zero set are two ellipses, images of each other under the involution; both pass "
            "through $A = (-1, 0)$ and $B = (1, 0)$.",
            rf"H:\ {in_powers(swan.horizon(), t)} = 0",
            "s6-horizon",
            ("s6-lips",),
        ),
        Step("and", rf"Z:\ {in_powers(swan.zero_set(), t)} = 0", "s6-zero-set"),
        Step(
            "The two curves meet again at the flight that starts and ends at rest,",
            rf"E = {latex(E)}",
            "s6-E",
        ),
        Step(
            "The zeros $A$ and $B$ of $a$ are each the landing of one more flight: $p$ has cusps where a flight lands "
            "at rest on one of them, $\\phi$ where it leaves there at rest. For $t > 0$ these are, with their images,",
            rf"D = {latex(D)},\quad p(D) = {latex(swan.project(D))},\quad \phi(D) = {latex(swan.reset(D))}",
            "s6n-corr",
            ("s6n-corr", "s6n-corr-A"),
        ),
        Step(
            "and",
            rf"C = {latex(C)},\quad p(C) = {latex(swan.project(C))},\quad \phi(C) = {latex(swan.reset(C))}",
            "s6n-cusp",
            ("s6n-cusp", "s6n-C"),
        ),
    )


def _slope(place: tuple[Any, Any], curve: Any, image: tuple[Any, Any]) -> Any:
    """The slope of the image of a curve at a place, along the curve's tangent."""
    along = (sympy.diff(curve, t), -sympy.diff(curve, sigma))
    rates = [sympy.diff(part, sigma) * along[0] + sympy.diff(part, t) * along[1] for part in image]
    at = {sigma: place[0], t: place[1]}
    first, second = (sympy.expand(rate.subs(at, simultaneous=True)) for rate in rates)
    return sympy.cancel(second / first)


def _positive() -> tuple[Step, ...]:
    outline = (sigma, swan.launch_velocity())
    return (
        Step(
            "At a positive swan $a < 0$ between $A$ and $B$, so that $a' < 0$ at $A$ and $a' > 0$ at $B$:",
            rf"a'(A) = {latex(_rate(A))},\quad a'(B) = {latex(_rate(B))}",
            "s6p-AB",
            ("s6p-none", "s6p-AB"),
        ),
        Step(
            "What is visible for small velocities is bounded by the arc $BE$ of $H$ and the arc $AE$ of $Z$. The "
            "image of the first under $p$ is tangent to $\\Pi_0$ at $B$ and leaves it at $E'$ with the slope",
            rf"\frac{{dv}}{{d\sigma}}(E') = {latex(_slope(E, swan.horizon(), outline))}",
            "s6p-BE",
            ("s6p-BE", "s6p-AE", "s6p-regions"),
        ),
        Step(
            "The restitution takes the image of the second under $\\phi$ into it: one arc, tangent to $\\Pi_0$ at $A$, "
            "that ends on the outline at one point $N$. Both curves lie over $\\sigma = wz$ where $w^2(1 + 2z^2) = "
            "18$, $A$ at $z = -\\tfrac14$ and $B$ at $\\tfrac14$; their heights are equal where",
            rf"{in_powers(OUTLINE, z)} = {name_of(r)} \left({in_powers(LANDING, z)}\right),",
            "s6p-eps",
            ("s6p-eps",),
        ),
        Step(
            "and the difference of the two sides falls from $A$ to $B$. The invariant curve $\\gamma$ of the tangency "
            "point $B$ comes back to $\\Pi_0$ between $E'$ and $A$; below it chatter is complete, above it orbits "
            "leave:",
            r"B,\ (\sigma_\gamma, 0) \in \gamma,\quad -\sqrt{3} < \sigma_\gamma < -1",
            "s6p-gamma",
            ("s6p-gamma", "s6p-separates"),
            "figure12",
        ),
    )


def _rate(point: tuple[Any, Any]) -> Any:
    return sympy.diff(swan.acceleration(), sigma).subs(sigma, point[0])


def _excess() -> str:
    """The velocity for a flight that is r times the last, less the one after the impact."""
    longer = swan.launch_velocity().subs({sigma: sigma + t, t: r * t}, simultaneous=True)
    return factored(sympy.expand(longer + r * swan.impact_velocity()))


def _negative() -> tuple[Step, ...]:
    velocity = name_of(r)
    after = (swan.reset(C)[0], sympy.expand(-r * swan.reset(C)[1]))
    return (
        Step(
            "At a negative swan the flights launched between $D'$ and $A$ on the outline graze at the arc $DA$ of $H$, "
            "and land beyond it. The height of a flight that grazes after $t$ has the roots $0$, $t$, $t$ and one "
            "more, and their sum is known; so the shadow of $DA$ lies at",
            rf"t_1 = {latex(swan.shadow())}",
            "s6-shadow",
            ("s6n-visible", "s6n-shadow-neg"),
        ),
        Step(
            "The loop $ADCBA$ of horizon, shadow, zero set and axis bounds what is not visible. $\\phi$ takes $DA$ to "
            "the interval between $A''$ and $D'' = B$ on $\\Pi_0$, the shadow to an arc that ends at $C''$, and $F$ "
            "takes $AB$ to the arc $CB$ of $Z$. The map is torn along $\\delta = p(DA)$:",
            rf"\phi(DA) = [-1, 1] \times 0,\quad \phi(C) = {latex(swan.reset(C))}",
            "s6n-maps",
            ("s6n-maps", "s6n-AB"),
            "figure15",
        ),
        Step(
            f"From $A$ the orbit goes to $R(C'')$, which depends on ${velocity}$ alone,",
            rf"G(A) = {latex(after)}",
            "s6-GA",
        ),
        Step(
            "to the right of $B$, where $a < 0$ from there on. There a flight after one of length $t$ would need more "
            f"velocity to last ${velocity} t$ than it has,",
            rf"v(\sigma + t, {velocity} t) + {velocity} \dot x(\sigma, t) = {_excess()} > 0,",
            "s6n-chatter",
        ),
        Step(
            "so that chatter is complete, at a regular point $X = (\\tau_3, 0)$. Its stable manifold "
            "contains $A$ and is tangent to $\\Pi_0$ there; the inverse images of its arc from $A$ to $R(C'')$ are "
            "loops around the inverse images of $\\delta$, which accumulate on the invariant curve of $A$:",
            r"A \in W^s(X),\quad X = (\tau_3, 0),\quad \tau_3 > \tau_2",
            "s6n-X",
            ("s6n-X", "s6n-tangent", "s6n-transverse", "s6n-loops", "s6n-accumulate", "s7-loops", "s6n-Y"),
        ),
    )
