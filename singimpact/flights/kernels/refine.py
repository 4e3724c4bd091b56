"""A hit of a linear model refined: one step of Halley's method on the flow in double-double arithmetic.

(x - c, x', 1, cosine and sine of every wave) is one linear system y' = A y, so damping, resonance and k = 0 need no
care: y moves by two matrices of `fine`, powers of exp(h A), and by the series of exp(s A) over the rest.  The first
root has been
isolated before; here it is only placed.
"""

from typing import Any

from singimpact.flights.kernels.double_double import divided, product_twice, sum_twice
from singimpact.flights.kernels.state import COSINE, PHASE, RATE, SINE
from singimpact.flights.kernels.waves import phase_of, wave_twice

# Powers of a step, and of LEVEL steps, that `fine` holds.
LEVEL = 15


def fill_fine(p: Any, rest: Any, step: float, fine: Any, space: Any) -> None:
    """fine[i] = exp(i step A) and fine[LEVEL + i] = exp(LEVEL i step A), its last axis the two doubles of an entry.

    Parameters
    ----------
    p, rest : numbers of the model and what their doubles leave out. space : scratch of shape (4, n, 2).
    """
    n = fine.shape[1]
    # fine[1] = exp(h A) column by column: each is the series applied to a unit vector
    for i in range(n):
        for j in range(n):
            space[0, j, 0], space[0, j, 1] = 1.0 * (i == j), 0.0
        keep_column(fine[0], i, space)
        move_twice(space, step, 0.0, p, rest)
        keep_column(fine[1], i, space)
    # its powers up to exp(LEVEL h A), which is fine[LEVEL] for now; the powers of this one; the identity in its place
    fill_powers(fine, 1, 2, LEVEL + 1, space)
    fill_powers(fine, LEVEL, LEVEL + 2, 2 * LEVEL, space)
    for i in range(n):
        for j in range(n):
            fine[LEVEL + 1, i, j, 0], fine[LEVEL + 1, i, j, 1] = fine[LEVEL, i, j, 0], fine[LEVEL, i, j, 1]
            fine[LEVEL, i, j, 0], fine[LEVEL, i, j, 1] = fine[0, i, j, 0], fine[0, i, j, 1]


def fill_powers(fine: Any, one: int, begin: int, end: int, space: Any) -> None:
    """fine[begin], ..., fine[end - 1] become the second, third, ... power of fine[one]."""
    for i in range(fine.shape[1]):
        for j in range(fine.shape[1]):
            space[0, j, 0], space[0, j, 1] = fine[one, j, i, 0], fine[one, j, i, 1]
        for m in range(begin, end):
            multiply_twice(fine[one], space)
            keep_column(fine[m], i, space)


def keep_column(matrix: Any, i: int, space: Any) -> None:
    """Column i of a matrix becomes y = space[0]."""
    y = space[0]
    for j in range(len(y)):
        matrix[j, i, 0], matrix[j, i, 1] = y[j, 0], y[j, 1]


def multiply_twice(matrix: Any, space: Any) -> None:
    """y = space[0] becomes matrix y."""
    y, before = space[0], space[3]
    n = len(y)
    for i in range(n):
        before[i, 0], before[i, 1] = y[i, 0], y[i, 1]
    for i in range(n):
        s, s_low = 0.0, 0.0
        for k in range(n):
            if matrix[i, k, 0] != 0.0 and before[k, 0] != 0.0:
                x, x_low = product_twice(matrix[i, k, 0], matrix[i, k, 1], before[k, 0], before[k, 1])
                s, s_low = sum_twice(s, s_low, x, x_low)
        y[i, 0], y[i, 1] = s, s_low


