"""Section 2: singular sets of p_c and phi_c, the first-hit map, the correspondence principle."""

from __future__ import annotations

import sympy

from singimpact.paper.claims.claim import Check, Statement, in_section
from singimpact.paper.claims.sections.section2_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, identity, is_zero
from singimpact.paper.routes import implicit as route
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.implicit import a_symbol, sigma, t, v
from singimpact.paper.trials import surfaces
from singimpact.theory.fold_form import fold_form
from singimpact.theory.sheet import generic_sheet

a, a1 = a_symbol(0), a_symbol(1)


def _smooth(exceptions: str) -> Check:
    """V_c fails to be smooth only where the gradient (x_tau, x_v, x-dot) vanishes; x_tau = x-dot - v x_c - A x_v."""
    found = surfaces.gradients()
    singular = surfaces.singular_point()
    identity_error = max(case.identity_error for case in found)
    least = min(case.gradient for case in found)
    return every(
        [
            (
                f"x_tau = x-dot - v x_c - A x_v at {len(found)} points of V_c on two models (to {identity_error:.0e}), so with v != 0 the "
                "gradient vanishes only with the whole first variation, which it cannot",
                identity_error < 1e-6,
            ),
            (
                f"the gradient is at least {least:.2g} at those points with v > 0",
                least > 1e-6 and exceptions != "v > 0",
            ),
            (
                "and there are points with v = 0, t != 0 at which it vanishes",
                (exceptions == "v = 0") == (singular.gradient < 1e-12),
            ),
        ],
        kind="supported",
        witness=lambda: {
            "model": singular.name,
            "tau": "0",
            "v": "0",
            "t": "pi",
            "gradient": f"{singular.gradient:.1e}",
        },
    )


def _two_sheets(rank: int) -> Check:
    """Rank of the gradients of y_c and of t on Pi_0, for every a: 2 is transverse."""
    y = route.y_c(2)
    on_axis = {v: 0, t: 0}
    gradient = sympy.Matrix([[sympy.diff(y, x).subs(on_axis) for x in (sigma, v, t)], [0, 0, 1]])
    minor = gradient[:, 1:].det()
    found = 2 if minor == 1 else 1
    return every([(f"a minor of the two gradients on Pi_0 is {minor}, whatever a is: rank {found}", found == rank)])


def _horizon(included: str) -> Check:
    """Singular points of p_c on V_c' (dv_c/dt = 0) against zeros of x-dot: "all", or "t != 0, or a = 0"."""
    sheet = generic_sheet(0, 4)
    v_t = sympy.diff(sheet.to_sympy(sheet.v), t)
    y_v = route.at_launch(sympy.diff(route.y_c(5), v), 4)
    left = sympy.expand(sheet.to_sympy(sheet.xdot) + t * y_v * v_t)
    degrees = [sum(key) for key, _ in sympy.Poly(left, sigma, t).terms()] if left != 0 else [9]
    at_rest = v_t.subs({t: 0, sigma: 0})
    return every(
        [
            ("x-dot = -t (dy/dv) dv_c/dt on V_c' to order 4, so for t != 0 the two sets agree", min(degrees) > 4),
            (
                "at t = 0 x-dot vanishes everywhere, dv_c/dt = -a/2 only where a = 0",
                included == "t != 0, or a = 0" and is_zero(at_rest + a / 2),
            ),
        ],
        kind="supported",
        witness=lambda: {"point": "(tau, 0; 0) with a = 1", "x-dot": "0", "dv_c/dt": str(at_rest.subs(a, 1))},
    )


def _whitney(powers: tuple[int, int]) -> Check:
    """Orders of vanishing of v along the kernel: at a tangency point (a fold of p) and at the cusp D of the unfolded swan."""
    normal = fold_form(4).normal[1]
    fold = sympy.Poly(normal, sympy.Symbol("eta")).degree()
    first, second, third, mixed = model.cusp_conditions(model.D)
    cusp = 3 if first == second == 0 and third != 0 and mixed != 0 else 0
    return every(
        [
            (
                f"theorem of Whitney, quoted; p has exponent {fold} at a tangency point after changes of coordinates, "
                f"and at D v_t = v_tt = 0, v_ttt = {third}, v_(sigma t) = {mixed}",
                (fold, cusp) == powers,
            )
        ],
        kind="cited",
    )


