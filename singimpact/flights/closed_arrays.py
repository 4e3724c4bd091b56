"""`flow.closed_form` over arrays of flight times: numpy does all flights at once, so that nothing has to be compiled.

The numbers p and the launches are those of `flow.closed_form`; the formulas are its own, the same digits are kept.
"""

from __future__ import annotations

from math import factorial as factorial_of
from typing import Any

import numpy as np

from singimpact.flights.kernels.double_double import product_twice

Array = np.ndarray[Any, Any]


def turning(a: Any, t: Any) -> Array:
    """e^{a t}; the rounding of the angle is made good."""
    angle, rest = product_twice(np.imag(a), 0.0, t, 0.0)
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(np.exp(np.real(a) * t) * ((c - rest * s) + 1j * (s + rest * c)))


def pair(a: complex, b: complex, t: Array) -> Array:
    """D[a, b](t) = (e^{a t} - e^{b t})/(a - b)."""
    y = (a - b) * t / 2
    found, near = np.empty(t.shape, dtype=complex), np.abs(y) < 0.1
    small, y2 = t[near], y[near] ** 2
    ratio = 1 + y2 / 6 * (1 + y2 / 20 * (1 + y2 / 42 * (1 + y2 / 72 * (1 + y2 / 110))))
    found[near] = turning(b, small) * turning(y[near], 1.0) * small * ratio
    if not near.all():
        found[~near] = (turning(a, t[~near]) - turning(b, t[~near])) / (a - b)
    return found


def triple(a: complex, b: complex, c: complex, t: Array) -> Array:
    """D[a, b, c](t), from the two points that are farthest apart, or from the series when all are close."""
    ab, bc, ca = abs(a - b), abs(b - c), abs(c - a)
    if ab >= bc and ab >= ca:
        b, c = c, b
    elif bc >= ca:
        a, b = b, a
    found, far = np.empty(t.shape, dtype=complex), np.abs((a - c) * t) > 0.5
    if far.any():
        found[far] = (pair(a, b, t[far]) - pair(b, c, t[far])) / (a - c)
    found[~far] = series((a, b, c), t[~far], 13)
    return found


def beyond(a: complex, b: complex, rate: complex, t: Array) -> Array:
    """rate D[a, b, 0, rate](t) = D[a, b, rate](t) - D[a, b, 0](t); for short times nothing cancels."""
    found, far = np.empty(t.shape, dtype=complex), np.maximum(abs(rate), max(abs(a), abs(b))) * np.abs(t) > 1.0
    if far.any():
        found[far] = triple(a, b, rate, t[far]) - triple(a, b, 0j, t[far])
    found[~far] = rate * series((a, b, 0j, rate), t[~far], 18)
    return found


def series(points: tuple[complex, ...], t: Array, terms: int) -> Array:
    """D[points](t) of points that are close for such times, by complete homogeneous polynomials about their mean."""
    mean, last = sum(points) / len(points), len(points) - 1
    factorial = float(factorial_of(last))
    sums: list[Any] = [np.ones(t.shape, dtype=complex) for _ in points]
    total: Any = sums[0] / factorial
    for m in range(1, terms + 1):
        sums[0] = sums[0] * (points[0] - mean) * t
        for at in range(1, len(points)):
            sums[at] = sums[at - 1] + (points[at] - mean) * t * sums[at]
        factorial *= m + last
        total = total + sums[-1] / factorial
    return np.asarray(total * t**last * turning(mean, t))


def places(launch: Array, v: Array, push: Array, time: Array, p: Array) -> Array:
    """x - c and x' at time[i] after launch i, which may be negative, shape (n, 2).

    Parameters
    ----------
    launch : cosine and sine of every phase. v, time : as they are. p : the numbers of the kernel.
    push : a_c at the launches: known to all its digits, where the sum of constant and waves would have cancelled.

    Examples
    --------
    >>> free_fall = np.array([0.0, 0.0, 0.0, -2.0, 0.0])
    >>> times, push = np.array([1.0, -1.0]), np.array([-2.0, -2.0])
    >>> places(np.zeros((2, 0)), np.array([3.0, 0.0]), push, times, free_fall).tolist()
    [[2.0, 1.0], [-1.0, 2.0]]
    """
    root = np.sqrt(complex(p[1] * p[1] / 4 - p[2]))
    a, b = complex(-p[1] / 2 + root), complex(-p[1] / 2 - root)
    with np.errstate(all="ignore"):  # what grows out of the range of doubles is inf or nan, as in the kernel
        free = pair(a, b, time)
        slope = turning(a, time) + b * free
        z, u = v * free.real + push * triple(a, b, 0j, time).real, v * slope.real + push * free.real
        for j in range((len(p) - 5) // 3):
            rate = 1j * p[5 + 3 * j]
            wave = complex(p[6 + 3 * j], -p[7 + 3 * j]) * (launch[:, 2 * j] + 1j * launch[:, 2 * j + 1])
            z = z + (wave * beyond(a, b, rate, time)).real
            u = u + (wave * rate * triple(a, b, rate, time)).real
    return np.stack([z, u], axis=1)
