"""The paper's route at a tangency, to any order for given rationals: eta, psi, h, the blow-up h', m(s), gamma.

A second way to the numbers of `invariant_curve` that shares no solver with it: a witness, which the package itself
does not use.  Lengths are measured in units of k = a'/6.  The stable manifold of h' is the graph m(s) with
(m o s')^2 (s'/s)^2 = Q(s, m), found power by power.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from singimpact.algebra import Jet, JetSpace
from singimpact.contact import Contact


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


# Maps made of jets: inverse of a map, a variable made implicit, derivations, and the blow-up (s, s m).


def inverse_map(images: Sequence[Jet]) -> tuple[Jet, ...]:
    """The inverse of x -> (images), a map of as many variables as images that fixes 0.

    Raises
    ------
    ValueError : its linear part has no inverse over the ring.

    Examples
    --------
    >>> from singimpact.algebra import EXACT
    >>> x, y = JetSpace(("x", "y"), 3, EXACT).generators()
    >>> print(*inverse_map([x, y - x * x]), sep=", ")
    x, y + x**2
    """
    space = images[0].space
    linear = _inverse([[image.coefficient(key) for key in _units(space)] for image in images], space.ring)
    target = space.generators()
    inverse = _applied(linear, target)
    for degree in range(2, space.order + 1):
        missed = [image.compose(inverse).part(degree) for image in images]
        inverse = [jet - step for jet, step in zip(inverse, _applied(linear, missed), strict=True)]
    return tuple(inverse)


def _units(space: JetSpace) -> list[tuple[int, ...]]:
    size = len(space.variables)
    return [tuple(int(i == k) for k in range(size)) for i in range(size)]


def _applied(matrix: Sequence[Sequence[Any]], jets: Sequence[Jet]) -> list[Jet]:
    empty = jets[0].space.jet({})
    return [sum((jet.scaled(entry) for entry, jet in zip(row, jets, strict=True)), empty) for row in matrix]


def _inverse(matrix: list[list[Any]], ring: Any) -> list[list[Any]]:
    """By elimination; a pivot that is zero, or not seen to be different from it, is passed over."""
    size = len(matrix)
    unit = [[ring.rational(Fraction(int(i == k))) for k in range(size)] for i in range(size)]
    rows = [row + beside for row, beside in zip(matrix, unit, strict=True)]
    for column in range(size):
        pivot = next((i for i in range(column, size) if rows[i][column] != 0), None)
        if pivot is None:
            raise ValueError("the linear part of the map has no inverse")
        rows[column], rows[pivot] = rows[pivot], rows[column]
        factor = ring.power(rows[column][column], Fraction(-1))
        rows[column] = [value * factor for value in rows[column]]
        for i in range(size):
            if i != column:
                rows[i] = [a - rows[i][column] * b for a, b in zip(rows[i], rows[column], strict=True)]
    return [row[size:] for row in rows]


def implicit(equation: Jet, variable: str) -> Jet:
    """The jet y(x) with equation(x, y(x)) = 0, in the same space, where `variable` does not occur in it.

    The coefficient of `variable` alone must have an inverse, and the equation no constant term.

    Examples
    --------
    >>> from singimpact.algebra import EXACT
    >>> x, y = JetSpace(("x", "y"), 4, EXACT).generators()
    >>> print(implicit(y - x - y * y, "y"))
    x + x**2 + (2)*x**3 + (5)*x**4
    """
    space = equation.space
    index = space.variables.index(variable)
    slope = equation.coefficient(_units(space)[index])
    factor = space.ring.power(slope, Fraction(-1))
    inner = list(space.generators())
    inner[index] = space.jet({})
    for degree in range(1, space.order + 1):
        inner[index] = inner[index] - equation.compose(inner).part(degree).scaled(factor)
    return inner[index]


def blow_up(jet: Jet, s: str = "s", m: str = "m") -> Jet:
    """A jet in two variables of weight 1 in the chart (s, s m): graded by s alone.

    Examples
    --------
    >>> from singimpact.algebra import EXACT
    >>> x, y = JetSpace(("x", "y"), 3, EXACT).generators()
    >>> print(blow_up(x * y + y * y * y))
    s**2*m + s**3*m**3
    """
    space = JetSpace((s, m), jet.space.order, jet.space.ring, (1, 0))
    first, slope = space.generators()
    return jet.compose((first, first * slope))


def divided(jet: Jet, variable: str, power: int) -> Jet:
    """The jet divided by a power of a variable that divides it; the order falls by its weight.

    Raises
    ------
    ValueError : a term is not divisible.
    """
    index = jet.space.variables.index(variable)
    fallen = jet.space.to_order(jet.space.order - power * jet.space.weights[index])
    terms = {tuple(e - power * (i == index) for i, e in enumerate(key)): value for key, value in jet.terms.items()}
    if any(key[index] < 0 for key in terms):
        raise ValueError(f"a term is not divisible by {variable}**{power}")
    return fallen.jet(terms)
