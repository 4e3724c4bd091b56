"""All double zeros in one variable of a function with a parameter, in a window of both: isolated by balls.

A box is dropped when the ball of the function or of its slope over it leaves out 0, or when Krawczyk's operator moves
all of it out; it holds at most one double zero where the matrix of derivatives is regular over it.  Boxes that are
neither, down to the least size, are handed on as undecided.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression
from singimpact.algebra.precision import balls_at

Box = tuple[Fraction, Fraction, Fraction, Fraction]


@dataclass(frozen=True)
class BoxSettings:
    """bits : of the balls. least : size of a box, in parts of the window, below which it is undecided.
    most : boxes looked at before the rest is undecided; two waves and one parameter take 200 to 700.
    grown : the last enclosure is made wider by this share of the window, to show that a zero lies in it.
    """

    bits: int = 128
    least: Fraction = Fraction(1, 2**20)
    most: int = 6000
    grown: Fraction = Fraction(1, 2**90)


SETTINGS = BoxSettings()


@dataclass(frozen=True)
class DoubleZero:
    """A place where the function and its slope vanish, proved to exist and to be alone in its box.

    Attributes
    ----------
    at, value : of the variable and of the parameter, rational, true to 2^-80 of the window. curvature : sign of the
        second derivative; 0 where it is not told from zero.
    """

    at: Fraction
    value: Fraction
    curvature: int


@dataclass(frozen=True)
class DoubleZeros:
    """found : in order of the parameter, then of the variable. undecided : boxes that may hold more."""

    found: tuple[DoubleZero, ...]
    undecided: tuple[Box, ...]

    @property
    def complete(self) -> bool:
        """Whether no other double zero lies in the window."""
        return not self.undecided


def double_zeros(tree: Expression, names: tuple[str, str], window: Box) -> DoubleZeros:
    """The double zeros of a tree in the first name, as the second moves.

    Parameters
    ----------
    names : the variable and the parameter. window : ends of the one, ends of the other.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> box = (Fraction(-1), Fraction(6), Fraction(0), Fraction(2))
    >>> made = double_zeros(parse("p*cos(t) - 1", ["t", "p"]), ("t", "p"), box)
    >>> [(round(float(each.at), 12) + 0.0, float(each.value), each.curvature) for each in made.found], made.complete
    ([(0.0, 1.0, -1)], True)
    """
    with balls_at(SETTINGS.bits):
        return _Search(tree, names, window).run()


class _Search:
    """Boxes on a stack."""

    def __init__(self, tree: Expression, names: tuple[str, str], window: Box) -> None:
        first = derivative(tree, names[0])
        second = derivative(first, names[0])
        self.values = (tree, first)
        self.matrix = ((first, derivative(tree, names[1])), (second, derivative(first, names[1])))
        self.names, self.window, self.balls = names, window, Balls(SETTINGS.bits)
        self.sizes = window[1] - window[0], window[3] - window[2]

    def run(self) -> DoubleZeros:
        stack, found, undecided = [self.window], list[tuple[Any, Any]](), list[Box]()
        for _ in range(SETTINGS.most):
            if not stack:
                break
            box = stack.pop()
            told = self._looked_at(box)
            if told is None:
                smaller = self._halved(box)
                stack += smaller
                undecided += [] if smaller else [box]
            elif told and not any(told[0].overlaps(at) and told[1].overlaps(value) for at, value in found):
                found.append((told[0], told[1]))
        zeros = [DoubleZero(as_rational(at), as_rational(value), self._sign(at, value)) for at, value in found]
        zeros.sort(key=lambda each: (each.value, each.at))
        return DoubleZeros(tuple(zeros), tuple(undecided + stack))

    def _looked_at(self, box: Box) -> tuple[Any, ...] | None:
        """() when no zero lies in a box, its enclosure when one does, None when the box is too large to tell."""
        place = self.balls.interval(*box[:2]), self.balls.interval(*box[2:])
        if any(not self._of(tree, place).contains(0) for tree in self.values):
            return ()
        regular = False
        for _ in range(60):
            step = self._krawczyk(place)
            if step is None:
                return None
            moved, dominant = step
            regular = regular or dominant
            if not all(new.overlaps(old) for new, old in zip(moved, place, strict=True)):
                return ()
            smaller = tuple(new.intersection(old) for new, old in zip(moved, place, strict=True))
            stuck = all(new.rad() > old.rad() * 0.7 for new, old in zip(smaller, place, strict=True))
            place = smaller[0], smaller[1]
            if stuck:
                break
        return self._exists(place) if regular else None

    def _exists(self, place: tuple[Any, Any]) -> tuple[Any, ...] | None:
        """The enclosure made a little wider, when Krawczyk's operator takes it into itself."""
        import flint

        margins = [self.balls.rational(size * SETTINGS.grown) for size in self.sizes]
        wider = tuple(part + flint.arb(0, m.mid()) for part, m in zip(place, margins, strict=True))
        step = self._krawczyk((wider[0], wider[1]))
        if step is None or not all(old.contains_interior(new) for new, old in zip(step[0], wider, strict=True)):
            return None
        return step[0]

    def _krawczyk(self, place: tuple[Any, Any]) -> tuple[tuple[Any, Any], bool] | None:
        """m - Y f(m) + (1 - Y J)(box - m), and whether 1 - Y J is small; None where no Y is found."""
        middle = place[0].mid(), place[1].mid()
        (a, b), (c, d) = [[self._of(tree, middle).mid() for tree in row] for row in self.matrix]
        determinant = (a * d - b * c).mid()
        if determinant == 0:
            return None
        Y = [[(each / determinant).mid() for each in row] for row in ((d, -b), (-c, a))]
        J = [[self._of(tree, place) for tree in row] for row in self.matrix]
        f = [self._of(tree, middle) for tree in self.values]
        away = place[0] - middle[0], place[1] - middle[1]
        rest = [
            [(1 if i == k else 0) - (Y[i][0] * J[0][k] + Y[i][1] * J[1][k]) for k in range(2)] for i in range(2)
        ]  # fmt: skip
        moved = [
            middle[i] - (Y[i][0] * f[0] + Y[i][1] * f[1]) + rest[i][0] * away[0] + rest[i][1] * away[1]
            for i in range(2)
        ]  # fmt: skip
        if not all(part.is_finite() for part in moved):
            return None
        sizes = [float(self.balls.rational(size)) for size in self.sizes]
        dominant = all(
            float(sum(abs(rest[i][k]).upper() * sizes[k] for k in range(2))) < sizes[i] for i in range(2)
        )  # fmt: skip
        return (moved[0], moved[1]), dominant

    def _halved(self, box: Box) -> list[Box]:
        """Two boxes, cut across the longer side off the middle: symmetric zeros do not fall on an edge."""
        wide, high = (box[1] - box[0]) / self.sizes[0], (box[3] - box[2]) / self.sizes[1]
        if max(wide, high) < SETTINGS.least:
            return []
        if wide >= high:
            at = box[0] + (box[1] - box[0]) * Fraction(127, 256)
            return [(box[0], at, *box[2:]), (at, *box[1:])]
        at = box[2] + (box[3] - box[2]) * Fraction(127, 256)
        return [(*box[:3], at), (*box[:2], at, box[3])]

    def _of(self, tree: Expression, place: tuple[Any, Any]) -> Any:
        return self.balls.evaluate(tree, dict(zip(self.names, place, strict=True)))

    def _sign(self, at: Any, value: Any) -> int:
        bent = self._of(self.matrix[1][0], (at, value))
        return 1 if bent > 0 else -1 if bent < 0 else 0
