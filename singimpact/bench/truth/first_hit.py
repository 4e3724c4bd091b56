"""The first root of x - c after the launch, in balls; between points it is excluded by the bound of x'''."""

from __future__ import annotations

from math import sqrt
from typing import Any

from singimpact.algebra.precision import bits_of_balls


def first_hit(motion: Any, v: float, horizon: float) -> tuple[Any, Any] | None:
    """Time and velocity of the first hit; None when there is none before the horizon.

    Parameters
    ----------
    motion : of `motions`, launched with velocity v >= 0, a > 0 for v = 0.

    Raises
    ------
    ArithmeticError : a touch that no width of a step tells from a miss.

    Examples
    --------
    >>> from singimpact.algebra.precision import balls_at
    >>> from singimpact.bench.truth.motions import Linear
    >>> with balls_at(256):
    ...     print(first_hit(Linear(2.0, 0.0, 1.0, 0.5), 0.5, 100.0)[0].str(20, radius=False))
    1.1115158754205710871
    """
    a = float(motion.at(0)[2])
    begin = _without_root(v, a, motion)
    width = min(begin, 0.25)
    while begin < horizon:
        width = min(width, 0.5)
        half = width / 2
        z, u, e = (float(ball) for ball in motion.at(begin + half))
        third = motion.third(z, u, width) * (1 + 1e-9)
        if _lowest(z, u, e, half) - third * half**3 / 6 > 1e-12 * abs(z):
            begin, width = begin + width, 1.5 * width
            continue
        if u + abs(e) * half + third * half**2 / 2 < 0 and motion.at(begin + width)[0] < 0:
            return _root(motion, begin, begin + width)
        width = half
        if width < 1e-14 * begin:
            raise ArithmeticError("a touch")
    return None


def _without_root(v: float, a: float, motion: Any) -> float:
    """A time before which v t + a t^2/2 - M t^3/6 is positive; M bounds |x'''| there."""
    third: float = motion.third(0.0, v, 0.25) * (1 + 1e-9)
    if a > 0:
        return min(max(3 * a / third, sqrt(6 * v / third)), 0.25) * (1 - 1e-9)
    # v + a t/2 - M t^2/6 falls, so its first root bounds; the form without a difference
    return min(2 * v / (-a / 2 + sqrt(a * a / 4 + 2 * third * v / 3)), 0.25) * (1 - 1e-9)


def _lowest(z: float, u: float, e: float, half: float) -> float:
    """The least value of z + u s + e s^2/2 on [-half, half]."""
    ends: float = min(z + u * half, z - u * half) + e * half * half / 2
    return min(ends, z - u * u / (2 * e)) if e > 0 and abs(u) < e * half else ends


def _root(motion: Any, low: float, high: float) -> tuple[Any, Any]:
    """The root between two times, where x' < 0: bisected to where Newton's method converges, then to all digits."""
    import flint

    for _ in range(20):
        middle = (low + high) / 2
        low, high = (middle, high) if motion.at(middle)[0] > 0 else (low, middle)
    t = flint.arb((low + high) / 2)
    small = flint.arb(2) ** (-bits_of_balls() + 40)
    for _ in range(60):
        z, u, _ = motion.at(t)
        change = (z / u).mid()
        t = (t - change).mid()
        if abs(change) < small * t:
            break
    return t, motion.at(t)[1]
