"""gamma: the closed forms, the paper's route, one solver over every ring, and the defining equation itself."""

from fractions import Fraction

import mpmath
import pytest
import sympy
from fold_route import fold_series
from sympy_ring import SympyExact

from singimpact.algebra import DOUBLES, EXACT, Balls, Multiprecision, precision_of
from singimpact.contact import Contact
from singimpact.theory import P, invariant_curve, lambda_, multiplier_across, restitution_of, sheet, symbolic_curve

LAMBDA = Fraction(3, 5)
RHO = {2: Fraction(1, 7), 3: Fraction(-2, 11)}


def contact(j, order, ring=EXACT):
    """Jets with nothing special about them."""
    a = {k: ring.rational(Fraction((-1) ** k * (k + 2), k * k + 3)) for k in range(j, order)}
    f = {(i, k): ring.rational(Fraction(i - 2 * k + 1, 5 + i * k)) for i in range(4) for k in range(4) if i + k}
    return Contact(j, ring, a, f)


@pytest.mark.parametrize("j", [0, 1, 2, 3])
def test_graph_is_invariant_under_the_sheet(j):
    """rho(xdot(sigma, T)) = W(sigma + T), with xdot from the sheet, which shares no code with the solver."""
    order = 7
    point = contact(j, order)
    curve = invariant_curve(point, LAMBDA, order, RHO)
    made = sheet(point, order)
    space = made.v.space
    sigma = space.generators()[0]
    time = space.jet({(n, 0): value for n, value in curve.flight_time.items()})
    graph = space.jet({(n, 0): value for n, value in curve.graph.items()})
    impact = made.xdot.compose((sigma, time))
    rebound = impact.scaled(-curve.restitution)
    for k, value in RHO.items():
        rebound = rebound + (impact**k).scaled(value)
    assert not (rebound - graph.compose((sigma + time, space.jet({})))).terms
    assert not (made.v.compose((sigma, time)) - graph).terms


@pytest.mark.parametrize("ring", [EXACT, SympyExact()])
def test_paper_route_gives_the_same_rationals_to_order_10(ring):
    order = 10
    curve = invariant_curve(contact(1, order), LAMBDA, order, RHO)
    point = contact(1, order, ring)
    route = fold_series(sheet(point, order), LAMBDA, restitution_of(1, LAMBDA), RHO)
    assert route.graph == curve.graph
    a1, a2, f_v = point.a[1], 2 * point.a[2], point.f[(0, 1)]
    assert route.m[1] == (LAMBDA + Fraction(1, 2)) * (3 * a2 - a1 * f_v) / (16 * a1)


def test_paper_route_sees_a_wrong_sheet():
    order = 5
    point = contact(1, order)
    right = sheet(point, order)
    wrong = sheet(Contact(1, EXACT, {**point.a, 3: point.a[3] + 1}, point.f), order)
    graphs = [fold_series(s, LAMBDA, restitution_of(1, LAMBDA), RHO).graph for s in (right, wrong)]
    assert graphs[0] != graphs[1]


@pytest.mark.parametrize("j", [1, 2, 3])
def test_closed_forms(j):
    point = contact(j, j + 3)
    curve = invariant_curve(point, LAMBDA, j + 3, RHO)
    a, after, f_v = point.a[j], point.a[j + 1], point.f[(0, 1)]
    lead = Fraction(str(P(j).subs(lambda_, sympy.Rational(3, 5)))) * (1 - LAMBDA) / ((j + 1) * (j + 2))
    assert curve.graph[j + 1] == a * lead
    assert curve.graph[j + 2] / curve.graph[j + 1] == (2 * (j + 2) * after - a * f_v) / (2 * (j + 3) * a)
    assert curve.motion[2] == LAMBDA * (1 - LAMBDA) * (2 * after + a * f_v) / (2 * (j + 3) * a)
    assert curve.mu == multiplier_across(j, LAMBDA)


def test_one_solver_for_every_ring():
    order = 14
    exact = invariant_curve(contact(2, order), LAMBDA, order, RHO)
    context = mpmath.mp.clone() if hasattr(mpmath.mp, "clone") else mpmath.ctx_mp.MPContext()
    context.dps = 60
    for ring, close in ((DOUBLES, 1e-9), (Balls(300), 1e-60), (Multiprecision(context), 1e-45)):
        with precision_of(ring):
            rho = {k: ring.rational(value) for k, value in RHO.items()}
            found = invariant_curve(contact(2, order, ring), ring.rational(LAMBDA), order, rho)
            for n, value in exact.graph.items():
                gap = found.graph[n] - ring.rational(value)
                assert abs(gap) < close
                assert not isinstance(ring, Balls) or gap.contains(0)


@pytest.mark.parametrize(
    ("j", "order"), [(0, 4), *(pytest.param(*case, marks=pytest.mark.slow) for case in ((1, 5), (2, 6)))]
)
def test_symbols_with_numbers_put_in_are_the_numbers(j, order):
    """At a lambda that was not a node, for symbols for all jets, r and rho."""
    symbolic = symbolic_curve(j, order)
    point = contact(j, order)
    rho = {k: value for k, value in RHO.items() if k * (j + 1) <= order}
    curve = invariant_curve(point, LAMBDA, order, rho)
    values = {"lambda": LAMBDA, **{f"rho_{k}": rho.get(k, 0) for k in range(2, 9)}}
    values |= {f"a_d{k}" if k else "a": c * sympy.factorial(k) for k, c in point.a.items()}
    values |= {f"f_{i}{k}": c * sympy.factorial(i) * sympy.factorial(k) for (i, k), c in point.f.items()}
    shown = {sympy.Symbol(name): sympy.Rational(str(value)) for name, value in values.items()}
    for part, length in (("graph", 1), ("motion", 0)):
        for n, coefficient in getattr(symbolic, part).items():
            expected = getattr(curve, part)[n]
            found = sympy.cancel(symbolic.to_sympy(coefficient, length).subs(shown))
            assert found == sympy.Rational(expected.numerator, expected.denominator)