def _phi_singular(on_axis: str) -> Check:
    """The determinant of D phi on V_c': -dv_c/dt after the involution off Pi_0, and on Pi_0 a/2."""
    sheet = generic_sheet(0, 4)
    impact, launch = sheet.to_sympy(sheet.xdot), sheet.to_sympy(sheet.v)
    determinant = sympy.diff(impact, t) - sympy.diff(impact, sigma)
    involuted = -sympy.diff(launch, t).subs({sigma: sigma + t, t: -t}, simultaneous=True)
    at_rest = determinant.subs(t, 0)
    return every(
        [
            (
                "det D phi = -(dv_c/dt) o iota, so off Pi_0 phi is singular where v = 0",
                is_zero(sympy.expand(determinant - involuted)),
            ),
            (
                "on Pi_0 it is a/2 (to first order a/2 + a' sigma/2): singular at tangency points",
                is_zero(at_rest.subs(sigma, 0) - a / 2) and on_axis == "a = 0",
            ),
        ],
        kind="supported",
        witness=lambda: {"point": "a tangency point (tau_*, 0; 0)", "det D phi": str(at_rest.subs({sigma: 0, a: 0}))},
    )


def _phi_fold(condition: str) -> Check:
    """Second derivative of phi along its kernel at points of Z: proportional to a_c(tau), on true orbits of two models."""
    found = surfaces.zero_set_points()
    worst = max(abs(case.second / case.expected - 1) for case in found)
    return every(
        [
            (
                f"at {len(found)} points of Z on two models d^2 v/dt^2 after the involution is -a_c(tau)/(t dy/dv) (to {worst:.0e}), "
                "zero with a_c(tau) only",
                worst < 1e-4 and condition == "a != 0",
            )
        ],
        kind="supported",
    )


def _phi_cusp(extra: str) -> Check:
    """Whether a = 0, a' != 0 is enough ("none") or x-dot != 0 is needed too: the mixed derivative is x-dot W/x_v."""
    touching = surfaces.touching_flight()
    generic = model.cusp_conditions(model.D)
    fails = touching.velocity == 0 and touching.mixed == 0 and touching.acceleration == 0 and touching.slope != 0
    return every(
        [
            (
                "at the image of D, where x-dot != 0, all conditions of a cusp hold",
                generic[0] == generic[1] == 0 and 0 not in generic[2:],
            ),
            (
                f"on x'' = (t^3 (1-t)^2)'', c = 0, the point (0, 0; 1) has a = 0, a' = {touching.slope}, x-dot = 0 and v_(sigma t) = 0: no cusp",
                fails and extra == "x-dot != 0",
            ),
        ],
        kind="supported",
        witness=lambda: {
            "model": "x'' = (t^3 (1-t)^2)'', c = 0",
            "point": "(0, 0; 1)",
            "a": "0",
            "a'": str(touching.slope),
            "x-dot": "0",
            "v_(sigma t)": str(touching.mixed),
        },
    )


def _lift_off(threshold: str) -> Check:
    """Points (tau, 0) from which the mass flies: those with x_c above the stated level for small t > 0."""
    case = surfaces.pressed_point()
    return every(
        [
            (
                f"at a point with a = {case.acceleration:.3g} < 0 and c = {case.clearance:.3g} the free flight has x_c > 0 and x_c < c "
                "for small t: the mass cannot follow it",
                case.above_zero and case.below_c,
            ),
            ("so the level is c", threshold == "c"),
        ],
        kind="supported",
        witness=lambda: {
            "c": f"{case.clearance:.3g}",
            "a": f"{case.acceleration:.6g}",
            "x_c at t = 0.01": f"{case.height:.9f}",
        },
    )


def _rest(which: str) -> Check:
    """x_c - c = a' t^3/6 + ... from a tangency point: rest for a' < 0, flight for a' > 0."""
    leading = sympy.cancel(route.at_contact(route.y_c(2), 1).subs({sigma: 0, v: 0}) / t**2)
    return every(
        [
            ("x_c - c = a' t^3/6 + ... from a tangency point", is_zero(leading - a1 / 6)),
            ("so it is fixed where a' < 0, and the mass lifts off where a' > 0", which == "a' < 0"),
        ],
        witness=lambda: {"a'": "1", "(x_c - c)/t^3": str(leading.subs(a1, 1))},
    )


