"""Jets against sympy's Taylor coefficients and against each other over different rings."""

from fractions import Fraction

import flint
import mpmath
import pytest
import sympy

from singimpact.algebra import (
    DOUBLES,
    EXACT,
    Balls,
    JetSpace,
    Multiprecision,
    NotSmooth,
    negative_on,
    parse,
    positive_on,
    real_roots,
    to_sympy,
    value_at,
)

TEXTS = ["sin(x)*exp(y)", "sqrt(2 + x)/(1 + y**2)", "log(1.5 + x*y)", "tan(0.3 + x) + tanh(y - 0.2)",
         "atan(0.7 + x + y)", "abs(x - 1)*y", "(1 + x)**(1/3)", "(1.2 + x)**pi", "cos(x + 2*y)**3"]  # fmt: skip


@pytest.mark.parametrize("text", TEXTS)
def test_coefficients_are_derivatives(text):
    tree = parse(text, ["x", "y"])
    context = mpmath.mp.clone() if hasattr(mpmath.mp, "clone") else mpmath.ctx_mp.MPContext()
    context.dps = 40
    space = JetSpace(("x", "y"), 4, Multiprecision(context))
    jet = space.evaluate(tree, dict(zip("xy", space.generators(), strict=True)))
    x, y = sympy.symbols("x y", real=True)
    expression = to_sympy(tree).subs({"x": x, "y": y})
    for i in range(5):
        for k in range(5 - i):
            expected = expression.diff(x, i, y, k).subs({x: 0, y: 0}) / (sympy.factorial(i) * sympy.factorial(k))
            assert abs(jet.coefficient((i, k)) - context.mpf(str(sympy.N(expected, 45)))) < 1e-30


def test_one_code_for_every_ring():
    tree = parse("sin(x)/(1 + x)", ["x"])
    values = []
    for ring in (EXACT, DOUBLES, Balls(200)):
        space = JetSpace(("x",), 6, ring)
        with flint.ctx.workprec(200):
            jet = space.evaluate(tree, {"x": space.generators()[0]})
            values.append([float(jet.coefficient((n,))) for n in range(7)])
    assert values[1] == pytest.approx(values[0], rel=1e-14)
    assert values[2] == pytest.approx(values[0], rel=1e-14)


@pytest.mark.parametrize("text", ["abs(x)", "sqrt(x)", "log(x)", "1/x", "x**0.5"])
def test_not_smooth_is_said(text):
    space = JetSpace(("x",), 3, EXACT)
    with pytest.raises(NotSmooth, match="must be smooth"):
        space.evaluate(parse(text, ["x"]), {"x": space.generators()[0]})


def test_spaces_do_not_mix():
    one, other = JetSpace(("x",), 3, EXACT), JetSpace(("x",), 4, EXACT)
    with pytest.raises(TypeError, match="do not mix"):
        one.generators()[0] + other.generators()[0]


def test_truncation_by_weight():
    space = JetSpace(("s", "t"), 4, EXACT, (1, 2))
    s, t = space.generators()
    assert str(s * t * t) == "0"
    assert str(t * t + s**4) == "s**4 + t**2"


def test_signs_are_proved_and_wrong_ones_rejected():
    x = sympy.Symbol("x")
    assert positive_on((1 - x) * x / (2 - x), x, 0, 1)
    assert not positive_on((x - sympy.Rational(1, 2)) ** 2, x, 0, 1)  # touches zero inside
    assert not positive_on(x - sympy.Rational(1, 10**9), x, 0, 1)
    assert negative_on(-x, x, 0, sympy.oo)
    assert not positive_on(x, x, -1, 1)
    assert value_at((x**2 - 1) / (x - 1), x, 1) == 2


def test_real_roots_are_isolated_at_any_distance():
    tiny, X = Fraction(1, 10**40), flint.fmpq_poly([0, 1])
    roots = real_roots((X - 1) * (X - flint.fmpq(1, 10**40)), Balls(300))
    assert len(roots) == 2
    assert roots[0].overlaps(Balls(400).rational(tiny))
    assert float(roots[0].rad()) < 1e-110
    assert roots[1].overlaps(Balls(400).rational(Fraction(1)))
