"""A linear model's closed form at multiples of one step, as kernel text: a launch is flown by sums of products.

    x - c = z_0 G + u_0 F + h D_0 + sum_j cos(theta_j) Zc_j + sin(theta_j) Zs_j

is linear in what the launch gives; the columns are the same for all launches of a model, and no error grows along a
flight.  p as in `flow.closed_form`.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from cmath import sqrt as complex_sqrt
from typing import Any

FIXED = 8
"""Columns before the waves: G, F, h D_0, their derivatives, and the sizes that rounding is relative to."""

EACH = 8
"""Columns of a wave: its part in x (cosine, sine), in x', in x'' (without what x and x' add), cosine and sine of its
turn."""


def tabulate(p: Any, step: float, table: Any) -> None:
    """Fill table[m] for the time m step."""
    root = complex_sqrt(complex(p[1] * p[1] / 4 - p[2]))
    a, b = -p[1] / 2 + root, -p[1] / 2 - root
    for m in range(len(table)):
        time, row = m * step, table[m]
        free = pair(a, b, time)
        slope = turning(a, time) + b * free
        steady = p[3] * triple(a, b, 0j, time)
        row[0], row[1], row[2] = slope.real + p[1] * free.real, free.real, steady.real
        row[3], row[4], row[5] = -p[2] * free.real, slope.real, p[3] * free.real
        row[6], row[7] = abs(row[0]), abs(row[2])
        for j in range((len(p) - 5) // 3):
            rate = p[5 + 3 * j]
            wave = complex(p[6 + 3 * j], -p[7 + 3 * j])
            forced = wave * triple(a, b, 1j * rate, time)
            moved = wave * free + 1j * rate * forced
            turned = turning(1j * rate, time)
            turn_c, turn_s = turned.real, turned.imag
            at = 8 + 8 * j
            row[at], row[at + 1], row[at + 2], row[at + 3] = forced.real, -forced.imag, moved.real, -moved.imag
            row[at + 4] = p[6 + 3 * j] * turn_c + p[7 + 3 * j] * turn_s
            row[at + 5] = p[7 + 3 * j] * turn_c - p[6 + 3 * j] * turn_s
            row[at + 6], row[at + 7] = turn_c, turn_s
            row[7] += abs(forced)


def bounds(p: Any, step: float, out: Any) -> None:
    """out = (alpha, beta, gamma, ..., 1/0!, 1/1!, ...): |x^(n)| <= alpha |x - c| + beta |x'| + gamma over a step.

    The first three are for n = 4, the next for n = 6.
    The same equation with |damping| and |stiffness| majorises the flight; its solution grows, so its value at the end
    of the step bounds the whole step.
    """
    d, k = abs(p[1]), abs(p[2])
    for source in range(3):
        value, slope = 1.0 * (source == 0), 1.0 * (source == 1)
        force = abs(p[3]) if source == 2 else 0.0
        wave = 0.0
        for j in range((len(p) - 5) // 3):
            if source == 2:
                wave += abs(p[6 + 3 * j]) + abs(p[7 + 3 * j])
        force += wave
        # Taylor sums of value and slope at the end of the step
        first, second = value, slope
        total, speed, power = first, second, 1.0
        for n in range(2, 40):
            third = (d * second * (n - 1) + k * first + (force if n == 2 else 0.0)) / (n * (n - 1))
            power *= step
            total += second * power
            speed += n * third * power
            first, second = second, third
        high = [total, speed, 0.0, 0.0, 0.0, 0.0, 0.0]
        for n in range(2, 7):
            pull = abs(p[3]) if source == 2 and n == 2 else 0.0
            for j in range((len(p) - 5) // 3):
                if source == 2:
                    pull += (abs(p[6 + 3 * j]) + abs(p[7 + 3 * j])) * abs(p[5 + 3 * j]) ** (n - 2)
            high[n] = d * high[n - 1] + k * high[n - 2] + pull
        out[source], out[3 + source] = high[4], high[6]
    factorial = 1.0
    for n in range(6, len(out)):
        factorial *= max(n - 6, 1)
        out[n] = 1 / factorial


def expansions(p: Any, out: Any) -> None:
    """out[i] = how x_i of the series x - c = x_0 + x_1 t + ... follows from the state at its start.

    Columns: by x_0, by x_1, by nothing, then by cosine and sine of every wave there.
    """
    count = (len(p) - 5) // 3
    for i in range(len(out)):
        row = out[i]
        for at in range(3 + 2 * count):
            row[at] = 0.0
        if i < 2:
            row[i] = 1.0
            continue
        row[2] = p[3] if i == 2 else 0.0
        for j in range(count):
            # cos and sin differentiated i - 2 times: turned by as many quarters
            power = 1.0 if (i - 2) % 4 < 2 else -1.0
            for k in range(1, i - 1):
                power *= p[5 + 3 * j] / k
            one, other = p[6 + 3 * j] * power, p[7 + 3 * j] * power
            row[3 + 2 * j], row[4 + 2 * j] = (one, other) if i % 2 == 0 else (other, -one)
        for at in range(3 + 2 * count):
            row[at] = (row[at] - p[1] * (i - 1) * out[i - 1, at] - p[2] * out[i - 2, at]) / (i * (i - 1))
