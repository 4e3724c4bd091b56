"""Forcing phases and a_c at a launch: in twice the precision where a_c cancels.

A launch time comes as two doubles, t + t_low.  Sine and cosine are polynomials after a reduction that keeps its
remainder: the same bits with and without the compiler, and several times faster than a library's.
"""

from math import cos, sin
from typing import Any

from singimpact.flights.kernels.double_double import divided, product_twice, sum_twice
from singimpact.flights.kernels.state import COSINE, PHASE, RATE, SINE

# Adding 3 2^51 and taking it away rounds a double to the nearest integer.
NEAREST = 6755399441055744.0


def reduced_twice(tau: float, turn: Any) -> Any:
    """tau minus the nearest multiple of the period, as two doubles; tau itself within one period of zero.

    Parameters
    ----------
    turn : the period, then its parts of 26 bits, whose products with fewer than 2^26 periods are exact; 0 without one.
    """
    if not abs(tau) > turn[0] or turn[0] == 0:
        return tau, 0.0
    # Cody and Waite: the period in parts whose products with n are exact; the differences are summed as high + low
    n, high, low = (tau / turn[0] + NEAREST) - NEAREST, tau, 0.0
    for i in range(1, 5):
        multiple, before = n * turn[i], high
        high = before - multiple
        back = high - before
        low += (before - (high - back)) - (multiple + back)
    total = high + low
    return total, low - (total - high)


def wall_acceleration(t: float, t_low: float, p: Any, rest: Any, launch: Any) -> float:
    """a_c at t + t_low; launch takes cosine and sine of every wave.

    Parameters
    ----------
    p, rest : the model's numbers, and what their doubles leave out, see `state.Linear`.
    """
    a, size = p.steady, abs(p.steady)
    for j in range(len(p.waves)):
        angle, left = phase_of(t, t_low, p.waves[j, RATE], rest.waves[j, RATE], p.waves[j, PHASE], rest.waves[j, PHASE])
        launch[2 * j], launch[2 * j + 1] = wave(angle, left)
        one, other = p.waves[j, COSINE] * launch[2 * j], p.waves[j, SINE] * launch[2 * j + 1]
        a += one + other
        size += abs(one) + abs(other)
    # as oscillator.acceleration: a sum that has lost five bits is computed again
    if 32 * abs(a) < size:
        a = wall_acceleration_twice(t, t_low, p, rest)
    return float(a)


def wall_acceleration_twice(t: float, t_low: float, p: Any, rest: Any) -> float:
    """a_c at t + t_low, its error relative to the size of the terms 1e-30."""
    a, a_low = p.steady, rest.steady
    for j in range(len(p.waves)):
        angle, left = phase_of(t, t_low, p.waves[j, RATE], rest.waves[j, RATE], p.waves[j, PHASE], rest.waves[j, PHASE])
        c, c_low, s, s_low = wave_twice(angle, left)
        x, x_low = product_twice(p.waves[j, COSINE], rest.waves[j, COSINE], c, c_low)
        a, a_low = sum_twice(a, a_low, x, x_low)
        x, x_low = product_twice(p.waves[j, SINE], rest.waves[j, SINE], s, s_low)
        a, a_low = sum_twice(a, a_low, x, x_low)
    return float(a + a_low)


def phase_of(t: float, t_low: float, rate: float, rate_low: float, phase: float, phase_low: float) -> Any:
    """rate t + phase as two doubles."""
    x, x_low = product_twice(rate, rate_low, t, t_low)
    return sum_twice(x, x_low, phase, phase_low)


def wave(angle: float, rest: float) -> Any:
    """Cosine and sine of angle + rest, to a unit in the last place."""
    if not abs(angle) < 1e6:
        c, s = cos(angle), sin(angle)
        return c - rest * s, s + rest * c
    return quarters(angle, rest)