def move_twice(space: Any, h: float, h_low: float, p: Any, rest: Any) -> None:
    """y = space[0] becomes exp((h + h_low) A) y by its series; h is below a radian of the fastest motion."""
    y, term, slope = space[0], space[1], space[2]
    n = len(y)
    for i in range(n):
        # term = (h A)^k y/k!, summed in double-doubles (Dekker 1971) until it is below 1e-33 of y
        term[i, 0], term[i, 1] = y[i, 0], y[i, 1]
    slope[2, 0] = slope[2, 1] = 0.0
    for k in range(1, 40):
        slope[0, 0], slope[0, 1] = term[1, 0], term[1, 1]
        s, s_low = product_twice(p.damping, rest.damping, -term[1, 0], -term[1, 1])
        s, s_low = sum_twice(s, s_low, *product_twice(p.stiffness, rest.stiffness, -term[0, 0], -term[0, 1]))
        if k == 1:  # the constant force has one term
            s, s_low = sum_twice(s, s_low, *product_twice(p.steady, rest.steady, term[2, 0], term[2, 1]))
        for j in range(len(p.waves)):
            i, now, low = 3 + 2 * j, p.waves[j], rest.waves[j]
            s, s_low = sum_twice(s, s_low, *product_twice(now[COSINE], low[COSINE], term[i, 0], term[i, 1]))
            s, s_low = sum_twice(s, s_low, *product_twice(now[SINE], low[SINE], term[i + 1, 0], term[i + 1, 1]))
            slope[i, 0], slope[i, 1] = product_twice(now[RATE], low[RATE], -term[i + 1, 0], -term[i + 1, 1])
            slope[i + 1, 0], slope[i + 1, 1] = product_twice(now[RATE], low[RATE], term[i, 0], term[i, 1])
        slope[1, 0], slope[1, 1] = s, s_low
        ratio, ratio_low = divided(h, h_low, k)
        left = 0.0
        for i in range(n):
            term[i, 0], term[i, 1] = product_twice(slope[i, 0], slope[i, 1], ratio, ratio_low)
            left = max(left, abs(term[i, 0]) - 1e-33 * abs(y[i, 0]))
            y[i, 0], y[i, 1] = sum_twice(y[i, 0], y[i, 1], term[i, 0], term[i, 1])
        if left <= 0.0:
            break


def state_after(t: float, t_low: float, v: float, height: float, time: float, model: Any, space: Any) -> None:
    """space[0] becomes y at `time` after the launch from x - c = height with velocity v at t + t_low."""
    p, rest, fine, step = model.numbers, model.rest, model.fine, model.table.step
    y = space[0]
    y[0, 0], y[0, 1], y[1, 0], y[1, 1], y[2, 0], y[2, 1] = height, 0.0, v, 0.0, 1.0, 0.0
    for j in range(len(p.waves)):
        now, low = p.waves[j], rest.waves[j]
        angle, left = phase_of(t, t_low, now[RATE], low[RATE], now[PHASE], low[PHASE])
        y[3 + 2 * j, 0], y[3 + 2 * j, 1], y[4 + 2 * j, 0], y[4 + 2 * j, 1] = wave_twice(angle, left)
    left, left_low = time, 0.0
    while left >= step:
        # m = LEVEL a + b: two matrices, exp(LEVEL a step A) and exp(b step A), move y by m steps
        m = min(int(left / step), LEVEL * LEVEL - 1)
        if m >= LEVEL:
            multiply_twice(fine[LEVEL + m // LEVEL], space)
        if m % LEVEL > 0:
            multiply_twice(fine[m % LEVEL], space)
        left, left_low = sum_twice(left, left_low, -(m * step), 0.0)
    move_twice(space, left, left_low, p, rest)


def refine_hit(
    t: float, t_low: float, v: float, height: float, time: float, side: float, model: Any, space: Any
) -> Any:
    """Flight time and velocity of a hit known to be near `time`, and whether Halley's method settled there.

    Parameters
    ----------
    side : 1, or -1 of a hit of the other wall, whose velocity is that of the model with x -> -x.
    """
    p, y = model.numbers, space[0]
    for _ in range(4):
        state_after(t, t_low, v, height, time, model, space)
        u = y[1, 0]
        e = p.steady - p.damping * u - p.stiffness * y[0, 0]
        jerk = -p.stiffness * u
        for j in range(len(p.waves)):
            c, s = y[3 + 2 * j, 0], y[4 + 2 * j, 0]
            e += p.waves[j, COSINE] * c + p.waves[j, SINE] * s
            jerk += p.waves[j, RATE] * (p.waves[j, SINE] * c - p.waves[j, COSINE] * s)
        jerk -= p.damping * e
        above = y[0, 0]
        if side < 0:
            above, _low = sum_twice(y[0, 0], y[0, 1], -model.rules.gap, -model.rules.gap_low)
        change = -above / u
        # next to a graze a step is not short beside u/e, and Halley's step leaves an error of its third order
        settled = abs(change * e) < 1e-6 * abs(u) and abs(change) < 1e-6 * time
        # Halley's method: Newton's step with the curvature x'' = e, which here costs nothing
        change *= 1 - change * e / (2 * u)
        if settled:
            return time + change, side * (u + (y[1, 1] + change * (e + change * jerk / 2))), True
        if not (side * u < 0 and abs(change) < 1e-3 * time):
            break
        time += change
    return time, side * y[1, 0], False
