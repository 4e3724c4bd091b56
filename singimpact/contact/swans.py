"""Swan points of a family as the clearance varies: tau_*, c_0 and the model at c_0, all with exact definitions."""

from dataclasses import dataclass
from fractions import Fraction
from math import floor
from typing import Any

from singimpact.algebra.balls import Balls, Zero, as_rational, derivatives, refined
from singimpact.algebra.certified import Certified
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    BOUND,
    Expression,
    Name,
    Number,
    Power,
    Root,
    evaluate,
    multiply,
    names_in,
    number,
    substitute,
    subtract,
    walk,
)
from singimpact.algebra.isolated_zeros import is_one_root, isolate
from singimpact.algebra.numbers import as_float, sign_of
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import EXACT, SYMBOLIC, ExactAtAngles
from singimpact.contact.contacts_over import contact_points
from singimpact.contact.points import enclosed, in_period, is_polynomial, window
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE
from singimpact.result import Result, Results

PARTS = 8  # of a period: the zeros of g' that have a name are looked for at its eighths
GRID = 10**6  # the ends of a root are multiples of 1/GRID where they can be
SAME = 1e-9  # two swan points nearer than this, in time and clearance, are one
SHORT = 1000  # the largest denominator with which c_0 is tried as a rational


@dataclass(frozen=True, repr=False)
class SwanPoint(Result):
    """A clearance c_0 and a time tau_* at which a_c and a_c' vanish together.

    Attributes
    ----------
    model : the family, at any clearance. time, place : tau_* and c_0 as exact constants.
    kind : "positive" (a'' > 0) or "negative".
    """

    model: Oscillator
    time: Expression
    place: Expression
    kind: str

    def __repr__(self) -> str:
        return f"{type(self).__name__}(clearance={self.clearance}, tau={self.tau}, kind={self.kind})"

    def as_dict(self) -> dict[str, Any]:
        """c_0 and tau_* as doubles, and the kind."""
        return {"clearance": self.clearance, "tau": self.tau, "kind": self.kind}

    def tau_ball(self, bits: int = 128) -> Any:
        """A ball that contains tau_*."""
        return Balls(bits).evaluate(self.time, {})

    def clearance_ball(self, bits: int = 128) -> Any:
        """A ball that contains c_0."""
        return Balls(bits).evaluate(self.place, {})

    def certified(self, digits: int = 30) -> tuple[Certified, Certified]:
        """(tau_*, c_0), each with a certified radius and so many significant digits."""
        return enclosed(self.tau_ball, digits), enclosed(self.clearance_ball, digits)

    @kept_property
    def tau(self) -> float:
        """tau_* as a double."""
        return as_float(self.time)

    @kept_property
    def clearance(self) -> float:
        """c_0 as a double."""
        return as_float(self.place)

    def oscillator(self, restitution: Any) -> Any:
        """The model exactly at c_0: its a_c has a double zero at tau_*, to any number of digits.

        Examples
        --------
        >>> model = Oscillator("x + 0.3*x**3", "cos(2*t)", 0, 1)
        >>> print(swan_points_over_clearance(model)[0].oscillator("0.5").clearance)
        root(u + 0.3*u**3 - 1, 0.829051, 0.829052)
        """
        return self.model.replace(clearance=self.place, restitution=restitution)


class SwanPoints(Results, tuple[SwanPoint, ...]):
    """The swan points of an interval of clearances, in the order of tau_*.

    Attributes
    ----------
    model : the family. between : the interval; where none was given, one that holds them all. Both None for constant g.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> found = swan_points_over_clearance(linear(2, 0, "1/2"))
    >>> [(float(swan.clearance), swan.kind) for swan in found], found.complete
    ([(1.0, 'negative'), (-1.0, 'positive')], True)
    """

    called = "swans"
    model: Oscillator | None = None
    between: tuple[Fraction, Fraction] | None = None

    @kept_property
    def complete(self) -> bool:
        """Whether a second search, in boxes of times and clearances, proves that there are these and no others."""
        if self.model is None:
            return not self
        boxes = contact_points(self.model, 2, CLEARANCE, self.between)
        swans = [(swan.tau, swan.clearance) for swan in self]
        near = [
            any(max(abs(box.tau - tau), abs(box.numbers[CLEARANCE] - c)) < SAME for tau, c in swans) for box in boxes
        ]
        return boxes.complete and len(boxes) == len(swans) and all(near)


