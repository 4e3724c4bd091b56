"""`bench regions`, `ensemble` and `fit`: many models, orbits and impacts, beside a user's loops over scipy and numba.

At two sizes or more, so that it shows how time grows. A picture of classes has no known truth, and the orbits of an
ensemble are chaotic: only their time is measured. A fit to impacts without noise has the numbers that they came from.
"""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

import singimpact as si
from singimpact.algebra.numbers import Array
from singimpact.bench.drawn import Problem
from singimpact.bench.groups.impact_map_rows import ACCURACY, SCIPY
from singimpact.bench.measuring import NO_AIM, Aim, Case, Effort, Method, with_peers
from singimpact.bench.peers import fixed_steps, followed_impacts
from singimpact.dynamics.orbit import Orbit

MODELS = {
    "linear": si.linear("2.8", 0, "0.8"),
    "duffing": si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", 0, "0.8", {"omega": "1.7"}),
}
BALL = si.ImpactOscillator("1", "1.9*sin(t)", 0, "1/2")
WINDOWS = {"linear": ((1.5, 5), (-0.3, 0.5)), "duffing": ((0.8, 3), (0.0, 0.5))}
# microseconds of a place: 30 s and 120 s of CPU for 400 x 400
PLACES = {"linear": 187.5, "duffing": 750.0}
SETTLING = 300  # impacts of each place in a user's own loop


def square(family: str, size: int) -> object:
    """Periods over frequency and clearance, of so many values each."""
    return si.regions(MODELS[family], ("omega", "clearance"), WINDOWS[family], size=size)


def regions(effort: Effort) -> Iterator[Case]:
    """Regions over frequency and clearance, a place."""
    for family in MODELS:
        sizes = (20, 40) if effort.quick else (100, 200, 400) if family == "linear" else (50, 100)
        own = [
            timed("singimpact, regions", f"{n} x {n}", n**2, partial(square, family, n), Aim(PLACES[family]))
            for n in sizes
        ]
        omegas, clearances = WINDOWS[family]
        places = [Problem(family, omega, c, 0.8, 0.0, 0.1) for omega in omegas for c in clearances]
        setting = f"{SETTLING} impacts a place"
        methods, skipped = with_peers(own, partial(_numba, setting, places), partial(_scipy, setting, places[:1]))
        yield Case(f"{family}, periods over omega and c, a place", methods, skipped=skipped)


def _numba(setting: str, places: list[Problem]) -> list[Method]:
    """A student's loop, of so many impacts a place."""

    def call() -> None:
        for each in places:
            numbers = fixed_steps.numbers(each.family, each.omega, each.clearance)
            fixed_steps.orbit(each.tau, each.v, SETTLING, each.restitution, numbers)

    return [timed("numba", setting, len(places), call)]


def _scipy(setting: str, places: list[Problem]) -> list[Method]:
    """A loop over events of scipy."""
    fly = followed_impacts.scipy_stepper(places[0].family, ACCURACY[SCIPY])
    calls = [partial(followed_impacts.chain, fly, each, SETTLING) for each in places]
    return [timed(SCIPY, setting, len(places), lambda: [call() for call in calls])]


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


def fit(effort: Effort) -> Iterator[Case]:
    """Restitution and clearance from impacts without noise, an impact."""
    true, names = MODELS["linear"].replace(clearance="0.1"), ("restitution", "clearance")
    start = true.replace(clearance="0.15", restitution="0.7")
    for count in (30, 60) if effort.quick else (60, 240, 960):
        seen = true.orbit(0.3, 0.4, count)
        call = partial(si.fit, start, {"tau": seen.tau, "v": seen.v}, names)
        # times are known to their own roundings, which grow beside a flight
        own = Method("singimpact, fit", "", lambda call=call: list(call().values.values()), problems=count)
        yield Case(
            f"numbers from {count} impacts, an impact",
            [own, Method(SCIPY, "curve_fit of single flights", partial(_scipy_fit, seen), problems=count)],
            [0.8, 0.1],
            [float(count)] * 2,
        )


def _scipy_fit(seen: Orbit) -> list[float]:
    """A user's own fit: each measured impact flown to the next one."""
    from scipy.optimize import curve_fit

    fly, states = followed_impacts.scipy_stepper("linear", ACCURACY[SCIPY]), np.stack([seen.tau, seen.v], axis=1)

    def following(states: Array, r: float, c: float) -> Array:
        flown = np.array([fly(Problem("linear", 2.8, c, r, *state)) for state in states.tolist()])
        return np.asarray(flown * [1, -r] + states * [1, 0]).ravel()

    return list(curve_fit(following, states[:-1], states[1:].ravel(), [0.7, 0.15])[0])


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
