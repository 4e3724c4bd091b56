"""Flights of linear models in balls: every number contains the true one, and a first hit is proved to be the first.

    z'' + d z' + k z = h(tau + t),   z = x - c,   z = t^p y: with y no trivial root is left at t = 0.

y is a Taylor polynomial with a ball beside its last power, from |z^(N)| <= e^(L t) (max(|z^(N)|, |z^(N+1)|) at 0
+ t max |h^(N)|), L = max(1, |d| + |k|), since z^(N) solves the same equation with the forcing h^(N).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Name, evaluate, names_in
from singimpact.algebra.precision import balls_at, kept_property
from singimpact.algebra.solving import newton_in_balls
from singimpact.flights.short_balls import ShortFlights
from singimpact.oscillator.linear import at_rest, form_of, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION


@dataclass(frozen=True)
class BallLimits:
    """How far a flight in balls is followed.

    Parameters
    ----------
    turns : of the fastest rate at most; longer flights need another expansion, and cancellation takes their digits.
    halvings : of a window in search of the hit; a graze is not decided by more of them.
    first, growth : the first window is so many times 2 v/|a|, and each next one so much longer.
    """

    turns: int = 24
    halvings: int = 60
    first: Fraction = Fraction(11, 7)
    growth: Fraction = Fraction(9, 5)


LIMITS = BallLimits()
NEAR = Fraction(1, 10**7)  # of its size is as far as a hit in doubles is from the true one, where it is isolated


@dataclass(frozen=True)
class BallHit:
    """A proved first hit: flight time and the velocity there, x-dot < 0; both None when none comes before the limit."""

    time: Any
    velocity: Any


class LinearFlow:
    """The numbers of a linear model as balls, at the precision that is set when it is made.

    Parameters
    ----------
    osc : the model. bits : of the balls.
    number : name and ball of a number of the model that takes every value in the ball; what is returned then holds for
        each of them.

    Examples
    --------
    >>> from singimpact.algebra.precision import balls_at
    >>> with balls_at(200):
    ...     flow = LinearFlow(Oscillator("x", "cos(2*t)", "0.3", "0.5"), 200)
    ...     hit = flow.first_hit(flow.number(Fraction(0)), flow.number(Fraction(1)))
    ...     print(hit.time.str(25, radius=False))
    2.333796858489047912592349
    """

    def __init__(self, osc: Oscillator, bits: int, number: tuple[str, Any] | None = None) -> None:
        kept = () if number is None else (number[0],)
        form = form_of(osc.force(kept), osc.forcing(kept)) if kept else linear_form(osc)
        if form is None or names_in(osc.restitution):
            raise ArithmeticError("balls fly linear models with a number for restitution")
        self.balls, self.moving = Balls(bits), dict([number] if number else [])
        clearance, restitution = (
            Name(name) if name in kept else tree
            for name, tree in ((CLEARANCE, osc.clearance), (RESTITUTION, osc.restitution))
        )
        self.d, self.k, self.r, self.rest = (
            self._ball(tree) for tree in (form.damping, form.stiffness, restitution, at_rest(form, clearance))
        )
        self.waves = [tuple(map(self._ball, (w.rate, w.phase, w.cosine, w.sine))) for w in form.harmonics]
        self.fastest = max([abs(w[0]).upper() for w in self.waves], default=self.number(Fraction(1)))
        for part in (abs(self.k).upper().sqrt(), abs(self.d).upper()):
            self.fastest = max(self.fastest, part)

    def _ball(self, tree: Any) -> Any:
        return evaluate(tree, self.moving, self.balls)

    @kept_property
    def _short(self) -> ShortFlights:
        return ShortFlights(self)

    def number(self, value: Fraction) -> Any:
        """A rational as a ball."""
        return self.balls.rational(value)

    def acceleration(self, tau: Any, order: int = 0) -> Any:
        """a_c or its derivative of an order at tau."""
        total = self.rest if not order else self.number(Fraction(0))
        for rate, phase, cosine, sine in self.waves:
            total += rate**order * _turned(rate * tau + phase, cosine, sine, order)
        return total

    def pressing(self, tau: Any, window: Any, v: Any) -> tuple[Any, Any]:
        """Bounds of -x'' while t is in the window after tau, |x'| <= 2 v and 0 <= x - c <= v window."""
        pull = -self.acceleration(tau.union(tau + window))
        off = (abs(self.d) * 2 * v + abs(self.k) * v * window).upper()
        return pull.lower() - off, pull.upper() + off

    def first_hit(self, tau: Any, v: Any, limit: Any = None, removed: int = 1) -> BallHit | None:
        """The first t > 0 with x = c.

        Parameters
        ----------
        tau, v : the launch. limit : no hit is looked for beyond. removed : the power p of t in z; above 1 from rest.

        Returns
        -------
        BallHit or None : None when these balls do not decide it.
        """
        if removed == 1 and (soon := self._short.hit(tau, v)) is not None:
            return BallHit(None, None) if limit is not None and soon[0] > limit else BallHit(*soon)
        longest = LIMITS.turns / self.fastest
        end = longest if limit is None or limit > longest else limit.upper()
        low, high = self.number(Fraction(0)), self._first_window(tau, v, removed)
        while True:
            top = end if high > end else high
            y, slope = self._expansion(tau, v, top, removed)
            if not y[0] > 0:
                return None
            found = _first_sign_change(y, slope, low, top)
            if found is None:
                return None
            if found:
                time = newton_in_balls(y, slope, found[0].union(found[1]))
                return BallHit(time, slope(time) * time**removed)
            if not top < end:
                return BallHit(None, None) if limit is not None and end < longest else None
            low, high = top, high * LIMITS.growth.numerator / LIMITS.growth.denominator

    def refined_hit(self, tau: Any, v: Any, near: float) -> tuple[Any, Any] | None:
        """Time and velocity of the hit next to a time that doubles have found, one step of Halley's method away.

        The model with its waves is one linear system, so resonance needs no care; None when the step is not small.
        """
        time, pull = self.number(Fraction(near)), self._system()
        for _ in range(6):
            state = (pull * time).exp() * self._start(tau, v)
            height, speed = state[0, 0], state[1, 0]
            change = pull * state
            curve, jerk = change[1, 0], (pull * change)[1, 0]
            if not abs(height) < abs(speed * time) * NEAR.numerator / NEAR.denominator:
                return None
            step = -height / speed
            # next to a graze the step is not short beside speed/curve; the error left is of third order in the step
            near_enough = bool(abs(step * curve) < abs(speed) / 10**9)
            step *= 1 - step * curve / (2 * speed)
            if near_enough:
                return time + step, speed + step * (curve + step * jerk / 2)
            time = (time + step).mid()
        return None

    def _system(self) -> Any:
        """The matrix of (z, z', 1, cosine and sine of each wave)."""
        import flint

        size = 3 + 2 * len(self.waves)
        rows = [[flint.arb(0)] * size for _ in range(size)]
        rows[0][1], rows[1][0], rows[1][1], rows[1][2] = flint.arb(1), -self.k, -self.d, self.rest
        for n, (rate, _, cosine, sine) in enumerate(self.waves):
            at = 3 + 2 * n
            rows[1][at], rows[1][at + 1], rows[at][at + 1], rows[at + 1][at] = cosine, sine, -rate, rate
        return flint.arb_mat(rows)

    def _start(self, tau: Any, v: Any) -> Any:
        import flint

        angles = [(rate * tau + phase).sin_cos() for rate, phase, _, _ in self.waves]
        return flint.arb_mat([[0], [v], [1], *([part] for sine, cosine in angles for part in (cosine, sine))])

    def _first_window(self, tau: Any, v: Any, removed: int) -> Any:
        a = self.acceleration(tau)
        if removed == 1 and a < 0:
            return (self.number(LIMITS.first) * v / -a).mid()
        return 1 / (2 * self.fastest)

    def _expansion(self, tau: Any, v: Any, reach: Any, removed: int) -> tuple[Any, Any]:
        """y and dy/dt on (0, reach] as polynomials; the last coefficients contain the truncation error."""
        import flint

        zero, one = self.number(Fraction(0)), self.number(Fraction(1))
        z = [zero, v]
        waves = [(rate, _pair(rate * tau + phase, cosine, sine)) for rate, phase, cosine, sine in self.waves]
        scale = [one for _ in waves]  # rate^n/n!
        growth = (reach * max(abs(self.d).upper() + abs(self.k).upper(), one)).exp()
        target = self._small(v, tau, reach)
        for n in range(10_000):
            forced = self.rest if n == 0 else zero
            for size, (_, pair) in zip(scale, waves, strict=True):
                forced += size * (pair[n % 2] * (-1 if n % 4 in (2, 3) else 1))
            z.append((forced - self.d * (n + 1) * z[n + 1] - self.k * z[n]) / ((n + 1) * (n + 2)))
            scale = [size * rate / (n + 1) for size, (rate, _) in zip(scale, waves, strict=True)]
            if n + 2 < removed:
                z[n + 2] = zero  # known exactly, where a ball only contains it
            if n < removed:
                continue
            left = max(abs(z[n + 1]).upper(), (n + 2) * abs(z[n + 2]).upper())
            size = sum((part * (abs(a) + abs(b)) for part, (_, (a, b)) in zip(scale, waves, strict=True)), z[0])
            bound = (growth * (left + reach * abs(size))).upper()
            if bound * reach ** (n + 1) < target:
                break
        order = n + 1
        tail = zero.union(bound).union(-bound)
        kept = z[removed:order]
        y = flint.arb_poly([*kept, tail])
        slope = flint.arb_poly([*(value * m for m, value in enumerate(kept) if m), tail * (order + removed)])
        return y, slope

    def _small(self, v: Any, tau: Any, reach: Any) -> Any:
        """A size far below that of z on the way."""
        height = abs(v) * reach + abs(self.acceleration(tau)) * reach**2 + reach**4
        return height.abs_upper() * self.number(Fraction(1, 2**self.balls.bits))


