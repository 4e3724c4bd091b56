"""The next zero of a_c after a phase, with its contact order decided exactly.

After a phase with a_c < 0 the next zero carries a gamma whatever its order: a_c becomes positive there (odd order,
a_j > 0) or touches zero from below (even order, a_j < 0).  What has to be decided is that it is a zero, and its order.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from math import floor, frexp
from typing import Any

from singimpact.algebra.balls import Balls, Zero, as_rational, derivatives, refined, sign_at
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    BOUND,
    Expression,
    Number,
    Root,
    evaluate,
    multiply,
    names_in,
    number,
    substitute,
    walk,
)
from singimpact.algebra.isolated_zeros import isolate
from singimpact.algebra.numbers import as_float, rational_near
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import Symbolic
from singimpact.algebra.taylor import NotSmooth
from singimpact.contact.contact import acceleration
from singimpact.contact.points import window
from singimpact.handed_on import sympy
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class ZeroSettings:
    """Settings of the isolation of zeros of a_c.

    Parameters
    ----------
    order : the highest contact order looked for. eighths : parts of the period at which an exact zero is tried.
    short : the largest denominator of a rational that is tried. pieces : of the axis looked at before giving up; two
        waves take some hundreds. bits : of the balls that tell a time from a zero.
    far : end of the search for a forcing that is neither periodic nor a polynomial, in units of time.
    """

    order: int = 12
    eighths: int = 8
    short: int = 1000
    pieces: int = 20_000
    bits: tuple[int, ...] = (128, 512, 2048)
    far: int = 10_000


SETTINGS = ZeroSettings()


@lru_cache(maxsize=1024)
def _ball(function: Expression, zero: Zero, order: int, bits: int) -> Any:
    return refined(function, "t", zero, bits, order=order - 1)


@dataclass(frozen=True)
class ContactZero:
    """A zero of a_c of known contact order, moved by whole periods.

    Attributes
    ----------
    function : a_c as a tree in t. zero : the piece that isolates the simple zero of its derivative of order j - 1.
    order, sign : the contact order j, and the sign of the j-th derivative. turns : periods added. period : or None.
    """

    function: Expression
    zero: Zero
    order: int
    sign: int
    period: Expression | None = None
    turns: int = 0

    def ball(self, bits: int = 128) -> Any:
        """A ball that contains the zero within the first period."""
        return _ball(self.function, self.zero, self.order, bits)

    def moved(self, bits: int = 128) -> Any:
        """A ball that contains the zero itself."""
        found = self.ball(bits)
        if self.period is None or not self.turns:
            return found
        with balls_at(bits):
            return found + self.turns * evaluate(self.period, {}, Balls(bits))

    @property
    def tau(self) -> float:
        """The zero as a double."""
        return float(self.moved(128 + max(frexp(float(self.turns))[1], 0)).mid())


@dataclass(frozen=True)
class NextZero:
    """The zero, or None; `decided` when it is proved to be the next one, or that there is none."""

    zero: ContactZero | None
    decided: bool


UNDECIDED = NextZero(None, False)


def next_zero(osc: Oscillator, tau: Expression) -> NextZero:
    """The next zero of a_c after a constant tau with a_c(tau) != 0.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> found = next_zero(Oscillator("x", "cos(2*t)", 1, "1/2"), constant("tau", "0.1")).zero
    >>> found.order, found.sign, found.tau
    (2, -1, 3.141592653589793)
    >>> next_zero(Oscillator("x", "cos(2*t)", 2, "1/2"), constant("tau", "0.1"))
    NextZero(zero=None, decided=True)
    """
    function = acceleration(osc)
    if "t" not in names_in(function):
        return NextZero(None, True)
    try:
        low, high = window(osc, function)
    except InputError:
        return _far(osc, function, tau)
    pieces = _decided(osc, function, low, high)
    return UNDECIDED if pieces is None else _first(pieces, tau, osc.period)


def _far(osc: Oscillator, function: Expression, tau: Expression) -> NextZero:
    """For a forcing of no known period: windows of growing length; that there is no zero is then never proved."""
    start = rational_near(tau, 256) - Fraction(1, 2**60)
    low, width = start, Fraction(1)
    while low - start < SETTINGS.far:
        pieces = _decided(osc, function, low, low + width)
        if pieces is None:
            return UNDECIDED
        zero = _first(pieces, tau, None)
        if zero.zero is not None or not zero.decided:
            return zero
        low, width = low + width, 2 * width
    return UNDECIDED


def _first(pieces: tuple[ContactZero | Zero, ...], tau: Expression, period: Expression | None) -> NextZero:
    """The first zero after tau, unless an undecided piece may come before it."""
    ahead = [_ahead(piece, tau, period) for piece in pieces]
    if any(found is None for found in ahead):
        return UNDECIDED
    later = [found for found in ahead if found is not None and found[0] is not None]
    if not later:
        return NextZero(None, True)
    first = min(later, key=lambda found: found[1])[0]
    return NextZero(first, True) if isinstance(first, ContactZero) else UNDECIDED


def _ahead(
    piece: ContactZero | Zero, tau: Expression, period: Expression | None
) -> tuple[ContactZero | Zero | None, float] | None:
    """A zero moved behind tau, and the time to it (an undecided piece: to its beginning); None when undecided."""
    for bits in SETTINGS.bits:
        bits += max(frexp(as_float(tau))[1], 0)
        balls = Balls(bits)
        with balls_at(bits):
            start = balls.evaluate(tau, {})
            at = piece.ball(bits) if isinstance(piece, ContactZero) else balls.rational(piece.low)
            end = at if isinstance(piece, ContactZero) else balls.rational(piece.high)
            if period is None:
                if end < start:
                    return None, 0.0
                if end > start:
                    return piece, max(float((at - start).mid()), 0.0)
                continue
            length = evaluate(period, {}, balls)
            least = floor(as_rational((start - end) / length))
            for turns in (least - 1, least, least + 1, least + 2):
                if end + turns * length > start:
                    moved = replace(piece, period=period, turns=turns) if isinstance(piece, ContactZero) else piece
                    return moved, max(float((at + turns * length - start).mid()), 0.0)
                if not end + turns * length < start:
                    break
    return None


@lru_cache(maxsize=256)
def _decided(
    osc: Oscillator, function: Expression, low: Fraction, high: Fraction
) -> tuple[ContactZero | Zero, ...] | None:
    """The zeros in a window with their orders; a piece stays a `Zero` where its order is not decided."""
    try:
        pieces = isolate(function, "t", low, high, pieces=SETTINGS.pieces)
        return tuple(part for piece in pieces for part in _of_piece(osc, function, piece))
    except (InputError, NotSmooth, ArithmeticError):
        return None


def _of_piece(osc: Oscillator, function: Expression, piece: Zero) -> list[ContactZero | Zero]:
    if piece.slope:
        return [ContactZero(function, piece, 1, piece.slope)]
    for order in range(1, SETTINGS.order):
        turns = isolate(function, "t", piece.low, piece.high, order, pieces=SETTINGS.pieces)
        if len(turns) == 1 and turns[0].slope:
            return _at_turn(osc, function, piece, turns[0], order)
    return [piece]


def _at_turn(osc: Oscillator, function: Expression, piece: Zero, turn: Zero, order: int) -> list[ContactZero | Zero]:
    """The only zero of a derivative of a_c on a piece: whether a_c and the derivatives before it vanish there too."""
    for bits in SETTINGS.bits:
        ball = refined(function, "t", turn, bits, order)
        with balls_at(bits):
            values = derivatives(function, "t", ball, order - 1, Balls(bits))
        if not all(value.contains(0) for value in values):
            # next to a zero of higher order lie several of lower order; only those of order 1 are told apart
            sign = (values[0] > 0) - (values[0] < 0)
            return _beside(function, piece, as_rational(ball), turn.slope, sign) if order == 1 else [piece]
    if any(_vanishes(function, phase, order) for phase in _named_places(osc, turn)):
        return [ContactZero(function, turn, order + 1, turn.slope)]
    return [piece]


def _beside(function: Expression, piece: Zero, turn: Fraction, slope: int, value: int) -> list[ContactZero | Zero]:
    """The zeros of a_c on the two sides of an extremum, by signs; none where the extremum points away from zero."""
    if value == slope:
        return []
    low, high = (sign_at(function, "t", end, 0) for end in (piece.low, piece.high))
    left = [Zero(piece.low, turn, -slope)] if low == slope else []
    right = [Zero(turn, piece.high, slope)] if high == slope else []
    return [ContactZero(function, part, 1, part.slope) for part in left + right]


def _named_places(osc: Oscillator, turn: Zero) -> list[Expression]:
    """Exact numbers on a piece at which the zero may lie: short rationals, parts of the period, roots in c."""
    middle = (turn.low + turn.high) / 2
    tried: list[Expression] = [number(0), Number(middle.limit_denominator(SETTINGS.short))]
    if osc.period is not None:
        eighth = as_float(osc.period) / SETTINGS.eighths
        tried.append(multiply(number(Fraction(round(float(middle) / eighth), SETTINGS.eighths)), osc.period))
    tried += [tree for tree in walk(osc.clearance) if isinstance(tree, Root)]
    tried += [
        inner
        for tree in list(tried)
        if isinstance(tree, Root)
        for inner in walk(tree.function)
        if isinstance(inner, Root)
    ]
    return [tree for tree in tried if turn.low <= rational_near(tree, 256) <= turn.high]


def _vanishes(function: Expression, phase: Expression, order: int) -> bool:
    """Whether a_c and its first `order` derivatives are exactly 0 at a constant, by sympy's rules for special angles
    and the equations of the roots that occur."""
    tree = substitute(function, {"t": phase})
    derived = function
    for _ in range(order + 1):
        if not _is_zero(tree):
            return False
        derived = derivative(derived, "t")
        tree = substitute(derived, {"t": phase})
    return True


class _WithRoots(Symbolic):
    """sympy objects, with a letter for every root."""

    def __init__(self) -> None:
        self.letters: dict[Root, Any] = {}

    def root(self, tree: Root) -> Any:
        return self.letters.setdefault(tree, sympy.Dummy(f"root{len(self.letters)}", real=True))


def _is_zero(tree: Expression) -> bool:
    """Whether a constant is 0, or is one of its roots put into that root's own equation."""
    ring = _WithRoots()
    value = sympy.expand(evaluate(tree, {}, ring))
    if value == 0:
        return True
    equations = [evaluate(root.function, {BOUND: letter}, ring) for root, letter in list(ring.letters.items())]
    return any(sympy.expand(value - sign * equation) == 0 for equation in equations for sign in (1, -1))
