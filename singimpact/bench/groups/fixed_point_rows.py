"""`bench fixed-points`: m3 and mu of the blown-up map at a tangency by digits, and 1 - lambda as r -> 1."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from typing import Any

from singimpact.bench.measuring import Case, Effort, Method
from singimpact.bench.peers import many_digits
from singimpact.theory.fixed_points import tangency

# what is asked, by the restitution and the places in (1 - lambda, m3, mu)
ASKED = {"m3 and mu, r = 1/2": ("1/2", slice(1, 3)), "1 - lambda, r = 1 - 1e-9": ("0.999999999", slice(0, 1))}
DIGITS = (15, 50, 100, 200)
SPARE = 20  # digits of the truth beyond the most asked for; its radius is proved


def cases(effort: Effort) -> Iterator[Case]:
    """Two cases; next to r = 1 the difference 1 - lambda cancels, and its condition with respect to r is 1e9."""
    digits = DIGITS[:3] if effort.quick else DIGITS
    for name, (r, columns) in ASKED.items():
        ways = (("singimpact, certified", "digits", _own), ("mpmath findroot", "dps", _findroot))
        methods = [
            Method(way, f"{word} {d}", partial(_part, function, r, columns, d), epsilon=10.0**-d)
            for way, word, function in ways
            for d in digits
        ]
        methods.append(Method("numpy roots", "doubles", lambda r=r, columns=columns: _numpy(r)[columns]))
        yield Case(name, methods, _own(r, DIGITS[-1] + SPARE)[columns], _conditions(r)[columns])


def _part(function: Callable[[str, int], list[Any]], r: str, part: slice, digits: int) -> list[Any]:
    return function(r, digits)[part]


def _own(r: str, digits: int) -> list[Any]:
    found = tangency(r, digits)
    return [found.one_minus_lambda.value, found.m3.value, found.mu.value]


def _conditions(r: str) -> list[float]:
    """1 + |r dF/dr|/|F|, by differences in 60 digits."""
    rate, step = Fraction(r), Fraction(1, 10**14)
    ends = [_own(str(rate * (1 + sign * step)), 60) for sign in (-1, 1)]
    return [1 + abs(float((b - a) / a)) * float(1 / (2 * step)) for a, b in zip(*ends, strict=True)]


def _findroot(r: str, digits: int) -> list[Any]:
    import mpmath

    with mpmath.workdps(digits):
        return list(many_digits.fixed_points(r))


def _numpy(r: str) -> list[float]:
    """The cubic lambda^2 (lambda + 2) - r (2 lambda + 1) by its companion matrix."""
    import numpy as np

    rate = float(Fraction(r))
    (lambda_,) = [root.real for root in np.roots([1, 2, -2 * rate, -rate]) if root.real > 0]
    return [1 - lambda_, lambda_ + 0.5, ((lambda_ + 2) / (2 * lambda_ + 1)) ** 2 / lambda_]