def _discontinuity(where: str) -> Check:
    """Every jump of F found on a grid of states of two models is at a graze, and grazes of the first hit are jumps."""
    found = surfaces.jumps_are_grazes()
    return every(
        [
            (
                f"{found.count} jumps of F located on {found.lines} lines of two models, each with |x-dot| at the first touch below "
                f"{found.worst:.0e}",
                found.count >= 5 and found.worst < 1e-3 and where == "F(w) in H",
            )
        ],
        kind="supported",
    )


def _corresponding(form: str) -> Check:
    """phi(H) and p(Z): images on models.  "equal" as printed, or with Pi_0 taken out of H and Z, "on"."""
    sheet = generic_sheet(0, 3)
    rest_image = (sigma, sheet.to_sympy(sheet.xdot).subs(t, 0))
    on_axis = is_zero(rest_image[1])
    touched = surfaces.horizon_images()
    return every(
        [
            (
                f"phi takes {touched.count} points of H on two models to |v| <= {touched.worst:.0e}, p takes points of Z to v = 0",
                touched.worst < 1e-9,
            ),
            (
                "Z contains Pi_0, which phi leaves in Pi_0 and not in P"
                if form == "equal"
                else "Pi_0 is left out of Z and H",
                form == "on" and on_axis,
            ),
        ],
        kind="supported",
        witness=lambda: {"point of Z": "(tau, 0; 0), a != 0", "its image under phi": "(tau, 0), not in P_c"},
    )


def _preimages(same: bool) -> Check:
    """z, p(z) and phi(z) lie on one orbit, so a touch of c at rest somewhere on it counts for both."""
    found = surfaces.common_orbits()
    return every(
        [
            (
                f"{found.count} flights of two models: the orbit through p(z) is the orbit through phi(z) to {found.worst:.0e}, "
                "and both sets are told by that orbit alone",
                same and found.worst < 1e-9,
            )
        ],
        kind="supported",
    )


def _semiconjugacy(region: str) -> Check:
    """G o p = R o phi at points of V': first hits ("visible") and later crossings ("all")."""
    found = surfaces.semiconjugacy()
    return every(
        [
            (
                f"at {found.visible} first hits of two models G(p(z)) = R(phi(z)) to {found.worst:.0e}",
                found.worst < 1e-9,
            ),
            ("at later crossings it fails", (region == "visible") == (found.least_miss > 1e-3)),
        ],
        kind="supported",
        witness=lambda: {
            "model": found.name,
            "tau": f"{found.tau:.6f}",
            "v": f"{found.v:.6f}",
            "t of a later crossing": f"{found.later:.6f}",
            "first hit": f"{found.first:.6f}",
        },
    )


_claim = in_section("2")


