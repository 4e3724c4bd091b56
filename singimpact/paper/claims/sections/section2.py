"""Section 2: the impact surface and its sheet V_c'."""

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Claim, Statement
from singimpact.paper.claims.sections.section2_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, identity, is_zero
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes.implicit import a_symbol, t, v

a = a_symbol(0)


def _divisible(power: int) -> Check:
    """x_c - c = t^power y with y smooth, and y = 0 defines v_c near Pi_0."""
    quotient = sympy.expand(t * route.y_c(4) / t**power)
    smooth = not sympy.fraction(sympy.together(quotient))[1].has(t)
    at_launch = quotient.subs(t, 0) if smooth else v**2
    return every(
        [
            ("x_c = c at t = 0, so (x_c - c)/t is smooth (Hadamard's lemma)", is_zero((t * route.y_c(4)).subs(t, 0))),
            (f"the Taylor polynomial of (x_c - c)/t^{power} to order 4 has no negative power of t", smooth),
            ("it vanishes on Pi_0", is_zero(at_launch.subs(v, 0))),
            ("its v-derivative there is 1, so the implicit function theorem gives v_c", sympy.diff(at_launch, v) == 1),
            ("v_c put back solves y_c = 0 to order 4", is_zero(route.at_launch(quotient, 4))),
        ]
        if smooth
        else [(f"(x_c - c)/t^{power} has no negative power of t", smooth)]
    )


def _signed(number: sympy.Expr) -> bool:
    """Whether the sign of a number is known."""
    return number.is_positive is True or number.is_negative is True


def _dense(omega: sympy.Expr) -> Check:
    """x'' + x = cos(omega t), a clearance of its own: P near a launch at tau = 0, with flights of any length.

    q = k cos(omega t) is the periodic solution.  The flight from rest at s is at time 0, with alpha = -s and
    beta = omega s, at k + (c - k cos beta) cos alpha + k omega sin beta sin alpha, with the velocity
    -(c - k cos beta) sin alpha + k omega sin beta cos alpha.
    """
    alpha, beta = sympy.symbols("alpha beta")
    Ca, Sa, Cb, Sb, w = sympy.symbols("Ca Sa Cb Sb w")
    k = 1 / (1 - w**2)
    angles = {alpha: sympy.pi / 2, beta: sympy.pi / 6}
    level = k * (1 + w / 2)
    height = k + (level - k * Cb) * Ca + k * w * Sb * Sa - level
    velocity = -(level - k * Cb) * Sa + k * w * Sb * Ca
    substitution(At(height, {Ca: 0, Sa: 1, Sb: sympy.Rational(1, 2)}), sympy.Integer(0))
    circles = {Ca: sympy.cos(alpha), Sa: sympy.sin(alpha), Cb: sympy.cos(beta), Sb: sympy.sin(beta), w: omega}
    met, speed = (expression.subs(circles) for expression in (height, velocity))
    start, rate = (sympy.nsimplify(expression.subs(angles)) for expression in (met, speed))
    along = sympy.diff(met, beta) * omega - sympy.diff(met, alpha)
    turn = sympy.Matrix([met, speed]).jacobian([alpha, beta]).det()
    return every(
        [
            (f"omega = {omega} is irrational, so (-s, omega s) modulo 2 pi is dense", omega.is_irrational is True),
            ("one flight from rest passes the wall at time 0, upwards", is_zero(start) and rate.is_positive is True),
            ("nearby such (alpha, beta) lie on an arc that the dense line crosses", _signed(along.subs(angles))),
            ("along which the velocity changes: a dense set of an interval", _signed(turn.subs(angles))),
        ],
        modulo=("Kronecker's theorem",),
    )


CLAIMS = (
    Claim(
        id="s2-dense",
        section="2.2",
        title="with flights of any length P may be dense in a region of Pi: in x'' + x = cos(omega t), omega irrational",
        printed=Statement(
            r"\ddot x+x=\cos\omega t,\ \omega=\sqrt2,\ c=-1-\tfrac\omega2:\quad\overline{P_c}\ \text{has interior points}",
            sympy.sqrt(2),
        ),
        verify=_dense,
        mutants=(sympy.Rational(3, 2), sympy.Integer(2)),
        rests_on=("s2-horizon",),
    ),
    Claim(
        id="e:yeq",
        section="2.1",
        title="near Pi_0, x_c = c + t y_c with y_c smooth, and V_c' is the graph of v_c, where y_c = 0",
        printed=Statement(r"x_c=c+t\,y_c(\tau,v;t),\qquad y_c(\tau,v_c(\tau,t);t)=0", 1),
        verify=_divisible,
        mutants=(0, 2),
    ),
    Claim(
        id="e:acc",
        section="2.1",
        title="dv_c/dt at t = 0 is minus half the acceleration at rest",
        printed=Statement(r"\frac{\partial}{\partial t}v_c(\tau,t)\Big|_{t=0}=-\tfrac12 a_c(\tau)", -a / 2),
        verify=identity(route.slope_at_rest),
        mutants=(a / 2, -a, -a / 3),
        rests_on=("e:yeq",),
    ),
)
