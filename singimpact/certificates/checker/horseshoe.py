"""A horseshoe: parallelograms of states whose images cross one another.

A set is c + E (u, s), |u| <= a, |s| <= b.  A map crosses from X to Y if, in the coordinates of Y, with the offset of
the image of c_X from c_Y and every matrix m of the derivatives over X, from coordinates of X to those of Y,

    |offset_s| + |m21| a_X + |m22| b_X < b_Y,      |m11| a_X - |m12| b_X - |offset_u| > a_Y,      m11 never 0.

Then the image of every curve in X from side u = -a to side u = a has a piece in Y from side to side.  The sets are N,
B_1, ..., B_m.  If G^n crosses from N to N and to B_1, G from B_i to B_(i+1) and from B_m to N, there is for every
sequence of loops of n and n + m impacts a state of N that follows it: it lies in nested pieces of one curve.  Where two
sequences part, one is in N and one in B_1, which lie apart.  So the entropy of G is at least ln x, where
x^-n + x^-(n + m) = 1.
"""

from fractions import Fraction
from itertools import pairwise
from typing import Any

from flint import arb, arb_mat

from .formulas import Formula, Refused, Wrong, ball, need, require_period
from .motion import Model, next_state, within
from .periodic_orbit import impact

PIECES = (1, 4)  # along u and along s, into which a set is cut
COARSE = 64  # bits of the flights of a set


class Set:
    """A parallelogram of states."""

    def __init__(self, content: dict[str, Any]) -> None:
        self.centre = [ball(Fraction(part)) for part in content["centre"]]
        self.frame = arb_mat([[ball(Fraction(part)) for part in row] for row in content["frame"]])
        self.radii = [ball(Fraction(part)) for part in content["radii"]]
        self.inverse = self.frame.inv()

    def pieces(self, count: int) -> list[list[Any]]:
        """Balls of tau and v that cover it."""
        found = []
        for u in range(count):
            for s in range(count):
                place = [radius * (arb(2 * k + 1, 1) / count - 1) for k, radius in zip((u, s), self.radii, strict=True)]
                found.append(
                    [x + part for x, part in zip(self.centre, (self.frame * column(place)).entries(), strict=True)]
                )
        return found

    def reach(self) -> list[Any]:
        """By how much tau and v of a state may differ from those of the centre."""
        return (self.frame * column([within(radius) for radius in self.radii])).entries()  # type: ignore[no-any-return]


def column(parts: Any) -> Any:
    return arb_mat([[part] for part in parts])


def horseshoe(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that the sets are crossed as the loops say, and that the entropy follows from them."""
    require_period(model.g, content["period"])
    period = Formula(content["period"], model.g.parameters)()
    (short, long), (home, *way) = map(int, content["loops"]), map(Set, content["sets"])
    need("loops", long == short + len(way), "the loops are not those of the sets")
    x = [
        (ball(Fraction(content["entropy"]["value"])) + k * ball(Fraction(content["entropy"]["radius"]))).exp()
        for k in (-1, 1)
    ]
    between = x[0] ** -short + x[0] ** -long > 1 > x[1] ** -short + x[1] ** -long
    need("entropy", between, "the entropy is not shown to be that of the loops", Refused)
    require_apart(way[0], home, period)
    for one, other, impacts in (
        (home, home, short),
        (home, way[0], short),
        *((*pair, 1) for pair in pairwise(way)),
        (way[-1], home, 1),
    ):
        require_crossed(model, (one, other), impacts, period, bits)


def require_apart(one: Set, other: Set, period: Any) -> None:
    """Refuse sets that may meet, whole periods apart."""
    whole = round(float((one.centre[0] - other.centre[0]).mid()) / float(period))
    need("long", sum(abs(part.reach()[0]) for part in (one, other)) < period / 2, "a set is too long")
    for turns in (whole - 1, whole, whole + 1):
        # sets of less than half a period are apart after more turns
        off = [one.centre[0] - other.centre[0] - turns * period, one.centre[1] - other.centre[1]]
        place = [x + part for x, part in zip(off, one.reach(), strict=True)]
        apart = any(abs(x) > radius for x, radius in zip(seen(other, one, off), other.radii, strict=True))
        need("apart", apart, f"two sets are not shown to be apart: {place}")


def seen(other: Set, one: Set, off: list[Any]) -> list[Any]:
    """Balls of the coordinates, in another set, of the states of a set whose centre is so far off."""
    spread = other.inverse * one.frame * column([within(radius) for radius in one.radii])
    return (other.inverse * column(off) + spread).entries()  # type: ignore[no-any-return]


def require_crossed(model: Model, pair: tuple[Set, Set], impacts: int, period: Any, bits: int) -> None:
    """Refuse two sets unless the map crosses from one to the other."""
    one, other = pair
    state = one.centre
    for _ in range(impacts):
        state = list(next_state(model, state[0], state[1], bits))
    turns = round(float((state[0] - other.centre[0]).mid()) / float(period))
    off = [state[0] - other.centre[0] - turns * period, state[1] - other.centre[1]]
    u, s = (other.inverse * column(off)).entries()
    (a, b), why = one.radii, ""
    for count in PIECES:
        try:
            over = [derivative(model, piece, impacts, COARSE) for piece in one.pieces(count)]
        except Refused as reason:
            why = str(reason)
            continue
        D = arb_mat([[joined(matrix[i, k] for matrix in over) for k in (0, 1)] for i in (0, 1)])
        (m11, m12), (m21, m22) = (other.inverse * D * one.frame).table()
        width, height = abs(m11) * a - abs(m12) * b - abs(u), abs(s) + abs(m21) * a + abs(m22) * b
        try:
            # m11 is not 0 then
            need("width", width > other.radii[0], "an image is not shown to cross the next set from side to side")
            need("height", height < other.radii[1], "an image is not shown to cross the next set within its height")
            return
        except Wrong as reason:
            why = str(reason)
    raise Wrong(why)


def joined(parts: Any) -> Any:
    """A ball that contains balls."""
    first, *others = parts
    for each in others:
        first = first.union(each)
    return first


def derivative(model: Model, box: list[Any], impacts: int, bits: int) -> Any:
    """Of the images of a box under so many impacts, over all of it."""
    total = arb_mat([[1, 0], [0, 1]])
    for n in range(impacts):
        centre = [arb(coordinate.mid()) for coordinate in box]
        slope = arb_mat(impact(model, box[0], box[1], bits, (centre[0], centre[1])))
        total = slope * total
        if n + 1 < impacts:
            off = column([coordinate - x for coordinate, x in zip(box, centre, strict=True)])
            landed = next_state(model, centre[0], centre[1], bits)
            box = [x + coordinate for x, coordinate in zip(landed, (slope * off).entries(), strict=True)]
    return total
