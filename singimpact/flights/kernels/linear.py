"""Linear models: coefficients by a short recurrence, restarts from a well-conditioned closed form.

    x - c = v D[a, b](t) + Re sum_j (A_j - i B_j) e^{i theta_j} D[a, b, i w_j](t)

with a, b the roots of s^2 + d s + k and D the divided differences of s -> e^{s t}: nothing divides by k - w^2, so
resonance, critical damping and k = 0 are ordinary points.  launch = cos theta_j, sin theta_j of every wave.
"""

from cmath import sqrt as complex_sqrt
from math import cos, exp, expm1, inf, sin
from typing import Any

from singimpact.flights.kernels.double_double import product_twice
from singimpact.flights.kernels.state import COSINE, RATE, SINE

# The share of a proved quiet time that is used: the rest is far above what a few operations round.
SHY = 1 - 2.0**-20
# The fastest rate times t up to which motions are power series, and their terms: what follows is below 1/19!.
SOON, SOON_TERMS = 1.0, 17


def coefficients(launch: Any, time: Any, z: Any, u: Any, shift: Any, n: int, p: Any, work: Any) -> None:
    """Taylor coefficients of x - c (X[0] is not read); W takes those of cosine and sine of every wave."""
    X, W, count = work.X, work.W, len(p.waves)
    for j in range(count):
        rate = p.waves[j, RATE]
        turn_c, turn_s = cos(rate * time), sin(rate * time)
        W[2 * j, 0] = launch[2 * j] * turn_c - launch[2 * j + 1] * turn_s
        W[2 * j + 1, 0] = launch[2 * j + 1] * turn_c + launch[2 * j] * turn_s
        for k in range(n - 2):
            W[2 * j, k + 1] = -rate * W[2 * j + 1, k] / (k + 1)
            W[2 * j + 1, k + 1] = rate * W[2 * j, k] / (k + 1)
    X[0], X[1] = z, u
    for k in range(n - 1):
        total = p.steady if k == 0 else 0 * z
        for j in range(count):
            total += p.waves[j, COSINE] * W[2 * j, k] + p.waves[j, SINE] * W[2 * j + 1, k]
        total -= p.damping * (k + 1) * X[k + 1] + p.stiffness * X[k]
        X[k + 2] = total / ((k + 1) * (k + 2))
        if k == 0:
            X[2] += shift


def step_size(X: Any, W: Any, z: Any, n: int, longest: Any, ulp: Any, p: Any, pace: Any) -> Any:  # noqa: ARG001
    """3/2 of the fastest rate: order 24 leaves 1.5^24/24! < 3e-20 of the terms; also 17/16 of it."""
    return 3 / (2 * p.fastest) if p.fastest > 0 else longest * 1e6, 17 / 16, pace


def singular_part(X: Any, W: Any, n: int, h: Any, p: Any) -> Any:  # noqa: ARG001
    """The forces of a linear model are entire."""
    return 0


def turning(a: complex, t: float) -> complex:
    """e^{a t}; the rounding of the angle would be that of t, times the amplitude: 1e-14 after 100 turns."""
    angle, rest = product_twice(a.imag, 0.0, t, 0.0)
    size, c, s = exp(a.real * t), cos(angle), sin(angle)
    return complex(size * (c - rest * s), size * (s + rest * c))


def pair(a: complex, b: complex, t: float) -> complex:
    """D[a, b](t) = (e^{a t} - e^{b t})/(a - b)."""
    # numpy's complex scalars divide in another way than Python's and the compiler's
    a, b, t = complex(a), complex(b), float(t)
    # D[a, b](t) = t e^{(a + b) t/2} sinh(y)/y, y = (a - b) t/2: next to a = b the series of sinh(y)/y replaces a
    # difference of nearly equal numbers (McCurdy, Ng and Parlett 1984)
    y = (a - b) * t / 2
    if abs(y) < 0.1:
        y2 = y * y
        ratio = 1 + y2 / 6 * (1 + y2 / 20 * (1 + y2 / 42 * (1 + y2 / 72 * (1 + y2 / 110))))
        return turning(b, t) * turning(y, 1.0) * t * ratio
    return (turning(a, t) - turning(b, t)) / (a - b)


