"""The first root of x - c after the launch, in balls; between points it is excluded by the bound of x'''."""

from math import hypot, sqrt
from typing import Any

import flint

from singimpact.algebra.precision import bits_of_balls


def first_hit(motion: "Linear | Cubic | Above", v: float, horizon: float, quiet: float = 0.0) -> tuple[Any, Any] | None:
    """Time and velocity of the first hit; None when there is none before the horizon.

    Parameters
    ----------
    motion : `Linear` or `Cubic`, launched with velocity v >= 0, a > 0 for v = 0; or its distance from another wall.
    quiet : a time without a hit, where it is known, for a release with a = 0.

    Raises
    ------
    ArithmeticError : a touch that no width of a step tells from a miss.

    Examples
    --------
    >>> from singimpact.algebra.precision import balls_at
    >>> from singimpact.bench.truth.first_hit import Linear
    >>> with balls_at(256):
    ...     print(first_hit(Linear(2.0, 0.0, 1.0, 0.5), 0.5, 100.0)[0].str(20, radius=False))
    1.1115158754205710871
    """
    begin, width = quiet, quiet or min(horizon, 0.25)
    if not quiet and not isinstance(motion, Above):
        begin = _without_root(v, float(motion.at(0)[2]), motion)
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


def first_of_both(motion: "Linear | Cubic", v: float, horizon: float, gap: Any) -> tuple[Any, Any] | None:
    """Time and velocity of the first hit of the wall below, or of one above at a distance `gap`, where x' > 0.

    Without a `gap` there is no wall above.
    """
    below = first_hit(motion, v, horizon)
    if gap is None:
        return below
    above = first_hit(Above(motion, gap), v, horizon if below is None else float(below[0]))
    return below if above is None else (above[0], -above[1])


def _without_root(v: float, a: float, motion: "Linear | Cubic") -> float:
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


def _root(motion: "Linear | Cubic | Above", low: float, high: float) -> tuple[Any, Any]:
    """The root between two times, where x' < 0: bisected to where Newton's method converges, then to all digits."""
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


# Flights in balls: the linear oscillator in closed form, the cubic one by its Taylor recurrence.
#
# x'' + x = cos omega t,        x'' + x'/10 + x + 3 x^3/10 = cos omega t

DIGITS = 60


class Above:
    """A motion seen from a wall above: its distance from there, whose velocity and acceleration point down."""

    def __init__(self, motion: "Linear | Cubic", gap: Any) -> None:
        self.motion, self.gap = motion, gap

    def at(self, t: Any) -> tuple[Any, Any, Any]:
        """Distance and its derivatives at a time after the launch."""
        z, u, e = self.motion.at(t)
        return self.gap - z, -u, -e

    def third(self, z: float, u: float, width: float) -> float:
        """A bound of |x'''| within `width` of a place."""
        return self.motion.third(float(self.gap) - z, -u, width)


