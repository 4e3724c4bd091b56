"""G with its first and second derivatives over a box of launches and of a number of the model.

The flight from (tau + eps_1, v + eps_2) of the model with the number p + eps_3 is a motion z(s) with values in the jets
of order 2, s the time since the launch, and solves the equation of the model: its coefficients are the derivatives of
the flight. The bounds of `taylor_step` hold with the norm of jets as size:

    |z' - P'| <= K s^n,   |z - P| <= K s^(n+1)/(n+1),   K = M R^(1-n) e^(B h + A h^2/2)/n,

M a bound of the norm of the defect on |s| <= R, A and B of those of f_x and f_v next to the step. The time of the hit
is the jet that solves z(T) = 0.

Jets of order 2 are numbers with their Taylor coefficients by the launch time, the launch velocity and the number p:

    c_0 + sum c_i eps_i + sum c_ij eps_i eps_j,     products of three eps are 0.

With |c| the sum of the sizes of the coefficients |a b| <= |a| |b|: jets are a Banach algebra. An analytic function is
defined on them by its Taylor series, which ends. Coefficients are balls, complex balls or series of balls.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from math import factorial
from typing import Any

from singimpact.algebra.analytic import Place, Program, Recorder
from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate, subtract
from singimpact.algebra.precision import balls_at
from singimpact.flights.enclosures import tube
from singimpact.flights.enclosures.certified_hit import ENCLOSURE, SHORTER, SHORTEST, Launch, box_of, working_at
from singimpact.flights.enclosures.equation import Equation, NotAnalytic, Programs, Refused, programs_of, recorded
from singimpact.flights.enclosures.taylor_step import (
    STEP,
    around,
    coefficients,
    degree_at,
    listed,
    response,
    sums_of,
    widest_disc,
)
from singimpact.handed_on import flint
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator

Jet = list[Any]
# Monomials of degree 1: tau, v, p
FIRST = ((0,), (1,), (2,))
SECOND = tuple((i, j) for i in range(3) for j in range(i, 3))
MONOMIALS: tuple[tuple[int, ...], ...] = ((), *FIRST, *SECOND)
PLACES = {monomial: place for place, monomial in enumerate(MONOMIALS)}
# Which coefficients of two factors are multiplied, and the coefficient to which the product belongs
PRODUCTS = tuple(
    (i, j, PLACES[tuple(sorted(a + b))])
    for i, a in enumerate(MONOMIALS)
    for j, b in enumerate(MONOMIALS)
    if len(a + b) <= 2
)
# Values of the partial derivatives of a function by its arguments, by the orders of each
Partials = Mapping[tuple[int, ...], Any]


@cache
def orders(arguments: int, most: int) -> tuple[tuple[int, ...], ...]:
    """The orders of the partial derivatives of at most a total order.

    Examples
    --------
    >>> orders(2, 1)
    ((0, 0), (0, 1), (1, 0))
    """
    if not arguments:
        return ((),)
    return tuple((k, *rest) for k in range(most + 1) for rest in orders(arguments - 1, most - k))


def jet(values: Mapping[int, Any], zero: Any) -> Jet:
    """The jet with coefficients at some places, and 0 elsewhere."""
    return [values.get(place, zero) for place in range(len(MONOMIALS))]


def product(one: Sequence[Any], other: Sequence[Any]) -> Jet:
    """The product of two jets."""
    found: list[Any] = [0] * len(MONOMIALS)
    for i, j, place in PRODUCTS:
        if _counts(one[i]) and _counts(other[j]):
            found[place] = found[place] + one[i] * other[j]
    return found


def _counts(part: Any) -> bool:
    return not (isinstance(part, int) and part == 0)


def scaled(one: Sequence[Any], factor: Any) -> Jet:
    """A jet times a number."""
    return [part * factor for part in one]


def total(*jets: Sequence[Any]) -> Jet:
    """The sum of jets."""
    return [sum(parts[1:], parts[0]) for parts in zip(*jets, strict=True)]


def composed(partials: Partials, small: Sequence[Sequence[Any]], at: tuple[int, ...] | None = None) -> Jet:
    """A function of jets, by its partial derivatives at their values.

    Parameters
    ----------
    partials : up to order 2, or 2 beyond `at`. small : each argument less its value. at : the derivative of the
        function by its arguments whose jet is wanted; the function itself where it is left out.
    """
    base = at or (0,) * len(small)
    zero = partials[base] * 0
    image = jet({0: partials[base]}, zero)
    for powers in orders(len(small), 2):
        if any(powers):
            term: Jet = jet({0: partials[tuple(a + b for a, b in zip(base, powers, strict=True))]}, 0)
            for n, count in enumerate(powers):
                for _ in range(count):
                    term = product(term, small[n])
                term = [
                    coefficient / factorial(count) if count > 1 and _counts(coefficient) else coefficient
                    for coefficient in term
                ]
            image = total(image, term)
    return image


def norm(one: Sequence[Any]) -> Any:
    """An upper bound of the sum of the sizes of the coefficients."""
    return tube.upper(sum((tube.upper(part) for part in one[1:]), tube.upper(one[0])))


def quotient(one: Sequence[Any], other: Sequence[Any]) -> Jet:
    """The quotient of two jets."""
    small = [0, *(part / other[0] for part in other[1:])]
    inverse = total(
        jet({0: 1 / other[0]}, other[0] * 0), scaled(small, -1 / other[0]), scaled(product(small, small), 1 / other[0])
    )
    return product(one, inverse)


@dataclass(frozen=True)
class JetPrograms(Programs):
    """The programs of a model with one name, and partial derivatives.

    Parameters
    ----------
    near, far : of f by x, x', the name up to order 2, and 3. forced : of g by t and the name up to order 2. law : of
        the rebound by x' and the name up to order 2.
    """

    near: Program
    far: Program
    forced: Program
    law: Program


@lru_cache(maxsize=64)
def jet_programs(osc: Oscillator, name: str) -> JetPrograms:
    """The programs of a model whose number `name` stays a letter."""
    force, f, forcing, g, law, rho = recorded(osc, (name,))
    return JetPrograms(
        **vars(programs_of(osc, (name,))),
        near=_partials(force, f, ("x", "xdot", name), 2),
        far=_partials(force, f, ("x", "xdot", name), 3),
        forced=_partials(forcing, g, ("t", name), 2),
        law=_partials(law, rho, ("v", name), 2),
    )


def _partials(recorder: Recorder, place: Place, names: tuple[str, ...], most: int) -> Program:
    """The partial derivatives of a place in the order of `orders`."""
    found = []
    for each in orders(len(names), most):
        part = place
        for name, count in zip(names, each, strict=True):
            for _ in range(count):
                part = recorder.derivative(part, name)
        found.append(part)
    return recorder.program(found)


class JetHit:
    """The result of a flight over a box: the next tau and v as jets."""

    def __init__(self, tau: Jet, v: Jet) -> None:
        self.jets = tau, v

    def slopes(self) -> list[list[Any]]:
        """Rows of the next tau and v, columns of tau, v and the number."""
        return [list(each[1:4]) for each in self.jets]

    def along(self, direction: tuple[Any, Any, Any]) -> list[list[Any]]:
        """The derivative of `slopes`, columns tau and v alone, in a direction of (tau, v, number)."""
        return [
            [sum((self._second(each, i, j) * part for j, part in enumerate(direction)), each[0] * 0) for i in (0, 1)]
            for each in self.jets
        ]

    @staticmethod
    def _second(each: Jet, i: int, j: int) -> Any:
        part = each[MONOMIALS.index((min(i, j), max(i, j)))]
        return 2 * part if i == j else part


def jet_hit(osc: Oscillator, launch: Launch, horizon: Fraction, across: bool = False) -> JetHit:
    """The first impact of all members of a box, with first and second derivatives over it.

    Parameters
    ----------
    osc : an analytic model. launch : with v > 0, and radii of "tau", "v" and one number of the model.
    across : whether the impact is at the upper wall, of a model with two.

    Raises
    ------
    Refused : some member is not shown to hit, or the balls of the derivatives grow too wide.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> small = Fraction(1, 10**9)
    >>> ball = Oscillator("g", "0", 0, "1/2", {"g": 2})  # T = 2 v/g, v' = v/2
    >>> launch = Launch(constant("tau", 1), constant("v", 3), 1, {"tau": small, "v": small, "g": small})
    >>> hit = jet_hit(ball, launch, Fraction(10))
    >>> [round(float(part.mid()), 6) for part in hit.slopes()[0]]  # of tau + 2 v/g
    [1.0, 1.0, -1.5]
    >>> [round(float(part.mid()), 6) for part in hit.along((0, 0, 1))[0]]  # by g, of its derivatives by tau and v
    [0.0, -0.5]
    """
    bits = ENCLOSURE.coarse
    with working_at(bits + ENCLOSURE.guard):
        return _JetFlight(osc, launch, bits, across).hit(horizon)


class _JetFlight:
    """z and z' as jets, from step to step."""

    def __init__(self, osc: Oscillator, launch: Launch, bits: int, across: bool) -> None:
        self.bits, self.name, self.across = bits, launch.names[0], across
        self.gap = flint.arb(0) if osc.upper is None else evaluate(subtract(osc.upper, osc.clearance), {}, Balls(bits))
        self.tau, self.v0, numbers = box_of(osc, launch, bits)
        need(self.v0 > 0, Refused("the launch velocity is not shown positive"))
        need(not osc.parametric, Refused("second derivatives of flights are not enclosed where t occurs in f"))
        self.equation, self.time = Equation(jet_programs(osc, self.name), numbers), flint.arb(0)
        self.law = Equation(jet_programs(osc.mirrored, self.name), numbers) if across else self.equation
        zero, one = flint.arb(0), flint.arb(1)
        self.z: Jet = jet({}, zero)
        self.v: Jet = jet({0: self.v0, 2: one}, zero)
        self.last: Any = None

    # ---- functions of jets

    def _run(self, kind: str, names: int, most: int, **values: Any) -> dict[tuple[int, ...], Any]:
        programs = self.law if kind == "law" else self.equation
        return dict(zip(orders(names, most), programs.run(kind, **values), strict=True))

    def _force(self, z: Jet, v: Jet, kind: str, at: tuple[int, int, int]) -> Jet:
        """f, or a derivative of it, at jets."""
        partials = self._run(kind, 3, 2 if kind == "near" else 3, x=z[0], xdot=v[0])
        return composed(partials, ([0, *z[1:]], [0, *v[1:]], jet({3: 1}, 0)), at)

    def _forcing(self, time: Any) -> Jet:
        """g at a time, as a jet."""
        return composed(self._run("forced", 2, 2, t=time), (jet({1: 1}, 0), jet({3: 1}, 0)))

    # ---- steps

    def _series(self) -> list[list[Any]]:
        """Taylor coefficients of each coefficient of the jet z."""
        time, n = self.tau + self.time, degree_at(self.bits)
        count = n - 1
        X = coefficients(self.equation, (time, self.z[0], self.v[0]), n)
        need(X[-1].is_finite(), NotAnalytic("f or g has no power series where the flight goes"))
        zero = flint.arb_series([0], prec=count)
        forced = [listed(series, count) for series in self._forcing(flint.arb_series([time, 1], prec=count))]
        rows = [X, *([[flint.arb(0)]] * (len(MONOMIALS) - 1))]
        V = [(k + 1) * coefficient for k, coefficient in enumerate(X[1:])]
        partials = self._run("near", 3, 2, x=flint.arb_series(X, prec=count), xdot=flint.arb_series(V, prec=count))
        partials = {key: partial + zero for key, partial in partials.items()}
        by_x, by_v = (listed(partials[key], count) for key in ((1, 0, 0), (0, 1, 0)))
        z, v = jet({}, zero), jet({}, zero)  # without the coefficients that are not known yet
        for degree in (1, 2):
            f = composed(partials, (z, v, jet({3: 1}, 0)))
            for index, monomial in enumerate(MONOMIALS):
                if len(monomial) == degree:
                    driven = [a - b for a, b in zip(forced[index], listed(f[index], count), strict=True)]
                    P = response(by_x, by_v, driven, (self.z[index], self.v[index]))
                    rows[index] = P
                    z[index] = flint.arb_series(P, prec=count)
                    v[index] = flint.arb_series(
                        [(k + 1) * coefficient for k, coefficient in enumerate(P[1:])], prec=count
                    )
        return rows

    def _defect(self, series: list[list[Any]], sums: list[Any], R: Any) -> list[Any] | None:
        """A bound of the norm of the defect on a disc; None where f or g is not shown analytic on its image."""
        z, v = ([around(P[order], part[order](R)) for P, part in zip(series, sums, strict=True)] for order in (0, 1))
        g = self._forcing(around(self.tau + self.time, R))
        rest = total(self._force(z, v, "near", (0, 0, 0)), scaled(g, -1))
        if not all(flint.acb(part).is_finite() for part in rest):
            return None
        return [tube.upper(norm(rest) + sum((tube.upper(part[2](R)) for part in sums), tube.upper(R * 0)))]

    def _step(self) -> tuple[list[list[Any]], Any, Any]:
        """The polynomials of a step, the bound K of their errors, and its length."""
        series = self._series()
        n = len(series[0]) - 1
        with balls_at(STEP.disc_bits):
            sums = [sums_of(column) for column in series]
            length, R, (M,) = widest_disc(series[0], lambda R: self._defect(series, sums, R), self.bits, self.last)
            self.last = R
            slack = flint.arb(2) ** (-self.bits // 2)
            for _ in range(STEP.boxes):
                z, v = (
                    [
                        P[order] + tube.ball(column[order](length) + slack)
                        for P, column in zip(series, sums, strict=True)
                    ]
                    for order in (0, 1)
                )
                A, B = (norm(self._force(z, v, "far", at)) for at in ((1, 0, 0), (0, 1, 0)))
                if A.is_finite() and B.is_finite():
                    K = tube.upper(M * R ** (1 - n) * (B * length + A * length**2 / 2).exp() / n)
                    if K * length**n * (1 + length) < slack:
                        return series, K, length
                length = flint.arb(float(length) / 2)
        raise Refused("no step on which the bounds hold")

    def hit(self, horizon: Fraction) -> JetHit:
        """Fly to the first impact."""
        for _ in range(ENCLOSURE.steps):
            try:
                series, K, length = self._step()
            except (ValueError, ZeroDivisionError) as reason:  # flint raises where a series has no inverse
                raise Refused(str(reason)) from None
            value, slope = tube.height(series[0], K), tube.speed(series[0], K)
            launched = bool(self.time == 0)
            inner = tube.divided(value, slope, 1) if launched else (value, slope)
            need(inner[0].polynomial[0] > 0, Refused("the mass is not shown to leave the wall"))
            met, other = inner, tube.below(value, slope, self.gap)
            if self.across:
                met, other = other, met
            root, length = self._root(met, length)
            if self.gap != 0:
                last = length if root is None else tube.centre(root.upper())
                before, length = self._root(other, last)
                if before is not None or (root is not None and length is not last):
                    raise Refused("the flight is not shown to meet one wall before the other")
            tubes = [(tube.height(P, K), tube.speed(P, K)) for P in series]
            at = length if root is None else root
            self.z, self.v = [height_tube(at) for height_tube, _ in tubes], [rate(at) for _, rate in tubes]
            self.time = self.time + at
            if root is not None:
                return self._landed()
            need(self.z[0] > 0, Refused("x - c is not shown positive at the end of a step"))
            if self.time > float(horizon):
                raise Refused("no hit comes before the horizon")
        raise Refused(f"{ENCLOSURE.steps} steps do not come to a hit")

    def _root(self, inner: tuple[tube.Tube, tube.Tube], length: Any) -> tuple[Any, Any]:
        """The first root, or None, and the length of the step on which that is decided."""
        shorter = length
        while shorter > length * SHORTEST:
            try:
                return tube.first_root(*inner, shorter, self.bits), shorter
            except tube.RootAtEnd:
                shorter = tube.centre(shorter * SHORTER)
            except tube.NearGraze:
                raise Refused("x - c and x' both vanish, as far as balls tell") from None
        raise Refused("the ball of a state grew too wide to tell the sign of x - c")

    def _landed(self) -> JetHit:
        """The state after the hit: the jet N with z(T + N) = 0 by Taylor's formula, T the ball of the times."""
        z, v, clock = [flint.arb(0), *self.z[1:]], self.v, self.tau + self.time
        level = self.gap if self.across else flint.arb(0)
        a = total(self._forcing(clock), scaled(self._force([level, *z[1:]], v, "near", (0, 0, 0)), -1))
        late = scaled(quotient(z, v), -1)
        late = scaled(quotient(total(z, scaled(product(late, late), a[0] / 2)), v), -1)
        _, by_x, by_v = self.equation.run("force", x=level, xdot=v[0])
        jerk = self.equation.run("forcing", t=clock)[1] - by_x * v[0] - by_v * a[0]
        landing = total(v, product(a, late), scaled(product(late, late), jerk / 2))
        landing = scaled(landing, -1) if self.across else landing
        after = composed(self._run("law", 2, 2, v=landing[0]), ([0, *landing[1:]], jet({3: 1}, 0)))
        return JetHit(total(late, jet({0: clock, 1: flint.arb(1)}, flint.arb(0))), after)