def triple(a: complex, b: complex, c: complex, t: float) -> complex:
    """D[a, b, c](t), from the two points that are farthest apart, or from the series when all are close."""
    a, b, c, t = complex(a), complex(b), complex(c), float(t)
    ab, bc, ca = abs(a - b), abs(b - c), abs(c - a)
    if ab >= bc and ab >= ca:
        b, c = c, b
    elif bc >= ca:
        a, b = b, a
    if abs((a - c) * t) > 0.5:
        return (pair(a, b, t) - pair(b, c, t)) / (a - c)
    mean = (a + b + c) / 3
    a, b, c = (a - mean) * t, (b - mean) * t, (c - mean) * t
    # all three close: D[a, b, c](t) = t^2 sum_m h_m(a t, b t, c t)/(m + 2)!, h_m the complete homogeneous symmetric
    # polynomials, about the mean of the three
    h1, h2, h3, total, factorial = 1.0 + 0j, 1.0 + 0j, 1.0 + 0j, 0.5 + 0j, 2.0
    for m in range(1, 14):
        h1 = h1 * a
        h2 = h1 + b * h2
        h3 = h2 + c * h3
        factorial *= m + 2
        total += h3 / factorial
    return total * t * t * turning(mean, t)


def restart(launch: Any, start: Any, time: float, z: float, u: float, noise: float, ulp: float, p: Any) -> Any:  # noqa: ARG001
    """x - c and x' at `time`, from the launch, so that errors of earlier steps do not enter; and their errors.

    Parameters
    ----------
    start : x - c and x' at the launch.
    """
    height, v = start
    root = complex_sqrt(complex(p.damping * p.damping / 4 - p.stiffness))
    a, b = -p.damping / 2 + root, -p.damping / 2 - root
    free = pair(a, b, time)
    slope = turning(a, time) + b * free
    forced = p.steady * triple(a, b, 0j, time)
    z, u = v * free.real + forced.real, v * slope.real + p.steady * free.real
    size = abs(v * free) + abs(forced)
    for j in range(len(p.waves)):
        rate = 1j * p.waves[j, RATE]
        wave = complex(p.waves[j, COSINE], -p.waves[j, SINE]) * complex(launch[2 * j], launch[2 * j + 1])
        forced = wave * triple(a, b, rate, time)
        moved = wave * free + rate * forced
        z, u, size = z + forced.real, u + moved.real, size + abs(forced) + abs(wave) * abs(free) / p.fastest
    if height > 0:
        still = height * (slope + p.damping * free)
        z, u, size = z + still.real, u - height * p.stiffness * free.real, size + abs(still)
    return z, u, ulp * size * (1 + p.fastest * time)


