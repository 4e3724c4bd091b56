"""Limits and tolerances of the impact map, each with its reason."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Horizons, allowances for rounding errors, and budgets of a flight."""

    # default horizon, in periods of g; in units of time for a g without a period
    horizon_periods: float = 1000.0
    horizon_time: float = 1e4
    # default horizon at most, in radians of the fastest motion of the model: such a flight takes 0.6 s. With a forcing
    # a million times slower than the free motion, 1000 periods would take hours
    horizon_radians: float = 2e5
    # horizon that may be requested, in the same radians: such a flight takes 30 s, in compiled code that does not stop
    # at an interruption
    longest_radians: float = 1e7
    # bound of the rounding error, in units of epsilon times the size of the terms: measured are 2.5 for a Horner sum of
    # 25 terms and 3 for a restart of the closed form
    safety: float = 8.0
    # the same in practice; hits of linear models above it, 22 % of random states, are refined in balls (70 us)
    likely: float = 4.0
    # relative rounding errors of the flight time and of x' below which a hit is never refined
    rough: tuple[float, float] = (1e-14, 1e-13)
    # relative error above which a flight of a late launch, whose time no period takes in, is not decided by doubles: at
    # 0.03 another impact came first
    vague: float = 1e-2
    # bits of the balls that refine a hit which double-double arithmetic leaves open (70 us)
    refine_bits: int = 192
    # derivatives of a_c that are tested before a mass at rest is said to rest for ever
    derivatives_at_rest: int = 12
    # launches in one call that are decided in many digits after doubles left them undecided: 20 ms each, so a grid
    # along a graze ends within seconds
    settled: int = 200
    # digits of the first and the last attempt; a touch that 120 digits do not separate from a graze is a graze
    settling_digits: tuple[int, int] = (50, 120)
    # x'' at a hit below this part of g has lost ten bits and is computed in balls (40 us): at 1e-12 from a swan D G had
    # an error of 4e6 roundings without this
    cancelled: float = 2.0**-10
    # Taylor steps of a flight by default: 0.8 s if interpreted; 1000 periods of an ordinary model take 10 000 steps
    steps: int = 16_000
    # the same times the price of a step at most, in sums of 10 to 25 us: x + x^3 + tanh(5 x') has a price of 5.5
    steps_by_price: float = 88_000
    # steps of a linear model, which its horizon ends before
    longest: int = 10_000_000
    # Taylor steps in many digits, at some milliseconds each
    settling_steps: int = 400
    # the same times the price of a step, at most
    settling_by_price: float = 2400
    # steps stored for the error estimate; a longer flight, one of 10^4, is flown again with more memory
    traced: int = 400
    # tolerance of the steps of the variational equation, which carries errors and condition numbers
    judging: float = 1e-12
    # factor on the error estimate of a Taylor flow: on 720 hits the true error was at most 1.3 times the estimate
    margin: float = 2.5
    # digits beyond the requested ones; at a graze the square root loses half of all digits, so the result is accepted
    # by the agreement of two runs, not by this number
    guard: int = 15
    # s of one flight with interpreted kernels: linear, and by Taylor steps
    interpreted_linear: float = 8e-5
    interpreted_taylor: float = 3e-3
    # price of derivatives of a Taylor flow beside that of the flight: 20 to 40 ms of interpreted kernels were measured
    varied: int = 10


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
