"""Points of contact order j of a model over j - 1 of its numbers, isolated with proof."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import cast

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, Name, names_in
from singimpact.algebra.isolated_zeros import Box, RepeatedZero, repeated_zeros
from singimpact.algebra.numbers import Array, near_rational, rational_ends
from singimpact.algebra.precision import balls_at
from singimpact.contact.contact import rest_acceleration
from singimpact.contact.points import MOST_DIGITS, in_period, window
from singimpact.inputs import checked_keywords, require, whole
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.oscillator.moving_number import CLEARANCE, period_over, value_of, with_number
from singimpact.result import Result, Results

AROUND = Fraction(1, 2)  # of a number, or of 1 where it is 0: half the interval that is searched without `between`
GUARD_BITS = 64


@dataclass(frozen=True, repr=False)
class ContactPoint(Result):
    """A time tau_* and numbers at which a_c and its first j - 1 derivatives vanish, and the j-th does not.

    Attributes
    ----------
    oscillator : the model with these numbers, true to the digits asked for. order : j.
    tau, numbers : tau_*, and the numbers by name, as doubles. sign : of the j-th derivative of a_c.
    certified : tau_* and the numbers in balls, each holding one point, by name; tau_* under "tau".
    slopes : shape (j - 1, j - 1), for each number the derivatives by it of a_c, a_c', ... at the point, and leading :
        the j-th derivative; both as doubles.
    """

    oscillator: Oscillator
    order: int
    tau: float
    numbers: Mapping[str, float]
    sign: int
    certified: Mapping[str, Certified]
    slopes: Array
    leading: float

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name}={value:.12g}" for name, value in self.numbers.items())
        return f"ContactPoint(order={self.order}, tau={self.tau:.12g}, {numbers}, sign={self.sign})"

    def as_dict(self) -> dict[str, object]:
        """order, tau, the numbers by name, sign, and the certified digits by name."""
        digits = {name: number.as_dict() for name, number in self.certified.items()}
        return {"order": self.order, "tau": self.tau, **self.numbers, "sign": self.sign, "certified": digits}

    def unfolded(self, *coefficients: float) -> Oscillator:
        """The model nearby in which a_c is, to first order, s^j + p_0 + p_1 s + ... + p_(j-2) s^(j-2) times a_j/j!.

        Parameters
        ----------
        coefficients : p_0, p_1, ..., p_(j-2). s : t - tau_*, up to a shift of higher order.

        Examples
        --------
        >>> family = Oscillator("x", "cos(t) + b*sin(2*t)", 0, "1/2", {"b": 0})
        >>> point = contact_points(family, 3, ("clearance", "b"), ((-2, 2), (-1, 1)))[-1]
        >>> from singimpact.contact.points import tangency_points
        >>> near = point.unfolded(0, -1e-4)  # zeros at -0.01, 0 and 0.01
        >>> [round(zero.tau - point.tau, 4) for zero in tangency_points(near)][1:]
        [-0.01, 0.0, 0.01]
        """
        scale = self.leading / factorial(self.order)
        wanted = [scale * factorial(k) * value for k, value in enumerate(coefficients)]
        require(len(wanted) == self.order - 1, "coefficients", coefficients, f"{self.order - 1} numbers")
        moves = np.linalg.solve(self.slopes.T, np.array(wanted)).tolist()
        return self.oscillator.replace(
            **{name: value + move for (name, value), move in zip(self.numbers.items(), moves, strict=True)}
        )


class ContactPoints(Results, tuple[ContactPoint, ...]):
    """Points of one contact order in a window of time and numbers, in the order of tau_*, then of the numbers.

    Attributes
    ----------
    window : the ends of tau and of each number. undecided : boxes of these in which there may be more.
    """

    called = "points"
    window: Box = ()
    undecided: tuple[Box, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether the window has no other."""
        return not self.undecided