def quiet(z: Any, u: Any, W: Any, p: Any) -> Any:
    """A time from the state x - c = z, x' = u on in which the mass does not come down to the wall; 0 if none is proved.

    Parameters
    ----------
    W : cosine and sine of every wave now, in the first entries of its rows.

    Notes
    -----
    x - c = mean + forced motion + free motion. With k > 0 and d >= 0 the energy of the free motion does not grow, so
    its distance from 0 is at most A, and the forced motion changes no faster than the sum of its amplitudes times their
    rates; with k = 0 the free motion falls along a parabola, or to a straight line, and the forced motion is bounded.
    2^-20 of the sizes is left for rounding.
    """
    d, k = p.damping, p.stiffness
    none = 0 * z
    if d < 0 or k < 0:
        return none
    displacement, speed, bound, rise = none, none, none, none
    for j in range(len(p.waves)):
        rate = p.waves[j, RATE]
        # (k - rate^2 + i d rate) answers: the amplitude of x over that of the force
        a, b = k - rate * rate, d * rate
        square = a * a + b * b
        if not square > 1e-16 * (k + rate * rate) * (k + rate * rate):
            return none  # too near to a resonance for doubles
        even = p.waves[j, COSINE] * W[2 * j, 0] + p.waves[j, SINE] * W[2 * j + 1, 0]
        odd = p.waves[j, SINE] * W[2 * j, 0] - p.waves[j, COSINE] * W[2 * j + 1, 0]
        displacement += (a * even - b * odd) / square
        speed += rate * (a * odd + b * even) / square
        size = ((p.waves[j, COSINE] * p.waves[j, COSINE] + p.waves[j, SINE] * p.waves[j, SINE]) / square) ** 0.5
        bound += size
        rise += abs(rate) * size
    free, moving = z - displacement, u - speed
    spare = (abs(z) + abs(free) + bound) / 1048576
    if k > 0:
        mean = p.steady / k
        away = ((free - mean) * (free - mean) + moving * moving / k) ** 0.5
        spare += (abs(mean) + away) / 1048576
        gap = mean + displacement - away - spare
        if not gap > 0:
            return none
        return SHY * gap / rise if rise > 0 else gap * inf
    room = free - bound - spare
    if d > 0:
        # x' of the free motion goes to the drift h/d monotonically: what it falls behind at most comes first
        drift = p.steady / d
        room += min((moving - drift) / d, none)
        if not room > 0:
            return none
        return SHY * room / -drift if drift < 0 else room * inf
    if not room > 0:
        return none
    # room + moving t + steady t^2/2 = 0, by the form of the root that does not cancel
    if p.steady < 0:
        root = (moving * moving - 2 * p.steady * room) ** 0.5
        return SHY * (2 * room / (root - moving) if moving < 0 else (moving + root) / -p.steady)
    if moving >= 0:
        return room * inf
    square = moving * moving - 2 * p.steady * room
    return SHY * 2 * room / (square**0.5 - moving) if square >= 0 else room * inf


def response(launch: Any, v: float, time: float, p: Any) -> Any:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at `time` after the launch, and the sizes of the terms in x - c and x'."""
    reach = min(time, widest(p))
    free, slope, by_tau, by_tau_dot = 0.0, 0.0, 0.0, 0.0
    if p.fastest * time < SOON:
        free, slope = soon(0.0, 0.0, 0.0, 0.0, 1.0, time, p)
        for j in range(len(p.waves)):
            even, odd = moved_wave(launch[2 * j], launch[2 * j + 1], j, p)
            forced, moved = soon(even, even, odd, p.waves[j, RATE], 0.0, time, p)
            by_tau, by_tau_dot = by_tau + forced, by_tau_dot + moved
    elif reach > resonant_reach(5, 0.0, p):
        free, slope = free_motion(time, p)
        for j in range(len(p.waves)):
            even, odd = moved_wave(launch[2 * j], launch[2 * j + 1], j, p)
            c, s = turned(p.waves[j, RATE], time)
            forced, moved = answered(even, odd, p.waves[j, RATE], c, s, free, slope, p)
            by_tau, by_tau_dot = by_tau + forced, by_tau_dot + moved
    else:
        free, slope, by_tau, by_tau_dot = response_of_differences(launch, time, p)
    largest = (v + strength_of(p) * reach) * growth(time, p)
    return free, slope, by_tau, by_tau_dot, largest * reach, largest


def strength_of(p: Any) -> float:
    """The size of the constant force and of all waves."""
    strength = abs(p.steady)
    for j in range(len(p.waves)):
        strength += abs(p.waves[j, COSINE]) + abs(p.waves[j, SINE])
    return float(strength)


