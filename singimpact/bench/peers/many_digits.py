"""mpmath at the working precision: `findroot` on the closed form of a flight."""

from typing import Any

from singimpact.bench.problems import Problem

SCAN = 0.05  # step of the scan for a change of sign, as a user would choose it: a hundredth of a period
LONGEST = 1000.0
GUARD = 20  # digits that (x - c)/s may lose: without them the secant never settles for v below 1e-3, and fails


def root_of_closed_form(problem: Problem) -> tuple[Any, Any]:
    """First root of (x - c)/s of the linear oscillator, omega != 1, from a guess; time and velocity, nan if none.

    The guess is 2v/|a_c| where the obstacle presses, else the first change of sign of a scan.
    """
    import mpmath

    with mpmath.extradps(GUARD):
        found = _closed(problem, mpmath.mpf(10) ** (GUARD - mpmath.mp.dps))
    return +found[0], +found[1]


def _closed(problem: Problem, precise: Any) -> tuple[Any, Any]:
    import mpmath

    omega, c, tau, v = (mpmath.mpf(value) for value in (problem.omega, problem.clearance, problem.tau, problem.v))
    size = 1 / (1 - omega**2)
    by_cos, by_sin = c - size * mpmath.cos(omega * tau), v + size * omega * mpmath.sin(omega * tau)

    def lifted(s: Any) -> Any:
        return (size * mpmath.cos(omega * (tau + s)) + by_cos * mpmath.cos(s) + by_sin * mpmath.sin(s) - c) / s

    a = mpmath.cos(omega * tau) - c
    near = -2 * v / a if a < 0 else mpmath.inf
    guesses = (near, near * 1.05) if near < SCAN else _scanned(lifted)
    try:
        time = mpmath.findroot(lifted, guesses, tol=precise * guesses[0])
    except (ValueError, ZeroDivisionError):  # there is none, or it did not converge
        return mpmath.nan, mpmath.nan
    slope = -size * omega * mpmath.sin(omega * (tau + time)) - by_cos * mpmath.sin(time) + by_sin * mpmath.cos(time)
    return time, slope


def _scanned(lifted: Any) -> tuple[Any, Any]:
    """The ends of the first step of the scan at which x < c.

    Raises
    ------
    ValueError : none before the longest flight.
    """
    import mpmath

    s = mpmath.mpf(SCAN)
    while s < LONGEST:
        if lifted(s) < 0:
            return s - SCAN + mpmath.eps, s
        s += SCAN
    raise ValueError("no change of sign")
