"""The discontinuity mapping of a graze: what a weak impact changes, as a series in roots of its depth.

A motion that does not feel the wall has its lowest place x = c - D, D > 0, at the time t_*.  The true motion hits the
wall shortly before.  Followed to t_* again it is at (c + x, x'), which is the zero-time discontinuity mapping; followed
back to x' = 0 it gives the mapping of the Poincare section x' = 0, where a motion is named by its lowest place.

With contact order j (a_c and j - 1 derivatives vanish at t_*, j even) a flight that meets the wall at t_* - s has

    D = (a_j/(j + 2)!) s^(j + 2) (1 + ...),    x' = (1 + r) (a_j/(j + 1)!) s^(j + 1) (1 + ...),

so both are power series in h = ((j + 2)! D/a_j)^(1/(j + 2)), which is s to first order, with coefficients that are
rational in the jets.  j = 0: h = sqrt(2 D/a), and the first term (1 + r) sqrt(2 a D) is Nordmark's square root.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from math import factorial
from typing import Any

from singimpact.algebra.expressions import Expression
from singimpact.algebra.interpolation import RationalCoefficients
from singimpact.algebra.jets import Jet, JetSpace
from singimpact.algebra.numbers import constant, float_array
from singimpact.algebra.rings import EXACT
from singimpact.algebra.univariate import precision_of
from singimpact.codegen.polynomial_source import function_source
from singimpact.contact.contact import Contact, contact_order, derivative_name
from singimpact.handed_on import flint, sympy
from singimpact.inputs import InputError, checked_keywords, refuse, require, whole
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import sign_of_acceleration
from singimpact.theory.completion import in_length, length_weight, rho_names
from singimpact.theory.contact_points import Place, place
from singimpact.theory.power_series import PowerSeries, all_digits, with_digits

PARTS = ("x", "xdot", "depth", "time")
LENGTHS = {"x": 1, "xdot": 1, "depth": 1, "time": 0}  # the powers of the unit of length that the parts carry
MOST = {"symbols": 8, "numbers": 16}  # the highest order: of a generic graze in symbols (8 takes 1 s), and of a model


@dataclass(frozen=True)
class GrazingMap:
    """The discontinuity mapping of a graze.

    Parameters
    ----------
    j : contact order of the graze, 0 where a_c > 0. order : the last power of h.
    x, xdot : zero-time mapping: place above the wall and velocity at t_*, series in h.
    depth, time : mapping of the section x' = 0: the lowest place is c - depth, at t_* + time; None for j > 0, whose
        section is reached by roots of 1 + r.
    leading : a_j, a number or a symbol. source_terms : what `source` writes.
    """

    j: int
    order: int
    x: PowerSeries
    xdot: PowerSeries
    depth: PowerSeries | None
    time: PowerSeries | None
    leading: Any
    source_terms: Mapping[str, Mapping[tuple[int, ...], Any]] = field(default_factory=dict, repr=False)
    names: tuple[str, ...] = field(default=(), repr=False)

    @property
    def leading_power(self) -> Fraction:
        """The power of D in the velocity that the impact adds, (j + 1)/(j + 2): 1/2 at an ordinary graze."""
        return Fraction(self.j + 1, self.j + 2)

    def _latex(self, printer: object) -> str:  # noqa: ARG002
        return rf"x - c = {self.x._latex()},\quad x' = {self.xdot._latex()}"

    def h(self, distance: Any) -> Any:
        """((j + 2)! D/a_j)^(1/(j + 2)), a time, for distances D >= 0 of a model.

        Examples
        --------
        >>> grazing_map(1, model=Oscillator("0", "2", 0, "1/2"), at=0).h([0.0, 1.0]).tolist()
        [0.0, 1.0]
        """
        lengths = float_array("distance", distance)
        if (lengths < 0).any():
            raise refuse("distance", float(lengths.min()), "depths below the wall >= 0")
        return (factorial(self.j + 2) * lengths / float(self._number(self.leading))) ** (1 / (self.j + 2))

    def __call__(self, distance: Any) -> tuple[Any, Any]:
        """x and x' at t_* after the impact of motions whose lowest place would be c - distance.

        Examples
        --------
        >>> x, xdot = grazing_map(2, model=Oscillator("0", "2", 0, "1/2"), at=0)([0.25])
        >>> x.tolist(), xdot.tolist()  # at -1/2 with -1, then 1/2 upwards: 1/4 + 1/4, and 1/2 + 1
        ([0.5], [1.5])
        """
        h = self.h(distance)
        numbers = ({n: self._number(c) for n, c in series.coefficients.items()} for series in (self.x, self.xdot))
        x, xdot = (PowerSeries("h", self.order, values)(h) for values in numbers)
        return x, xdot

    def _number(self, value: Any) -> float:
        try:
            return float(value)
        except TypeError:
            raise InputError("the mapping holds symbols: give model= and at= for numbers") from None

    def source(self, name: str = "grazing_map") -> str:
        """The zero-time mapping as a Python function of D and, without a model, of the jets and r; it needs no package.

        Examples
        --------
        >>> text = grazing_map(1).source()
        >>> space = {}
        >>> exec(text, space)
        >>> space["grazing_map"](0.5, a=1.0, r=0.5)  # (1 + r) sqrt(2 a D)
        (0.0, 1.5)
        """
        letters = [*((derivative_name(self.j),) if self.names else ()), *self.names]
        says = f"x - c and x' where the motion without a wall is lowest, `distance` below it; contact order {self.j}."
        lines = [f"def {name}({', '.join(['distance', *letters])}):", f'    """{says}"""']
        lead = derivative_name(self.j) if self.names else repr(self._number(self.leading))
        lines.append(f"    h = ({factorial(self.j + 2)} * distance / {lead}) ** (1 / {self.j + 2})")
        arguments = ["h"]
        if self.names:
            lines.append(f"    unit = {lead} / {factorial(self.j)}")
            arguments += [jet if not (w := _weight(jet)) else f"{jet} * unit**{w}" for jet in self.names]
        unit = "unit * " if self.names else ""
        lines.append(f"    return {unit}_x({', '.join(arguments)}), {unit}_xdot({', '.join(arguments)})\n")
        nothing: Any = {(0,): {(0,) * len(self.names): Fraction(0)}}  # x begins with h^2
        parts = []
        for coordinate in ("x", "xdot"):
            terms = self.source_terms[coordinate] or nothing
            parts.append(function_source(f"_{coordinate}", ("h",), self.names, terms, f"The series of {coordinate}."))
        return "from typing import Any\n\n\n" + "\n\n".join([*parts, "\n".join(lines)])


@checked_keywords
def grazing_map(order: int = 1, model: Any = None, at: Any = None, digits: int = 30) -> GrazingMap:
    """The discontinuity mapping of a graze as a series in h = ((j + 2)! D/a_j)^(1/(j + 2)), D the depth of the motion.

    Parameters
    ----------
    order : the last power of h; at an ordinary graze h^order is the power order/2 of D.
    model : an oscillator; without one, symbols stand for the jets at the graze and r for the restitution.
    at : of a model, the time t_* of the graze, at which a_c > 0 or has an even zero with a_j > 0. Without a model
        "graze" (a_c > 0), "swan" (j = 2) or an even contact order.
    digits : of the numbers, where they are not rational.

    Returns
    -------
    GrazingMap : `.x`, `.xdot` (zero-time mapping), `.depth`, `.time` (mapping of the section x' = 0), called with D.

    Notes
    -----
    The coefficients are functions of the phase t_* of the lowest place: a mapping for all phases has the jets at each.
    Errors fall like D^((order + 1)/(j + 2)).

    Examples
    --------
    >>> generic = grazing_map(2)
    >>> generic.xdot[1], generic.xdot[2]
    (a*(r + 1), a**2*rho_2 + a*f_01*(-2*r/3 - 2/3) + a_d1*(-r/3 - 1/3))
    >>> generic.time[1], generic.depth[2]
    (-r - 1, a*r**2/2)
    """
    if model is None:
        j = 0 if at in (None, "graze") else contact_order(at)
        _checked(order, j, MOST["symbols"])
        return _generic(j, order)
    require(isinstance(model, Oscillator), "model", model, "an ImpactOscillator")
    require(at is not None, "at", at, "the time of the graze, at which a_c > 0 or has an even zero")
    where = _graze(model, constant("at", at))
    _checked(order, where.j, MOST["numbers"])
    return _of_model(where, order, digits)


def _checked(order: Any, j: int, most: int) -> None:
    if j % 2:
        raise refuse("at", j, "an even contact order: at an odd one a_c changes its sign, and nothing grazes")
    whole("order", order, j + 1, most)


def _graze(model: Oscillator, at: Expression) -> Place:
    """The contact point of a graze from above: the first derivative of a_c that is not zero is even and positive."""
    for j in range(7):
        sign = sign_of_acceleration(model, at, j)
        if sign and (sign < 0 or j % 2):
            raise refuse("at", at, "a time at which a_c > 0 or has an even zero from above; there the mass is pressed")
        if sign:
            return place(model, j, at)
    raise refuse("at", at, "a time at which a derivative of a_c up to the sixth is not zero")


def _weight(name: str) -> int:
    return 0 if name == "r" else length_weight(name)


@lru_cache(maxsize=16)
def _generic(j: int, order: int) -> GrazingMap:
    """The map with symbols for the jets and r: lengths are first measured so that a_j/j! = 1."""
    more = (*rho_names(j, order), "r")
    contact = Contact.generic(j, order, unit=True, more=more)
    ring = contact.ring
    rho = {int(name[4:]): ring.symbol(name) for name in more[:-1]}
    expansions = _expanded(contact, order, ring.symbol("r"), rho)
    names = ring.names[:-1]
    r, lambda_ = sympy.Symbol("r"), sympy.Symbol("lambda")

    def shown(name: str, value: Any) -> Any:
        terms: dict[Any, list[Any]] = {}
        for *jets, power in (coefficients := value.to_dict()):
            row = terms.setdefault(tuple(jets), [])
            row += [0] * (power + 1 - len(row))
            row[power] = coefficients[(*jets, power)]
        one = flint.fmpq_poly([1])
        polynomials = RationalCoefficients({key: (flint.fmpq_poly(row), one) for key, row in sorted(terms.items())})
        return in_length(polynomials, names, j, LENGTHS[name]).xreplace({lambda_: r})

    series = {
        coordinate: {n: shown(coordinate, value) for n, value in values.items()}
        for coordinate, values in expansions.items()
    }
    written = {
        coordinate: {
            (n,): {key: Fraction(int(c.p), int(c.q)) for key, c in value.to_dict().items()}
            for n, value in values.items()
        }
        for coordinate, values in expansions.items()
    }
    return _made(j, order, series, sympy.Symbol(derivative_name(j)), written, ring.names)


def _of_model(where: Place, order: int, digits: int) -> GrazingMap:
    """In rationals where the jets are rational, else in certified digits."""

    def compute(ring: Any) -> dict[tuple[str, int], Any]:
        with precision_of(ring):
            contact = where.contact(order, ring)
            found = _expanded(contact, order, where.restitution_in(ring), where.rho(order, ring))
            values = {(name, n): value for name, each in found.items() for n, value in each.items()}
            return values | {("leading", 0): contact.a[where.j] * ring.rational(Fraction(factorial(where.j)))}

    try:
        values = {key: sympy.Rational(value.numerator, value.denominator) for key, value in compute(EXACT).items()}
    except ArithmeticError:
        values = with_digits(compute, digits, all_digits)
    leading = values.pop(("leading", 0))
    series = {name: {n: value for (owner, n), value in values.items() if owner == name} for name in PARTS}
    written = {
        name: {
            (n,): {(): Fraction(str(value)) if hasattr(value, "p") else Fraction(float(value))}
            for n, value in series[name].items()
        }
        for name in PARTS
    }
    return _made(where.j, order, series, leading, written, (), digits)


def _made(
    j: int,
    order: int,
    series: Mapping[str, Mapping[int, Any]],
    leading: Any,
    written: Mapping[str, Any],
    names: tuple[str, ...],
    digits: int = 30,
) -> GrazingMap:
    x, xdot, depth, time = (PowerSeries("h", order, series.get(name, {}), digits) for name in PARTS)
    return GrazingMap(j, order, x, xdot, None if j else depth, None if j else time, leading, written, names)


# ---- the expansion, over any ring


def _expanded(contact: Contact, order: int, restitution: Any, rho: Mapping[int, Any]) -> dict[str, dict[int, Any]]:
    """The parts of the mapping: n -> coefficient of h^n, zeros left out."""
    j, ring = contact.order, contact.ring
    place_, speed = _flow(contact, order)
    space = JetSpace(("h",), order + 1, ring)
    h, nothing = space.generators()[0], space.jet({})
    lead = contact.a[j] * ring.rational(Fraction(1, (j + 1) * (j + 2)))
    depth = (h ** (j + 2)).scaled(lead)
    # the time s before t_* at which the motion meets the wall: each coefficient from the next degree of x = 0
    s, slope = h, ring.power(lead * ring.rational(Fraction(j + 2)), Fraction(-1))
    for n in range(1, order - j):
        missed = place_.compose((-s, -depth, nothing)).coefficient((j + 2 + n,))
        s = s - (h ** (n + 1)).scaled(missed * slope)
    s, depth, nothing, place_ = (jet.cut(order) for jet in (s, depth, nothing, place_))
    before = speed.compose((-s, -depth, nothing))
    after = before.scaled(-restitution)
    for k, value in rho.items():
        after = after + (before**k).scaled(value)
    # the state at t_* from which the flow leads back to (0, after): its own terms are the leading ones
    x, xdot = nothing, after
    for _ in range(order + 1):
        inner = (-s, x, xdot)
        x, xdot = x - place_.compose(inner), xdot - (speed.compose(inner) - after)
    jets = {"x": x, "xdot": xdot}
    if not j:
        time, inverse = nothing, ring.power(contact.a[0], Fraction(-1))
        for _ in range(order + 1):
            time = time - speed.compose((time, x, xdot)).scaled(inverse)
        jets |= {"depth": -place_.compose((time, x, xdot)), "time": time}
    return {
        name: {n: value for n in range(1, order + 1) if (value := jet.coefficient((n,))) != 0}
        for name, jet in jets.items()
    }


def _flow(contact: Contact, order: int) -> tuple[Jet, Jet]:
    """x - c to order + 1 and x' to order, from (c + X, U) at t_*: jets in (t, X, U) of weights 1, j + 2, j + 1.

    x'' = a_c(t_* + t) - (f(c + x, x', t_* + t) - f(c, 0, t_* + t)), by Picard's iteration: every round is
    right to one degree more.
    """
    j, ring = contact.order, contact.ring
    space = JetSpace(("t", "X", "U"), order + 1, ring, (1, j + 2, j + 1))
    t, start, launch = space.generators()
    low = space.to_order(order - 1)
    clock = low.generators()[0]
    push = low.jet({(k, 0, 0): value for k, value in contact.a.items()})
    x, xdot = start + t * launch, launch.cut(order)
    for _ in range(order + 1):
        short, fast = x.cut(order - 1), xdot.cut(order - 1)
        force = low.jet({})
        for (i, k, *late), value in contact.f.items():
            force = force + (short**i * fast**k * clock ** sum(late)).scaled(value)
        xdot = launch.cut(order) + (push - force).integral("t")
        x = start + xdot.integral("t")
    return x, xdot
