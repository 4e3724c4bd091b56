"""Section 4: the Taylor expansion of v_c, and its leading parts at tangency and swan points."""

from math import factorial
from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.algebra.expressions import Name
from singimpact.algebra.parsing import parse
from singimpact.algebra.rings import to_sympy
from singimpact.contact.contact import rest_acceleration
from singimpact.paper.claims.claim import Check, Claim, Statement
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, identity, is_zero, root_of_line, same
from singimpact.paper.routes import fold, implicit as route
from singimpact.paper.routes.implicit import X, Y, a_symbol, f_symbol, sigma, t, v
from singimpact.paper.trials import crosscheck
from singimpact.theory.impact_sheet import generic_sheet
from singimpact.theory.notation import latex

a, a1, a2 = (a_symbol(n) for n in range(3))
b = sympy.Symbol("b")  # the paper's b: d(x'')/dv at rest, so b = -f_01
c, omega, tau = sympy.symbols("c omega tau")
C, S = sympy.symbols("C S")  # cos(omega tau), sin(omega tau)
HALF, THIRD = sympy.Rational(1, 2), sympy.Rational(1, 3)


def _coefficient(sigma_power: int, t_power: int) -> Any:
    """One coefficient of v_c to order 3, by the boundary value route, with b for -f_01."""
    sheet = generic_sheet(0, 3)
    return _coefficient_of(sheet.to_sympy(sheet.v), sigma_power, t_power)


def _coefficient_of(series: sympy.Expr, sigma_power: int, t_power: int) -> Any:
    return sympy.expand(series).coeff(sigma, sigma_power).coeff(t, t_power).subs(f_symbol(0, 1), -b)


def _vtaylor(name: str, where: tuple[tuple[int, int], ...], printed: Statement, mutants: tuple[Any, ...]) -> Claim:
    """A claim on coefficients of v_c; the corrected one comes from the paper's own route, the implicit function."""
    shown = " and ".join(_monomial(*pair).replace("\\", "") for pair in where)

    def corrected() -> Statement:
        values = tuple(_coefficient_of(route.v_c(3), *pair) for pair in where)
        return Statement(
            r",\quad ".join(rf"[{_monomial(*p)}]\,v_c={latex(x)}" for p, x in zip(where, values, strict=True)), values
        )

    return Claim(
        id=name,
        section="4",
        title=f"the coefficient of {shown} in v_c, b = d(x'')/dv",
        printed=printed,
        verify=identity(
            lambda: tuple(_coefficient(*pair) for pair in where), "the solution of the boundary value problem"
        ),
        corrected=corrected,
        mutants=mutants,
        rests_on=("e:yeq", "e3"),
    )


def _monomial(i: int, j: int) -> str:
    head = {0: "", 1: r"\sigma "}.get(i, rf"\sigma^{i} ")
    return head + ("t" if j == 1 else f"t^{j}")


