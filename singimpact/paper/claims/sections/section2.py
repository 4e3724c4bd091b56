"""Section 2: the impact surface and its sheet V_c', singular sets of p_c and phi_c, the correspondence principle."""

from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section2_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import agree, every, identity, is_zero
from singimpact.paper.routes import implicit as route, unfolding as model, variations
from singimpact.paper.routes.implicit import a_symbol, sigma, t, v
from singimpact.paper.trials import surfaces
from singimpact.theory import fold_form, generic_sheet

a, a1 = a_symbol(0), a_symbol(1)


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
        {
            f"omega = {omega} is irrational, so (-s, omega s) modulo 2 pi is dense": omega.is_irrational is True,
            "one flight from rest passes the wall at time 0, upwards": is_zero(start) and rate.is_positive is True,
            "nearby such (alpha, beta) lie on an arc that the dense line crosses": _signed(along.subs(angles)),
            "along which the velocity changes: a dense set of an interval": _signed(turn.subs(angles)),
        },
        modulo=("Kronecker's theorem",),
    )


def _smooth(exceptions: sympy.Expr) -> Check:
    """Points of V_c whose gradient (x_tau, x_v, x-dot) vanishes: the stated polynomial is 0 there, and is needed.

    By the group law x_tau = x-dot - v q - A b, and where b = x-dot = 0 the Wronskian q b1 is positive.
    """
    law, speed = variations.by_launch_time(), variations.wronskian()
    still = {variations.b: 0, variations.u: 0}
    left = sympy.factor(law.subs(still))
    only = sympy.factor(speed.subs(still))
    s = sympy.Symbol("s")
    # x'' + x = 1 + c from rest comes back to c at rest after 2 pi, where dx/dv = sin t is 0 too
    height, by_v = 1 - sympy.cos(s), sympy.sin(s)
    again = {s: 2 * sympy.pi}
    exists = all(expression.subs(again) == 0 for expression in (height, sympy.diff(height, s), by_v))

    return every(
        [
            (
                f"where x_v = x-dot = 0, x_tau = {left} and W = {only} > 0: the gradient vanishes where v = 0 only",
                is_zero(left + variations.v * variations.q)
                and is_zero(only - variations.q * variations.b1)
                and exceptions != 0
                and is_zero(exceptions.subs({variations.v: 0, variations.u: 0})),
            ),
            ("there are such points: x'' + x = 1 + c, from rest, at t = 2 pi", exists),
        ],
        witness=lambda: {"model": "x'' + x = 1 + c", "v": "0", "t": "2 pi", "gradient": "0"},
    )


def _same_zeros(stated: sympy.Expr, derived: sympy.Expr) -> bool:
    """Whether two polynomials are multiples of one another by a number that is not 0."""
    if stated == 0 or derived == 0:
        return bool(stated == derived)
    return bool(sympy.cancel(stated / derived).is_Rational)


def _two_sheets(rank: int) -> Check:
    """Rank of the gradients of y_c and of t on Pi_0, for every a: 2 is transverse."""
    y = route.y_c(2)
    on_axis = {v: 0, t: 0}
    gradient = sympy.Matrix([[sympy.diff(y, x).subs(on_axis) for x in (sigma, v, t)], [0, 0, 1]])
    minor = gradient[:, 1:].det()
    found = 2 if minor == 1 else 1
    return every({f"a minor of the two gradients on Pi_0 is {minor}, whatever a is: rank {found}": found == rank})


