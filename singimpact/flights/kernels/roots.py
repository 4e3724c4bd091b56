"""The first root of a polynomial on a short interval, in plain arithmetic for doubles and mpf alike.

Nothing is looked for by changes of sign: from a point where q > 0, a lower bound of q'' gives a quadratic below q
whose first root cannot overshoot; it converges quadratically to the *first* root and passes a near graze in
O(log 1/depth) steps.
"""

from typing import Any


def first_root(q: Any, n: int, h: Any, base: Any, ulp: Any) -> Any:
    """The first root in (0, h] of q[0] + q[1] s + ... + q[n] s^n with q[0] >= 0.

    Parameters
    ----------
    q, n : coefficients and degree.
    h : length of the interval.
    base, ulp : q is known at s to base + ulp sum |q_k| s^k.

    Returns
    -------
    (code, s, q'(s), depth, bound) : code 0 none, 1 root, 2 undecided: q there is `depth`, known to `bound`.

    Notes
    -----
    A root is accepted when Newton's method is sure to converge to it (Kantorovich: q q'' < q'^2/8) with the bound of
    q'' over the whole distance; "the step got small" accepts false grazes.

    Examples
    --------
    >>> code, place, *_ = first_root([2.0, -3.0, 1.0], 2, 3.0, 0.0, 1e-16)
    >>> code, round(place, 15)
    (1, 1.0)
    """
    # one pass: a lower bound of q on (0, h], in which positive terms are left out, and a bound of |q'''|. 1.0 + 0 h has
    # the type of h, a double or an mpf
    power = 1.0 + 0 * h
    least = q[0] - base
    third = 0 * h
    for k in range(1, n + 1):
        if k >= 3:
            third += k * (k - 1) * (k - 2) * abs(q[k]) * power
        power *= h
        if q[k] < 0:
            least += q[k] * power
        least -= ulp * abs(q[k]) * power
    if least > ulp * q[0]:
        return 0, h, h, h, h
    third /= h * h
    s = 0 * h
    for _ in range(400):
        a0, a1, a2, size = sums(q, n, s)
        noise = base + ulp * size
        reach = h
        if a1 < 0:
            # Kantorovich: if |q| |q''| < q'^2/2 over twice the Newton step, the iteration converges to a root there,
            # the only one; 8 in place of 2 leaves room for rounding
            reach = 2 * (abs(a0) + noise) / (-a1)
            bend = abs(a2) + third * reach
            if s + reach <= h and 8 * (abs(a0) + noise) * bend < a1 * a1:
                return newton_in_kernel(q, n, s, reach, a0, a1)
        if s > 0 and a0 <= 2 * noise:
            # the least value of the parabola through the point: how deep the graze would be
            depth = a0 - a1 * a1 / (2 * a2) if a2 > 0 else a0
            return 2, s, a1, depth, noise
        # the lower end of what q may be: near a touch the rounding of q decides the sign of the discriminant
        step = safe_step(a0 - noise, a1, a2, third, h - s)
        s += step
        if s >= h:
            return 0, h, h, h, h
    return 2, s, a1, a0, noise


def sums(q: Any, n: int, s: Any) -> Any:
    """q, q', q'' and sum |q_k| s^k at s >= 0; even and odd terms apart, so that short chains run abreast.

    Examples
    --------
    >>> sums([1.0, -2.0, 3.0, 1.0], 3, 2.0)
    (17.0, 22.0, 18.0, 25.0)
    """
    # a Horner scheme in s^2 for each half: two independent chains of multiplications, which a processor overlaps
    x = s * s
    top = n - n % 2
    e0, e1, e2, es = q[top], 0 * s, 0 * s, abs(q[top])
    o0, o1, o2, os = 0 * s, 0 * s, 0 * s, 0 * s
    if top < n:
        o0, os = q[n], abs(q[n])
    for k in range(top - 2, -1, -2):
        o2 = o2 * x + o1
        o1 = o1 * x + o0
        o0 = o0 * x + q[k + 1]
        os = os * x + abs(q[k + 1])
        e2 = e2 * x + e1
        e1 = e1 * x + e0
        e0 = e0 * x + q[k]
        es = es * x + abs(q[k])
    bend = 2 * (e1 + 4 * x * e2) + s * (6 * o1 + 8 * x * o2)
    return e0 + s * o0, o0 + 2 * (s * e1 + x * o1), bend, es + s * os


def safe_step(a0: Any, a1: Any, a2: Any, third: Any, room: Any) -> Any:
    """A step that cannot pass a root: q >= a0 + a1 e + (a2 - third w) e^2/2 for 0 <= e <= w."""
    width = room
    while True:
        # the third derivative lowers the second by this much at most, so the parabola stays below q
        low = a2 - third * width
        inside = a1 * a1 - 2 * low * a0
        step = width
        if inside >= 0 and a1 <= 0:
            slope = -a1 + inside**0.5
            if slope > 0:
                step = 2 * a0 / slope
                if step <= 0:  # rounding decides the sign here already, and no halving ends
                    return 0 * step
        elif inside >= 0 and low < 0:
            # with a0 = 1e-300 the other form divides by a difference that is rounded to zero
            step = (a1 + inside**0.5) / -low
        if step >= width / 2:
            return step if step < width else width
        # the geometric mean: v = 1e-300 is reached in ten halvings of the exponent, not in a thousand halvings
        width = (width * step) ** 0.5 if width > 8 * step and step > 0 else width / 2
        if width < 2 * step:
            width = 2 * step


def newton_in_kernel(q: Any, n: int, s: Any, reach: Any, a0: Any, a1: Any) -> Any:
    """Newton's method from a point where it is sure to converge, no farther than `reach`."""
    last = s + reach
    for _ in range(60):
        change = a0 / (-a1)
        s += change
        if s > last:
            s = last
        value, slope, _bend, _size = sums(q, n, s)
        # quadratic convergence: a step this small was the last one that could matter, and one more is taken
        done = abs(change) <= 1e-9 * abs(s) and abs(value) >= abs(a0) / 4
        a0, a1 = value, slope
        if a0 == 0 or done or not a1 < 0:
            break
    return 1, s, a1, 0 * s, 0 * s
