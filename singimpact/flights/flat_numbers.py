"""The numbers of a model in the flat arrays that kernels read, and the rules of its flights.

They are computed as sums of two doubles, about 32 digits, for many models at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Any

import numpy as np

from singimpact.algebra import expressions
from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import Array, as_float, rational_near
from singimpact.codegen.scalar import scalar
from singimpact.codegen.taylor_recurrence import Recurrence
from singimpact.flights.bind import LAW
from singimpact.flights.horizons import Allowance
from singimpact.flights.kernels import layout
from singimpact.flights.kernels.double_double import product_twice, sum_twice
from singimpact.flights.kernels.hits import UNIT
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.linear import form_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION, UPPER, period_over
from singimpact.oscillator.rebound import rho_of

EPSILON = UNIT


# ---- sums of two doubles: a ring of arrays for trees of constants


@dataclass(frozen=True)
class Twofold:
    """high + low, numbers or arrays; low is below the last bit of high.

    Examples
    --------
    >>> third = TWOFOLDS.power(Twofold.of(3.0), Fraction(-1))
    >>> (third * Twofold.of(3.0) + Twofold.of(-1.0)).high < 1e-31
    True
    """

    high: Any
    low: Any

    @staticmethod
    def of(value: Any) -> Twofold:
        """Doubles as they are."""
        return Twofold(value, 0.0 * value)

    @staticmethod
    def near(value: Fraction) -> Twofold:
        """The nearest one to a rational."""
        return Twofold(float(value), float(value - Fraction(float(value))))

    def __add__(self, other: Twofold) -> Twofold:
        return Twofold(*sum_twice(self.high, self.low, other.high, other.low))

    def __mul__(self, other: Twofold) -> Twofold:
        return Twofold(*product_twice(self.high, self.low, other.high, other.low))

    def inverse(self) -> Twofold:
        """1/self, by one step of Newton's method."""
        first = Twofold.of(1.0 / self.high)
        left = Twofold.of(1.0) + self * Twofold.of(-first.high)
        return first + left * first


class Twofolds:
    """The ring; sums, products and whole powers of arrays, all other functions element by element."""

    def rational(self, value: Fraction) -> Twofold:
        return Twofold.near(value)

    def pi(self) -> Twofold:
        return Twofold.near(rational_near(expressions.Pi(), 256))

    def root(self, tree: expressions.Root) -> Twofold:
        return Twofold.near(rational_near(tree, 256))

    def power(self, base: Twofold, exponent: Fraction) -> Twofold:
        if exponent.denominator != 1:
            return _each(base, lambda balls, ball: balls.power(ball, exponent))
        found = Twofold.of(1.0)
        for _ in range(abs(int(exponent))):
            found = found * base
        return found if exponent > 0 else found.inverse()

    def call(self, function: str, argument: Twofold) -> Twofold:
        return _each(argument, lambda balls, ball: balls.call(function, ball))


TWOFOLDS = Twofolds()


def _each(argument: Twofold, work: Callable[[Balls, Any], Any]) -> Twofold:
    """A function of every element, in balls of 192 bits."""
    balls, highs = Balls(192), np.asarray(argument.high)
    parts = []
    for high, low in zip(
        highs.ravel().tolist(), np.broadcast_to(argument.low, highs.shape).ravel().tolist(), strict=True
    ):
        ball = work(balls, balls.rational(Fraction(high) + Fraction(low)))
        near = Twofold.near(as_rational(ball)) if ball.is_finite() else Twofold(np.nan, np.nan)
        parts.append((near.high, near.low))
    result = np.array(parts).reshape(*highs.shape, 2)
    return Twofold(result[..., 0][()], result[..., 1][()])


def value_of(tree: Expression, numbers: Mapping[str, Twofold]) -> Twofold:
    """A tree of constants and letters; without letters the doubles nearest to it, inf or nan where there is none."""
    if not expressions.names_in(tree):
        high = as_float(tree)
        low = float(rational_near(tree, 256) - Fraction(high)) if np.isfinite(high) else 0.0
        return Twofold(np.float64(high), np.float64(low))
    with np.errstate(all="ignore"):  # what is no number is refused by who reads it
        return expressions.evaluate(tree, numbers, TWOFOLDS)  # type: ignore[no-any-return]


