"""Numbers of the article on border orbits at contacts of every order."""

from __future__ import annotations

from functools import cache
from math import isclose
from typing import Any

import mpmath
import numpy as np

import singimpact as si
from singimpact.algebra.numbers import as_float
from singimpact.paper.trials.universal_foot import elastic

SWAN = 2 / 3**1.5
FAMILIES = {
    "$x'' + x$": si.ImpactOscillator("x", "cos(1.7*t) + b*sin(3.4*t)", 0, "1/2", {"b": 0}),
    "$x'' + 0.3x' + x + x^3$": si.ImpactOscillator(
        "x + 0.3*xdot + x**3", "cos(1.7*t) + b*sin(3.4*t)", 0, "1/2", {"b": 0}
    ),
    "$x'' + 0.1x' + \\sin x$": si.ImpactOscillator("sin(x) + 0.1*xdot", "cos(2*t) + b*sin(4*t)", 0, "1/2", {"b": 0}),
}
WINDOWS = (-0.9, 0.9), (-1, 1)  # of the clearance and of b
DEPTHS = -0.1, -0.01, -0.001


def cubic(r: str) -> si.ImpactOscillator:
    return si.ImpactOscillator("0", "t**3 - t + q", 0, r, {"q": "-1/4"})


@cache
def kappa(r: str, digits: int) -> Any:
    """kappa_* as it is certified."""
    rate = float(r)
    ends = (-SWAN + 1e-7, -0.36) if rate > 0.94 else (-0.3848, -0.1295)
    (found,) = si.border_orbits(cubic(r), "q", ends, points=5, digits=digits)
    return found.certified


@cache
def tends() -> dict[str, list[float]]:
    """q/|p|^(3/2) of border orbits beside a contact of order three of each family, at each depth."""
    rows = {}
    for name, family in FAMILIES.items():
        point = next(one for one in si.contact_points(family, 3, ("clearance", "b"), WINDOWS) if one.sign > 0)
        ratios = []
        for p in DEPTHS:
            ends = [point.unfolded(quotient * abs(p) ** 1.5, p) for quotient in (-0.36, -0.15)]
            ratios.append(ratio_of(ends))
        rows[name] = ratios
    return rows


def ratio_of(ends: list[si.ImpactOscillator]) -> float:
    """q/|p|^(3/2) of the zeros of a_c of the border orbit between two models."""
    found, *_ = si.border_orbits(ends[0], "clearance", sorted(as_float(model.clearance) for model in ends), points=12)
    period = as_float(found.oscillator.period)
    zeros = [zero.tau for zero in si.tangency_points(found.oscillator)]
    turned = sorted(float(np.mod(zero - found.release + period / 4, period)) for zero in zeros)[:3]
    roots = np.array(turned) - np.mean(turned)
    p, q = roots[0] * roots[1] + roots[0] * roots[2] + roots[1] * roots[2], -np.prod(roots)
    return float(q / abs(p) ** 1.5)


@cache
def drawn(count: int) -> tuple[int, int]:
    """Of polynomials of order 4 to 7 with drawn zeros: how many there are, and how many have one border orbit."""
    rng, single = np.random.default_rng(7), 0
    for _ in range(count):
        order = int(rng.integers(4, 8))
        others = np.round(np.cumsum(rng.uniform(0.4, 1.2, order - 1)), 3).tolist()
        product = "*".join(f"(t - {zero})" for zero in others)
        forcing = f"{(-1) ** (order - 1)}*(t - u)*{product}"
        osc = si.ImpactOscillator("0", forcing, 0, str(round(rng.uniform(0.1, 0.9), 3)), {"u": -1})
        found = si.border_orbits(osc, "u", (others[0] - 6, others[0] - 0.01), points=80)
        own = [orbit for orbit in found if isclose(orbit.release, float(orbit.parameter), abs_tol=1e-9)]
        single += [isclose(orbit.end, others[1], abs_tol=1e-6) for orbit in own].count(True) == 1
    return count, single


def numbers(quick: bool) -> dict[str, Any]:
    """What the text prints."""
    digits = 16 if quick else 30
    rates = (
        ("0.05", "0.5") if quick else ("0.05", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "0.95")
    )
    series = [-225 * 19**0.5 / 13718, -2625 * 57**0.5 / 260642 - 225 * 38**0.5 / 109744]
    left = []
    for exponent in (4, 6) if quick else (4, 6, 8):
        (found,) = si.border_orbits(cubic(f"1e-{exponent}"), "q", ("-0.15", "-0.129"), points=5, digits=25)
        root = mpmath.mpf(10) ** (-exponent // 2)
        rest = found.parameter + 56 / mpmath.mpf(57) ** 1.5 - series[0] * root - series[1] * root**2
        left.append((exponent, f"{float(rest / root**3):.4f}"))
    law = near_one()
    ratios = [(r, f"{over_law(r) / law:.4f}") for r in ("0.9", "0.99", "0.999")]
    models, single = drawn(2 if quick else 40)
    low, high = elastic().invariant
    return {
        "table": [(r, str(kappa(r, digits))) for r in rates],
        "digits": digits,
        "half": str(kappa("0.5", digits)),
        "rested": f"{-56 / 57**1.5:.12f}",
        "coefficients": [f"{value:.7f}" for value in series],
        "left": left,
        "law": f"{law:.7f}",
        "ratios": ratios,
        "u": (f"{float(low):.8f}", f"{float(high):.8f}"),
        "elastic_impacts": elastic().impacts,
        "models": models,
        "single": single,
        "depths": DEPTHS,
        "tends": {name: [f"{ratio:.5f}" for ratio in row] for name, row in tends().items()},
        "graze": f"{-2 * 2**0.5 / 27:.6f}",
        "swan": f"{SWAN:.6f}",
    }


def near_one() -> float:
    """C of kappa_* + 2/3^(3/2) = C (1 - r)^(6/7)."""
    u = float(sum(elastic().invariant) / 2)
    return float(3**1.5 * (4 * np.pi * 12 ** (2 / 3) / (81 * 3**0.5 * u)) ** (6 / 7))


@cache
def over_law(r: str) -> float:
    """(kappa_* + 2/3^(3/2))/(1 - r)^(6/7)."""
    ends = ("-0.3849", "-0.37") if float(r) > 0.95 else ("-0.3848", "-0.13")
    (found,) = si.border_orbits(cubic(r), "q", ends, points=5)
    return float((float(found.parameter) + SWAN) / (1 - float(r)) ** (6 / 7))