@checked_keywords
def contact_points(
    osc: Oscillator, order: int, over: str | Sequence[str], between: object = None, *, digits: int = 30
) -> ContactPoints:
    """The points of contact order j of a model as j - 1 of its numbers move.

    Parameters
    ----------
    osc : a model with a period that the numbers do not change, or with a polynomial g. order : j, from 2 to 4.
    over : j - 1 numbers of the model, as `bifurcation` takes them. between : the ends of each, in the same order;
        without them half of each number on both sides of its value, or of 1 where it is 0.
    digits : decimal digits to which tau_* and the numbers are enclosed.

    Returns
    -------
    ContactPoints : a tuple; `.complete` says whether boxes of times and numbers show that the window has no others.

    Raises
    ------
    InputError : another count of numbers; numbers that a_c does not contain, or that change the period.

    Notes
    -----
    The numbers unfold each point that is found: its existence is shown by a regular matrix of derivatives. A time at
    which a_c is flatter, or which the numbers do not unfold, is among the undecided boxes. (label: def:Z)

    Examples
    --------
    >>> family = Oscillator("x", "cos(t) + b*cos(2*t)", 0, "1/2", {"b": 0})
    >>> found = contact_points(family, 2, "clearance", (-2, 2))
    >>> [(point.numbers, point.sign) for point in found], found.complete
    ([({'clearance': 1.0}, -1), ({'clearance': -1.0}, 1)], True)
    """
    require_model("osc", osc)
    names = (over,) if isinstance(over, str) else tuple(over)
    whole("order", order, 2, 4)
    require(len({*names}) == len(names) == order - 1, "over", over, f"{order - 1} numbers, one less than the order")
    for name in names:
        osc = with_number(osc, name)
    tree = _acceleration(osc, names)
    require({*names} <= names_in(tree), "over", over, f"numbers that a_c = {tree} contains")
    period = None if osc.period is None else period_over(osc, [name for name in names if name != CLEARANCE])
    lasting = osc.period is None or (period is not None and not names_in(period))
    require(lasting, "over", over, "numbers that do not change the period of the forcing")
    pairs = (
        [None] * len(names) if between is None else [between] if order == 2 else list(cast("Sequence[object]", between))
    )
    require(len(pairs) == len(names), "between", between, "two ends for each number")
    ends = [_ends(name, pair, value_of(osc, name)) for name, pair in zip(names, pairs, strict=True)]
    box = (_times(osc, names, ends), *ends)
    bits = whole("digits", digits, 1, MOST_DIGITS) * 4 + GUARD_BITS
    zeros = repeated_zeros(tree, ("t", *names), box, bits)
    # what is equal but for the last bits of a ball, such as times a symmetry apart, must not be told by them
    listed = sorted(
        (_point(osc, tree, names, zero, digits) for zero in zeros.found if in_period(osc, float(zero.at))),
        key=lambda point: [round(value, 12) for value in (point.tau, *point.numbers.values())],
    )
    points = ContactPoints(listed)
    points.window, points.undecided = box, zeros.undecided
    return points


def _acceleration(osc: Oscillator, names: Sequence[str]) -> Expression:
    wall = Name(CLEARANCE) if CLEARANCE in names else osc.clearance
    return rest_acceleration(osc.force(names), osc.forcing(names), wall)


def _ends(name: str, pair: object, value: float) -> tuple[Fraction, Fraction]:
    middle = Fraction(value)
    reach = AROUND * (abs(middle) or 1)
    sides = (middle - reach, middle + reach) if pair is None else pair
    return rational_ends("between", sides, f"two ends low < high of {name}", near_rational)


def _times(
    osc: Oscillator, names: Sequence[str], ends: Sequence[tuple[Fraction, Fraction]]
) -> tuple[Fraction, Fraction]:
    """A window of t: a period, or the zeros of a polynomial at all ends of the numbers."""
    windows = []
    for corner in range(2 ** len(names)):
        values = {name: pair[corner >> k & 1] for k, (name, pair) in enumerate(zip(names, ends, strict=True))}
        at_corner = osc.replace(**values)
        windows.append(window(at_corner, _acceleration(at_corner, ())))
    return min(low for low, _ in windows), max(high for _, high in windows)


def _point(osc: Oscillator, tree: Expression, names: Sequence[str], zero: RepeatedZero, digits: int) -> ContactPoint:
    order = len(zero.place)
    tau, *values = (from_ball(ball, digits) for ball in zero.place)
    doubles = (0.0 if number.contains(0) else float(number.value) for number in (tau, *values))
    at = dict(zip(("t", *names), doubles, strict=True))
    balls = Balls(128)
    rows, down = [], tree
    with balls_at(128):
        at_point = dict(zip(("t", *names), zero.place, strict=True))
        for _ in range(order):
            rows.append([float(balls.evaluate(derivative(down, name), at_point).mid()) for name in names])
            down = derivative(down, "t")
        leading = float(balls.evaluate(down, at_point).mid())
    time = at.pop("t")
    model = osc.replace(**{name: str(value) for name, value in zip(names, values, strict=True)})
    certified = {"tau": tau, **dict(zip(names, values, strict=True))}
    slopes = np.array(rows[:-1]).T
    return ContactPoint(model, order, time, at, zero.sign, certified, slopes, leading)
