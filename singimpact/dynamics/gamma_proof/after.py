"""The motion after the contact point: contact is lost at an odd order; at a negative swan chatter completes.

notation: s > 0 after tau_*, |A(s)| = s^j B(s), e = landing place, sigma = launch place, p = |A(-x)| before tau_*.

Odd order: A > 0 while a_c > 0, so y is convex there and has at most one more impact.
Swan: where |A| does not decrease each flight is at most r times as long, in s, as the one before.  For landing places
sigma <= e <= e1 the landing speed at e is int (u - sigma)|A|/(e - sigma) <= |A(e)| (e - sigma)/2, and the next launch
speed is int (e1 - u)|A|/(e1 - e) >= |A(e)| (e1 - e)/2.  So chatter completes before e + d/(1 - r), d the first flight
that is launched after tau_*, as long as that is within the interval on which |A| increases.
"""

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from flint import arb

from singimpact.dynamics.gamma_proof.folded import between, symmetric
from singimpact.dynamics.gamma_proof.gravity import Gravity, LinearNumbers, time_of
from singimpact.dynamics.gamma_proof.lemmas import rational, short

PIECES = 64  # of an interval on which a sign is shown
CELLS = 7  # halvings of S, and of the first landing place
STEPS = 16  # of S, on which the speed that passes is bounded
HALVINGS = 12  # of a piece on which a sign is not decided
ENDS = (Fraction(1), Fraction(3, 4), Fraction(1, 2))  # of the interval looked at, at which chatter may end
FIRSTS = tuple(Fraction(9, 10) * Fraction(5, 6) ** k for k in range(22))  # of that end, where the first flight may land


class Lost(NamedTuple):
    """Contact is lost: after tau_* at most one more impact comes before tau_* + time.

    near : S up to which the series shows it.
    """

    near: Fraction
    time: Fraction


class Settled(NamedTuple):
    """A launch with S <= launch and y' <= speed that passes tau_* lands first at s <= first, and its chatter completes
    before s = end; y' = v e^(-b T)/sqrt(1 + w S^2)."""

    launch: Fraction
    speed: Fraction
    first: Fraction
    end: Fraction


def sum_after(o: Gravity, s: Any, weight: Any) -> Any:
    """The sum of weight(k) b_k (-s)^(k-j); weight(k) at most k in size."""
    found = arb(0)
    for k in reversed(range(o.j, len(o.b))):
        found = found * -s + weight(k) * o.b[k]
    return found + symmetric(o.tail(o.j))


def _one(k: int) -> int:  # noqa: ARG001
    return 1


def positive(o: Gravity, reach: Any, weight: Callable[[int], int], sign: int = 1) -> bool:
    """Whether `sum_after` is positive on (0, reach], or for sign = -1 on [-reach, 0): with the weight k, |A| rises."""
    steps = [reach * i / PIECES for i in range(PIECES + 1)]
    pieces = [between(a, b) for a, b in pairwise(steps)]
    return all(sum_after(o, piece if sign > 0 else -piece, weight) > 0 for piece in pieces)


def lost_contact(o: Gravity, numbers: LinearNumbers, near: Fraction, time: Fraction) -> Lost | None:
    """Proof that a_c > 0 up to a time after tau_*: to s = near by the series, then by balls; None if not decided."""
    if not positive(o, rational(near), _one):
        return None
    todo = [(arb(time_of(numbers.square, rational(near)).lower()), rational(time), 0)]
    while todo:
        a, b, level = todo.pop()
        if a >= b or acceleration_after(numbers, between(a, b)) > 0:
            continue
        if level > HALVINGS:
            return None
        middle = arb(((a + b) / 2).mid())
        todo += [(a, middle, level + 1), (middle, b, level + 1)]
    return Lost(near, time)


def acceleration_after(numbers: LinearNumbers, time: Any) -> Any:
    """a_c so long after tau_*."""
    found = numbers.steady
    for rate, phase, cosine, sine in numbers.waves:
        angle = rate * time + phase
        found = found + cosine * angle.cos() + sine * angle.sin()
    return found


def settled(o: Gravity, launch: Fraction, r: Any, most: Fraction) -> Settled | None:
    """The largest launch speed found for which chatter after a swan is shown to complete; None where none is.

    Parameters
    ----------
    o : gravity with a reach of at least most and launch. r : an upper bound. most : s after tau_* at most.
    """
    s0 = rational(launch)
    if o.j != 2 or not positive(o, s0, int, -1):
        return None
    best: Settled | None = None
    for end in (most * share for share in ENDS):
        if not positive(o, rational(end), int):
            continue
        for first in (short(rational(end * share)) for share in FIRSTS):
            passing = passing_speed(o, s0, rational(first))
            # a decimal of four digits below the ball
            speed = Fraction(f"{0.999 * float(passing.lower()):.4g}") if passing > 0 else Fraction(0)
            if speed <= 0 or (best is not None and speed <= best.speed):
                break
            if completes(o, s0, r, rational(first), rational(end)):
                best = Settled(launch, speed, first, end)
                break
    return best