class Linear:
    """The flight from (c, v) at tau, by sums and differences of frequencies: omega = 1 is an ordinary point.

    The forcing is `push` cos omega t.

    Examples
    --------
    >>> z, u, e = Linear(2.0, 0.0, 0.0, 1.0).at(0)
    >>> float(z), float(u), float(e)
    (0.0, 1.0, 1.0)
    """

    def __init__(self, omega: float, clearance: float, tau: Any, v: Any, push: int = 1) -> None:
        arb = flint.arb
        self.omega, self.c, self.v = arb(omega), arb(clearance), arb(v)
        self.sin, self.cos = (push * wave for wave in (self.omega * arb(tau)).sin_cos())
        self.p, self.q = (1 + self.omega) / 2, (1 - self.omega) / 2

    def at(self, t: Any) -> tuple[Any, Any, Any]:
        """x - c, x', x'' at a time after the launch."""
        t = flint.arb(t)
        sin_p, cos_p = (self.p * t).sin_cos()
        sin_q, cos_q = (self.q * t).sin_cos()
        over_q = t if self.q == 0 else sin_q / self.q
        sine, cosine = sin_p * cos_q + cos_p * sin_q, cos_p * cos_q - sin_p * sin_q
        one, other = sin_p * cos_q / self.p, cos_p * over_q
        answer = sin_p * over_q / (2 * self.p)
        z = self.v * sine - self.c * (1 - cosine) + self.cos * answer - self.sin * (one - other) / 2
        u = self.v * cosine - self.c * sine + self.cos * (one + other) / 2 - self.sin * self.omega * answer
        force = self.cos * (cos_p * cos_q + sin_p * sin_q) - self.sin * (sin_p * cos_q - cos_p * sin_q)
        return z, u, force - z - self.c

    def third(self, z: float, u: float, width: float) -> float:
        """A bound of |x'''| within `width` of a place; the energy grows by less than the force times the time."""
        return float(self.omega) + hypot(z + float(self.c), u) + width

    def variations(self, t: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """Derivatives of (x, x') at t by tau and by v."""
        # by tau only the force moves: the same motion from rest at c = 0, with the force's derivative
        turned = Linear.__new__(Linear)
        vars(turned).update(vars(self))
        turned.c, turned.v = flint.arb(0), flint.arb(0)
        turned.cos, turned.sin = -self.omega * self.sin, self.omega * self.cos
        z, u, _ = turned.at(t)
        sine, cosine = flint.arb(t).sin_cos()
        return (z, u), (sine, cosine)


class Cubic:
    """The flight of x'' + sign x'/10 + x + 3 x^3/10 = cos omega t, in Taylor steps whose last terms are below 10^-60.

    The forcing is `push` cos omega t.

    Examples
    --------
    >>> from singimpact.algebra.precision import balls_at
    >>> with balls_at(256):
    ...     print(Cubic(2.0, 0.0, 0.0, 1.0).at(1)[0].str(20, radius=False))
    1.0860656485255256926
    """

    order = 72

    def __init__(self, omega: float, clearance: float, tau: Any, v: Any, sign: int = 1, push: int = 1) -> None:
        arb = flint.arb
        self.omega, self.c, self.start = arb(omega), arb(clearance), (arb(tau), arb(v))
        self.damping, self.cubic, self.sign, self.push = arb(sign) / 10, arb(3) / 10, sign, push
        self.steps: list[tuple[Any, Any, list[Any]]] = []
        self._extend(arb(0), self.c, arb(v))

    def _extend(self, t: Any, x: Any, u: Any) -> None:
        X, square = [x, u], [x * x]
        sine, cosine = (self.omega * (self.start[0] + t)).sin_cos()
        force, power = (cosine, -sine, -cosine, sine), self.push * self.omega / self.omega
        for k in range(self.order - 1):
            cube = sum((square[i] * X[k - i] for i in range(k + 1)), 0 * x)
            pull = self.damping * (k + 1) * X[k + 1] + X[k] + self.cubic * cube
            X.append((force[k % 4] * power - pull) / ((k + 1) * (k + 2)))
            square.append(sum((X[i] * X[k + 1 - i] for i in range(k + 2)), 0 * x))
            power = power * self.omega / (k + 1)
        last = max(float(abs(X[-1])) ** (1 / self.order), float(abs(X[-2])) ** (1 / (self.order - 1)))
        width = min(10.0 ** (-(DIGITS + 3) / self.order) / last, 1.0)
        self.steps.append((t, t + width, X))

    def at(self, t: Any) -> tuple[Any, Any, Any]:
        """x - c, x', x'' at a time after the launch."""
        t = flint.arb(t)
        while not t <= self.steps[-1][1]:
            begin, end, X = self.steps[-1]
            x, u, _ = _summed(X, end - begin)
            self._extend(end, x, u)
        begin, _, X = next(step for step in reversed(self.steps) if t >= step[0])
        x, u, e = _summed(X, t - begin)
        return x - self.c, u, e

    def third(self, z: float, u: float, width: float) -> float:
        """A bound of |x'''| within `width` <= 1/2 of a place, by twice the sizes there and what the force adds."""
        x, u = 2 * (abs(z + float(self.c)) + abs(u) * width + width), 2 * (abs(u) + width)
        pull, damping = x + float(abs(self.cubic)) * x**3, float(abs(self.damping))
        return float(self.omega) + damping * (1 + damping * u + pull) + u * (1 + 3 * float(abs(self.cubic)) * x * x)

    def variations(self, t: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """Derivatives of (x, x') at t by tau and by v, as differences that 60 digits carry."""
        small = flint.arb(10) ** -25
        z, u, _ = self.at(t)
        rows = []
        for moved in ((small, 0), (0, small * self.start[1])):
            tau, v = self.start[0] + moved[0], self.start[1] + moved[1]
            other = Cubic(float(self.omega), float(self.c), tau, v, self.sign, self.push).at(t)
            size = moved[0] + moved[1]
            rows.append(((other[0] - z) / size, (other[1] - u) / size))
        return rows[0], rows[1]


def _summed(X: list[Any], s: Any) -> tuple[Any, Any, Any]:
    value, slope, bend = X[-1], 0 * s, 0 * s
    for part in reversed(X[:-1]):
        bend = bend * s + slope
        slope = slope * s + value
        value = value * s + part
    return value, slope, 2 * bend