def _horizon(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """Singular points of p_c on V_c': the polynomials that vanish there off t = 0, and on t = 0."""
    off, on = variations.singular_p()
    sheet = generic_sheet(0, 4)
    v_t = sympy.diff(sheet.to_sympy(sheet.v), t)
    y_v = route.at_launch(sympy.diff(route.y_c(5), v), 4)
    left = sympy.expand(sheet.to_sympy(sheet.xdot) + t * y_v * v_t)
    degrees = [sum(key) for key, _ in sympy.Poly(left, sigma, t).terms()] if left != 0 else [9]
    at_rest = v_t.subs({t: 0, sigma: 0})
    return every(
        {
            "x-dot = t dy/dt where y = 0, so off t = 0 p is singular where x-dot = 0": _same_zeros(stated[0], off),
            f"on t = 0 dy/dt = {on}: singular where a = 0": _same_zeros(stated[1], on),
            "x-dot = -t (dy/dv) dv_c/dt on V_c' to order 4": min(degrees) > 4 and is_zero(at_rest + on),
        },
        witness=lambda: {"point": "(tau, 0; 0) with a = 1", "x-dot": "0", "dv_c/dt": str(at_rest.subs(a, 1))},
    )


def _whitney(powers: tuple[int, int]) -> Check:
    """Orders of vanishing of v along the kernel: at a tangency point (a fold of p) and at the cusp D of the unfolded swan."""
    fold = sympy.Poly(fold_form(4).normal[1], sympy.Symbol("eta")).degree()
    first, second, third, mixed = model.cusp_conditions(model.D)
    cusp = 3 if first == second == 0 and third != 0 and mixed != 0 else 0
    return every(
        {
            f"theorem of Whitney, quoted; p has exponent {fold} at a tangency point after changes of coordinates, "
            f"and at D v_t = v_tt = 0, v_ttt = {third}, v_(sigma t) = {mixed}": (fold, cusp) == powers
        },
        kind="cited",
    )


def _phi_singular(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """Singular points of phi = p o iota: the polynomials that vanish there off t = 0, and on t = 0."""
    off, on = variations.singular_phi()
    sheet = generic_sheet(0, 4)
    impact, launch = sheet.to_sympy(sheet.xdot), sheet.to_sympy(sheet.v)
    determinant = sympy.diff(impact, t) - sympy.diff(impact, sigma)
    involuted = -sympy.diff(launch, t).subs({sigma: sigma + t, t: -t}, simultaneous=True)
    at_rest = determinant.subs(t, 0)
    return every(
        [
            ("iota takes x-dot = 0 to v = 0: off Pi_0 phi is singular where v = 0", _same_zeros(stated[0], off)),
            (f"on Pi_0, which iota leaves fixed, where {on} = 0: at tangency points", _same_zeros(stated[1], on)),
            (
                "det D phi = -(dv_c/dt) o iota to order 4, and a/2 at rest",
                is_zero(sympy.expand(determinant - involuted)) and is_zero(at_rest.subs(sigma, 0) - a / 2),
            ),
        ],
        witness=lambda: {"point": "a tangency point (tau_*, 0; 0)", "det D phi": str(at_rest.subs({sigma: 0, a: 0}))},
    )


def _phi_fold(condition: sympy.Expr) -> Check:
    """Off Pi_0 and on Z: the polynomial that must not vanish for a fold, where V_c' is smooth.

    At a flight that lands at rest the second derivative of p along its kernel is -E/x_v, or -E/x_tau in the other
    chart; E = a_c at the landing, x = c and x-dot = 0, and iota makes the landing the launch.
    """
    bend = variations.second_derivative().subs(variations.E, a)
    return every(
        [
            (
                f"the second derivative along the kernel is {bend} over x_v, or over x_tau: not 0 where a is not",
                _same_zeros(condition, bend),
            )
        ]
    )


def _phi_cusp(conditions: tuple[Any, ...]) -> Check:
    """Off Pi_0, on Z and where a = 0: the polynomials that must not vanish for a cusp, where V_c' is smooth.

    Whitney's conditions for p at a flight that lands at rest with a = 0 there: third derivative -a'/x_v, mixed
    derivative v W/x_v^2; iota exchanges v and x-dot.
    """
    third, mixed = variations.cusp_derivatives()
    third = third.subs(variations.dg, a1)
    mixed = sympy.cancel(mixed / variations.wronskian()).subs(variations.INVOLUTION, simultaneous=True)
    touching = surfaces.touching_flight()
    fails = touching.velocity == 0 and touching.mixed == 0 and touching.acceleration == 0 and touching.slope != 0
    needed = [third, mixed]
    stated = all(any(_same_zeros(condition, zero) for zero in needed) for condition in conditions)
    whole = all(any(_same_zeros(condition, zero) for condition in conditions) for zero in needed)
    return every(
        [
            (
                f"the third derivative is {third} over x_v, the mixed one {mixed} W over x_v^2: both must not vanish",
                stated and whole,
            ),
            (
                f"on x'' = (t^3 (1-t)^2)'', c = 0, the point (0, 0; 1) has a = 0, a' = {touching.slope}, x-dot = 0 and "
                "v_(sigma t) = 0: no cusp",
                fails,
            ),
        ],
        witness=lambda: {
            "path": "x = t^3 (1-t)^2, c = 0",
            "point": "(0, 0; 1)",
            "a": "0",
            "a'": str(touching.slope),
            "x-dot": "0",
            "v_(sigma t)": str(touching.mixed),
        },
    )


def _lift_off(level: sympy.Expr) -> Check:
    """The level that x_c has to exceed for small t > 0 where the mass lifts off from rest.

    x_c starts at c: above a lower level every flight from rest is at first, and above a higher one none, whatever a is.
    """
    height = sympy.Symbol("c") + t * route.y_c(1)
    return every(
        [
            (
                f"x_c = {sympy.expand(height.subs({sigma: 0, v: 0}))} + ... from rest, so that the sign of a decides at the level c alone",
                agree(height, {sigma: 0, v: 0}, level + a * t**2 / 2),
            )
        ],
        tried=lambda: surfaces.pressed_point()[0],
        witness=lambda: surfaces.pressed_point()[1],
    )


def _rest(sign: int) -> Check:
    """The sign of a' at tangency points that G fixes; 0 for every sign.  x_c - c = a' t^3/6 + ... from there."""
    leading = sympy.cancel(route.at_contact(route.y_c(2), 1).subs({sigma: 0, v: 0}) / t**2)
    share = sympy.cancel(leading / a1)
    return every(
        {
            f"x_c - c = ({leading}) t^3 + ... from a tangency point": share.is_Rational and share != 0,
            "it is fixed where that is negative, and lifts off where it is positive": sign == -sympy.sign(share),
        },
        witness=lambda: {"a'": "1", "(x_c - c)/t^3": str(leading.subs(a1, 1))},
    )


def _discontinuity(condition: sympy.Expr) -> Check:
    """The polynomial that vanishes at the first hit where F is discontinuous at a state with v > 0.

    x - c = t y with y = v > 0 at t = 0; if its derivative x-dot at the first zero is not 0, the zero is a smooth function
    of the state, and no other one can come before it, since y > 0 on a compact interval before.
    """
    derived = variations.singular_p()[0]
    return every(
        [
            (
                f"y = v at t = 0, and d(x - c)/dt = {derived} at the hit: where it is not 0 the hit "
                "persists, by the implicit function theorem",
                agree(route.y_c(3), {t: 0}, v) and _same_zeros(condition, derived),
            )
        ]
    )


def _corresponding(stated: tuple[bool, bool]) -> Check:
    """(phi(H) is all of Pi_0, p(H) = phi(Z) with Pi_0 in H and Z): both fail, without the latter iota proves it.

    phi = p o iota and iota takes H to Z off t = 0.  x'' = 1 with c = 0 has no graze at all, so there H and P are empty.
    """
    onto, with_axis = stated
    (off_p, _), (off_phi, _) = variations.singular_p(), variations.singular_phi()
    exchanged = _same_zeros(off_phi, v) and _same_zeros(off_p, variations.u)
    launch, landing = surfaces.exact_sheet(v * t + t**2 / 2)
    empty = sympy.Poly(landing, t).monoms() == [(1,)]  # x-dot = t/2 on V_c': 0 at t = 0 alone, where a = 1
    return every(
        {
            "iota exchanges v = 0 and x-dot = 0 off t = 0, and phi = p o iota": exchanged,
            f"x'' = 1 has v_c = {launch}, x-dot = {landing}: no graze, so phi(H) is empty, and Pi_0 in phi(Z) is not "
            "in P": empty and not onto and not with_axis,
        },
        witness=lambda: {
            "model": "x'' = 1, c = 0",
            "point of Z": "(tau, 0; 0)",
            "its image under phi": "(tau, 0), not in P_c",
        },
        tried=surfaces.horizon_images,
    )


def _preimages(stated: tuple[bool, bool]) -> Check:
    """Whether (P_c, Pi_0) belong to the set that p and phi have the same preimage of: with both it is a set of orbits.

    P_c and Pi_0 together are the states whose free motion touches c at rest at some time.  phi(z) lies on the motion of
    p(z).  On x'' = 2 - 6t the flight t^2 (1 - t) shows that neither set alone will do.
    """
    with_P, with_axis = stated
    height = t**2 * (1 - t)
    back = {t: 1}
    lands = sympy.diff(height, t).subs(back)
    touches = sympy.gcd(sympy.cancel(height / t**2), sympy.cancel(sympy.diff(height, t) / t))
    alone = height.subs(back) == 0 and lands != 0 and touches == 1 and sympy.diff(height, t, 2).subs(t, 0) != 0
    surfaces.exact_sheet(v * t + t**2 - t**3)
    return every(
        [
            (
                "the states with a rest contact on their orbit: a set of whole orbits, which p(z) and phi(z) share",
                with_P and with_axis,
            ),
            (f"from rest {height} lands with x-dot = {lands} and touches c at rest at t = 0 alone", alone),
        ]
    )


def _semiconjugacy(crossings: Any) -> Check:
    """Up to which crossing of the free flight G o p = R o phi holds: by definition at the first, F(p(z)) = z.

    On x'' = 6t - 6 the flight 2t - 3t^2 + t^3 crosses c = 0 at t = 1 and at t = 2.
    """
    height = 2 * t - 3 * t**2 + t**3
    times = sorted(sympy.roots(sympy.Poly(sympy.cancel(height / t), t)))
    states = [(time, sympy.diff(height, t).subs(t, time)) for time in times]
    surfaces.exact_sheet(v * t - 3 * t**2 + t**3)
    return every(
        {
            f"at visible points F(p(z)) = z; the flight {height} has phi = {states[0]} and then {states[1]}, and G(p(z)) "
            "is the first one for both": times == [1, 2] and states[0] != states[1] and crossings == 1
        },
        tried=lambda: surfaces.semiconjugacy()[0],
        witness=lambda: surfaces.semiconjugacy()[1],
    )


CLAIMS = {
    "s2-dense": Encoding(sympy.sqrt(2), _dense, (sympy.Rational(3, 2), sympy.Integer(2))),
    "e:yeq": Encoding(1, _divisible, (0, 2)),
    "e:acc": Encoding(-a / 2, identity(route.slope_at_rest), (a / 2, -a, -a / 3)),
    "s2-ivp": Encoding(
        (sympy.Integer(0), v),
        identity(lambda: ((t * route.y_c(3)).subs(t, 0), sympy.diff(t * route.y_c(3), t).subs(t, 0))),
        ((v, v), (sympy.Integer(0), -v)),
    ),
    "s2-smooth": Encoding(v, _smooth, (sympy.Integer(1), v - a, sympy.Integer(0))),
    "s2-two-sheets": Encoding(2, _two_sheets, (1,)),
    "s2-horizon": Encoding(
        (variations.u, sympy.Integer(0)),
        _horizon,
        ((variations.u, sympy.Integer(1)), (v, a)),
        lambda: (variations.u, a),
    ),
    "s2-fold-cusp-forms": Encoding((2, 3), _whitney, ((3, 3), (2, 2))),
    "p:phising-set": Encoding(
        (v, sympy.Integer(1)), _phi_singular, ((v, sympy.Integer(0)), (variations.u, a)), lambda: (v, a)
    ),
    "p:phising-fold": Encoding(a, _phi_fold, (a1, v)),
    "p:phising-cusp": Encoding((a1,), _phi_cusp, ((a1, v), (variations.u,)), lambda: (a1, variations.u)),
    "s2-lift-off-sign": Encoding(
        sympy.Integer(0), _lift_off, (-sympy.Symbol("c"), 2 * sympy.Symbol("c")), lambda: sympy.Symbol("c")
    ),
    "s2-first-hit-rest": Encoding(0, _rest, (1, 2), lambda: -1),
    "s2-discontinuity": Encoding(variations.u, _discontinuity, (v, a, sympy.Integer(1))),
    "s2-corr-sets": Encoding((True, True), _corresponding, ((True, False), (False, True)), lambda: (False, False)),
    "p:corresp": Encoding((True, True), _preimages, ((True, False), (False, True))),
    "s2-G-semiconj": Encoding(sympy.oo, _semiconjugacy, (0, 2), lambda: 1),
}