# ---- the numbers of a model


def gap_of(osc: Oscillator) -> tuple[float, float]:
    """The distance of both walls as a double, and what the double leaves out; inf and 0 of a model with one wall."""
    if osc.upper is None:
        return np.inf, 0.0
    gap = value_of(expressions.subtract(osc.upper, osc.clearance), {})
    return float(gap.high), float(gap.low)


@dataclass(frozen=True)
class TableSettings:
    """The layout of the tables of a linear model."""

    # step times the fastest rate: longer steps are fewer, need more terms and leave a larger remainder
    reach: float = 0.6
    # the same for batches: measured best at 1.0, for one flight at a time at 0.6
    batch_reach: float = 1.0
    # degree of a Taylor step: 0.6^17/17! and 1/19! leave less than 1e-17 of the terms at its far end
    order: int = 16
    # rows of a table; after so many steps the closed form begins again
    rows: int = 200
    # the rate where nothing has one: x'' is constant then, and a step of any length is exact
    slowest: float = 2.0**-10
    # bits of the step, so that the time of a row is exact
    bits: int = 24
    # states of one call into compiled code, which hears no interruption: 0.05 s
    block: int = 65_536
    # states that are worth a thread of their own, which costs 0.1 ms, and impacts in batches
    shared: int = 4096
    batched: int = 32_768
    # states at most whose orbits are flown one by one: a batch costs as much as three of them, 1.8 us an impact
    alone: int = 3
    # states of one call when flights are interpreted
    interpreted: int = 64
    # impacts of a chatter that scratch has rows for: at first, and of a state that needs more
    chatter: tuple[int, int] = (4096, 2**20)


TABLES = TableSettings()


class Numbers:
    """The numbers of a model, or of many that differ in some of them, in two doubles each.

    Parameters
    ----------
    osc : the model. over : names of the numbers that move, each with a double for every member, shape (n,); then they
        are letters in the trees.
    """

    def __init__(self, osc: Oscillator, over: Mapping[str, Array] = MappingProxyType({})) -> None:
        self.osc, self.over, self.letters = osc, over, frozenset(over)
        self.size = next(iter(over.values())).size if over else 1
        self._values = {name: Twofold.of(values) for name, values in over.items()}
        self._kept = {name: value for name, value in osc.parameters.items() if name not in over}
        self.sides = (osc,) if osc.upper is None else (osc, osc.mirrored)
        tree = period_over(osc, self.letters)
        self.period = None if tree is None else self.value(tree)
        if self.period is not None and np.any(self.period.high < 0):
            self.period = self.period * Twofold.of(np.sign(self.period.high))

    def member(self, index: int) -> Oscillator:
        """One of the models; its numbers are the doubles that were given."""
        changes = {name: float(values[index]) for name, values in self.over.items()}
        return self.osc.replace(**changes) if changes else self.osc

    def value(self, tree: Expression) -> Twofold:
        """A tree of constants and letters."""
        return value_of(expressions.substitute(tree, self._kept), self._values)

    def column(self, tree: Expression) -> Array:
        """The nearest doubles to a tree, one for each member."""
        return np.broadcast_to(self.value(tree).high, self.size)

    def place(self, above: int) -> Expression:
        """The clearance, or minus the upper wall: the clearance of the model with x -> -x."""
        name = UPPER[0] if above else CLEARANCE
        tree = expressions.Name(name) if name in self.letters else getattr(self.osc, name)
        return expressions.negate(tree) if above else tree

    def law(self, above: int) -> tuple[str, tuple[Expression, ...]]:
        """The text of a law rho, empty for a constant, and its constants."""
        side, name = self.sides[above], UPPER[1] if above and UPPER[1] in self.osc.to_dict() else RESTITUTION
        if expressions.names_in(side.restitution):
            return scalar(rho_of(side.restitution), ("v",), LAW)
        return "", (expressions.Name(name) if name in self.letters else side.restitution,)

    def slope(self, above: int) -> Array:
        """r = -rho'(0) of each member."""
        text, trees = self.law(above)
        if not text:
            return self.column(trees[0])
        models = [self.osc] if self.letters.isdisjoint(self.osc.parameters) else map(self.member, range(self.size))
        sides = (each.mirrored if above else each for each in models)
        return np.broadcast_to([as_float(each.slope_at_rest()) for each in sides], self.size)


