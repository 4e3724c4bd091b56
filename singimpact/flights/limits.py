"""Thresholds of the impact map, each with its reason."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Where a flight is cut, and how much rounding is allowed for.

    Parameters
    ----------
    horizon_periods, horizon_time : default horizon with and without a period of g.
    horizon_radians : of the fastest motion of the model: no default horizon is later. A flight that long takes 0.6 s;
        where the forcing is a million times slower than the free motion, a thousand periods would take hours.
    longest_radians : of that motion: a horizon that is asked for beyond it is refused, as a flight that long takes half
        a minute, in compiled code that hears no interruption.
    safety : rounding allowed for, in units of epsilon times the size of the terms; a Horner sum of 25 terms is
        within 2.5 units in practice, a restart of the closed form within 3, so 8 covers both.
    likely : the same, as it is usually: hits of linear models with more than their condition explains are refined in
        balls (70 us), 22 of 100 random states.
    rough : a rounding of the flight time and of x' below this, relative, is never refined.
    polish_bits : of the balls that place a hit which double-double arithmetic leaves open (70 us).
    derivatives_at_rest : how many derivatives of a_c are tried for a mass at rest before it is called at rest for good.
    settled : launches at most that double arithmetic leaves undecided and that are settled in many digits; a settled
        launch costs about 20 ms, so a grid laid along a graze does not hang.
    settling_digits : digits of the first and of the last attempt; a touch that 120 digits do not tell from a graze is
        called a graze.
    cancelled : where x'' at a hit is below this part of g, it has lost ten bits and is computed in balls (40 us);
        next to a swan, 1e-12 from it, D G was off by 4e6 roundings without it.
    steps : Taylor steps of a flight at most, where the caller gives no number: about 0.8 s when they are interpreted; a
        thousand periods of an ordinary model take 10 000.
    settling_steps : the same in many digits, where a step takes milliseconds.
    longest : steps at most of a linear model, which its horizon ends before.
    traced : steps kept for the errors of a flight; longer flights, one of 10^4, are flown again with more room.
    judging : tolerance of the steps that carry errors and conditions along.
    margin : times the estimate of the error of a Taylor flow: of 720 hits the true error was at most 1.3 times it.
    interpreted_linear, interpreted_taylor : seconds of a flight whose kernels are interpreted.
    patience : seconds of interpreted iterations after which this process compiles them itself.
    guard : digits beyond those asked for; half of the digits go in a square root at a graze, so agreement of two
        runs is what is trusted, not this number.
    """

    horizon_periods: float = 1000.0
    horizon_time: float = 1e4
    horizon_radians: float = 2e5
    longest_radians: float = 1e7
    safety: float = 8.0
    likely: float = 4.0
    rough: tuple[float, float] = (1e-14, 1e-13)
    polish_bits: int = 192
    derivatives_at_rest: int = 12
    settled: int = 200
    settling_digits: tuple[int, int] = (50, 120)
    cancelled: float = 2.0**-10
    steps: int = 16_000
    longest: int = 10_000_000
    settling_steps: int = 400
    traced: int = 400
    judging: float = 1e-12
    margin: float = 2.5
    guard: int = 15
    interpreted_linear: float = 8e-5
    interpreted_taylor: float = 3e-3
    patience: float = 3.0


LIMITS = Limits()


def degree_for(epsilon: float) -> int:
    """Degree of a Taylor step: the cheapest one for a step whose error is epsilon is near -log(epsilon)/1.5.

    Examples
    --------
    >>> degree_for(2.0**-52), degree_for(1e-6)
    (24, 9)
    """
    from math import ceil, log

    return max(8, ceil(-log(epsilon) / 1.5) - 1)
