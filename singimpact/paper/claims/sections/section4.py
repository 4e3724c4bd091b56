"""Section 4: the Taylor expansion of v_c, and its leading parts at tangency and swan points."""

from math import factorial
from typing import Any

import sympy

from singimpact.algebra import At, Name, parse, substitution, to_sympy
from singimpact.contact.contact import rest_acceleration
from singimpact.paper.claims.claim import Check, Encoding, Statement
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import agree, every, identity, is_zero, root_of_line, same
from singimpact.paper.routes import fold, implicit as route
from singimpact.paper.routes.implicit import X, Y, a_symbol, f_symbol, sigma, t, v
from singimpact.paper.trials import true_sheet
from singimpact.theory import generic_sheet, latex

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


def _vtaylor(where: tuple[tuple[int, int], ...], printed: Any, mutants: tuple[Any, ...]) -> Encoding:
    """A statement on coefficients of v_c; the corrected one comes from the paper's own route, the implicit function."""

    def corrected() -> Statement:
        values = tuple(_coefficient_of(route.v_c(3), *pair) for pair in where)
        return Statement(
            r",\quad ".join(rf"[{_monomial(*p)}]\,v_c={latex(x)}" for p, x in zip(where, values, strict=True)), values
        )

    verify = identity(
        lambda: tuple(_coefficient(*pair) for pair in where), "the solution of the boundary value problem"
    )
    return Encoding(printed, verify, mutants, corrected)


def _monomial(i: int, j: int) -> str:
    return {0: "", 1: r"\sigma "}.get(i, rf"\sigma^{i} ") + ("t" if j == 1 else f"t^{j}")


def _linear_model(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """a_c and the period of x'' + x = cos(omega t), from its expressions, for every c and omega."""
    model = rest_acceleration(parse("x", ["x"]), parse("cos(omega*t)", ["omega", "t"]), Name("c"))
    derived = to_sympy(model).subs(sympy.Symbol("t"), tau)
    substitution(At(Y - X, {X: c, Y: C}), derived.subs(sympy.cos(omega * tau), C))
    repeats = derived.subs(tau, tau + stated[1]) - derived
    halved = derived.subs(tau, tau + stated[1] / 2) - derived
    return every(
        {
            "a_c = g - f(c, 0) is the expression stated": is_zero(stated[0] - derived),
            "a_c repeats after T": is_zero(sympy.expand_trig(sympy.expand(repeats))),
            "and not after T/2": not is_zero(sympy.expand_trig(sympy.expand(halved))),
        }
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
        {
            f"a_c = {value} and a_c' = {rate} vanish together only where {remainder} = 0": same(remainder, stated),
            "so at c = 1 and c = -1 alone": sympy.Poly(remainder, c).real_roots() == [-1, 1],
        },
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
        slopes = true_sheet.remainders(j, order)
        lines = "; ".join(case.line() for case in slopes)
        return f"remainder on true orbits: {lines}", all(case.agrees for case in slopes)

    def verify(stated: sympy.Expr) -> Check:
        check = exact(stated)
        return every({check.evidence: True}, tried=trial) if check.holds else check

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


def _at_launch(stated: sympy.Expr) -> Check:
    return every({"y_c is what is stated at t = 0": agree(route.y_c(4), {t: 0}, stated)})


CLAIMS = {
    "e:lin": Encoding(
        (-c + sympy.cos(omega * tau), 2 * sympy.pi / omega),
        _linear_model,
        (
            (c + sympy.cos(omega * tau), 2 * sympy.pi / omega),
            (-c + sympy.cos(omega * tau), sympy.pi / omega),
            (-c + sympy.cos(omega * tau), 4 * sympy.pi / omega),
        ),
    ),
    "s4-zeros": Encoding(c**2 - 1, _zeros, (c**2 - 4, c - 1, c**2 + 1)),
    "e:phi": Encoding(sympy.Integer(0), _phi, (-t, t / 2), lambda: t),
    "e3": Encoding(v, _at_launch, (2 * v, v + sigma, v + v**2)),
    "e:vtaylor-t2": _vtaylor(
        ((0, 2),), (HALF * (-THIRD * a1 + HALF * a * b),), ((HALF * (-THIRD * a1 - a * b / 6),), (-a1 / 6,))
    ),
    "e:vtaylor-st": _vtaylor(((1, 1), (2, 1)), (-HALF * a1, -a2 / 4), ((HALF * a1, -a2 / 4), (-HALF * a1, -a2 / 2))),
    "e:vtaylor-st2": _vtaylor(
        ((1, 2),), (HALF * (-THIRD * a2 + HALF * a1 * b),), ((HALF * (-THIRD * a2 - a1 * b / 6),), (-a2 / 6,))
    ),
    "e:vtaylor-t3": _vtaylor(
        ((0, 3),),
        (-(a2 / 4 + sympy.Rational(3, 2) * (-THIRD * a1 + HALF * a * b) * b) / 6,),
        ((-a2 / 24,), (-a2 / 24 + a1 * b / 24,)),
    ),
    "s4-depends-on-c": Encoding(
        (a2 * f_symbol(1, 0) / a1, a_symbol(3) * f_symbol(1, 0) / a1),
        _depends_on_c,
        ((sympy.Integer(0), sympy.Integer(0)), (-a2 * f_symbol(1, 0) / a1, a_symbol(3) * f_symbol(1, 0) / a1)),
    ),
    "e:degen": Encoding(
        -a1 * t * (3 * sigma + t) / 6,
        _leading(1, 2),
        (-a1 * t * (3 * sigma + 2 * t) / 6, a1 * t * (3 * sigma + t) / 6, -a1 * t * (3 * sigma + t) / 3),
    ),
    "e:swan": Encoding(
        -a2 * t * (6 * sigma**2 + 4 * sigma * t + t**2) / 24,
        _leading(2, 3),
        (-a2 * t * (6 * sigma**2 + 8 * sigma * t + t**2) / 24, -a2 * t * (6 * sigma**2 + 4 * sigma * t + t**2) / 12),
    ),
    "s4-saddle": Encoding(-1, _saddle, (1, 0)),
    "s4-horizon-line": Encoding(
        (-3 * sigma / 2, sympy.Rational(3, 8) * a1 * sigma**2),
        identity(lambda: tuple(part.subs(fold.k, a1 / 6) for part in fold.horizon())),
        (
            (-2 * sigma / 3, sympy.Rational(3, 8) * a1 * sigma**2),
            (-3 * sigma / 2, -sympy.Rational(3, 8) * a1 * sigma**2),
        ),
    ),
}
