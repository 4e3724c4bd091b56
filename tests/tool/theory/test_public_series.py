"""The public series: reference values, exact where they can be, honest radii, one line for what cannot be done."""

import itertools
from fractions import Fraction

import flint
import mpmath
import pytest
import sympy

import singimpact as si
from singimpact.contact import Contact
from singimpact.inputs import InputError
from singimpact.theory import leaves, multiplier, restitution_of, rho_names, sheet, symbolic_completion

DUFFING = ("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


def linear(clearance="0.3", restitution="0.5"):
    return si.linear(2, clearance, restitution)


@pytest.mark.parametrize("rate", ["0.5", "0.9"])
def test_gamma_of_the_linear_model(rate, reference):
    series = si.theory.gamma(order=3, model=linear(restitution=rate), digits=40)
    with mpmath.workdps(45):
        for n in (2, 3):
            expected = mpmath.mpf(reference[f"gamma.C{n}[linear w=2,c=0.3,r={rate}]"])
            assert abs(series[n] - expected) < 1e-38


def test_gamma_and_fibre_of_the_duffing_model(reference):
    with mpmath.workdps(45):
        series = si.theory.gamma(order=2, model=si.ImpactOscillator(*DUFFING), digits=40)
        assert abs(series[2] - mpmath.mpf(reference["gamma.C2[duffing w=1.7,c=0.3,r=0.6,d=0.1,k3=0.3]"])) < 1e-38


def test_generic_series_in_lambda():
    lambda_, a1, a2, f_v = sympy.symbols("lambda a_d1 a_d2 f_01")
    series = si.theory.gamma(order=3)
    assert sympy.cancel(series[2] - a1 * (1 - lambda_) * (2 + lambda_) / 6) == 0
    assert sympy.cancel(series[3] - (1 - lambda_) * (2 + lambda_) * (3 * a2 - a1 * f_v) / 48) == 0
    assert series.as_expr().has(sympy.Symbol("sigma"))
    assert si.theory.r_of_lambda(1).subs(lambda_, sympy.Rational(1, 2)) == sympy.Rational(5, 16)


@pytest.mark.parametrize(
    "series",
    [
        lambda n: si.theory.gamma(order=n),
        lambda n: si.theory.gamma(order=n, at="swan"),
        lambda n: si.theory.fibre(order=n),
        lambda n: si.theory.dynamics_on_gamma(order=n),
        lambda n: si.theory.chatter_limit(order=n),
    ],
)
def test_a_coefficient_is_the_same_at_every_order(series):
    found = [series(n) for n in range(3, 7)]
    for shorter, longer in itertools.pairwise(found):
        for n in range(1, len(shorter)):
            assert sympy.cancel(shorter[n] - longer[n]) == 0


def test_chatter_limit_in_jets():
    a, a1, f_v, rho2, r = sympy.symbols("a a_d1 f_01 rho_2 lambda")
    series = si.theory.chatter_limit(order=2)
    expected = -sympy.Rational(2, 3) / a**2 * (2 * a1 / a + f_v + 3 * a * rho2 / (1 + r)) / (1 - r) ** 2
    assert sympy.cancel(series[1] + 2 / (a * (1 - r))) == 0
    assert sympy.cancel(series[2] - expected) == 0


@pytest.mark.slow
def test_chatter_limit_of_a_model(reference):
    """From (1.2, 0.01); the series converges slowly, with the distance of the tangency."""
    series = si.theory.chatter_limit(order=20, model=linear(), tau="1.2", digits=40)
    with mpmath.workdps(45):
        found = mpmath.mpf("1.2") + series(mpmath.mpf("0.01"))
        assert abs(found - mpmath.mpf(reference["chatter.tau_inf.linear[w=2,c=0.3,r=0.5](1.2,0.01)"])) < 1e-22
    assert 0.004 < series.valid_within(1e-20) < 0.02


def test_fibre_is_the_inverse_of_the_completion():
    """Along the fibre through tau_* chatter ends at tau_*."""
    model, tau = si.ImpactOscillator(*DUFFING), "1.5"
    fibre = si.theory.fibre(order=10, model=model, tau=tau)
    sigma = mpmath.mpf("-0.002")
    v = fibre(sigma)
    start = sympy.Rational(3, 2) + sympy.Rational("-0.002")
    ends = si.theory.chatter_limit(order=10, model=model, tau=start)
    assert abs(sigma + ends(v)) < 1e-19


def test_exact_when_tau_and_lambda_are():
    exact = linear(1, restitution_of(2, Fraction(1, 2)))
    assert si.theory.gamma(order=5, at="swan", model=exact, tau=0).coefficients == {
        3: sympy.Rational(-17, 48), 4: 0, 5: sympy.Rational(765, 10016)}  # fmt: skip
    by_symbols = si.theory.gamma(order=4, model=linear(0, "5/16"), tau="3*pi/4")
    assert by_symbols.coefficients == {2: sympy.Rational(5, 12), 3: 0, 4: sympy.Rational(-2245, 13248)}
    assert si.theory.v_c(order=1, model=linear(), tau="6/5").has(sympy.cos(sympy.Rational(12, 5)))


def test_exact_constants_agree_with_digits():
    """sqrt(3) enters through tau = 5 pi/12: the exact route through symbols, and balls."""
    model = si.ImpactOscillator("x + xdot/7 + x**2", "cos(2*t) + sqrt(3)/2", 0, "5/16")
    exact = si.theory.gamma(order=5, model=model, tau="7*pi/12")
    assert all(not value.has(sympy.Float) for value in exact.coefficients.values())
    found = si.theory.gamma(order=5, model=model.replace(restitution="0.3125000000000000000000000000000001"))
    with mpmath.workdps(40):
        assert all(abs(mpmath.mpf(str(sympy.N(exact[n], 36))) - found[n]) < 1e-28 for n in range(2, 6))


def test_tau_as_a_double_names_the_point():
    model = linear()
    near = si.tangency_points(model).tau[1]
    assert (
        si.theory.gamma(order=3, model=model, tau=near).coefficients
        == si.theory.gamma(order=3, model=model).coefficients
    )


@pytest.mark.parametrize("tolerance", [1e-4, 1e-8, 1e-12])
@pytest.mark.parametrize("model", [linear(), linear("0.3", "0.9"), si.ImpactOscillator(*DUFFING)])
def test_radius_is_honest(model, tolerance):
    """Against the series to a much higher order, where that one converges."""
    series = si.theory.gamma(order=8, model=model)
    long = si.theory.gamma(order=48, model=model)
    radius = series.valid_within(tolerance)
    assert radius > 0.02
    for part in (1.0, 0.5):
        sigma = mpmath.mpf(-radius * part)
        error = abs(series(sigma) - long(sigma))
        assert error <= tolerance * min(1, abs(long(sigma)))


@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
@pytest.mark.parametrize(
    "model", [linear(), linear("0.3", "0.9"), pytest.param(si.ImpactOscillator(*DUFFING), marks=pytest.mark.slow)]
)
def test_radius_is_honest_under_the_true_map(model, tolerance):
    """Against the velocity that separates complete from incomplete chatter, found by flights alone."""
    series = si.theory.gamma(order=8, model=model)
    point = next(p for p in si.tangency_points(model) if p.kind == "gamma")
    radius = series.valid_within(tolerance)
    for part in (1.0, 0.6):
        true = float(si.threshold(model, point.tau - radius * part).v)
        assert abs(float(series(mpmath.mpf(-radius * part))) - true) <= tolerance * min(1, true) + 4e-13 * true


def test_multiplier_is_found_when_rational():
    from singimpact.algebra import constant

    assert multiplier(2, constant("r", restitution_of(2, Fraction(2, 7)))) == Fraction(2, 7)
    assert multiplier(2, constant("r", "1/2")) is None
    ball = multiplier(1, constant("r", "5/16"), 200)
    assert ball.contains(0.5)
    assert ball.rel_accuracy_bits() > 150


REFUSED = [
    (lambda: si.theory.gamma(order=1), "order = 1 is not accepted"),
    (lambda: si.theory.gamma(order=-3), "order = -3 is not accepted"),
    (lambda: si.theory.v_c(order=0, model=linear(), tau=1), "order = 0 is not accepted"),
    (lambda: si.theory.gamma(at="generic"), "at = 'generic' is not accepted"),
    (lambda: si.theory.gamma(model=linear(restitution=1)), "restitution = 1 is not accepted"),
    (lambda: si.theory.gamma(at="swan", model=linear()), "has no swan point"),
    (lambda: si.theory.v_c(model=linear()), "tau is needed"),
    (lambda: si.theory.chatter_limit(model=linear()), "tau is needed"),
    (lambda: si.theory.v_c(model=si.ImpactOscillator("abs(x)", "cos(t)", 0, "0.5"), tau=1), "not smooth"),
    (lambda: si.theory.v_c(model=si.ImpactOscillator("sqrt(x)", "cos(t)", 0, "0.5"), tau=1), "must be smooth"),
    (lambda: si.theory.v_c(model=si.ImpactOscillator("x", 0, 0, "0.5"), tau=1), "contact order at tau = 1 is above 5"),
    (lambda: si.theory.v_c(at="tangency", model=linear(), tau=1), "not of contact order 1"),
    (lambda: si.theory.v_c(at=13), "at = 13 is not accepted"),
    (lambda: si.theory.v_c(model=3), "model = 3 is not accepted"),
    (lambda: si.theory.v_c(tau=1), "tau = 1 is not accepted"),
    (lambda: si.theory.gamma(order=3)[4], "power = 4 is not accepted"),
    (lambda: si.theory.gamma(order=3).valid_within(0.1), "valid_within needs numbers"),
    (lambda: si.theory.gamma(order=3, model=linear()).valid_within(0), "tolerance = 0 is not accepted"),
    (lambda: si.theory.gamma(order=3, model=linear(), digits=0), "digits = 0 is not accepted"),
]


@pytest.mark.parametrize(("call", "told"), REFUSED)
def test_refusals_are_one_line(call, told):
    with pytest.raises(InputError) as refusal:
        call()
    assert told in str(refusal.value)
    assert "\n" not in str(refusal.value)


NO_GAMMA = {
    "foliation": (si.linear(2, "0.3", "0.5"), 1, "first", "foliation with a' < 0"),
    "positive swan": (si.linear(2, -1, "1/2"), "swan", "pi/2", "positive swan with a'' > 0"),
    "third": (si.ImpactOscillator("0", "-t**3", 0, "0.5"), 3, 0, "contact order 3 with a''' < 0"),
    "fourth": (si.ImpactOscillator("0", "t**4", 0, "0.5"), 4, 0, "contact order 4 with a^(4) > 0"),
}


@pytest.mark.parametrize("name", NO_GAMMA)
@pytest.mark.parametrize("ask", [si.theory.gamma, si.theory.dynamics_on_gamma])
def test_where_no_gamma_is_none_is_given(name, ask):
    """The formal series exists there; with v < 0, or for orbits that rest, it is no curve of the impact map."""
    model, at, tau, told = NO_GAMMA[name]
    tau = si.tangency_points(model)[0].tau if tau == "first" else tau
    with pytest.raises(InputError) as refused:
        ask(order=5, at=at, model=model, tau=tau)
    assert told in str(refused.value)
    assert "a_c > 0 on its left" in str(refused.value)


@pytest.mark.parametrize(("at", "g"), [(1, "t"), (2, "-t**2"), (3, "t**3"), (4, "-t**4")])
def test_where_gamma_is_it_is_positive(at, g):
    series = si.theory.gamma(order=at + 1, at=at, model=si.ImpactOscillator("0", g, 0, "0.5"), tau=0)
    assert series(-1) > 0


def test_a_swan_is_no_tangency():
    with pytest.raises(InputError, match="contact order is above 1"):
        si.theory.gamma(at="tangency", model=si.linear(2, 1, "0.5"), tau=0)


def test_a_series_in_symbols_that_was_made_is_given_again():
    assert si.theory.v_c(5) is si.theory.v_c(5, at=0)
    first = si.theory.gamma(5)
    first.coefficients[2] = 0
    again = si.theory.gamma(5)
    assert again[2] != 0
    assert again[3] is first[3]
    assert si.theory.chatter_limit(4)[3] is si.theory.chatter_limit(4)[3]


@pytest.mark.parametrize("r", [Fraction(1, 2), Fraction(4, 5)])
def test_chatter_in_symbols_is_the_foliation_at_a_number(r):
    """One recurrence in symbols, one by the level sets of tau_inf at a number, which share the sheet alone."""
    order = 5
    found = symbolic_completion(order)
    contact = Contact.generic(0, order, unit=True, more=rho_names(0, order))
    ring = contact.ring
    rho = {int(name[4:]): ring.symbol(name) for name in rho_names(0, order)}
    known = leaves(sheet(contact, order), ring.rational(r), lambda n: ring.rational(1 / (1 - r**n)), rho)
    assert ring.names == found.names
    for n in range(1, order + 1):
        assert found.coefficients[n].at(flint.fmpq(r.numerator, r.denominator)) == known[(0, n)].to_dict()
