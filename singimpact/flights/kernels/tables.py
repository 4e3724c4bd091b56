"""A linear model's closed form at multiples of one step: a launch is flown by sums of products.

    x - c = z_0 G + u_0 F + h D_0 + sum_j cos(theta_j) Zc_j + sin(theta_j) Zs_j

is linear in the launch; the columns are the same for all launches of a model, and no error grows along a flight.
"""

from cmath import sqrt as complex_sqrt
from typing import Any

from singimpact.flights.kernels.linear import pair, triple, turning
from singimpact.flights.kernels.state import (
    A_COS,
    A_SIN,
    COSINE,
    RATE,
    SINE,
    SIZE_STEADY,
    SIZE_X,
    TURN_COS,
    TURN_SIN,
    V_BY_V,
    V_BY_X,
    V_COS,
    V_SIN,
    V_STEADY,
    X_BY_V,
    X_BY_X,
    X_COS,
    X_SIN,
    X_STEADY,
)


def tabulate(p: Any, table: Any) -> None:
    """Fill the rows of a table for the times m step."""
    root = complex_sqrt(complex(p.damping * p.damping / 4 - p.stiffness))
    a, b = -p.damping / 2 + root, -p.damping / 2 - root
    for m in range(len(table.rows)):
        time, row = m * table.step, table.rows[m]
        free = pair(a, b, time)
        slope = turning(a, time) + b * free
        steady = p.steady * triple(a, b, 0j, time)
        row[X_BY_X], row[X_BY_V], row[X_STEADY] = slope.real + p.damping * free.real, free.real, steady.real
        row[V_BY_X], row[V_BY_V], row[V_STEADY] = -p.stiffness * free.real, slope.real, p.steady * free.real
        row[SIZE_X], row[SIZE_STEADY] = abs(row[X_BY_X]), abs(row[X_STEADY])
        for j in range(len(p.waves)):
            rate, turn = p.waves[j, RATE], table.waves[m][j]
            wave = complex(p.waves[j, COSINE], -p.waves[j, SINE])
            forced = wave * triple(a, b, 1j * rate, time)
            moved = wave * free + 1j * rate * forced
            turned = turning(1j * rate, time)
            turn_c, turn_s = turned.real, turned.imag
            turn[X_COS], turn[X_SIN], turn[V_COS], turn[V_SIN] = forced.real, -forced.imag, moved.real, -moved.imag
            turn[A_COS] = p.waves[j, COSINE] * turn_c + p.waves[j, SINE] * turn_s
            turn[A_SIN] = p.waves[j, SINE] * turn_c - p.waves[j, COSINE] * turn_s
            turn[TURN_COS], turn[TURN_SIN] = turn_c, turn_s
            row[SIZE_STEADY] += abs(forced)


def bounds(p: Any, table: Any) -> None:
    """Bounds of the fourth and the sixth derivative over one step, and 1/k!, see `state.Table`.

    The same equation with |damping| and |stiffness| majorises the flight; its solution grows, so its value at the end
    of the step bounds the whole step.
    """
    d, k = abs(p.damping), abs(p.stiffness)
    for source in range(3):
        value, slope = 1.0 * (source == 0), 1.0 * (source == 1)
        steady = abs(p.steady) if source == 2 else 0.0
        force, wave = steady, 0.0
        for j in range(len(p.waves)):
            if source == 2:
                wave += abs(p.waves[j, COSINE]) + abs(p.waves[j, SINE])
        force += wave
        # Taylor sums of value and slope at the end of the step
        first, second = value, slope
        total, speed, power = first, second, 1.0
        for n in range(2, 40):
            third = (d * second * (n - 1) + k * first + (force if n == 2 else 0.0)) / (n * (n - 1))
            power *= table.step
            total += second * power
            speed += n * third * power
            first, second = second, third
        lower, low = total, speed
        for n in range(2, 7):
            driven = steady if n == 2 else 0.0
            for j in range(len(p.waves)):
                if source == 2:
                    driven += (abs(p.waves[j, COSINE]) + abs(p.waves[j, SINE])) * abs(p.waves[j, RATE]) ** (n - 2)
            lower, low = low, d * low + k * lower + driven
            if n == 4:
                table.fourth[source] = low
        table.sixth[source] = low
    factorial = 1.0
    for n in range(len(table.taylor)):
        factorial *= max(n, 1)
        table.taylor[n] = 1 / factorial


def expansions(p: Any, out: Any) -> None:
    """out[i] = how x_i of the series x - c = x_0 + x_1 t + ... follows from the state at its start.

    Columns: by x_0, by x_1, by nothing, then by cosine and sine of every wave there.
    """
    count = len(p.waves)
    for i in range(len(out)):
        row = out[i]
        for at in range(3 + 2 * count):
            row[at] = 0.0
        if i < 2:
            row[i] = 1.0
            continue
        row[2] = p.steady if i == 2 else 0.0
        for j in range(count):
            # cos and sin differentiated i - 2 times: turned by as many quarters
            power = 1.0 if (i - 2) % 4 < 2 else -1.0
            for k in range(1, i - 1):
                power *= p.waves[j, RATE] / k
            one, other = p.waves[j, COSINE] * power, p.waves[j, SINE] * power
            row[3 + 2 * j], row[4 + 2 * j] = (one, other) if i % 2 == 0 else (other, -one)
        for at in range(3 + 2 * count):
            row[at] = (row[at] - p.damping * (i - 1) * out[i - 1, at] - p.stiffness * out[i - 2, at]) / (i * (i - 1))
