"""Periodic orbits of a model: n impacts in k periods of the forcing.

Orbits of one impact of a linear model are found in closed form. All else by Newton's method on the closing conditions,
from many starts, grazes among them; for two impacts of a linear model balls show, when they are asked, that none is
missed. Orbits with digits= are these, refined in balls.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from math import ceil
from typing import Any

import numpy as np

from singimpact.algebra import (
    BITS_A_DIGIT,
    Array,
    IsolatedZeros,
    as_float,
    as_rational,
    balls_at,
    constant,
    digits_at,
    for_user,
    names_in,
    near_rational,
    rational_ends,
)
from singimpact.branches.ball_closing import BallClosing, return_slope
from singimpact.branches.closing import Closing
from singimpact.branches.enclosed_closing import closed_boxes
from singimpact.branches.events.meeting_branches import repeats
from singimpact.branches.krawczyk import Krawczyk
from singimpact.branches.orbits import PeriodicOrbit, PeriodicOrbits, same_states
from singimpact.branches.resting import chatter_orbits, free_orbits
from singimpact.branches.solutions import closing_of, cycles_found, orbit_at
from singimpact.branches.starts import closed_from, grid_of_starts, phases_and_speeds, two_impacts
from singimpact.branches.wall_closing import closed_words, closing_of_word, word_of
from singimpact.flights import Refused, checked_digits
from singimpact.flights.family import family
from singimpact.inputs import InputError, refuse, require
from singimpact.oscillator import Oscillator, linear_form, require_rebound
from singimpact.status import Status


@dataclass(frozen=True)
class PeriodicSettings:
    """When two orbits are the same, and when one is a graze."""

    # distance of equal states, relative to a period and to the largest velocity of the orbit
    apart: float = 1e-7
    # an orbit of smaller v is a graze and is not listed
    least: float = 1e-13
    # k, n up to this
    most: int = 1000


SETTINGS = PeriodicSettings()
WINDOW = "two numbers (low, high), 0 <= low < high"
SEARCHED = "found from a grid of starts and from grazes: it is not shown that there are no others"
CYCLES_SEARCHED = "found from a grid of velocities: it is not shown that there are no others"
SPARE = 5  # digits of the states in balls beside those asked for


def periodic(
    osc: Oscillator, n: Any, k: int | None = None, start: Any = None, *, v: Any = None, digits: int | None = None
) -> PeriodicOrbits:
    """The orbits of n impacts in k periods of the forcing.

    Parameters
    ----------
    osc : the model; f and g have a common period in t, or are free of t: then the orbits are limit cycles.
    n : impacts, a whole number; `math.inf` for orbits that chatter to rest and lift off; 0 for orbits without impact.
        Of a model with two walls a word of the letters l and u, such as "lu": the walls in the order of the impacts.
    k : periods, a whole number >= 1; None for limit cycles, which have no forcing to count.
    start : states to start from in place of a grid: (tau, v), or a sequence of n of them, or a `PeriodicOrbit`.
    v : (low, high), for models without a closed form and n = 1 or 2: `.complete` then tells by a proof whether there
        are others with all velocities after impacts in this window; with n = 1 this takes seconds, with n = 2 a minute.
    digits : decimal digits; the orbits then hold mpmath numbers.

    Notes
    -----
    With restitution 0 orbits of n impacts start from rest at each of them; their multipliers are the slope of the map
    of release phases around the orbit, and 0.

    Returns
    -------
    list of `PeriodicOrbit` in the order of the first phase, with `.complete` (whether there are shown to be no others;
        of two impacts of a linear model a proof runs when it is read) and `.notes`. Orbits that close sooner, and
        grazes, are not among them.

    Raises
    ------
    InputError : a count that is none, a model without a period, a start that no orbit is found from.

    Examples
    --------
    >>> found = periodic(Oscillator("x", "cos(4*t)", 0, "0.5"), 1, 2)
    >>> print([f"{orbit.v[0]:.12f}" for orbit in found], found.complete)
    ['0.533333333333'] True
    """
    if osc.upper is not None:
        return _words(osc, n, k, start, (v, digits))
    if osc.autonomous:
        return _limit_cycles(osc, n, (k, start, v, digits))
    if osc.period is None:
        raise InputError("the forcing has no period: a periodic orbit needs one, or f and g free of t")
    k, window = (
        _count("k", k, 1),
        None if v is None else rational_ends("v", v, WINDOW, near_rational),
    )
    require(window is None or window[0] >= 0, "v", v, WINDOW)
    if osc.plastic and v is not None:
        raise refuse("v", v, "no v with restitution = 0: all velocities after impacts are 0")
    if n == np.inf:
        return chatter_orbits(osc, k)
    n = _count("n", n, 0)
    if n == 0:
        return free_orbits(osc, k)
    doubts: Any = ("found from the start given",)
    if start is not None:
        closing = Closing(family(osc), n, k)
        points = _from_start(closing, start, lambda tau, v: closed_from(closing, grid_of_starts(closing, tau, v)))
    else:
        points, doubts = _all(osc, n, k)
    orbits = _judged(osc, n, k, points)
    if start is None:
        orbits = [orbit for orbit in orbits if orbit.visible]
    elif not orbits:
        raise refuse("start", start, f"a state near an orbit of {n} impacts in {k} periods; Newton's method finds none")
    if doubts is None:
        doubts = partial(_doubts_of_two, osc, k, list(orbits))
    elif window is not None and n < 3 and SEARCHED in doubts:
        doubts = partial(_doubts_in_window, osc, (n, k), window, list(orbits))
    if digits is not None:
        orbits = [in_digits(osc, orbit, checked_digits(digits)) for orbit in orbits]
    return PeriodicOrbits(orbits, doubts)


def _words(osc: Oscillator, word: Any, k: Any, start: Any, others: tuple[Any, Any]) -> PeriodicOrbits:
    """The orbits between two walls whose impacts have a word."""
    v, digits = others
    require(v is None, "v", v, "no v for a model with two walls: osc.one_wall('lower') has one")
    if osc.period is None:
        raise InputError("the forcing has no period: a periodic orbit between two walls needs one")
    closing = closing_of_word(osc, word_of(word), _count("k", k, 1))
    if start is None:
        points = closed_words(osc, closing)
    else:
        points = _from_start(closing, start, lambda tau, v: closed_words(osc, closing, (tau, v)))
    orbits = [orbit for orbit in _judged_points(osc, closing, points) if orbit.visible]
    if start is not None and not orbits:
        raise refuse("start", start, f"a state near a ({word}, {k}) orbit; Newton's method finds none")
    if digits is not None:
        orbits = [in_digits(osc, orbit, checked_digits(digits)) for orbit in orbits]
    return PeriodicOrbits(orbits, (SEARCHED if start is None else "found from the start given",))


def _count(name: str, value: Any, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= SETTINGS.most:
        more = ", or math.inf" if name == "n" else ""
        raise refuse(name, value, f"a whole number from {least} to {SETTINGS.most}{more}")
    return int(value)


def _all(osc: Oscillator, n: int, k: int) -> tuple[list[Array], tuple[str, ...] | None]:
    """Points of all solutions found, and why there may be others; None where `_doubts_of_two` decides."""
    linear = not names_in(osc.restitution) and linear_form(osc) is not None
    if n == 1 and linear:
        solutions = phases_and_speeds(osc, k)
        if solutions is not None:
            return [np.array(pair) for pair in zip(*solutions, strict=True)], ()
        return [], (
            f"every phase closes after one impact in {k} periods with its own velocity: a continuum of orbits, "
            "none is listed",
        )
    closing = Closing(family(osc), n, k)
    points = closed_from(closing, grid_of_starts(closing))
    return points, None if n == 2 and linear and not osc.plastic else (SEARCHED,)


def _limit_cycles(osc: Oscillator, n: Any, others: tuple[Any, ...]) -> PeriodicOrbits:
    """The limit cycles of n impacts of a model in which t does not occur."""
    require_rebound(osc, "a search for limit cycles")
    for name, value in zip(("k", "start", "v", "digits"), others, strict=True):
        if value is not None:
            raise refuse(
                name, value, f"no {name} for a model in which t does not occur: osc.periodic(n) lists its cycles"
            )
    if n in (0, np.inf):
        raise refuse("n", n, "a whole number from 1 to 1000: a cycle is listed with its impacts, none of which rests")
    count = _count("n", n, 1)
    points, continuum = cycles_found(osc, count)
    orbits = [orbit for orbit in _judged(osc, count, count, points) if orbit.visible]
    notes = (f"velocities return as they were after n = {count}: a continuum of orbits, none is listed",)
    return PeriodicOrbits(orbits, (CYCLES_SEARCHED,), notes if continuum else ())


def _doubts_of_two(osc: Oscillator, k: int, listed: list[PeriodicOrbit]) -> tuple[str, ...]:
    """Why there may be more orbits of two impacts of a linear model than those listed."""
    proved = two_impacts(osc, k)
    if proved is None:
        return (SEARCHED, "the free motion is in resonance with the forcing: no formulas for a proof")
    return _lacking(osc, (2, k), proved, "flight times", listed)


def _doubts_in_window(
    osc: Oscillator, counts: tuple[int, int], speeds: tuple[Fraction, Fraction], listed: list[PeriodicOrbit]
) -> tuple[str, ...]:
    """Why there may be more orbits of one or two impacts with all velocities in a window than those listed."""
    try:
        proved = closed_boxes(osc, *counts, speeds)
    except InputError as reason:
        return SEARCHED, f"f, g or rho is not analytic: {reason}"
    return _lacking(osc, counts, proved, "velocities", listed)


def _lacking(
    osc: Oscillator,
    counts: tuple[int, int],
    proved: tuple[list[Array], IsolatedZeros],
    unknown: str,
    listed: list[PeriodicOrbit],
) -> tuple[str, ...]:
    """Boxes that are not decided, and visible orbits next to points with a solution each that are not in a list."""
    (points, boxes), doubts, closing = proved, list[str](), Closing(family(osc), *counts)
    if not boxes.complete:
        number = f"{len(boxes.undecided)} boxes of phases and {unknown}, of {boxes.looked_at},"
        doubts.append(f"{number} are not decided")
    refined = [closing.newton(point) for point in points]
    if None in refined:
        doubts.append("Newton's method does not arrive at an orbit that exists")
    shown = _judged(osc, *counts, [root[0] for root in refined if root is not None])
    lacking = [
        orbit
        for orbit in shown
        if orbit.visible and not any(same_states(orbit, other, SETTINGS.apart) for other in listed)
    ]
    return (*doubts, *(f"the list lacks {orbit!r}" for orbit in lacking))


def _from_start(closing: Closing, start: Any, closed: Callable[[Array, Array], list[Array]]) -> list[Array]:
    """Points of the solutions that Newton's method finds from states that the caller gives.

    Parameters
    ----------
    closed : gives those from phases and velocities of the first impact.
    """
    n = closing.n
    if isinstance(start, PeriodicOrbit):
        start = list(zip(np.asarray(start.tau, dtype=float), np.asarray(start.v, dtype=float), strict=True))
    try:
        states = np.array([[as_float(constant("start", number)) for number in state] for state in _pairs(start)])
    except (TypeError, ValueError):
        raise refuse("start", start, "(tau, v), or n such pairs, or a PeriodicOrbit") from None
    if states.ndim != 2 or states.shape[1:] != (2,) or len(states) not in (1, n):
        raise refuse("start", start, f"(tau, v), or {n} such pairs, or a PeriodicOrbit")
    if len(states) == n:
        root = closing.newton(np.concatenate(states.T))
        return [] if root is None else [root[0]]
    return closed(states[:, 0], states[:, 1])


def _pairs(start: Any) -> list[Any]:
    rows = list(start)
    return [rows] if len(rows) == 2 and not np.ndim(rows[0]) else rows


def _judged(osc: Oscillator, n: int, k: int, points: list[Array]) -> list[PeriodicOrbit]:
    """Orbits of closed points, each once, in the order of the first phase; those that close sooner are left out."""
    closing = closing_of(osc, (0,) * n, k, ())
    assert isinstance(closing, Closing)
    return _judged_points(osc, closing, points)


def _judged_points(osc: Oscillator, closing: Closing, points: list[Array]) -> list[PeriodicOrbit]:
    """Orbits of closed points, as `_judged` gives them."""
    n = closing.n
    distinct: list[PeriodicOrbit] = []
    for point in points:
        if not (osc.plastic or point[n : 2 * n].max() > SETTINGS.least) or point[n : 2 * n].min() < -SETTINGS.least:
            continue
        orbit, fast = orbit_at(closing, point, osc), max(float(point[n : 2 * n].max()), 1e-300)
        once = repeats(closing, point, SETTINGS.apart, fast) == 1
        if once and not any(same_states(orbit, other, SETTINGS.apart) for other in distinct):
            distinct.append(orbit)
    return sorted(distinct, key=lambda orbit: (float(orbit.tau[0]), float(orbit.v[0])))


# ---- in many digits, by Newton's method in balls: nothing is proved


def in_digits(osc: Oscillator, rough: PeriodicOrbit, digits: int) -> PeriodicOrbit:
    """The orbit and its multipliers in many digits; `unresolved` where the next impacts are not its own to these."""
    states = [Fraction(float(number)) for state in zip(rough.tau, rough.v, strict=True) for number in state]
    small, miss, status = Fraction(1, 10 ** (digits + SPARE)), Fraction(float(rough.miss)), Status.unresolved
    half: Fraction | None = None
    product = Fraction(0)
    bits = ceil((digits + SPARE) * BITS_A_DIGIT) + 64
    with balls_at(bits):
        closing = BallClosing(osc, rough.k, digits + SPARE, bits, word=rough.walls)
        # refused where the orbit is virtual, or a flight is not shown to be its own: the status says so
        with suppress(Refused, ZeroDivisionError, ValueError):
            states = Krawczyk(closing, states, small).solved(states)
            miss = max(abs(as_rational(residual)) for residual in closing.miss(states).entries())
            total = return_slope(closing.slopes(states, small))
            half, product = as_rational((total[0, 0] + total[1, 1]) / 2), as_rational(total.det())
            closing.first_hits(states, small)
            status = Status.hit
    with digits_at(digits + 15) as mp:
        if half is None:
            multipliers = [mp.convert(complex(multiplier)) for multiplier in rough.multipliers]
        else:
            root = mp.sqrt(mp.mpc(mp.convert(half * half - product)))
            multipliers = sorted([half + root, half - root], key=abs, reverse=True)
        numbers = [mp.convert(state) for state in states]
        missed = mp.convert(miss)
    with digits_at(digits):
        tau, v, sizes = (
            np.array([for_user(+number) for number in row], dtype=object)
            for row in (numbers[::2], numbers[1::2], multipliers)
        )
        return replace(rough, tau=tau, v=v, multipliers=sizes, miss=for_user(+missed), status=np.int8(status))