CLAIMS = (
    _claim(
        "s2-ivp",
        "x_c starts at c with velocity v",
        Statement(r"x_c(\tau,v;0)=c,\quad\dot x_c(\tau,v;0)=v", (sympy.Integer(0), v)),
        identity(lambda: ((t * route.y_c(3)).subs(t, 0), sympy.diff(t * route.y_c(3), t).subs(t, 0))),
        ((v, v), (sympy.Integer(0), -v)),
        ("e:yeq",),
    ),
    _claim(
        "s2-smooth",
        "V_c is a smooth surface except on Pi_0 and possibly at other points with v = 0",
        Statement(r"\nabla(x_c)\ne0\ \text{on}\ V_c\setminus\Pi_0\ \text{where}\ v\ne0", "v = 0"),
        _smooth,
        ("none", "v > 0"),
    ),
    _claim(
        "s2-two-sheets",
        "near Pi_0 V_c is two smooth sheets crossing transversely along Pi_0",
        Statement(r"\Pi\pitchfork V_c'\ \text{along}\ \Pi_0", 2),
        _two_sheets,
        (1,),
        ("e:yeq",),
    ),
    _claim(
        "s2-horizon",
        "the singular set of p_c is where x-dot vanishes; of Pi_0 only the tangency points belong to it",
        Statement(r"H_c=\{\dot x_c=0\}\subset V_c'", "all"),
        _horizon,
        ("none",),
        ("e:acc", "e:phi"),
        lambda: Statement(r"H_c=\{\dot x_c=0,\ t\ne0\}\cup\{(\tau,0;0):a_c(\tau)=0\}", "t != 0, or a = 0"),
    ),
    _claim(
        "s2-fold-cusp-forms",
        "local forms of folds and cusps (theorem of Whitney, quoted)",
        Statement(r"(x,y)\mapsto(x,y^2),\qquad(x,y)\mapsto(x,xy+y^3)", (2, 3)),
        _whitney,
        ((3, 3), (2, 2)),
    ),
    _claim(
        "p:phising-set",
        "the singular set of phi_c is Z_c without Pi_0; the tangency points belong to it too",
        Statement(r"\Sigma(\phi_c)=Z_c\setminus\Pi_0", "none"),
        _phi_singular,
        ("all",),
        ("e:phi", "e:acc"),
        lambda: Statement(r"\Sigma(\phi_c)=(Z_c\setminus\Pi_0)\cup\{(\tau,0;0):a_c(\tau)=0\}", "a = 0"),
    ),
    _claim(
        "p:phising-fold",
        "points of Z_c, t != 0, with a_c(tau) != 0 are folds of phi_c",
        Statement(r"(\tau,0;t)\in Z_c,\ t\ne0,\ a_c(\tau)\ne0:\ \text{fold of}\ \phi_c", "a != 0"),
        _phi_fold,
        ("a = 0",),
        ("p:phising-set",),
    ),
    _claim(
        "p:phising-cusp",
        "points of Z_c with a_c = 0, a_c' != 0 are cusps of phi_c; x-dot != 0 is needed too",
        Statement(r"(\tau,0;t)\in Z_c,\ t\ne0,\ a_c(\tau)=0,\ a_c'(\tau)\ne0:\ \text{cusp of}\ \phi_c", "none"),
        _phi_cusp,
        ("v != 0",),
        ("p:phising-set",),
        lambda: Statement(
            r"a_c(\tau)=0,\ a_c'(\tau)\ne0,\ \dot x_c(\tau,0;t)\ne0:\ \text{cusp of}\ \phi_c", "x-dot != 0"
        ),
    ),
    _claim(
        "s2-lift-off-sign",
        "F_c extends to (tau, 0) where x_c > 0 for small t; the level is c, not 0",
        Statement(r"x_c(\tau,0;t)>0\ \text{for small}\ t>0", "0"),
        _lift_off,
        ("-c",),
        ("e:acc",),
        lambda: Statement(r"x_c(\tau,0;t)>c\ \text{for small}\ t>0", "c"),
    ),
    _claim(
        "s2-first-hit-rest",
        "with first hit or rest a tangency point is fixed by G; with a' > 0 it lifts off",
        Statement(r"G(\tau_*,0)=(\tau_*,0)\ \text{at every tangency point}", "all"),
        _rest,
        ("a' > 0", "none"),
        ("e:yeq",),
        lambda: Statement(r"G(\tau_*,0)=(\tau_*,0)\ \text{where}\ a_c'(\tau_*)<0", "a' < 0"),
    ),
    _claim(
        "s2-discontinuity",
        "where F_c is discontinuous the first hit is a graze",
        Statement(r"F_c\ \text{discontinuous at}\ w\Rightarrow w\in P_c,\ F_c(w)\in H_c", "F(w) in H"),
        _discontinuity,
        ("F(w) not in H",),
        ("s2-horizon",),
    ),
    _claim(
        "s2-corr-sets",
        "phi(H) = Pi_0 = p(Z) and p(H) = P = phi(Z); with Pi_0 in Z the last one fails",
        Statement(r"\phi_c(H_c)=\Pi_0=p_c(Z_c),\qquad p_c(H_c)=P_c=\phi_c(Z_c)", "equal"),
        _corresponding,
        ("reversed",),
        ("s2-horizon", "p:phising-set"),
        lambda: Statement(
            r"\phi_c(H_c)\subset\Pi_0=p_c(Z_c),\qquad p_c(H_c\setminus\Pi_0)=\phi_c(Z_c\setminus\Pi_0)", "on"
        ),
    ),
    _claim(
        "p:corresp",
        "p and phi have the same preimage of P_c and Pi_0 together",
        Statement(r"p_c^{-1}(P_c\cup\Pi_0)=\phi_c^{-1}(P_c\cup\Pi_0)", True),
        _preimages,
        (False,),
        ("s2-corr-sets",),
    ),
    _claim(
        "s2-G-semiconj",
        "G o p = R o phi on V'; it holds at visible points",
        Statement(r"G\circ p=R\circ\phi\ \text{on}\ V'", "all"),
        _semiconjugacy,
        ("none",),
        ("e:phi",),
        lambda: Statement(r"G\circ p=R\circ\phi\ \text{on the visible part of}\ V'", "visible"),
    ),
)
