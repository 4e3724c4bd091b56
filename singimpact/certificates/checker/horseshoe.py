"""A horseshoe: parallelograms of states whose images cross one another.

A set is c + E (u, s), |u| <= a, |s| <= b.  A map crosses from X to Y if, in the coordinates of Y, with the offset of
the image of c_X from c_Y and every matrix m of the derivatives over X, from coordinates of X to those of Y,

    |offset_s| + |m21| a_X + |m22| b_X < b_Y,      |m11| a_X - |m12| b_X - |offset_u| > a_Y,      m11 never 0.

Then the image of every curve in X from side u = -a to side u = a has a piece in Y from side to side.  The sets are N,
B_1, ..., B_m.  If G^n crosses from N to N and to B_1, G from B_i to B_(i+1) and from B_m to N, there is for every
sequence of loops of n and n + m impacts a state of N that follows it: it lies in nested pieces of one curve.  Where two
sequences part, one is in N and one in B_1, which lie apart.  So the entropy of G is at least ln x, where
x^-n + x^-(n + m) = 1.

Of all values p of a number within h of a middle the centres are c + c' (p - middle).  The offset is that at the middle,
and at most h times D G (c', 1) less the other c', D G by tau, v and p over all these centres and values.
"""

import re
from fractions import Fraction
from itertools import pairwise
from typing import Any

from flint import arb, arb_mat

from .formulas import Formula, Refused, Wrong, ball, need, require_period
from .motion import Model, next_state, within
from .periodic_orbit import impact

PIECES = ((1, 1), (1, 4), (4, 8))  # along u and along s, into which a set is cut; slices of the number's interval
COARSE = 64  # bits of the flights of a set


class Set:
    """A parallelogram of states, whose centre moves along with a number."""

    def __init__(self, content: dict[str, Any]) -> None:
        self.drift = [ball(Fraction(part)) for part in content.get("drift", (0, 0))]
        self.centre = [ball(Fraction(part)) for part in content["centre"]]
        self.frame = arb_mat([[ball(Fraction(part)) for part in row] for row in content["frame"]])
        self.radii = [ball(Fraction(part)) for part in content["radii"]]
        self.inverse = self.frame.inv()

    def moved(self, shift: Any) -> list[Any]:
        """The centre where the number differs so from that of its middle."""
        return [x + part * shift for x, part in zip(self.centre, self.drift, strict=True)]

    def pieces(self, count: int, shift: Any = 0) -> list[list[Any]]:
        """Balls of tau and v that cover it."""
        centre, found = self.moved(shift), []
        for u in range(count):
            for s in range(count):
                place = [radius * (arb(2 * k + 1, 1) / count - 1) for k, radius in zip((u, s), self.radii, strict=True)]
                found.append([x + part for x, part in zip(centre, (self.frame * column(place)).entries(), strict=True)])
        return found

    def reach(self) -> list[Any]:
        """By how much tau and v of a state may differ from those of the centre."""
        return (self.frame * column([within(radius) for radius in self.radii])).entries()  # type: ignore[no-any-return]


def column(parts: Any) -> Any:
    return arb_mat([[part] for part in parts])


def growth(content: dict[str, Any], side: int) -> Any:
    """exp of an end of the ball of the entropy."""
    return (ball(Fraction(content["entropy"]["value"])) + side * ball(Fraction(content["entropy"]["radius"]))).exp()