def passing_speed(o: Gravity, s0: Any, first: Any) -> Any:
    """A launch speed below which flights from -s0 <= s < 0 land before s = first: int (e-u)|A|/(e+S) at least."""
    steps = [s0 * i / STEPS for i in range(STEPS + 1)]
    # the integral over u > 0, then that over u < 0 with x = -u: int (e + x) p(x) dx
    right = first ** (o.j + 2) * sum_after(o, first, lambda k: arb(1) / ((k + 1) * (k + 2)))
    least = arb("1e9")
    for a, b in pairwise(steps):
        S = between(a, b)
        left = first * _moment(o, -S, 1) + _moment(o, -S, 2)
        least = least.min(arb(((right + left) / (first + S)).lower()))
    return least


def _moment(o: Gravity, s: Any, n: int) -> Any:
    """int_0^|s| x^(n-1) |A| dx, after tau_* for s > 0 and before it for s < 0."""
    return abs(s) ** (o.j + n) * sum_after(o, s, lambda k: arb(1) / (k + n))


def completes(o: Gravity, s0: Any, r: Any, first: Any, end: Any) -> bool:
    """Whether the flights after any first landing in [0, first] end before s = end."""
    least = least_ratios(o, end)
    if not least[-1] > 0:
        return False
    half = arb(1) / 2
    todo = [(0, 0, 0)]  # cells of (S, e); the far ones come first
    while todo:
        a, c, n = todo.pop()
        S = between(a * half**n, (a + 1) * half**n) * s0
        e = between(c * half**n, (c + 1) * half**n) * first
        if _ends_before(o, (S, e), r, end, least):
            continue
        if n >= CELLS:
            return False
        todo += [(2 * a + i, 2 * c + k, n + 1) for i in (0, 1) for k in (0, 1)]
    return True


def least_ratios(o: Gravity, end: Any) -> list[Any]:
    """Lower bounds of |A|/s^j on [0, end i/PIECES], i = 1, 2, ..."""
    steps, found, alpha = [end * i / PIECES for i in range(PIECES + 1)], [], arb("1e9")
    for a, b in pairwise(steps):
        alpha = alpha.min(arb(sum_after(o, between(a, b), _one).lower()))
        found.append(alpha)
    return found


def _ends_before(o: Gravity, cell: tuple[Any, Any], r: Any, end: Any, least: list[Any]) -> bool:
    """Whether the flights after a landing e of a launch S in a cell end before s = end: e + d/(1 - r) < end."""
    S, e = cell
    speed, start, alpha = r * landing_speed(o, S, e), arb(e.lower()), least[-1]
    for _ in range(3):
        d = flight_bound(speed, start, alpha)
        if d is None:
            return False
        if e + d / (1 - r) < end:
            return True
        # the flight stays below e + d, where |A|/s^2 may be larger
        piece = int(float(((e + d) / end * PIECES).upper())) if e + d < end else PIECES - 1
        alpha = least[min(piece, PIECES - 1)]
    return False


def landing_speed(o: Gravity, S: Any, e: Any) -> Any:
    """An upper bound of int (u + S)|A|/(e + S) du from -S to e: by its value, and by the largest |A|."""
    at = [abs(x) ** o.j * sum_after(o, x, _one) for x in (e, -S)]
    rough = at[0].max(at[1]) * (e + S) / 2
    exact = (_moment(o, e, 2) + S * _moment(o, e, 1) + S * _moment(o, -S, 1) - _moment(o, -S, 2)) / (e + S)
    bound = arb(rough.upper())
    return bound.min(arb(exact.upper())) if exact.is_finite() else bound


def flight_bound(speed: Any, e: Any, alpha: Any) -> Any:
    """A length within which a flight from s = e with this speed lands, |A| >= alpha s^2: alpha d (e^2/2 + e d/3 +
    d^2/12) >= speed; None where none is found."""
    need, start, weight = float(speed.upper()), float(e.mid()), float(alpha.mid())
    low, high = 0.0, 1.0
    for _ in range(40):
        d = (low + high) / 2
        lands = weight * d * (start**2 / 2 + start * d / 3 + d * d / 12) > need
        low, high = (low, d) if lands else (d, high)
    length = arb(high * 1.001)
    return length if alpha * length * (e * e / 2 + e * length / 3 + length * length / 12) >= speed else None
