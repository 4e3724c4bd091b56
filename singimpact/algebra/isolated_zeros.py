"""All zeros in a box of as many equations as there are unknowns: isolated by balls.

The equations are formulas (`isolated_zeros`), or whatever encloses its values and derivatives (`zeros_of`).

A box is dropped when the ball of an equation over it, or its centred form, leaves out 0, or when Krawczyk's operator
moves all of it out.  A zero exists and is alone where that operator takes a box into its interior.  Boxes that are
neither, down to the least size, are handed on as undecided.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Protocol

import numpy as np

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.balls import BITS, Balls, Zero, as_rational, derivatives, sign_at
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import BOUND, Expression, Root
from singimpact.algebra.precision import balls_at
from singimpact.algebra.taylor import NotSmooth, dot
from singimpact.inputs import InputError, shown
from singimpact.progress import ProgressLine

Box = tuple[tuple[Fraction, Fraction], ...]
Place = tuple[Any, ...]


@dataclass(frozen=True)
class BoxSettings:
    """Settings of the subdivision of boxes.

    Parameters
    ----------
    bits : of the balls. least : size of a box, in parts of the unknowns' sizes, below which it is undecided.
    most : boxes looked at before the rest is undecided. lost : undecided ones of the least size after which it is too.
    cut : where a box is cut: off the middle, for there are zeros at places of symmetry.
    wider : each box is looked at with this part of it more on every side, so that no zero is on an edge.
    rounds : of Krawczyk's operator on the box of a zero.
    """

    bits: int = 128
    least: Fraction = Fraction(1, 2**20)
    most: int = 20_000
    lost: int = 20_000
    cut: Fraction = Fraction(127, 256)
    wider: Fraction = Fraction(1, 16)
    rounds: int = 60


SETTINGS = BoxSettings()


@dataclass(frozen=True)
class IsolatedZeros:
    """Zeros of a system.

    Parameters
    ----------
    found : balls of the unknowns, each with exactly one zero. A zero may lie outside the window by a little.
    undecided : boxes in which there may be more. looked_at : boxes in all.
    """

    found: tuple[Place, ...]
    undecided: tuple[Box, ...]
    looked_at: int

    @property
    def complete(self) -> bool:
        """Whether the window has no other zero."""
        return not self.undecided


def isolated_zeros(
    trees: Sequence[Expression],
    names: Sequence[str],
    window: Box,
    *,
    fixed: Mapping[str, Any] | None = None,
    excluded: Callable[[Place], bool] | None = None,
    settings: BoxSettings = SETTINGS,
) -> IsolatedZeros:
    """The zeros of trees in a window.

    Parameters
    ----------
    trees, names : equations and unknowns, as many. window : the ends of each unknown.
    fixed : balls of other names. excluded : another proof that a box has no zero.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> x, y = (parse(text, ["x", "y"]) for text in ("x**2 + y**2 - 1", "x - y"))
    >>> made = isolated_zeros((x, y), ("x", "y"), ((Fraction(-2), Fraction(2)), (Fraction(0), Fraction(2))))
    >>> [[round(float(part.mid()), 12) for part in zero] for zero in made.found], made.complete
    ([[0.707106781187, 0.707106781187]], True)
    """
    with balls_at(settings.bits):
        return zeros_of(_Formulas(trees, names, dict(fixed or {}), excluded), window, settings)


class System(Protocol):
    """Equations over boxes; a box over which they are not enclosed is cut."""

    def without_zeros(self, place: Place) -> bool:
        """Whether a box is shown to have no zero."""

    def linearised(self, place: Place, middle: Place) -> tuple[Sequence[Any], Sequence[Sequence[Any]]] | None:
        """Values at the middle of a box, and derivatives over it, a row for each equation."""


class _Formulas:
    """Expression trees as a system."""

    def __init__(
        self,
        trees: Sequence[Expression],
        names: Sequence[str],
        fixed: dict[str, Any],
        excluded: Callable[[Place], bool] | None,
    ) -> None:
        recorder = Recorder()
        values = [recorder.record(tree) for tree in trees]
        slopes = [recorder.derivative(value, name) for value in values for name in names]
        self.names, self.excluded = tuple(names), excluded
        self.values = recorder.program(values).prepared(fixed)
        self.slopes = recorder.program(slopes).prepared(fixed)

    def without_zeros(self, place: Place) -> bool:
        if not all(value.contains(0) for value in self.values(self._named(place))):
            return True
        return self.excluded is not None and self.excluded(place)

    def linearised(self, place: Place, middle: Place) -> tuple[Sequence[Any], Sequence[Sequence[Any]]]:
        flat, size = self.slopes(self._named(place)), len(self.names)
        return self.values(self._named(middle)), [flat[size * i : size * (i + 1)] for i in range(size)]

    def _named(self, place: Place) -> dict[str, Any]:
        return dict(zip(self.names, place, strict=True))


def zeros_of(
    system: System, window: Box, settings: BoxSettings = SETTINGS, sizes: Sequence[Fraction] | None = None
) -> IsolatedZeros:
    """The zeros of a system in a window, with balls of the precision at hand.

    Parameters
    ----------
    sizes : of the unknowns, in parts of which boxes are compared; those of the window without them.
    """
    search = _Search(system, window, settings, sizes or [high - low for low, high in window])
    with ProgressLine() as line:
        return search.run(lambda count: line.show(count, None, "boxes"))


class _Search:
    """Boxes on a stack."""

    def __init__(self, system: System, window: Box, settings: BoxSettings, sizes: Sequence[Fraction]) -> None:
        self.system, self.window, self.settings, self.sizes = system, window, settings, sizes
        self.balls, self.size = Balls(settings.bits), len(window)

    def run(self, shown: Callable[[int], None]) -> IsolatedZeros:
        """Cut boxes until each is decided or too small."""
        stack, zeros, undecided, count = [self.window], list[Place](), list[Box](), 0
        while stack and count < self.settings.most and len(undecided) < self.settings.lost:
            shown(count)
            count += 1
            box = stack.pop()
            decided = self._looked_at(box)
            if decided is None:
                smaller = self._cut(box)
                stack += smaller
                undecided += [] if smaller else [box]
            elif decided and not any(overlap(decided, other) for other in zeros):
                zeros.append(decided)
        return IsolatedZeros(tuple(zeros), tuple(undecided + stack), count)

    def _looked_at(self, box: Box) -> Place | None:
        """() when a box has no zero, the enclosure of one when it has, None when it is too large to tell."""
        balls = tuple(self.balls.interval(*ends) for ends in box)
        if self.system.without_zeros(balls):
            return ()
        # a zero on an edge lies inside the wider box of one of the two neighbours
        spare = [(high - low) * self.settings.wider for low, high in box]
        wider = tuple(self.balls.interval(low - w, high + w) for (low, high), w in zip(box, spare, strict=True))
        moved = self._krawczyk(wider)
        if moved is None:
            return None
        if moved == () or not overlap(moved, balls):
            return ()
        return self._polished(moved) if all(b.contains_interior(a) for a, b in zip(moved, wider, strict=True)) else None

    def _polished(self, zero: Place) -> Place:
        """The enclosure of a zero that is known to be there, until it shrinks no more."""
        # at 0 the radius is squared in each round, without an end: numbers with such exponents are a burden
        tiny = self.balls.rational(Fraction(1, 2 ** (4 * self.settings.bits)))
        for _ in range(self.settings.rounds):
            moved = self._krawczyk(zero)
            if not moved:
                return zero
            smaller = tuple(new.intersection(old) for new, old in zip(moved, zero, strict=True))
            stuck = all(new.rad() > 0.7 * old.rad() or new.rad() < tiny for new, old in zip(smaller, zero, strict=True))
            zero = smaller
            if stuck:
                break
        return zero

    def _krawczyk(self, balls_: Place) -> Place | None:
        """m - Y f(m) + (1 - Y J)(place - m); () where the centred form leaves out 0, None where no Y is found."""
        middle = tuple(side.mid() for side in balls_)
        away = [side - m for side, m in zip(balls_, middle, strict=True)]
        linear = self.system.linearised(balls_, middle)
        if linear is None:
            return None
        at_middle, J = linear
        for value, row in zip(at_middle, J, strict=True):
            if not (value + dot(row, away)).contains(0):
                return ()
        matrix = np.array([[float(slope.mid()) for slope in row] for row in J])
        try:
            # Y need not be exact: any regular matrix makes the operator right, a good one makes it contract
            Y = [[self.balls.rational(Fraction(float(side))) for side in row] for row in np.linalg.inv(matrix)]
        except (np.linalg.LinAlgError, ValueError, OverflowError):
            return None
        moved = []
        for i, row in enumerate(Y):
            rest = [int(i == k) - dot(row, [J[n][k] for n in range(self.size)]) for k in range(self.size)]
            moved.append(middle[i] - dot(row, at_middle) + dot(rest, away))
        return tuple(moved) if all(side.is_finite() for side in moved) else None

    def _cut(self, box: Box) -> list[Box]:
        """Two boxes, cut across the largest side."""
        shares = [(high - low) / size for (low, high), size in zip(box, self.sizes, strict=True)]
        k = shares.index(max(shares))
        if shares[k] < self.settings.least:
            return []
        return cut(box, k, self.settings.cut)


def cut(box: Box, k: int, share: Fraction) -> list[Box]:
    """Both parts of a box that is cut across a side, off its middle: zeros like to lie at places of symmetry."""
    low, high = box[k]
    at = low + (high - low) * share
    return [(*box[:k], ends, *box[k + 1 :]) for ends in ((low, at), (at, high))]


def overlap(one: Place, other: Place) -> bool:
    return all(a.overlaps(b) for a, b in zip(one, other, strict=True))


# All zeros in one variable of a function with parameters at which as many derivatives vanish as there are parameters.


@dataclass(frozen=True)
class RepeatedZero:
    """A place where a function and its first derivatives vanish, proved to exist and to be alone in its box.

    Attributes
    ----------
    place : balls of the variable and of each parameter. sign : of the next derivative; 0 where it is not told from
        zero. at, values : of the variable and of the parameters as rationals.
    """

    place: Place
    sign: int

    @property
    def at(self) -> Fraction:
        return as_rational(self.place[0])

    @property
    def values(self) -> tuple[Fraction, ...]:
        return tuple(map(as_rational, self.place[1:]))


@dataclass(frozen=True)
class RepeatedZeros:
    """found : in order of the parameters, then of the variable. undecided : boxes that may hold more."""

    found: tuple[RepeatedZero, ...]
    undecided: tuple[Box, ...]

    @property
    def complete(self) -> bool:
        """Whether no other zero of this kind lies in the window."""
        return not self.undecided


def repeated_zeros(tree: Expression, names: Sequence[str], window: Box, bits: int = BITS) -> RepeatedZeros:
    """The places in a window where a tree and its derivatives by the first name vanish, one for each other name.

    Parameters
    ----------
    names : the variable and the parameters. window : the ends of each.

    Notes
    -----
    A zero is found where the matrix of derivatives is regular: the next derivative is not 0, and the parameters move
    the value and the other derivatives in all directions.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> box = (Fraction(-1), Fraction(6)), (Fraction(0), Fraction(2))
    >>> made = repeated_zeros(parse("p*cos(t) - 1", ["t", "p"]), ("t", "p"), box)
    >>> [(round(float(each.at), 12) + 0.0, float(each.values[0]), each.sign) for each in made.found], made.complete
    ([(0.0, 1.0, -1)], True)
    """
    trees = [tree]
    for _ in names:
        trees.append(derivative(trees[-1], names[0]))
    # boxes of more unknowns are cut more often
    most = SETTINGS.most * 20 ** max(0, len(names) - 3)
    isolated = isolated_zeros(trees[:-1], names, window, settings=replace(SETTINGS, bits=bits, most=most))
    zeros = []
    for balls in isolated.found:
        with balls_at(bits):
            bent: Any = Balls(bits).evaluate(trees[-1], dict(zip(names, balls, strict=True)))
        zero = RepeatedZero(balls, 1 if bent > 0 else -1 if bent < 0 else 0)
        if all(low <= side <= high for side, (low, high) in zip((zero.at, *zero.values), window, strict=True)):
            zeros.append(zero)
    zeros.sort(key=lambda each: (each.values, each.at))
    return RepeatedZeros(tuple(zeros), isolated.undecided)


# All real zeros of a function of one variable in a window: isolated by balls, so none is missed.
#
# A piece of the window is dropped when the ball of the function over it leaves out 0, and settled when the ball of the
# derivative does: then there is at most one zero, and the signs at the two ends decide.  A piece that is neither, down
# to the least width, is kept as `undecided` (a double zero looks like this).

LEAST_WIDTH = Fraction(1, 2**26)  # of the window: below it a double zero is suspected and handed on as undecided


def isolate(
    tree: Expression, variable: str, low: Fraction, high: Fraction, order: int = 0, pieces: int | None = None
) -> list[Zero]:
    """All zeros in [low, high) of the derivative of this order of a tree in one variable.

    Raises
    ------
    InputError : more than `pieces` pieces were looked at, when a number of them is given.
    NotSmooth : the function has no Taylor series somewhere in the window, to within the least width of a piece.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> [zero.slope for zero in isolate(parse("cos(t)", ["t"]), "t", Fraction(-1), Fraction(6))]
    [-1, 1]
    """
    balls = Balls(BITS)
    least = (high - low) * LEAST_WIDTH
    zeros: list[Zero] = []
    with balls_at(BITS):
        stack = [(low, high)]
        while stack:
            left, right = stack.pop()
            if pieces is not None:
                pieces -= 1
                if pieces < 0:
                    raise InputError(f"the zeros of {shown(str(tree))} cost too much to tell apart: give closer ends")
            window = balls.interval(left, right)
            try:
                value, slope = derivatives(tree, variable, window, order + 1, balls)[order : order + 2]
            except NotSmooth:
                # a ball over a long piece may hold a 0 of a denominator that none of its points has
                if right - left < least:
                    raise
                value = slope = balls.unknown()
            if value > 0 or value < 0:
                continue
            if slope > 0 or slope < 0:
                rising = 1 if slope > 0 else -1
                if sign_at(tree, variable, left, order) * rising <= 0 < sign_at(tree, variable, right, order) * rising:
                    zeros.append(Zero(left, right, rising))
                continue
            if right - left < least:
                zeros.append(Zero(left, right, 0))
                continue
            middle = left + (right - left) * Fraction(127, 256)  # off the middle: symmetric zeros do not fall on an end
            stack += [(middle, right), (left, middle)]
    return _merged(zeros)


def _merged(found: list[Zero]) -> list[Zero]:
    """Neighbouring undecided pieces as one."""
    merged: list[Zero] = []
    for zero in found:
        if merged and zero.slope == 0 == merged[-1].slope and zero.low == merged[-1].high:
            merged[-1] = Zero(merged[-1].low, zero.high, 0)
        else:
            merged.append(zero)
    return merged


def is_one_root(tree: Root, pieces: int | None = None) -> bool:
    """Whether the function has exactly one zero in the interval, with opposite signs at the ends."""
    ends = [sign_at(tree.function, BOUND, end, 0) for end in (tree.low, tree.high)]
    found = isolate(tree.function, BOUND, tree.low, tree.high, pieces=pieces)
    return ends[0] * ends[1] < 0 and len(found) == 1 and found[0].slope != 0
