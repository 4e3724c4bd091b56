"""`bench public`: the twelve calls of the page on run times, beside heyoka, scipy and a student's loops of numba.

Cases of the map, of chatter and of orbits under names of one kind, with the loops beside them; and two studies, of
which only the time is measured: no truth of a picture is known.  Below them are the rows of `bench regions`, `ensemble`
and `fit`.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import chain
from typing import Any

import numpy as np

import singimpact as si
from singimpact.algebra.numbers import Array
from singimpact.bench.drawn import CHATTERING, CLEARANCES, OMEGAS, Draws, Problem, States, counted
from singimpact.bench.groups.impact_map_rows import (
    ACCURACY,
    HEYOKA,
    SCIPY,
    between,
    derivative_case,
    map_case,
    phases_case,
    sizes_of,
    states_case,
    summed,
    taylor_stepper,
    true_impacts,
)
from singimpact.bench.measuring import NO_AIM, Aim, Case, Counted, Effort, Method, with_peers
from singimpact.bench.peers import fixed_steps, followed_impacts
from singimpact.dynamics.orbit import Orbit

TWO_BASINS = si.linear("2.8", "0.1", "0.8", amplitude=-1)
FIRST = (1, 2, 3, 4, 5)  # impacts of each orbit that are judged
OVER = (-0.1, 0.25)  # clearances of the bifurcation diagram


def cases(effort: Effort) -> Iterator[Case]:
    """The twelve cases."""
    maps = {
        "linear, a state a call": ("linear", "generic", True),
        "linear, an array": ("linear", "generic", False),
        "linear, v from 1e-8 to 1e-2": ("linear", "v from 1e-8 to 1e-2", False),
        "Duffing, a state a call": ("duffing", "generic", True),
        "Duffing, an array": ("duffing", "generic", False),
    }
    for name, (family, kind, alone) in maps.items():
        case = map_case(family, kind, alone, sizes_of(effort))
        yield _beside(f"impact_map: {name}", case, _flown(family, kind, effort))
    yield _beside("derivative: linear, an array", derivative_case(sizes_of(effort)))
    for name, family in (("linear", "linear"), ("Duffing", "duffing")):
        yield _beside(f"orbit: {name}, an impact", _orbit_case(family, effort), _orbits(family))
    # a student ends a chatter as the other peers do, and bisects as they do
    limits = states_case(CHATTERING, 0.9, 1, effort)
    few = Draws(CHATTERING, "chattering", 5, restitution=0.9)
    yield _beside("chatter_limit: linear, a state", limits, summed("numba", fixed_steps.fly, few))
    thresholds = phases_case(0.5, effort)
    phase = Draws("linear", "chattering", 1, restitution=0.5)
    yield _beside("threshold: linear, a phase", thresholds, between("numba", fixed_steps.fly, phase))
    yield Case("basins: linear, a pixel", _basins(effort))
    yield Case("bifurcation: linear, a value", _diagrams(effort))


def _beside(title: str, case: Case, *loops: Method) -> Case:
    """A case with loops: the first call of the package, the peers by the names of their programs, the loops."""
    own, *others = case.methods
    # "heyoka, terminal event" is heyoka; further settings of the package have no column
    peers = [
        replace(method, name=method.name.partition(",")[0].split()[0], aim=NO_AIM)
        for method in others
        if not method.name.startswith("singimpact")
    ]
    return replace(case, name=title, methods=[replace(own, name="singimpact", aim=NO_AIM), *peers, *loops])


def _orbit_case(family: str, effort: Effort) -> Case:
    """Every run has several orbits; impacts are counted that were flown, not the ones that a sum stands for."""
    starts, impacts = 4 if effort.quick else 10, 1000
    few = (2, 20) if effort.quick else (10, 100)
    draw = partial(Draws, family, "generic", restitution=0.9)
    own = [Method("singimpact, orbit", f"{impacts} impacts a call", partial(_own_orbits, impacts), draw=draw(starts))]
    methods, skipped = with_peers(
        own,
        lambda: [_chained(HEYOKA, taylor_stepper(family), draw(starts), few[1])],
        lambda: [_chained(SCIPY, followed_impacts.scipy_stepper(family, ACCURACY[SCIPY]), draw(few[0] // 2), 10)],
    )
    # a flight of Duffing's model takes 80 ms in balls
    truth, kappas = true_impacts(draw(starts)(), starts if family == "linear" else 2, FIRST)
    return Case(f"{family}, an impact of an orbit", methods, truth, kappas, skipped)


def _own_orbits(impacts: int, states: States) -> Counted:
    orbits = [states.osc.orbit(tau, v, impacts) for tau, v in zip(states.tau.tolist(), states.v.tolist(), strict=True)]
    # a completed chatter is one entry for infinitely many impacts, and is not counted
    flown = sum(int(np.count_nonzero(orbit.kind == "impact")) for orbit in orbits)
    return Counted(flown, list(chain.from_iterable(orbit.tau[list(FIRST)].tolist() for orbit in orbits)))


def _chained(name: str, fly: followed_impacts.Fly, draw: Draws, impacts: int) -> Method:
    def run(problems: Any) -> Counted:
        times = [followed_impacts.chain(fly, problem, impacts) for problem in problems]
        return Counted(impacts * len(times), [each[number - 1] for each in times for number in FIRST])

    setting = f"tolerance {ACCURACY[name]:.0e}, {counted(draw.count, 'state')}, {impacts} impacts"
    return Method(name, setting, run, draw=lambda: draw().problems())


def _numbers(states: States) -> Array:
    return fixed_steps.numbers(states.family, OMEGAS[states.family], CLEARANCES[states.family])


def _flown(family: str, kind: str, effort: Effort) -> Method:
    count = 10 * effort.judged
    return Method(
        "numba",
        f"{count} states",
        lambda states: fixed_steps.flights(states.tau, states.v, _numbers(states)),
        problems=count,
        draw=Draws(family, kind, count),
    )


def _orbits(family: str) -> Method:
    def run(states: States) -> Counted:
        pairs = zip(states.tau.tolist(), states.v.tolist(), strict=True)
        rows = [fixed_steps.orbit(*pair, 100, states.restitution, _numbers(states))[:, 0] for pair in pairs]
        return Counted(int(np.isfinite(rows).sum()), np.array(rows)[:, np.array(FIRST) - 1].ravel().tolist())

    return Method("numba", "100 impacts", run, draw=Draws(family, "generic", 10, restitution=0.9))


def _basins(effort: Effort) -> list[Method]:
    """A student flies 200 impacts from each state, and looks at the last ten."""
    side, few = (40, 10) if effort.quick else (400, 20)
    tau, v = (axis.ravel().tolist() for axis in np.meshgrid(np.linspace(0, 2, few), np.linspace(0.01, 2, few)))
    n = fixed_steps.numbers("linear", 2.8, 0.1, -1.0)
    own = partial(si.basins, TWO_BASINS, size=side)
    return [
        timed("singimpact", f"{side} x {side}", side**2, own),
        timed(
            "numba",
            f"{few} x {few}",
            few**2,
            lambda: [fixed_steps.orbit(*state, 200, 0.8, n)[-10:] for state in zip(tau, v, strict=True)],
        ),
    ]


def _diagrams(effort: Effort) -> list[Method]:
    count, few = (20, 5) if effort.quick else (300, 20)
    own = partial(si.bifurcation, TWO_BASINS, "clearance", OVER, points=count)
    # of 260 impacts at each clearance the first 200 are not drawn, because the orbit settles in them
    models = [fixed_steps.numbers("linear", 2.8, c, -1.0) for c in np.linspace(*OVER, few)]
    return [
        timed("singimpact", f"{count} values", count, own),
        timed("numba", f"{few} values", few, lambda: [fixed_steps.orbit(0.0, 0.1, 260, 0.8, n)[200:] for n in models]),
    ]


# `bench regions`, `ensemble` and `fit`: many models, orbits and impacts, beside a user's loops over scipy and numba. At
# two sizes or more, so that it shows how time grows. A picture of classes has no known truth, and the orbits of an
# ensemble are chaotic: only their time is measured. A fit to impacts without noise has the numbers that they came from.

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
    fly = followed_impacts.scipy_stepper(places[0].family, ACCURACY[SCIPY])
    calls = [partial(followed_impacts.chain, fly, each, SETTLING) for each in places]
    return [timed(SCIPY, setting, len(places), lambda: [call() for call in calls])]


def ensemble(effort: Effort) -> Iterator[Case]:
    """A ball on a shaken table that comes to rest again and again, and members of a family, an impact."""
    rng, impacts, few = np.random.default_rng(7), 100 if effort.quick else 400, 500 if effort.quick else 1000
    tau, v = rng.uniform(0, 2 * np.pi, 10 * few), rng.uniform(0, 3, 10 * few)

    def flown(orbits: int, each: int) -> Method:
        call = partial(si.ensemble, BALL, tau[:orbits], v[:orbits], impacts=each)
        return timed("singimpact, ensemble", f"{orbits} orbits, {each} impacts", orbits * each, call, Aim(1.0))

    alone = [partial(BALL.orbit, *state, impacts) for state in zip(tau[:20].tolist(), v[:20].tolist(), strict=True)]
    item = timed("singimpact, orbit", "one after the other", len(alone) * impacts, lambda: [call() for call in alone])
    yield Case("bouncing ball, more orbits, an impact", [flown(few, impacts), flown(10 * few, impacts), item])
    yield Case("bouncing ball, longer orbits, an impact", [flown(few, impacts), flown(few, 4 * impacts)])
    families = [
        timed("singimpact, family", f"{n} members", 300 * n, family_of(MODELS["linear"], n)) for n in (few, 4 * few)
    ]
    yield Case("linear, members of a family, an impact", families)


def fit(effort: Effort) -> Iterator[Case]:
    """Restitution and clearance from impacts without noise, an impact."""
    true, names = MODELS["linear"].replace(clearance="0.1"), ("restitution", "clearance")
    start, own, peers = true.replace(clearance="0.15", restitution="0.7"), [], []
    counts = (30, 60) if effort.quick else (60, 240, 960)
    for count in counts:
        seen = true.orbit(0.3, 0.4, count)
        call = partial(si.fit, start, {"tau": seen.tau, "v": seen.v}, names)
        setting = f"{count} impacts"
        own.append(Method("singimpact, fit", setting, lambda call=call: list(call().values.values()), problems=count))
        peers.append(Method(SCIPY, f"curve_fit, {setting}", partial(_scipy_fit, seen), problems=count))
    # times are known to their own roundings, which grow beside a flight
    yield Case("numbers from impacts, an impact", [*own, *peers], [0.8, 0.1], [float(counts[-1])] * 2)


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
