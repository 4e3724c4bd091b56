"""The motion after a contact point: contact is lost, or, at a swan, chatter completes.

Where a_c > 0 the motion y is convex in s, so it meets the wall at most once more.  After a negative swan |A| increases
with s up to some place.  There each flight is at most r times as long as the one before: from sigma to e it lands with
at most |A(e)| (e - sigma)/2, and is launched from e with at least |A(e)| (e1 - e)/2.  A flight from -S <= 0 that is
launched with at most V, below int (e + x)|A| dx/(e + S) over -S < s < e, lands before e; if at e0, then with at most
max |A| (e0 + S)/2.  The next one, launched from e0 with v, lands within d if alpha d (e0^2/2 + e0 d/3 + d^2/12) >= v,
|A| >= alpha s^2.  All end before e0 + d/(1 - r).
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from flint import arb

from .formulas import Refused, Wrong, ball, need
from .gravity import Gravity

PIECES, LAUNCHES, DEEP = 64, 16, 7
COARSE = 2.0**-16


def require_after(o: Gravity, content: dict[str, Any], r: Any) -> None:
    """Refuse what the certificate says of the time after tau, unless it says nothing."""
    after = content["after"]
    if not after:
        return
    numbers = {name: ball(Fraction(text)) for name, text in after.items()}
    reached = Fraction(after["near" if o.j % 2 else "launch"]) <= Fraction(content["reach"])
    need("reached", reached, "what comes after tau is said of launches beyond the reach")
    if o.j % 2:
        require_lost(o, numbers["near"], numbers["time"])
    elif o.j == 2:
        launch, end = numbers["launch"], numbers["end"]
        wide = launch if launch > end else end
        require_settled(Gravity(o.model, o.tau, 2, wide, COARSE), numbers, r)
    else:
        raise Wrong("nothing is shown after a contact point of this order")


def series(o: Gravity, s: Any, weight: Callable[[int], Any]) -> Any:
    """sum weight(k) b_k (-s)^(k-j), weights at most k."""
    total, power = arb(0), arb(1)
    for k in range(o.j, o.K + 1):
        total, power = total + weight(k) * o.b[k] * power, power * -s
    return total + arb(0, o.tail(o.j).upper())


def require_positive(function: Callable[[Any], Any], end: Any, what: str) -> None:
    for n in range(PIECES):
        piece = (end * n / PIECES).union(end * (n + 1) / PIECES)
        need(what, function(piece) > 0, f"that {what} is not shown", Refused)


def require_lost(o: Gravity, near: Any, time: Any) -> None:
    """a_c > 0 for so long."""
    short = not o.square > 0 or time * o.square.sqrt() < arb.pi() / 2
    need("short", short, "the time after tau is longer than the change of variable reaches")
    require_positive(lambda s: series(o, s, lambda _: 1), near, "a_c > 0 after tau")
    todo = [(arb(o.time(near).lower()), arb(time.upper()), 0)]
    while todo:
        a, b, level = todo.pop()
        if a >= b or o.model.push(o.tau + a.union(b), arb(0)) > 0:
            continue
        if level > 12:
            need("lost", False, "that a_c > 0 for so long is not shown", Refused)
            break
        middle = arb(((a + b) / 2).mid())
        todo += [(a, middle, level + 1), (middle, b, level + 1)]


def moment(o: Gravity, s: Any, n: int) -> Any:
    """int |u|^(n-1) |A| du between 0 and s."""
    return abs(s) ** (o.j + n) * series(o, s, lambda k: arb(1) / (k + n))


def require_settled(o: Gravity, numbers: dict[str, Any], r: Any) -> None:
    """Chatter completes before s = end, of all launches with S <= launch and y' <= speed that pass tau."""
    launch, speed, first, end = (numbers[name] for name in ("launch", "speed", "first", "end"))
    require_positive(lambda s: series(o, s, lambda k: k), end, "|A| increases after tau")
    right = first ** (o.j + 2) * series(o, first, lambda k: arb(1) / ((k + 1) * (k + 2)))
    for n in range(LAUNCHES):
        S = (launch * n / LAUNCHES).union(launch * (n + 1) / LAUNCHES)
        landed = speed * (first + S) < right + first * moment(o, -S, 1) + moment(o, -S, 2)
        need("landed", landed, "that the first flight after tau lands in time is not shown", Refused)
    ratios = [
        arb(series(o, (end * n / PIECES).union(end * (n + 1) / PIECES), lambda _: 1).lower()) for n in range(PIECES)
    ]
    todo, half = [(0, 0, 0)], arb(1) / 2
    while todo:
        a, c, n = todo.pop()
        S, e = ((k * half**n).union((k + 1) * half**n) * width for k, width in ((a, launch), (c, first)))
        if not ends_before(o, (S, e), r, end, ratios):
            if n >= DEEP:
                need("completes", False, "that chatter completes in time is not shown", Refused)
                break
            todo += [(2 * a + i, 2 * c + k, n + 1) for i in (0, 1) for k in (0, 1)]


def ends_before(o: Gravity, cell: tuple[Any, Any], r: Any, end: Any, ratios: list[Any]) -> bool:
    S, e = cell
    x = (-S).union(e)
    landing = arb((x * x * series(o, x, lambda _: 1) * (e + S) / 2).upper())
    exact = (moment(o, e, 2) + S * (moment(o, e, 1) + moment(o, -S, 1)) - moment(o, -S, 2)) / (e + S)
    if exact.is_finite():
        landing = landing.min(arb(exact.upper()))
    speed, start, piece = r * landing, arb(e.lower()), PIECES - 1
    for _ in range(3):
        alpha = arb("1e9")
        for ratio in ratios[: piece + 1]:
            alpha = alpha.min(ratio)
        d = length(speed, start, alpha)
        if d is None:
            return False
        if e + d / (1 - r) < end:
            return True
        reached = (e + d) / end * PIECES
        piece = min(int(float(reached.upper())), PIECES - 1) if reached < PIECES else PIECES - 1
    return False


def length(speed: Any, start: Any, alpha: Any) -> Any:
    """A d with alpha d (start^2/2 + start d/3 + d^2/12) >= speed."""
    d = arb(2) ** -12
    while d < 4:
        if alpha * d * (start * start / 2 + start * d / 3 + d * d / 12) >= speed:
            return d
        d = arb((d * arb(257) / 256).mid())
    return None
