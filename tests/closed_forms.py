"""Closed forms of periodic orbits, which share no code with the package."""

from __future__ import annotations

from dataclasses import dataclass

import mpmath


@dataclass(frozen=True)
class OneImpact:
    """Orbits of one impact in k periods of x'' + b x' + x = A cos(w t), wall at c, in closed form.

    x - X, with X the motion without wall, is a free motion: E = exp(T M) takes (c - X, v - X') to (c - X, -v/r - X').
    So c - X = w1 v and X' = -w2 v with (w1, w2) = -(E - 1)^-1 (1/r + E) (0, 1), and

        (c - w1 v)^2 + (w2 v / w)^2 = (A R)^2,     R = 1 / |1 - w^2 + i b w|                    (the response ellipse)

    The multipliers have product r^2 det E and sum -r tr E - r (1 + r) E_12 (g - c)/v.
    """

    b: object
    r: object
    k: int = 1

    def parts(self, w):
        """w1, w2, E_12, tr E, det E, R at a frequency, in mpmath's precision."""
        mp = mpmath.mp
        b, r, T = mp.mpf(self.b), mp.mpf(self.r), 2 * mp.pi * self.k / w
        s = mp.sqrt(1 - b * b / 4)
        decay, cosine, sine = mp.exp(-b * T / 2), mp.cos(s * T), mp.sin(s * T) / s
        E = decay * mp.matrix([[cosine + b / 2 * sine, sine], [-sine, cosine - b / 2 * sine]])
        right = mp.matrix([E[0, 1], 1 / r + E[1, 1]])
        w1, w2 = -((E - mp.eye(2)) ** -1 * right)
        return w1, w2, E[0, 1], E[0, 0] + E[1, 1], mp.exp(-b * T), 1 / mp.sqrt((1 - w * w) ** 2 + (b * w) ** 2)

    def amplitude(self, w, c, v):
        """A > 0 of the orbit with velocity v."""
        w1, w2, *_, R = self.parts(w)
        return mpmath.sqrt((c - w1 * v) ** 2 + (w2 * v / w) ** 2) / R

    def fold(self, w, c):
        """The velocity at which A has its least value."""
        w1, w2, *_ = self.parts(w)
        return c * w1 / (w1**2 + (w2 / w) ** 2)

    def doubling(self, w, c):
        """The velocity at which 1 + sum + product of the multipliers vanishes."""
        w1, w2, E12, trace, det, _ = self.parts(w)
        b, r = mpmath.mpf(self.b), mpmath.mpf(self.r)
        side = r * (1 + r) * E12
        return -side * w * w * c / (1 - r * trace + r * r * det + side * ((1 - w * w) * w1 + b * w2))

    def grazing(self, w, c):
        return abs(c) / self.parts(w)[-1]
