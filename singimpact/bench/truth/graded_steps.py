"""First hits in doubles by an explicit Runge-Kutta method of order 8 whose steps are graded before they are taken.

x'' = acceleration(t, x, x'),        h = fineness/(rate of the motion + sum over layers of speed/max(width, distance))

The length of a step depends on the state, on the places of the layers and on the fineness alone; no error is estimated
on the way. The fineness is halved until two flights agree.
"""

import types
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import floor, inf, isfinite, sqrt
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate._ivp import dop853_coefficients as table

Array = np.ndarray[Any, Any]
Acceleration = Callable[[float, float, float, Sequence[float]], float]
POSITION, VELOCITY, PHASE, BEYOND, EVERYWHERE = range(5)
MISS, HIT, UNDECIDED = range(3)
MOST_STEPS = 2_000_000
A, B, C = np.zeros((0, 0)), np.zeros(0), np.zeros(0)  # the nodes of the method; `compiled_kernel` puts them in
KERNEL = ("added", "rate", "side", "increments", "bracketed_root", "flown")


@dataclass(frozen=True)
class FinenessSettings:
    """Sizes of the steps, and how well two flights have to agree.

    Parameters
    ----------
    first : fineness of the first flight; a step is at most that part of the distance to a layer.
    halvings : how often it is halved before a state is undecided.
    time : relative difference of two flight times that agree.
    touch : difference of two flight times, times the impact velocity, relative to the largest x - c, that agrees too;
        rounding moves the time of a near graze by that much.
    most : relative difference of the flight times that is never exceeded.
    """

    first: float = 0.2
    halvings: int = 5
    time: float = 1e-11
    touch: float = 1e-13
    most: float = 1e-10


FINENESS = FinenessSettings()


class Motion(NamedTuple):
    """A compiled acceleration, its parameters, the layers, rows (kind, centre, width, stiffness, spacing), and c.

    A layer of kind EVERYWHERE adds 1/width to the rate of the motion in every state. A second wall is at c + gap.
    """

    acceleration: Any
    parameters: Array
    layers: Array
    clearance: float
    gap: float = inf

    def flown(self, tau: float, v: float, horizon: float, fineness: float) -> Any:
        """`flown` of this motion."""
        return compiled_kernel()["flown"](*self[:3], (self.clearance, self.gap), tau, v, horizon, fineness)


class Hit(NamedTuple):
    """`status` MISS, HIT or UNDECIDED, time and velocity of the hit, whether a layer was crossed, steps of all runs."""

    status: int
    flight_time: float
    velocity: float
    crossed: bool
    steps: int


def first_hit(motion: Motion, tau: float, v: float, horizon: float, first: float = FINENESS.first) -> Hit:
    """The first hit of the flight from (tau, v), v > 0, alike at two finenesses; UNDECIDED where no two agree.

    Its velocity is > 0 at a second wall.

    Parameters
    ----------
    first : fineness of the first of the flights.

    Examples
    --------
    >>> import numpy as np
    >>> falling = compiled(lambda t, x, u, p: -p[0])
    >>> round(first_hit(Motion(falling, np.array([2.0]), np.zeros((0, 5)), 0.0), 0.0, 3.0, 30.0).flight_time, 13)
    3.0
    """
    fineness, before, steps = first, None, 0
    for _ in range(FINENESS.halvings + 1):
        status, time, velocity, crossed, count, top = motion.flown(tau, v, horizon, fineness)
        steps += count
        ended = (status, time, velocity, top)
        if before is not None and _agree(ended, before):
            return Hit(status, time, velocity, crossed, steps)
        before, fineness = ended, fineness / 2
    return Hit(UNDECIDED, time, velocity, crossed, steps)


def _agree(one: tuple[int, float, float, float], other: tuple[int, float, float, float]) -> bool:
    if one[0] != other[0] or one[0] == UNDECIDED:
        return False
    if one[0] == MISS:
        return True
    off, time = abs(one[1] - other[1]), one[1]
    return off <= FINENESS.most * time and (off <= FINENESS.time * time or off * abs(one[2]) <= FINENESS.touch * one[3])