def _linear_model(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """a_c and the period of x'' + x = cos(omega t), from its expressions, for every c and omega."""
    model = rest_acceleration(parse("x", ["x"]), parse("cos(omega*t)", ["omega", "t"]), Name("c"))
    derived = to_sympy(model).subs(sympy.Symbol("t"), tau)
    substitution(At(Y - X, {X: c, Y: C}), derived.subs(sympy.cos(omega * tau), C))
    repeats = derived.subs(tau, tau + stated[1]) - derived
    halved = derived.subs(tau, tau + stated[1] / 2) - derived
    return every(
        [
            ("a_c = g - f(c, 0) is the expression stated", is_zero(stated[0] - derived)),
            ("a_c repeats after T", is_zero(sympy.expand_trig(sympy.expand(repeats)))),
            ("and not after T/2", not is_zero(sympy.expand_trig(sympy.expand(halved)))),
        ]
    )


def _zeros(stated: sympy.Expr) -> Check:
    """A polynomial in c that vanishes for the c at which a zero of a_c of x'' + x = cos(omega t) is not simple.

    a_c = C - c and a_c' = -omega S with C = cos(omega tau), S = sin(omega tau), C^2 + S^2 = 1.  In general a_c = a_c' = 0
    says that f(c, 0) is a critical value of g, and critical values are few by Sard's theorem.
    """
    model = to_sympy(rest_acceleration(parse("x", ["x"]), parse("cos(omega*t)", ["omega", "t"]), Name("c")))
    time = sympy.Symbol("t")
    letters = {sympy.cos(omega * time): C, sympy.sin(omega * time): S}
    value, rate = model.subs(letters), sympy.diff(model, time).subs(letters)
    circle = C**2 + S**2 - 1
    at_zero = {letter: sympy.cancel(root_of_line(value_, letter)) for letter, value_ in ((C, value), (S, rate))}
    remainder = sympy.expand(circle.subs(at_zero))
    substitution(At(circle, at_zero), remainder)
    return every(
        [
            (f"a_c = {value} and a_c' = {rate} vanish together only where {remainder} = 0", same(remainder, stated)),
            ("so at c = 1 and c = -1 alone", sympy.Poly(remainder, c).real_roots() == [-1, 1]),
        ],
        modulo=("Sard's theorem",),
    )


def _phi(time: sympy.Expr) -> Check:
    """x-dot_c(tau, v_c; time), the second component of phi_c, against the launch velocity after the involution."""
    taken = route.at_launch(sympy.diff(t * route.y_c(3), t).subs(t, time), 3)
    sheet = generic_sheet(0, 3)
    return identity(lambda: sheet.to_sympy(sheet.xdot), "the launch velocity after the involution")(taken)


def _depends_on_c(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """d/dc of a' and a'' at tau_*(c), the zero of a_c: implicit differentiation of g(tau) = f(c, 0)."""
    derived = followed_zero()
    check = identity(lambda: derived, "derived by following the zero tau_*(c) of a_c")(stated)
    return Check(
        check.holds and not any(is_zero(part) for part in derived),
        check.kind,
        f"{check.evidence}; tau_* is read as the zero of a_c, since at a fixed time a_c' = g' is free of c",
        check.witness,
    )


def followed_zero() -> tuple[sympy.Expr, sympy.Expr]:
    """d/dc of a' and a'' at the zero tau_*(c) of a_c, by implicit differentiation of a_c(tau_*) = g(tau_*) - f(c, 0).

    With c + delta the acceleration at tau_* + sigma is a(sigma) - f_10 delta + O(delta^2).
    """
    delta = sympy.Symbol("delta")
    jets = sum(a_symbol(n) * sigma**n / factorial(n) for n in range(1, 5))
    acceleration = jets - f_symbol(1, 0) * delta - f_symbol(2, 0) * delta**2 / 2
    at_zero = {sigma: 0, delta: 0}
    rate = sympy.cancel(-sympy.diff(acceleration, delta).subs(at_zero) / sympy.diff(acceleration, sigma).subs(at_zero))
    moved = {sigma: rate * delta}
    substitution(At(acceleration, moved), sympy.Integer(0), order=1, small=[delta])
    rows = []
    for order in (1, 2):
        derivative = sympy.diff(acceleration, sigma, order)
        by_both = [sympy.diff(derivative, letter).subs(at_zero) for letter in (sigma, delta)]
        rows.append(sympy.cancel(by_both[0] * rate + by_both[1]))
        start = derivative.subs(at_zero)
        substitution(At(derivative, moved), At(start + X * delta, {X: rows[-1]}), order=1, small=[delta])
    return rows[0], rows[1]


def _leading(j: int, order: int) -> Any:
    """A verifier of the leading part at contact order j: exact identity, and the remainder measured on true orbits."""
    exact = identity(lambda: _sheet(j, order), "the solution of the boundary value problem with the zeros set first")

    def trial() -> tuple[str, bool]:
        slopes = crosscheck.remainders(j, order)
        lines = "; ".join(case.line() for case in slopes)
        return f"remainder on true orbits: {lines}", all(case.agrees for case in slopes)

    def verify(stated: sympy.Expr) -> Check:
        check = exact(stated)
        return every([(check.evidence, True)], tried=trial) if check.holds else check

    return verify


def _sheet(j: int, order: int) -> Any:
    sheet = generic_sheet(j, order)
    return sheet.to_sympy(sheet.v)


def _saddle(stated: int) -> Check:
    """The Hessian of v_c at a tangency point: no linear part, and the stated sign of the determinant."""
    leading = route.v_c_tangency(2)
    gradient = [sympy.diff(leading, x).subs({sigma: 0, t: 0}) for x in (sigma, t)]
    determinant = sympy.factor(sympy.hessian(leading, (sigma, t)).det())
    square = sympy.cancel(determinant / a1**2)
    return every(
        [
            ("the gradient vanishes", all(is_zero(component) for component in gradient)),
            (
                f"the Hessian determinant {determinant} has the stated sign for a' != 0",
                square.is_Rational and sympy.sign(square) == stated,
            ),
        ]
    )


CLAIMS = (
    Claim(
        id="e:lin",
        section="4",
        title="for x'' + x = cos(omega t): a_c and the period",
        printed=Statement(
            r"a_c(\tau)=-c+\cos\omega\tau,\quad T=2\pi/\omega", (-c + sympy.cos(omega * tau), 2 * sympy.pi / omega)
        ),
        verify=_linear_model,
        mutants=(
            (c + sympy.cos(omega * tau), 2 * sympy.pi / omega),
            (-c + sympy.cos(omega * tau), sympy.pi / omega),
            (-c + sympy.cos(omega * tau), 4 * sympy.pi / omega),
        ),
    ),
    Claim(
        id="s4-zeros",
        section="4",
        title="for all c but few the zeros of a_c are simple, so finitely many a period; for x'' + x = cos(omega t), c = +-1 are left out",
        printed=Statement(
            r"a_c=a_c'=0\ \text{for no}\ \tau,\ c\ \text{generic};\quad\ddot x+x=\cos\omega t:\ \text{only for}\ c^2=1",
            c**2 - 1,
        ),
        verify=_zeros,
        mutants=(c**2 - 4, c - 1, c**2 + 1),
        rests_on=("e:lin",),
    ),
    Claim(
        id="e:phi",
        section="4",
        title="phi_c is (tau + t, velocity at t); printed without the time at which x-dot_c is taken",
        printed=Statement(r"\phi_c:(\tau,t)\mapsto(\tau+t,\ \dot x_c(\tau,v_c(\tau,t))", sympy.Integer(0)),
        verify=_phi,
        corrected=lambda: Statement(r"\phi_c:(\tau,t)\mapsto(\tau+t,\ \dot x_c(\tau,v_c(\tau,t);t))", t),
        mutants=(-t, t / 2),
        rests_on=("e:yeq",),
    ),
    Claim(
        id="e3",
        section="4",
        title="y_c = v at t = 0, so dy_c/dv = 1 and its other v- and tau-derivatives vanish on Pi_0",
        printed=Statement(r"v=\dot x_c(\tau,v;0)=y_c(\tau,v;0)", v),
        verify=identity(lambda: route.y_c(4).subs(t, 0)),
        mutants=(2 * v, v + sigma, v + v**2),
        rests_on=("e:yeq",),
    ),
    _vtaylor(
        "e:vtaylor-t2",
        ((0, 2),),
        Statement(r"[t^2]\,v_c=\tfrac12(-\tfrac13a'+\tfrac12ab)", (HALF * (-THIRD * a1 + HALF * a * b),)),
        ((HALF * (-THIRD * a1 - a * b / 6),), (-a1 / 6,)),
    ),
    _vtaylor(
        "e:vtaylor-st",
        ((1, 1), (2, 1)),
        Statement(r"[\sigma t]\,v_c=-\tfrac12a',\quad[\sigma^2t]\,v_c=-\tfrac14a''", (-HALF * a1, -a2 / 4)),
        ((HALF * a1, -a2 / 4), (-HALF * a1, -a2 / 2)),
    ),
    _vtaylor(
        "e:vtaylor-st2",
        ((1, 2),),
        Statement(r"[\sigma t^2]\,v_c=\tfrac12(-\tfrac13a''+\tfrac12a'b)", (HALF * (-THIRD * a2 + HALF * a1 * b),)),
        ((HALF * (-THIRD * a2 - a1 * b / 6),), (-a2 / 6,)),
    ),
    _vtaylor(
        "e:vtaylor-t3",
        ((0, 3),),
        Statement(
            r"[t^3]\,v_c=-\tfrac16(\tfrac14a''+\tfrac32(-\tfrac13a'+\tfrac12ab)b)",
            (-(a2 / 4 + sympy.Rational(3, 2) * (-THIRD * a1 + HALF * a * b) * b) / 6,),
        ),
        ((-a2 / 24,), (-a2 / 24 + a1 * b / 24,)),
    ),
    Claim(
        id="s4-depends-on-c",
        section="4",
        title="a' and a'' at tau_* in general depend on c, because tau_* does",
        printed=Statement(
            r"\frac{d}{dc}a'(\tau_*)=\frac{a''f_{10}}{a'},\quad\frac{d}{dc}a''(\tau_*)=\frac{a'''f_{10}}{a'}",
            (a2 * f_symbol(1, 0) / a1, a_symbol(3) * f_symbol(1, 0) / a1),
        ),
        verify=_depends_on_c,
        mutants=((sympy.Integer(0), sympy.Integer(0)), (-a2 * f_symbol(1, 0) / a1, a_symbol(3) * f_symbol(1, 0) / a1)),
    ),
    Claim(
        id="e:degen",
        section="4",
        title="v_c at a tangency point to second order",
        printed=Statement(r"v_c=-\tfrac16a't(3\sigma+t)+O(3)", -a1 * t * (3 * sigma + t) / 6),
        verify=_leading(1, 2),
        mutants=(-a1 * t * (3 * sigma + 2 * t) / 6, a1 * t * (3 * sigma + t) / 6, -a1 * t * (3 * sigma + t) / 3),
        rests_on=("e:vtaylor-t2", "e:vtaylor-st"),
    ),
    Claim(
        id="e:swan",
        section="4",
        title="v_c at a swan point to third order",
        printed=Statement(
            r"v_c=-\tfrac1{24}a''t(6\sigma^2+4\sigma t+t^2)+O(4)", -a2 * t * (6 * sigma**2 + 4 * sigma * t + t**2) / 24
        ),
        verify=_leading(2, 3),
        mutants=(
            -a2 * t * (6 * sigma**2 + 8 * sigma * t + t**2) / 24,
            -a2 * t * (6 * sigma**2 + 4 * sigma * t + t**2) / 12,
        ),
        rests_on=("e:vtaylor-st", "e:vtaylor-st2", "e:vtaylor-t3"),
    ),
    Claim(
        id="s4-saddle",
        section="4.1",
        title="v_c has a saddle point at a tangency point",
        printed=Statement(r"\det D^2v_c(0,0)<0", -1),
        verify=_saddle,
        mutants=(1, 0),
        rests_on=("e:degen",),
    ),
    Claim(
        id="s4-horizon-line",
        section="4.1",
        title="H_c is tangent to 3 sigma + 2t = 0, and p(H_c) is v = (3/8) a' sigma^2 + O(3)",
        printed=Statement(
            r"3\sigma+2t=0,\qquad v=\tfrac38a'\sigma^2+O(3)", (-3 * sigma / 2, sympy.Rational(3, 8) * a1 * sigma**2)
        ),
        verify=identity(lambda: tuple(part.subs(fold.k, a1 / 6) for part in fold.horizon())),
        mutants=(
            (-2 * sigma / 3, sympy.Rational(3, 8) * a1 * sigma**2),
            (-3 * sigma / 2, -sympy.Rational(3, 8) * a1 * sigma**2),
        ),
        rests_on=("e:pnew",),
    ),
)
