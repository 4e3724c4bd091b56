"""Normal forms are reached with nothing left, for p and for phi, in every ring; what is no such germ is refused."""

from fractions import Fraction

import mpmath
import pytest
import sympy

import singimpact as si
from singimpact.algebra import EXACT, Balls, Jet, JetSpace, Multiprecision, precision_of
from singimpact.germs import normal_form
from singimpact.inputs import InputError
from singimpact.paper import D, impact_velocity, kappa, launch_velocity
from singimpact.theory import normal_form as public_form

ORDERS = [3, 5, 8]


def left_over(w, found):
    """What stays of w by the definition of the form, without the code that found it, by sympy: lowest degree."""
    u, t = sympy.symbols("u t")
    T, B = (part.to_sympy() for part in (found.source, found.offset))
    form = T**found.power + sum(part.to_sympy() * T**i for i, part in found.unfolding.items())
    poly = sympy.Poly(sympy.expand(w.to_sympy() - sympy.Rational(str(found.lead)) * form - B), u, t)
    return min((sum(key) for key, value in poly.terms() if value != 0), default=99)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("power", [2, 3])
def test_form_is_reached_to_its_order(power, order):
    u, t = JetSpace(("u", "t"), order, EXACT).generators()
    lower = (u * t).scaled(Fraction(2)) if power == 3 else u * t
    w = t**power + lower + u * t * t + t**4 - u**3 + u * u * t.scaled(Fraction(5, 7))
    found = normal_form(w.scaled(Fraction(-3)), power)
    assert found.reached
    assert found.invertible
    assert left_over(w.scaled(Fraction(-3)), found) > order


def test_a_wrong_source_change_leaves_something():
    u, t = JetSpace(("u", "t"), 4, EXACT).generators()
    w = t**3 + u * t + u * t * t
    found = normal_form(w, 3)
    bent = type(found)(3, found.lead, found.source + (found.source.space.generators()[0] ** 2), found.unfolding,
                       found.offset, found.residual)  # fmt: skip
    assert left_over(w, bent) <= 4


def test_what_is_no_such_germ_is_refused():
    u, t = JetSpace(("u", "t"), 4, EXACT).generators()
    with pytest.raises(ValueError, match="no power of t alone below 3"):
        normal_form(t * t + u * t, 3)
    with pytest.raises(ZeroDivisionError):
        normal_form(t**4 + u * t, 3)
    assert not normal_form(t**3 + u * u * t, 3).invertible  # lips


def universal_germ(point, order, of):
    """The jet of v (of p) or of the impact velocity (of phi) of the unfolded swan at a point of V', kappa = 1.

    p keeps sigma and its kernel runs along t; phi keeps sigma + t.
    """
    s, e, sigma, t = sympy.symbols("s e sigma t")
    velocity = launch_velocity() if of == "p" else impact_velocity()
    at = {sigma: point[0] + s, t: point[1] + e} if of == "p" else {sigma: point[0] - e, t: point[1] + s + e}
    poly = sympy.Poly(sympy.expand(velocity.subs(kappa, 1).subs(at, simultaneous=True)), s, e)
    space = JetSpace(("u", "t"), order, EXACT)
    return space.jet({key: Fraction(int(c.p), int(c.q)) for key, c in poly.terms() if key != (0, 0)})


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("of", ["p", "phi"])
def test_cusps_of_the_unfolded_swan(of, order):
    """p has a cusp at D, where the flight lands on B at rest; phi at its mirror image, which is launched at rest."""
    point = D if of == "p" else (D[0] + D[1], -D[1])
    found = normal_form(universal_germ(point, order, of), 3)
    assert found.reached
    assert found.invertible
    assert left_over(universal_germ(point, order, of), found) > order


