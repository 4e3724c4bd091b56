"""Launches so late that doubles lose their phase, where g has no period that takes them in."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.status import Status


def first_return(start, v, c, a, b):
    """The first time at which x'' + x = cos(a t) + cos(sqrt(b) t) is back at c, from its closed form in 60 digits."""
    with mpmath.workdps(60):
        rates, y, c = (mpmath.mpf(a), mpmath.sqrt(b)), mpmath.mpf(start), mpmath.mpf(c)
        forced = [(mpmath.cos(w * y) / (1 - w**2), w * mpmath.sin(w * y) / (w**2 - 1)) for w in rates]
        p, q = c - sum(x for x, _ in forced), mpmath.mpf(v) - sum(slope for _, slope in forced)

        def distance(s):
            return sum(mpmath.cos(w * (y + s)) / (1 - w**2) for w in rates) + p * mpmath.cos(s) + q * mpmath.sin(s) - c

        s = mpmath.mpf("0.01")
        while distance(s) > 0:
            s += mpmath.mpf("0.01")
        return float(mpmath.findroot(distance, (s - mpmath.mpf("0.01"), s), solver="anderson"))


@pytest.mark.parametrize("seed", range(4))
def test_the_error_of_late_launches_without_a_period_is_true(seed):
    """first_hit(2**53 + 1, 0.7) of cos t + cos(sqrt(2) t) said 1.03 +- 0.15 for 4.32; 1e15, +- 7e-15 for 5e-4."""
    generator = np.random.default_rng(seed)
    hits = 0
    for _ in range(12):
        a, b, c = round(generator.uniform(1.5, 4), 2), int(generator.choice([2, 3, 5, 7])), "-0.1"
        osc = si.ImpactOscillator("x", f"cos({a}*t) + cos(sqrt({b})*t)", c, "0.6")
        late = 10 ** generator.uniform(5, 18)
        for start in (float(late), f"{late:.1f}"[:-2] + ".3", int(late) + 1):
            truth = first_return(start, "0.7", c, str(a), b)
            calls = [osc.first_hit(start, "0.7"), osc.impact_map(start, "0.7")]
            if isinstance(start, float):
                calls += [osc.first_hit(start, 0.7), osc.first_hit(np.array([start, 1.0]), 0.7)]
            for found in calls:
                time, status = np.ravel(found.flight_time)[0], np.ravel(found.status)[0]
                assert status == Status.hit
                assert abs(time - truth) <= 2 * np.ravel(found.error)[0] * max(truth, 1) + 1e-13
                hits += 1
    assert hits == 12 * (4 + 2 + 2)


def test_of_many_late_launches_in_one_call_those_beyond_a_limit_are_unresolved():
    osc = si.ImpactOscillator("x", "cos(2*t) + cos(sqrt(3)*t)", "-0.1", "0.6")
    found = osc.first_hit(1e17 + 64 * np.arange(260), 0.7)
    assert (found.status == Status.hit).sum() == 200
    assert (found.status == Status.unresolved).sum() == 60
    assert "digits=" in found.sentence[-1]