def swan_points_over_clearance(model: Oscillator, between: tuple[Fraction, Fraction] | None = None) -> SwanPoints:
    """The swan points of x'' + f = g as the clearance varies in an interval; without one, over all clearances.

    a_c'(tau) = g'(tau) is free of c, so tau_* is a zero of g' and c_0 solves f(c, 0) = g(tau_*). Where t occurs in
    f(c, 0, t) = A(t) c + B(t), tau_* is a zero of c'(t) for c = (g - B)/A.

    Raises
    ------
    InputError : f(c, 0, t) depends on t together with powers of c; g is neither periodic nor a polynomial; f(c, 0) is
        no polynomial and there is no interval; a zero of g' or of f(c, 0) - g(tau_*) is double.

    Examples
    --------
    >>> model = Oscillator("x", "cos(2*t)", 0, 1)
    >>> [(p.kind, p.clearance) for p in swan_points_over_clearance(model, (Fraction(-2), Fraction(2)))]
    [('negative', 1.0), ('positive', -1.0)]
    """
    slope, factor = _slope_of_swans(model)
    if "t" not in names_in(slope):
        return SwanPoints()
    points: list[SwanPoint] = []
    ends: list[Fraction] = []
    for zero in isolate(slope, "t", *window(model, slope)):
        if not zero.slope:
            raise InputError(
                f"g' has zeros near t = {float(zero.low):.6g} that are not simple: they are not classified"
            )
        time = _named_time(model, slope, zero)
        if in_period(model, as_float(time)):
            kind = "positive" if zero.slope * sign_of(substitute(factor, {"t": time})) > 0 else "negative"
            places, window_of_them = _clearances(model, time, between)
            points += [SwanPoint(model, time, clearance, kind) for clearance in places]
            ends += window_of_them
    ordered = SwanPoints(sorted(points, key=lambda point: (point.tau, point.clearance)))
    if ends:
        ordered.model, ordered.between = model, (min(ends), max(ends))
    return ordered


def swans_are_listed(model: Oscillator) -> bool:
    """Whether tau_* of the swans over the clearance are zeros of a function of t alone."""
    return not model.parametric or not {"x", "t"} <= names_in(derivative(_force_at_rest(model), "x"))


def _force_at_rest(model: Oscillator) -> Expression:
    return substitute(model.force(), {"xdot": number(0)})


def _slope_of_swans(model: Oscillator) -> tuple[Expression, Expression]:
    """A function of t with the zeros of swan points, and the factor that gives it the sign of a_c'."""
    slope = derivative(model.forcing(), "t")
    if not model.parametric:
        return slope, number(1)
    if not swans_are_listed(model):
        raise InputError(
            f"f = {model.f} depends on t together with powers of x: swan points need f(x, 0, t) linear in x"
        )
    rest = _force_at_rest(model)
    A, push = derivative(rest, "x"), subtract(model.forcing(), substitute(rest, {"x": number(0)}))
    if "t" not in names_in(A):
        return derivative(push, "t"), number(1)
    return subtract(multiply(derivative(push, "t"), A), multiply(push, derivative(A, "t"))), A


def _named_time(model: Oscillator, slope: Expression, zero: Zero) -> Expression:
    """The zero of g' on a piece: 0 or a part of the period where it is one exactly, else a root."""
    candidates: list[Expression] = [number(0)]
    if model.period is not None:
        candidates += [multiply(number(Fraction(k, PARTS)), model.period) for k in range(1, PARTS)]
    for tree in candidates:
        if float(zero.low) <= as_float(tree) <= float(zero.high) and _exact(slope, {"t": tree}) == 0:
            return tree
    return _root(slope, "t", zero)