def linear_velocity(space, tau, time):
    """v(tau + u, t + e) of x'' + x = cos 2t, c = 3/10, in closed form, over a jet space of mpmath numbers."""
    u, e = space.generators()
    start, flight = space.constant(tau) + u, space.constant(time) + e
    two = space.rational(Fraction(2))

    def forced(at):
        return space.call("cos", two * at).scaled(space.ring.rational(Fraction(-1, 3)))

    rest = space.rational(Fraction(3, 10)) - forced(start)
    x = space.rational(Fraction(3, 10)) - forced(start + flight) - rest * space.call("cos", flight)
    slope = space.call("sin", two * start).scaled(space.ring.rational(Fraction(2, 3)))
    return x * space.power(space.call("sin", flight), Fraction(-1)) + slope


@pytest.mark.parametrize("order", [4, 7])
def test_cusp_of_p_of_a_real_oscillator(order):
    """A flight of the linear model that lands at rest on a tangency point, in 60 digits."""
    with mpmath.workdps(60):
        landing = mpmath.acos(mpmath.mpf(3) / 10) / 2 * -1  # a = cos 2t - 3/10 = 0, a' > 0
        ring = Multiprecision(mpmath.mp)
        time = mpmath.findroot(lambda t: height_back(landing, t), 3)
        jet = linear_velocity(JetSpace(("u", "t"), order, ring), landing - time, time)
        small = mpmath.mpf(10) ** -50
        assert all(abs(jet.coefficient((0, k))) < small for k in (1, 2))
        w = Jet(jet.space, dict(jet.space.jet({k: c for k, c in jet.terms.items() if abs(c) > small and any(k)}).parts))
        found = normal_form(w, 3)
        assert max(map(abs, found.residual.terms.values()), default=0) < small
        assert abs(found.unfolding[1].coefficient((1, 0))) > 0.01


def height_back(landing, t):
    """x - c at time t before a landing at rest."""
    forced = [-mpmath.cos(2 * at) / 3 for at in (landing - t, landing)]
    slope = 2 * mpmath.sin(2 * landing) / 3
    c = mpmath.mpf(3) / 10
    return forced[0] + (c - forced[1]) * mpmath.cos(t) + slope * mpmath.sin(t) - c


def test_fold_form_of_a_model_in_digits_and_exactly():
    exact = public_form(4, model=si.ImpactOscillator("x + xdot/3", "t + t**2", 0, "0.5"), tau=0)
    assert exact.residual_vanishes
    assert exact.lead == sympy.Rational(-1, 6)
    assert exact.offset.is_polynomial()
    assert not exact.source.has(sympy.Float)
    found = public_form(5, model=si.linear(2, "0.3", "0.5"), digits=40)
    assert found.kind == "fold"
    assert found.residual_vanishes
    assert found.normal == (sympy.Symbol("sigma"), sympy.Symbol("T") ** 2)
    outline = sympy.Poly(found.offset, sympy.Symbol("sigma"))
    a1 = 2 * sympy.sqrt(1 - sympy.Rational(9, 100))
    assert abs(outline.coeff_monomial(sympy.Symbol("sigma") ** 2) - sympy.N(3 * a1 / 8, 45)) < 1e-38


@pytest.mark.slow
def test_forms_with_symbols():
    assert public_form(8, at="cusp").residual_vanishes
    assert public_form(8).residual_vanishes
    with precision_of(Balls(100)):
        u, t = JetSpace(("u", "t"), 4, Balls(100)).generators()
        assert normal_form(t**3 + u * t + u * t * t, 3).reached


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        ({"order": 2}, "order = 2 is not accepted"),
        ({"order": 13}, "a whole number from 3 to 12"),
        ({"at": "swan"}, "'tangency' or 'cusp'"),
        ({"at": "cusp", "model": si.linear(2, "0.3", "0.5")}, "takes no model"),
        ({"tau": 1}, "a model too"),
    ],
)
def test_refusals(ask, told):
    with pytest.raises(InputError, match=told):
        public_form(**ask)
