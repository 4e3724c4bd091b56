"""`bench ensemble`: many orbits through chatter and rest, beside one after the other; and calls of many models.

Only time is measured, at two sizes, so that it shows how time grows: the orbits of an ensemble are chaotic.
"""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

import singimpact as si
from singimpact.bench.measuring import NO_AIM, Aim, Case, Effort, Method

BALL = si.ImpactOscillator("1", "1.9*sin(t)", 0, "1/2")


def ensemble(effort: Effort) -> Iterator[Case]:
    """A ball on a shaken table that comes to rest again and again, an impact."""
    rng, impacts, rows = np.random.default_rng(7), 100 if effort.quick else 400, []
    for count in (500, 1000) if effort.quick else (1000, 10_000):
        tau, v = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 3, count)
        call = partial(si.ensemble, BALL, tau, v, impacts=impacts)
        rows.append(timed("singimpact, ensemble", f"{count} orbits", count * impacts, call, Aim(1.0)))
    few = [
        partial(BALL.orbit, float(time), float(speed), impacts) for time, speed in zip(tau[:20], v[:20], strict=True)
    ]
    item = timed("singimpact, orbit", "one after the other", len(few) * impacts, lambda: [call() for call in few])
    yield Case("bouncing ball, an impact", [*rows, item])


def family_of(model: si.ImpactOscillator, members: int) -> Callable[[], object]:
    """300 impacts of a state of each of so many models."""
    many = model.over(restitution=np.linspace(0.6, 0.9, members))
    return lambda: many.iterate(0.3, 0.7, 300)


def one_by_one(model: si.ImpactOscillator, times: int) -> Callable[[], object]:
    """300 impacts of a state of one model, so many times."""
    return lambda: [model.iterate(0.3, 0.7, 300) for _ in range(times)]


def timed(name: str, setting: str, problems: int, call: Callable[[], object], aim: Aim = NO_AIM) -> Method:
    """A method whose answers nobody judges."""

    def run() -> list[None]:
        call()
        return [None]

    return Method(name, setting, run, problems=problems, aim=aim)