def _root(tree: Expression, variable: str, piece: Zero) -> Root:
    """The zero on a piece, between short decimals where the piece contains them."""
    low = Fraction(floor(as_rational(refined(tree, variable, piece, 64).mid()) * GRID), GRID)
    ends = (low, low + Fraction(1, GRID)) if piece.low <= low < low + Fraction(1, GRID) <= piece.high else None
    function = substitute(tree, {variable: Name(BOUND)})
    found = Root(function, *(ends or (piece.low, piece.high)))
    return found if is_one_root(found) else Root(function, piece.low, piece.high)


def _exact(tree: Expression, values: dict[str, Expression]) -> Fraction | None:
    """The rational that a tree is at constants, when the rules for special angles show it; else None."""
    try:
        return Fraction(evaluate(substitute(tree, values), {}, ExactAtAngles()))
    except (ArithmeticError, TypeError, KeyError):
        pass  # sympy knows more angles; it takes 0.25 s to load
    try:
        value_ = evaluate(tree, {name: evaluate(value, {}, SYMBOLIC) for name, value in values.items()}, SYMBOLIC)
    except ArithmeticError:
        return None
    return Fraction(int(value_.p), int(value_.q)) if value_.is_Rational else None


def _clearances(
    model: Oscillator, time: Expression, between: tuple[Fraction, Fraction] | None
) -> tuple[list[Expression], tuple[Fraction, Fraction]]:
    """The solutions c of f(c, 0) = g(tau_*), and an interval that has been searched for them."""
    rest = substitute(model.force(), {"xdot": number(0), "t": time})
    value = _exact(model.forcing(), {"t": time})
    level = substitute(model.forcing(), {"t": time}) if value is None else Number(value)
    shifted = subtract(rest, level)
    if "x" not in names_in(rest):
        raise InputError(f"f = {model.f} does not contain x: no clearance is a swan point rather than another")
    low, high = between if between is not None else _all_clearances(rest, level)
    roots: list[Expression] = []
    for piece in isolate(shifted, "x", low, high):
        if not piece.slope:
            raise InputError(f"f(c, 0) - g(tau_*) has a double zero near c = {float(piece.low):.6g}: give between=")
        roots.append(_named_place(shifted, piece))
    return roots, (low, high)


def _named_place(shifted: Expression, piece: Zero) -> Expression:
    """The zero on a piece: a rational where it is a short one exactly, a quotient where f is linear, else a root."""
    short = Fraction(float(refined(shifted, "x", piece, 128).mid())).limit_denominator(SHORT)
    if piece.low <= short <= piece.high and _exact(shifted, {"x": Number(short)}) == 0:
        return Number(short)
    slope = derivative(shifted, "x")
    if isinstance(slope, Number):
        return multiply(Number(-1 / slope.value), substitute(shifted, {"x": number(0)}))
    return _root(shifted, "x", piece)


def _all_clearances(rest: Expression, level: Expression) -> tuple[Fraction, Fraction]:
    """A window with every solution: Cauchy's bound, for a polynomial."""
    if not is_polynomial(rest):
        raise InputError(f"between is needed: f(x, 0) = {rest} is not a polynomial in x; give between=(low, high)")
    degree = sum(
        int(abs(node.exponent.value))
        for node in walk(rest)
        if isinstance(node, Power) and isinstance(node.exponent, Number)
    ) + sum(isinstance(node, Name) for node in walk(rest))
    try:
        coefficients = derivatives(rest, "x", Fraction(0), degree, EXACT)
    except ArithmeticError:
        raise InputError("between is needed: f(x, 0) has coefficients that are not rational; give between=") from None
    while coefficients[-1] == 0:
        coefficients.pop()
    size = max(abs(value) for value in coefficients) + Fraction(abs(as_float(level))) + 1
    bound = 1 + size / abs(coefficients[-1])
    return -bound * Fraction(98, 97), bound
