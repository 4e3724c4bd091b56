"""How much slower than a quiet machine this one is now, by the reference computation of `singimpact bench limit`."""

import time

from singimpact.bench import reference

UNIT = 2.5e-3
"""Seconds that the reference takes on the machine where limits in seconds were set."""


def slowness() -> float:
    """At least 1: a limit in seconds times this is a ratio to a reference of the same run."""
    start = time.process_time()
    for _ in range(20):
        reference()
    return max(1.0, (time.process_time() - start) / 20 / UNIT)