def growth_rate(p: Any) -> float:
    """The larger real part of the roots of s^2 + d s + k."""
    square = p.damping * p.damping / 4 - p.stiffness
    root = square**0.5 if square > 0 else 0.0
    # next to s = 0 the sum would cancel: the roots have the product k
    return float(-p.stiffness / (p.damping / 2 + root) if p.damping > 0 and root > 0 else root - p.damping / 2)


def growth(time: float, p: Any) -> float:
    """The factor by which the free motion grows until `time`, where it grows."""
    return exp(growth_rate(p) * time) if p.damping < 0 or p.stiffness < 0 else 1.0


def widest(p: Any) -> float:
    """The time up to which the free motion grows like t; divided differences then are differences of larger terms."""
    gap = 2 * abs(p.stiffness - p.damping * p.damping / 4) ** 0.5
    return 2 / gap if gap > 0 else inf


def response_of_differences(launch: Any, time: float, p: Any) -> Any:
    """The four derivatives of `response` from divided differences: they have no exceptions and cost five times more."""
    root = complex_sqrt(complex(p.damping * p.damping / 4 - p.stiffness))
    a, b = -p.damping / 2 + root, -p.damping / 2 - root
    free = pair(a, b, time)
    slope = turning(a, time) + b * free
    by_tau, by_tau_dot = 0.0, 0.0
    for j in range(len(p.waves)):
        rate = 1j * p.waves[j, RATE]
        wave = rate * complex(p.waves[j, COSINE], -p.waves[j, SINE]) * complex(launch[2 * j], launch[2 * j + 1])
        forced = wave * triple(a, b, rate, time)
        moved = wave * free + rate * forced
        by_tau, by_tau_dot = by_tau + forced.real, by_tau_dot + moved.real
    return free.real, slope.real, by_tau, by_tau_dot


def moved_wave(c: float, s: float, j: int, p: Any) -> Any:
    """The derivative of a wave by the launch time, as the real and the imaginary part of what e^{i w t} is taken by.

    Parameters
    ----------
    c, s : cosine and sine of its phase at the launch.
    """
    rate, even, odd = p.waves[j, RATE], p.waves[j, COSINE], p.waves[j, SINE]
    return rate * (odd * c - even * s), rate * (even * c + odd * s)


def place_of(launch: Any, v: float, push: float, height: float, time: float, p: Any) -> Any:
    """x - c and x' at `time` after the launch, or before it, from x - c = `height` and x' = v.

    Parameters
    ----------
    push : a_c at the launch, known to all its digits, where the sum of constant and waves would have cancelled.
    """
    span = abs(time)
    if time == 0:
        return height, v
    if p.fastest * span < SOON:
        z, u = soon(push - p.stiffness * height, 0.0, 0.0, 0.0, v, time, p)
        for j in range(len(p.waves)):
            even, odd = wave_of(launch, j, p)
            forced, moved = soon(0.0, even, odd, p.waves[j, RATE], 0.0, time, p)
            z, u = z + forced, u + moved
        return z + height, u
    free, slope = free_motion(time, p)
    if min(span, widest(p)) > resonant_reach(3, abs(p.steady), p):
        z, u = v * free, v * slope
        if p.steady != 0:
            forced, moved = answered(p.steady, 0.0, 0.0, 1.0, 0.0, free, slope, p)
            z, u = z + forced, u + moved
        for j in range(len(p.waves)):
            even, odd = wave_of(launch, j, p)
            c, s = turned(p.waves[j, RATE], time)
            forced, moved = answered(even, odd, p.waves[j, RATE], c, s, free, slope, p)
            z, u = z + forced, u + moved
    else:
        z, u, _error = restart(launch, (0.0, v), time, 0.0, 0.0, 0.0, 0.0, p)
    # the free motion from (1, 0) is the derivative of the one from (0, 1), and d times that one
    return z + height * (slope + p.damping * free), u - height * p.stiffness * free