@lru_cache(maxsize=1)
def compiled_kernel() -> dict[str, Any]:
    """The functions of KERNEL compiled by numba, callees first, with the nodes of DOP853 as constants."""
    import numba

    space, count = dict(globals()), table.N_STAGES
    space.update(A=np.ascontiguousarray(table.A[:count, :count]), B=table.B.copy(), C=table.C[:count].copy())
    for name in KERNEL:
        # with its type given, `flown` is compiled once and calls any acceleration
        signature = (_signature(),) if name == "flown" else ()
        plain = types.FunctionType(globals()[name].__code__, space, name)
        space[name] = numba.njit(*signature, error_model="numpy")(plain)
    return space


def _signature() -> Any:
    import numba

    number: Any = numba.float64
    returned: Any = numba.types.Tuple((numba.int64, number, number, numba.boolean, numba.int64, number))
    called = numba.types.FunctionType(number(number, number, number, number[::1]))
    return returned(called, number[::1], number[:, ::1], numba.types.UniTuple(number, 2), *[number] * 4)


@lru_cache(maxsize=64)
def compiled(acceleration: Acceleration) -> Any:
    """An acceleration (t, x, x', parameters), compiled to one type: the kernel is compiled once for all of them."""
    import numba

    number = numba.float64
    signature = number(number, number, number, number[::1])
    return numba.njit(signature, error_model="numpy")(_with_compiled_callees(acceleration))


def _with_compiled_callees(function: Any) -> Any:
    """A function whose plain callees in its module are compiled."""
    import numba

    space = dict(function.__globals__)
    for name in function.__code__.co_names:
        if isinstance(space.get(name), types.FunctionType):
            space[name] = numba.njit(_with_compiled_callees(space[name]), error_model="numpy")
    return types.FunctionType(function.__code__, space, function.__name__)


# what follows is compiled by `compiled_kernel`


def added(total: float, lost: float, term: float) -> tuple[float, float]:
    """total + term with the part that rounding lost, which the next sum takes back."""
    part = term - lost
    result = total + part
    return result, (result - total) - part


def rate(layers: Array, t: float, x: float, u: float, e: float) -> float:
    """The rate of the motion: 2 for a smooth one, plus the speed towards each layer over the distance to it."""
    total: float = 2 + abs(e) / (1 + abs(u))
    for row in range(len(layers)):
        kind, centre, width, stiffness, spacing = layers[row]
        if kind == VELOCITY:
            distance = max(width, abs(u - centre))
            # a tenth: the method is stable up to h stiffness = 6, and friction that holds the mass changes slowly
            total += abs(e) / distance + 0.1 * abs(stiffness) * (width / distance) ** 2
        elif kind == PHASE:
            turn = t - centre
            total += 1 / max(width, abs(turn - spacing * floor(turn / spacing + 0.5)))
        elif kind == EVERYWHERE:
            total += 1 / width
        else:
            distance = width if kind == BEYOND and x > centre else max(width, abs(x - centre))
            total += abs(u) / distance + sqrt(abs(e) / distance) + sqrt(stiffness) * width / distance
    return total


def side(layer: Array, t: float, x: float, u: float) -> float:
    """A number that changes when the state crosses the centre of a layer."""
    kind, centre, spacing = layer[0], layer[1], layer[4]
    if kind == PHASE:
        return float(floor((t - centre) / spacing))
    return 1.0 if (u if kind == VELOCITY else x) > centre else 0.0


def increments(
    acceleration: Any, parameters: Array, clearance: float, t: float, z: float, u: float, h: float
) -> tuple[float, float]:
    """The changes of x - c and x' in one step of length h."""
    slopes = np.empty((len(B), 2))
    for stage in range(len(B)):
        dz, du = 0.0, 0.0
        for earlier in range(stage):
            dz += A[stage, earlier] * slopes[earlier, 0]
            du += A[stage, earlier] * slopes[earlier, 1]
        slopes[stage, 0] = u + h * du
        slopes[stage, 1] = acceleration(t + C[stage] * h, clearance + (z + h * dz), u + h * du, parameters)
    dz, du = 0.0, 0.0
    for stage in range(len(B)):
        dz += B[stage] * slopes[stage, 0]
        du += B[stage] * slopes[stage, 1]
    return h * dz, h * du