def laid_out(
    numbers: Numbers, allowance: Allowance, flows: Sequence[Recurrence | None], rows: int = TABLES.rows
) -> tuple[Array, Array, Array]:
    """Sizes, numbers of each model as the kernels read them, see `kernels.layout`, and constants of its laws.

    Behind a model with two walls lies the one with x -> -x, and so behind its law.

    Parameters
    ----------
    flows : the recurrence of f and g, None of a linear model; and that of the model with x -> -x. rows : of the tables
        of a linear model.

    Raises
    ------
    InputError : a number does not fit a double.
    """
    laws = []
    for above in range(len(numbers.sides)):
        text, trees = numbers.law(above)
        laws.append(np.stack([*map(numbers.column, trees), np.full(numbers.size, float(bool(text)))], axis=1))
    laws = _of_one_length(laws)
    parts = [_one_wall(numbers, above, allowance, flow, (laws[0].shape[1], rows)) for above, flow in enumerate(flows)]
    flats = [flat for _, flat in parts]
    flats = flats if flows[0] is None else _of_one_length(flats)
    # those of many members at one wall are not copied: they take megabytes
    both = np.hstack(flats) if len(flats) > 1 else flats[0]
    return np.maximum.reduce([sizes for sizes, _ in parts]), both, np.hstack(laws)


def _of_one_length(arrays: Sequence[Array]) -> list[Array]:
    """Rows whose last number stays the last: an address is read from there."""
    length = max(array.shape[1] for array in arrays)
    return [
        np.hstack([array[:, :-1], np.zeros((len(array), length - array.shape[1])), array[:, -1:]]) for array in arrays
    ]


def _one_wall(
    numbers: Numbers, above: int, allowance: Allowance, flow: Recurrence | None, lengths: tuple[int, int]
) -> tuple[Array, Array]:
    """Sizes and numbers of models at one wall; lengths : of the constants of rho, and rows of the tables."""
    osc, n = numbers.osc, numbers.size
    order = degree_for(EPSILON if flow is None else allowance.epsilon)
    room = max(order, degree_for(LIMITS.judging)) + 2 + LIMITS.derivatives_at_rest
    sizes = np.zeros(8, dtype=np.int64)
    sizes[layout.RHO] = lengths[0]
    if flow is None:
        flat, pace = _linear_numbers(numbers, above, sizes, (room, lengths[1]))
    else:
        trees = numbers.place(above), *flow.constants
        # last, the address of the compiled recurrence
        sizes[[layout.ROWS, layout.ROOM, layout.CONSTANTS]] = flow.rows, room, len(trees) + 1
        flat = np.ones((n, layout.SCALARS + len(trees) + 1))
        flat[:, layout.SCALARS : -1] = np.stack([numbers.column(tree) for tree in trees], axis=1)
        pace = np.ones(1) if numbers.period is None else 2 * np.pi / numbers.period.high
    short = TABLES.order if flow is None else degree_for(LIMITS.judging)
    coarse = 10 * allowance.epsilon if allowance.epsilon > EPSILON else 0.0
    gap = Twofold(np.inf, 0.0)
    if osc.upper is not None:
        gap = numbers.value(expressions.negate(expressions.add(numbers.place(0), numbers.place(1))))
    rules = (allowance.horizon, LIMITS.longest if flow is None else allowance.steps, order, short,
             LIMITS.safety * (EPSILON if flow is None else allowance.epsilon), LIMITS.likely,
             max(LIMITS.rough[0], coarse), max(LIMITS.rough[1], coarse), pace,
             1 - numbers.slope(above), allowance.reach, gap.high, gap.low)  # fmt: skip
    for slot, rule in enumerate(rules):
        flat[:, slot] = rule
    flat[:, layout.TURN : layout.TURN + 5] = 0.0 if numbers.period is None else parts_of_turn(numbers.period)
    finite = np.delete(flat[:, : layout.SCALARS + 4], layout.GAP, axis=1)
    if not (np.isfinite(finite).all() and np.isfinite(flat[:, layout.SCALARS :]).all()):
        if not numbers.over:
            raise InputError("a constant of the model is too large for a double: scale the model, or ask with digits=")
        shown = {name: np.unique(values)[:4].tolist() for name, values in numbers.over.items()}
        raise refuse("numbers", shown, "numbers at which the model has a period and finite constants")
    return sizes, flat