def wave_of(launch: Any, j: int, p: Any) -> Any:
    """The real and the imaginary part of what e^{i w t} of a wave is taken by."""
    even, odd = p.waves[j, COSINE], p.waves[j, SINE]
    return even * launch[2 * j] + odd * launch[2 * j + 1], even * launch[2 * j + 1] - odd * launch[2 * j]


def soon(first: float, even: float, odd: float, rate: float, speed: float, time: float, p: Any) -> Any:
    """y and y' of y'' + d y' + k y = F, y = 0 and y' = `speed` at first; F is Re (even + i odd) e^{i rate t}.

    Power series, for the fastest rate times t up to `SOON`.

    Parameters
    ----------
    first : F at the beginning; 0 leaves out the constant part of the wave.
    """
    low, high = 0.0, speed * time
    y, y_dot = high, high
    turn, drag, pull = rate * time, p.damping * time, p.stiffness * time * time
    force, even, odd = first * time * time, even * time * time, odd * time * time
    for n in range(SOON_TERMS):
        low, high = high, (force - drag * (n + 1) * high - pull * low) * (1.0 / ((n + 1) * (n + 2)))
        y, y_dot = y + high, y_dot + (n + 2) * high
        even, odd = -turn * odd * (1.0 / (n + 1)), turn * even * (1.0 / (n + 1))
        force = even
    return y, y_dot / time


def resonant_reach(bits: int, steady: float, p: Any) -> float:
    """The reach beyond which the answers to all waves, over what `answered` subtracts from them, lose fewer bits.

    Parameters
    ----------
    steady : the size of a constant force that is answered like a wave of rate 0.
    """
    least = p.stiffness * abs(p.stiffness) if steady > 0 else inf
    for j in range(len(p.waves)):
        rate = p.waves[j, RATE]
        above, drag = p.stiffness - rate * rate, p.damping * rate
        least = min(least, above * above + drag * drag)
    return float((4.0**bits * least) ** -0.25 if least > 0 else inf)


def turned(rate: float, time: float) -> Any:
    """cos and sin of rate times t, with the rounding of the product, see `turning`."""
    angle, rest = product_twice(rate, 0.0, time, 0.0)
    c, s = cos(angle), sin(angle)
    return c - rest * s, s + rest * c


def free_motion(time: float, p: Any) -> Any:
    """The free motion from y = 0, y' = 1, and its derivative."""
    square, size = p.stiffness - p.damping * p.damping / 4, exp(-p.damping / 2 * time)
    if square > 0:
        c, s = turned(square**0.5, time)
        return swung(c, s, size, square**0.5, p)
    if square == 0:
        return size * time, size * (1 - p.damping / 2 * time)
    # e^{a t} (1 - e^{-2 q t})/(2 q), a the root with the larger e^{a t}, 2 q the distance to the other
    a, gap = growth_rate(p), 2 * (-square) ** 0.5
    if time < 0:
        a, gap = a - gap, -gap
    size, less = exp(a * time), expm1(-gap * time)
    return -size * less / gap, size * (1 - (a - gap) * less / gap)


def swung(c: float, s: float, size: float, rate: float, p: Any) -> Any:
    """`free_motion` of an underdamped model, from cosine and sine of its own rate times t, and the damping `size`."""
    return size * s / rate, size * (c - p.damping / 2 * s / rate)


def answered(even: float, odd: float, rate: float, c: float, s: float, free: float, slope: float, p: Any) -> Any:
    """y and y' as in `soon` with y' = 0 at first: the answer to a wave, less the free motion that begins like it.

    Parameters
    ----------
    c, s : cosine and sine of rate times t. free, slope : see `free_motion`.
    """
    above, drag = p.stiffness - rate * rate, p.damping * rate
    square = above * above + drag * drag
    even, odd = (even * above + odd * drag) / square, (odd * above - even * drag) / square
    begin, speed = -even, rate * odd
    y = even * c - odd * s + begin * (slope + p.damping * free) + speed * free
    return y, -rate * (even * s + odd * c) + speed * slope - p.stiffness * begin * free
