"""The paper's route at a tangency, to any order for given rationals: eta, psi, h, the blow-up h', m(s), gamma.

A second way to the numbers of `invariant_curve` that shares no solver with it.  Lengths are measured in units of
k = a'/6.  The stable manifold of h' is the graph m(s) with (m o s')^2 (s'/s)^2 = Q(s, m), found power by power.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from singimpact.algebra.jets import Jet, blow_up, divided, implicit, inverse_map
from singimpact.contact.contact import Contact


class TangencySheet(Protocol):
    """A sheet, independent of the route that solved for it: jets of v and x-dot in (sigma, t), and where they hold."""

    @property
    def contact(self) -> Contact: ...
    @property
    def order(self) -> int: ...
    @property
    def v(self) -> Jet: ...
    @property
    def xdot(self) -> Jet: ...


@dataclass(frozen=True)
class FoldSeries:
    """The steps, each made from the one before it.

    Attributes
    ----------
    outline : P(sigma)/k, image of the horizon. flight_time : t(sigma, eta).
    landing, square : of h, sigma' and eta'^2 as jets in (sigma, eta).
    m : n -> coefficient of s^n in m(s). graph : n -> coefficient of sigma^n in v on gamma.
    """

    outline: Jet
    flight_time: Jet
    landing: Jet
    square: Jet
    m: Mapping[int, Fraction]
    graph: Mapping[int, Fraction]


def fold_series(
    sheet: TangencySheet, lambda_: Fraction, restitution: Fraction, rho: Mapping[int, Fraction]
) -> FoldSeries:
    """gamma at a tangency by the fold form, for a sheet over rationals.

    Parameters
    ----------
    sheet : at contact order 1, to the order wanted. lambda_ : m_3 - 1/2. restitution : the r that belongs to it.
    rho : k -> coefficient of v^k in rho, k >= 2.
    """
    k = sheet.contact.a[1] / 6
    outline, flight_time = fold_coordinate(sheet.v.scaled(1 / k))
    landing = flight_time.space.generators()[0] + flight_time
    square = eta_after(sheet, k, outline, flight_time, restitution, rho)
    m = _stable_manifold(landing, square, lambda_)
    order = sheet.order
    squares = _times(m, m, order - 2)
    graph = {n: k * (outline.coefficient((n, 0)) - squares[n - 2]) for n in range(2, order + 1)}
    return FoldSeries(outline, flight_time, landing, square, dict(enumerate(m)), graph)


def fold_coordinate(v: Jet) -> tuple[Jet, Jet]:
    """(P, t) with v(sigma, t(sigma, eta)) = P(sigma) - eta^2: the true fold coordinate, lengths in units of k.

    eta = (t - horizon) sqrt(E), where E is v - P divided by -(t - horizon)^2, and this is inverted.
    """
    horizon = implicit(v.derivative("t"), "t")  # known to one order less: dv/dt = 0 there, so P is not
    space = v.space
    sigma, t = space.generators()
    shift = Jet(space, horizon.parts)
    outline = v.compose((sigma, shift))
    body = divided(outline - v.compose((sigma, t + shift)), "t", 2)
    root = body.space.power(body, Fraction(1, 2))
    eta_space = space.to_order(space.order - 1)
    eta = eta_space.generators()[1] * Jet(eta_space, root.parts)
    _, back = inverse_map((eta_space.generators()[0], eta))
    return outline, back + Jet(eta_space, horizon.parts)


def eta_after(
    sheet: TangencySheet,
    k: Fraction,
    outline: Jet,
    flight_time: Jet,
    restitution: Fraction,
    rho: Mapping[int, Fraction],
) -> Jet:
    """eta'^2 = P(sigma') - v'/k of h, as a jet in (sigma, eta): psi o q, since psi o p = (sigma, -eta^2)."""
    space = sheet.v.space
    sigma = space.generators()[0]
    time = Jet(space, flight_time.parts)  # every term of what follows has a factor of degree 1 beside it
    impact = sheet.xdot.compose((sigma, time))
    rebound = impact.scaled(-restitution)
    for power, value in rho.items():
        rebound = rebound + (impact**power).scaled(value)
    after = outline.compose((sigma + time, space.jet({})))
    return after - rebound.scaled(1 / k)


def _stable_manifold(landing: Jet, square: Jet, lambda_: Fraction) -> list[Fraction]:
    """m_0, m_1, ... of the graph that h' maps to itself, through the fixed point m_0 = lambda + 1/2."""
    rate, body = divided(blow_up(landing), "s", 1), divided(blow_up(square), "s", 2)
    rates, bodies = _in_m(rate), _in_m(body)
    m = [lambda_ + Fraction(1, 2)]
    for degree in range(1, body.space.order + 1):
        at_zero, at_one = (_defect(rates, bodies, [*m, Fraction(trial)], degree) for trial in (0, 1))
        m.append(at_zero / (at_zero - at_one))  # linear in the last coefficient
    return m


def _in_m(jet: Jet) -> dict[int, dict[int, Fraction]]:
    """Power of s -> power of m -> coefficient."""
    found: dict[int, dict[int, Fraction]] = {}
    for (i, k), value in jet.terms.items():
        found.setdefault(i, {})[k] = value
    return found


def _defect(rates: Any, bodies: Any, m: list[Fraction], degree: int) -> Fraction:
    """The coefficient of s^degree in (rate m(s rate))^2 - Q(s, m(s))."""
    rate = _on_graph(rates, m, degree)
    moved, power = [Fraction(0)] * (degree + 1), [Fraction(1)] + [Fraction(0)] * degree
    for n, value in enumerate(m):  # m(s rate) = sum m_n s^n rate^n
        for i in range(degree + 1 - n):
            moved[n + i] += value * power[i]
        power = _times(power, rate, degree)
    product = _times(rate, moved, degree)
    return _times(product, product, degree)[degree] - _on_graph(bodies, m, degree)[degree]


def _on_graph(table: dict[int, dict[int, Fraction]], m: list[Fraction], degree: int) -> list[Fraction]:
    """sum s^i m(s)^k table[i][k], cut after s^degree."""
    top = max((k for series in table.values() for k in series), default=0)
    powers = [[Fraction(1)] + [Fraction(0)] * degree]
    for _ in range(top):
        powers.append(_times(powers[-1], m, degree))
    total = [Fraction(0)] * (degree + 1)
    for i, series in table.items():
        for k, value in series.items():
            for n in range(degree + 1 - i):
                total[i + n] += value * powers[k][n]
    return total


def _times(left: list[Fraction], right: list[Fraction], degree: int) -> list[Fraction]:
    total = [Fraction(0)] * (degree + 1)
    for i, value in enumerate(left[: degree + 1]):
        if value:
            for n, factor in enumerate(right[: degree + 1 - i]):
                total[i + n] += value * factor
    return total