def quarters(angle: float, rest: float) -> Any:
    """Cosine and sine of angle + rest, |angle| < 1e6, without a branch: loops over a batch stay vectors."""
    # adding and taking away 3 2^51 leaves the nearest integer
    n = (angle * 0.6366197723675814 + NEAREST) - NEAREST
    quarter = n - 4 * ((n * 0.25 + NEAREST) - NEAREST)
    cosine, sine = in_quarter(angle, rest, n)
    # n mod 4 quarter turns: odd ones exchange cosine and sine, and two of the four change each sign
    odd, half = abs(quarter) == 1, abs(quarter) == 2
    c, s = (sine if odd else cosine), (cosine if odd else sine)
    return (-c if (quarter == 1) | half else c), (-s if (quarter == -1) | half else s)


def in_quarter(angle: float, rest: float, n: float) -> Any:
    """Cosine and sine of angle + rest - n pi/2, which is within pi/4."""
    # the parts of pi/2 have 33 bits, so that products with n are exact
    r, near = angle - n * 1.5707963267341256, n * 6.077100506303966e-11
    y = r - near
    back = r - y
    tail = ((back - near) + ((r - back) - y)) + (rest - n * 2.0222662487959506e-21)
    x = y + tail
    tail += y - x
    x2 = x * x
    # minimax polynomials of sin and cos on [-pi/4, pi/4], as in fdlibm (Sun Microsystems 1993), with the tail of the
    # reduction
    s = x2 * (2.75573137070700676789e-6 + x2 * (-2.50507602534068634195e-8 + x2 * 1.58969099521155010221e-10))
    s = -1.66666666666666324348e-1 + x2 * (8.33333333332248946124e-3 + x2 * (-1.98412698298579493134e-4 + s))
    s = x + (x * x2 * s + tail * (1 - 0.5 * x2))
    c = x2 * (-2.75573143513906633035e-7 + x2 * (2.08757232129817482790e-9 - x2 * 1.13596475577881948265e-11))
    c = 4.16666666666666019037e-2 + x2 * (-1.38888888888741095749e-3 + x2 * (2.48015872894767294178e-5 + c))
    one = 1 - 0.5 * x2
    c = one + (((1 - one) - 0.5 * x2) + (x2 * x2 * c - x * tail))
    return c, s


def wave_twice(angle: float, rest: float) -> Any:
    """Cosine and sine of angle + rest, each as two doubles, to 1e-30: a series at a 64th, squared six times."""
    n = (angle * 0.6366197723675814 + NEAREST) - NEAREST
    quarter = n - 4 * ((n * 0.25 + NEAREST) - NEAREST)
    x, x_low = sum_twice(angle, rest, -n * 1.5707963267341256, 0.0)
    x, x_low = sum_twice(x, x_low, -n * 6.077100506303966e-11, 0.0)
    x, x_low = sum_twice(x, x_low, -n * 2.0222662487111665e-21, 0.0)
    x, x_low = sum_twice(x, x_low, -n * 8.4784276603689e-32, 0.0)
    x, x_low = x / 64, x_low / 64
    # cos - 1 and sin: the 1 would cost the small part its digits
    c, c_low, s, s_low = 0.0, 0.0, 0.0, 0.0
    for k in range(13, 0, -1):
        one, one_low = sum_twice(c, c_low, 1.0, 0.0)
        one, one_low = product_twice(one, one_low, x, x_low)
        c, c_low = product_twice(s, s_low, -x, -x_low)
        s, s_low = divided(one, one_low, k)
        c, c_low = divided(c, c_low, k)
    for _ in range(6):
        # cos 2x - 1 = -2 sin^2 x and sin 2x = 2 sin x (1 + (cos x - 1)): no difference cancels
        square, square_low = product_twice(s, s_low, s, s_low)
        one, one_low = sum_twice(c, c_low, 1.0, 0.0)
        s, s_low = product_twice(2 * s, 2 * s_low, one, one_low)
        c, c_low = -2 * square, -2 * square_low
    c, c_low = sum_twice(c, c_low, 1.0, 0.0)
    if abs(quarter) == 1:
        c, c_low, s, s_low = s, s_low, c, c_low
    if quarter == 1 or abs(quarter) == 2:
        c, c_low = -c, -c_low
    if quarter == -1 or abs(quarter) == 2:
        s, s_low = -s, -s_low
    return c, c_low, s, s_low