def bracketed_root(
    acceleration: Any,
    parameters: Array,
    clearance: float,
    state: tuple[float, float, float],
    high: float,
    turning: bool,
    gap: float,
) -> tuple[float, float, float]:
    """Where x - c falls to 0 inside a step, or where x' rises to 0 (`turning`), with x - c and x' there.

    With gap > 0 where x - c rises to it, or where x' falls to 0. Each trial is a step of its own from the state (t,
    x - c, x') at the step's start: Newton's method, halving where it leaves the bracket.
    """
    t, z, u = state
    low, s, side = 0.0, 0.5 * high, -1.0 if gap > 0 else 1.0
    for _ in range(100):
        dz, du = increments(acceleration, parameters, clearance, t, z, u, s)
        value, slope = gap + side * (z + dz), side * (u + du)
        if turning:
            value = -side * (u + du)
            slope = -side * acceleration(t + s, clearance + z + dz, u + du, parameters)
        if value > 0:
            low = s
        else:
            high = s
        trial = s - value / slope
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if abs(trial - s) <= 4e-16 * s:
            break
        s = trial
    return s, z + dz, u + du


def flown(
    acceleration: Any,
    parameters: Array,
    layers: Array,
    walls: tuple[float, float],
    tau: float,
    v: float,
    horizon: float,
    fineness: float,
) -> tuple[int, float, float, bool, int, float]:
    """Status, time, velocity, whether a layer was crossed, steps, largest x - c of the flight at one fineness."""
    s, z, u, h, top, crossed = 0.0, 0.0, v, inf, 0.0, False
    s_lost, z_lost, u_lost, (clearance, gap) = 0.0, 0.0, 0.0, walls
    for count in range(MOST_STEPS):
        t = tau + s
        e = acceleration(t, clearance + z, u, parameters)
        # the first step is a part of the time in which x'' would turn the mass back, and later ones grow twofold
        h = min(fineness / rate(layers, t, clearance + z, u, e), 2 * h if count else fineness * v / (abs(e) + v))
        dz, du = increments(acceleration, parameters, clearance, t, z, u, h)
        if not (isfinite(dz) and isfinite(du)):
            return UNDECIDED, s, u, crossed, count, top
        end, state = h, (t, z, u)
        if u > 0 and gap < inf:
            highest = z + dz
            if u + du < 0:
                end, highest, _ = bracketed_root(acceleration, parameters, clearance, state, h, True, gap)
                if abs(gap - highest) <= 1e-12 * gap:
                    return UNDECIDED, s + end, 0.0, crossed, count, gap
            if highest >= gap:
                end, _, velocity = bracketed_root(acceleration, parameters, clearance, state, end, False, gap)
                return HIT if s + end <= horizon else MISS, s + end, velocity, crossed, count, gap
            end = h
        if u < 0 < u + du and z + dz > 0:
            end, least, _ = bracketed_root(acceleration, parameters, clearance, state, h, True, 0.0)
            if abs(least) <= 1e-12 * top:
                return UNDECIDED, s + end, 0.0, crossed, count, top
            dz = least - z if least < 0 else dz
        if z + dz <= 0:
            end, _, velocity = bracketed_root(acceleration, parameters, clearance, state, end, False, 0.0)
            return HIT if s + end <= horizon else MISS, s + end, velocity, crossed, count, top
        if z + dz >= gap:
            end, _, velocity = bracketed_root(acceleration, parameters, clearance, state, h, False, gap)
            return HIT if s + end <= horizon else MISS, s + end, velocity, crossed, count, gap
        s, s_lost = added(s, s_lost, h)
        z, z_lost = added(z, z_lost, dz)
        u, u_lost = added(u, u_lost, du)
        top = max(top, z)
        for row in range(len(layers)):
            now = side(layers[row], tau + s, clearance + z, u)
            crossed = crossed or now != side(layers[row], tau, clearance, v)
        if s > horizon:
            return MISS, inf, 0.0, crossed, count, top
    return UNDECIDED, s, u, crossed, MOST_STEPS, top