def horseshoe(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that the sets are crossed as the loops say, and that the entropy follows from them."""
    require_period(model.g, content["period"])
    require_loops(model, content, growth(content, -1), Formula(content["period"], model.g.parameters)(), bits)
    (short, long), x = map(int, content["loops"]), growth(content, 1)
    need("no more", x**-short + x**-long < 1, "the entropy is not shown to be that of the loops", Refused)


def horseshoes(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that there is a horseshoe for all values of a number between two: in pieces, that cover them."""
    over, text = content["over"], content["model"]
    others = {name: number for name, number in model.g.parameters.items() if name != over}
    if over in Formula(text["clearance"], others | {over: 0}).names():  # x is measured from the wall then
        text = {**text, "f": re.sub(r"\bx\b", f"(x + ({text['clearance']}))", text["f"]), "clearance": "0"}
    for formula in (text["g"], text["f"]):  # whatever the number is: it is no rate of t, and not in the period
        require_period(Formula(formula, others), content["period"])
    (low, high), period = map(Fraction, content["between"]), Formula(content["period"], others)()
    for piece in content["pieces"]:
        middle, span = Fraction(piece["number"]), Fraction(piece["reach"])
        need("follow", middle - span == low, "the pieces do not follow one another")
        low = middle + span
        require_loops(Model(text, over, ball(middle)), piece, growth(content, -1), period, bits)
    need("whole", low == high, "the pieces do not cover the interval")


def require_loops(model: Model, piece: dict[str, Any], x: Any, period: Any, bits: int) -> None:
    """Refuse loops whose sets are not crossed, or whose entropy is not at least ln x."""
    span = ball(Fraction(piece.get("reach", 0)))
    (short, long), (home, *way) = map(int, piece["loops"]), map(Set, piece["sets"])
    need("loops", long == short + len(way), "the loops are not those of the sets")
    need("entropy", x**-short + x**-long > 1, "the entropy is not shown to be that of the loops", Refused)
    require_apart(way[0], home, period, span)
    for one, other, impacts in (
        (home, home, short),
        (home, way[0], short),
        *((*pair, 1) for pair in pairwise(way)),
        (way[-1], home, 1),
    ):
        require_crossed(model, (one, other), impacts, (period, span), bits)


def require_apart(one: Set, other: Set, period: Any, span: Any) -> None:
    """Refuse sets that may meet, whole periods apart."""
    whole = round(float((one.centre[0] - other.centre[0]).mid()) / float(period))
    apart_by = [within(span) * (a - b) for a, b in zip(one.drift, other.drift, strict=True)]
    length = abs(one.reach()[0]) + abs(other.reach()[0]) + abs(apart_by[0])
    need("long", length < period / 2, "a set is too long")
    for turns in (whole - 1, whole, whole + 1):
        # sets of less than half a period are apart after more turns
        off = [one.centre[0] - other.centre[0] - turns * period, one.centre[1] - other.centre[1]]
        off = [x + more for x, more in zip(off, apart_by, strict=True)]
        apart = any(abs(x) > radius for x, radius in zip(seen(other, one, off), other.radii, strict=True))
        need("apart", apart, f"two sets are not shown to be apart: {off}")


def seen(other: Set, one: Set, off: list[Any]) -> list[Any]:
    """Balls of the coordinates, in another set, of the states of a set whose centre is so far off."""
    spread = other.inverse * one.frame * column([within(radius) for radius in one.radii])
    return (other.inverse * column(off) + spread).entries()  # type: ignore[no-any-return]


def slices(model: Model, span: Any, count: int) -> list[tuple[Model, Any]]:
    """The model for parts of the interval of its number, each with the distances from the middle."""
    shifts = [span * (arb(2 * k + 1) / count - 1) + within(span / count) for k in range(count if model.over else 1)]
    return [(model.at(model.value + shift) if model.over else model, shift) for shift in shifts]


def require_crossed(model: Model, pair: tuple[Set, Set], impacts: int, lengths: tuple[Any, Any], bits: int) -> None:
    """Refuse two sets unless the map crosses from one to the other; `lengths` are the period, and of the number."""
    (one, other), (period, span) = pair, lengths
    state = one.centre
    for _ in range(impacts):
        state = list(next_state(model, state[0], state[1], bits))
    turns = round(float((state[0] - other.centre[0]).mid()) / float(period))
    off = [state[0] - other.centre[0] - turns * period, state[1] - other.centre[1]]
    (a, b), why = one.radii, ""
    for count, parts in PIECES:
        models = slices(model, span, parts)
        try:
            along = [derivative(near, one.moved(shift), impacts, COARSE) for near, shift in models if model.over]
            over = [
                derivative(near, piece, impacts, COARSE) for near, shift in models for piece in one.pieces(count, shift)
            ]
        except Refused as reason:
            why = str(reason)
            continue
        rates = [joined((matrix * column([*one.drift, arb(1)]))[i, 0] for matrix in along) for i in (0, 1) if along]
        moved = [within(span) * (rate - goal) for rate, goal in zip(rates, other.drift, strict=False)] or [0, 0]
        u, s = (other.inverse * column([x + more for x, more in zip(off, moved, strict=True)])).entries()
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
    """Of the images of a box under so many impacts, over all of it; with the number as the last one, if it moves."""
    unknowns = 3 if model.over else 2
    total = arb_mat([[int(i == k) for k in range(unknowns)] for i in range(unknowns)])
    for n in range(impacts):
        centre = [arb(coordinate.mid()) for coordinate in box]
        rows = impact(model, box[0], box[1], bits, (centre[0], centre[1]))
        slope = arb_mat([row[:2] for row in rows])
        total = arb_mat([*rows, [0, 0, 1]][:unknowns]) * total
        if n + 1 < impacts:
            off = column([coordinate - x for coordinate, x in zip(box, centre, strict=True)])
            landed = next_state(model, centre[0], centre[1], bits)
            box = [x + coordinate for x, coordinate in zip(landed, (slope * off).entries(), strict=True)]
    return total