@lru_cache(maxsize=64)
def linear_flow(osc: Oscillator, bits: int) -> LinearFlow | None:
    """The flow of a linear model with any restitution; None without a closed form.

    Examples
    --------
    >>> linear_flow(Oscillator("x**3", "cos(t)", 0, "1/2"), 100) is None
    True
    """
    if linear_form(osc) is None:
        return None
    plain_rebound = Oscillator(osc.force(), osc.forcing(), osc.clearance, 1, period=osc.period)
    with balls_at(bits):
        return LinearFlow(plain_rebound, bits)


def _pair(angle: Any, cosine: Any, sine: Any) -> tuple[Any, Any]:
    """A cos + B sin and its derivative by the angle."""
    s, c = angle.sin_cos()
    return cosine * c + sine * s, sine * c - cosine * s


def _turned(angle: Any, cosine: Any, sine: Any, order: int) -> Any:
    even, odd = _pair(angle, cosine, sine)
    return (even, odd)[order % 2] * (-1 if order % 4 in (2, 3) else 1)


def _first_sign_change(y: Any, slope: Any, low: Any, high: Any) -> tuple[Any, ...] | None:
    """A piece with the first zero of y alone on it; (): none up to high; None: not decided."""
    stack, left = [(low, high, 0)], LIMITS.halvings * 8
    while stack:
        a, b, depth = stack.pop()
        left -= 1
        piece = a.union(b)
        if y(piece) > 0:
            continue
        rate = slope(piece)
        if rate > 0 and (y(a) > 0 or not a > 0):
            continue
        if rate < 0:
            end = y(b)
            if end > 0:
                continue
            if end < 0:
                return a, b
        if depth == LIMITS.halvings or left < 0:
            return None
        middle = ((a + b) / 2).mid()
        stack += [(middle, b, depth + 1), (a, middle, depth + 1)]
    return ()