def _linear_numbers(numbers: Numbers, above: int, sizes: Array, lengths: tuple[int, int]) -> tuple[Array, Array]:
    """The numbers of linear models, and their largest rates; lengths : of Taylor coefficients, and rows of tables."""
    form = form_of(numbers.osc.force(numbers.letters), numbers.osc.forcing(numbers.letters))
    assert form is not None
    count, at, sign = len(form.harmonics), layout.SCALARS, expressions.number(-1 if above else 1)
    sizes[[layout.WAVES, layout.ROWS, layout.ROOM]] = count, lengths[1], max(lengths[0], 2 * count + 2)
    flat = np.zeros((numbers.size, layout.linear_length(sizes)))
    steady = expressions.add(
        expressions.multiply(sign, form.constant),
        expressions.negate(expressions.multiply(form.stiffness, numbers.place(above))),
    )
    trees = {at: form.damping, at + 1: form.stiffness, at + 2: steady}
    d, k = numbers.column(form.damping), numbers.column(form.stiffness)
    rates = [np.abs(numbers.column(wave.rate)) for wave in form.harmonics]
    # the largest rate is only a scale, so a double of it is enough
    scale = np.maximum.reduce([np.abs(d), np.abs(k) ** 0.5, *rates])
    flat[:, at + 3] = scale
    root = np.sqrt(d * d / 4 - k + 0j)
    fastest = np.maximum.reduce([np.abs(-d / 2 + root), np.abs(-d / 2 - root), *rates])
    for slot, reach in ((8, TABLES.reach), (9, TABLES.batch_reach)):
        flat[:, at + slot] = steps_with_few_bits(reach / np.where(fastest == 0, TABLES.slowest, fastest), TABLES.bits)
    for j, wave in enumerate(form.harmonics):
        parts = wave.rate, wave.phase, expressions.multiply(sign, wave.cosine), expressions.multiply(sign, wave.sine)
        trees |= dict(enumerate(parts, at + 10 + 4 * j))
    for slot, tree in trees.items():
        value = numbers.value(tree)
        flat[:, slot], flat[:, slot + 4 * (count if slot >= at + 10 else 1)] = value.high, value.low
    if numbers.period is not None:
        # in two parts, the first of 33 bits, and its inverse
        high = steps_with_few_bits(numbers.period.high, 33)
        rest = (numbers.period.high - high) + numbers.period.low
        flat[:, -3:] = np.stack([high, rest, 1 / numbers.period.high], axis=-1)
    return flat, scale


def steps_with_few_bits(steps: Array, bits: int) -> Array:
    """Steps cut to few bits, so that multiples of them are exact."""
    fraction, exponent = np.frexp(steps)
    return np.asarray(np.ldexp(np.floor(np.ldexp(fraction, bits)), exponent - bits))


def parts_of_turn(period: Twofold) -> Array:
    """A period and its parts of 26 bits, whose products with fewer than 2^26 periods are exact."""
    left, parts = period, [period.high]
    for _ in range(4):
        _, exponent = np.frexp(left.high)
        parts.append(np.ldexp(np.rint(np.ldexp(left.high, 26 - exponent)), exponent - 26))
        left = left + Twofold.of(-parts[-1])
    return np.asarray(np.stack(np.broadcast_arrays(*parts), axis=-1))
