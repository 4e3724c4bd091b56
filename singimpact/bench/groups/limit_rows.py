"""`bench limit`: public calls beside the figures to reach, as ratios to a reference computation of the same run.

The ratios are stored beside the code; `singimpact bench limit` ends with exit code 1 where a row takes more than half
again as long as its stored ratio allows, and `--store` stores those of the run.  A busy or slow machine slows the
reference too, so that ratios hardly depend on it.
"""

import json
import tempfile
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import count
from pathlib import Path

import numpy as np

import singimpact as si
from singimpact.algebra.numbers import Array
from singimpact.bench.drawn import CHATTERING, CLEARANCES, OMEGAS, Draws, States
from singimpact.bench.groups.public_rows import BALL, PLACES, family_of, one_by_one, square
from singimpact.bench.measuring import Aim, Case, Effort, Method, Row, Timed, cost
from singimpact.branches.events import PERIOD_DOUBLING

STORED = Path(__file__).parents[1] / "data" / "limits.json"
TABLE = np.linspace(0, 6, 1000), np.linspace(0.1, 3, 1000)  # states of a ball on a shaken table
ArrayCall = Callable[[Array, Array], object]
MOST = 1.5  # a ratio may exceed the stored one by this factor
# A call that is as much work for a flight from a wall, without another one, and how many of it each may cost.
BESIDE = {
    "launch": ("first_hit", 2.0),
    "between walls": ("first_hit", 1.5),
    "iterate between walls": ("iterate", 1.5),
    "a family": ("one model", 1.5),
}
MODELS = {
    "linear": si.linear("2.8", "0.3", "0.8"),
    "Duffing": si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.8"),
    "van der Pol": si.ImpactOscillator("x + (x**2 - 1)*xdot/5", "cos(1.7*t)", "0.3", "0.8"),
    "pendulum": si.ImpactOscillator("sin(x) + 0.1*xdot", "cos(1.7*t)/5", "0.3", "0.8"),
    "exp and rational": si.ImpactOscillator("x/(1 + x**2) + exp(x)/5 + 0.1*xdot", "cos(1.7*t)", "0.3", "0.8"),
    "tanh": si.ImpactOscillator("x + 0.2*tanh(5*xdot)", "cos(1.7*t)", "0.3", "0.8"),
    # it pushes on one side, smoothed over a hundredth
    "smoothed spring": si.ImpactOscillator(
        "x + 10*(x - 1/2 + sqrt((x - 1/2)**2 + 1/10000))/2", "cos(1.7*t)", "0.3", "0.8"
    ),
    "damped": si.linear("1.7", "0.3", "0.8", damping="0.1"),
}
# Microseconds of a state of a nonlinear model, in arrays.
FLIGHTS = {"Duffing": 1.8, "van der Pol": 2.0, "pendulum": 5.0, "exp and rational": 5.0, "tanh": 8.0}
TERMS = 20_000


def reference() -> list[None]:
    """Terms of a sum in a loop of Python, and as many sines of numpy again and again, about half of the time each."""
    total, angles = 0.0, np.linspace(0, 1, TERMS)
    for k in range(1, TERMS):
        total += (k % 7) / k
    for k in range(8):
        total += float(np.sum(np.sin(angles + k)))
    return [None]


def cases(effort: Effort) -> Iterator[Case]:
    """First answers in new cache folders, arrays, calls of one state, and longer calls, each beside the reference."""
    unit = Method("reference", f"a term of {TERMS}", reference, problems=TERMS)
    for name, rows in (("first answers", first_answers), ("arrays", arrays), ("calls", calls), ("searches", searches)):
        yield Case(name, [unit, *rows(effort)])


# ---- what a new process costs


# Models, and microseconds of CPU of the first script in a new cache folder.
SCRIPTS = {
    "linear": (f"si.linear({OMEGAS['linear']}, {CLEARANCES['linear']}, 0.8)", 0.8e6),
    "Duffing": (
        f"si.ImpactOscillator('x + 0.1*xdot + 0.3*x**3', 'cos(omega*t)', {CLEARANCES['duffing']}, 0.8,"
        f" {{'omega': {OMEGAS['duffing']}}})",
        2.5e6,
    ),
    "linear, a law of its own": (
        f"si.linear({OMEGAS['linear']}, {CLEARANCES['linear']}, '-0.8*v - 0.1*(-v)**1.5')",
        1.5e6,
    ),
}
SCRIPT = """import singimpact as si
import numpy as np
osc = {model}
rng = np.random.default_rng({seed})
tau, v = rng.uniform(0, 2, {states}), rng.uniform(0.05, 2, {states})
osc.impact_map(tau, v)
"""
COMMANDS = {"verify": 25e6, "verify e:meq e:qdef": 1e6}
RUN = "subprocess.run([sys.executable, '-m', 'singimpact', *{words!r}], cwd={place!r}, check=True, capture_output=True)"
SEEDS = count()


def script(family: str, states: int) -> str:
    """A user's first lines: a model and an array of states, which are others each time."""
    return SCRIPT.format(model=SCRIPTS[family][0], seed=next(SEEDS), states=states)


def first_answers(effort: Effort) -> list[Method]:  # noqa: ARG001
    """Scripts and commands, each in a new process and a new cache folder."""
    rows = [
        Method("singimpact, script", f"{family}, 100000 states", partial(_script, family), aim=Aim(aim))
        for family, (_, aim) in SCRIPTS.items()
    ]
    return rows + [Method("singimpact", line, partial(_command, line), aim=Aim(aim)) for line, aim in COMMANDS.items()]


def _script(family: str) -> Timed:
    with tempfile.TemporaryDirectory() as place:
        return Timed(cost(script(family, 100_000), around={"SINGIMPACT_CACHE": place}).seconds, [None])


def _command(line: str) -> Timed:
    with tempfile.TemporaryDirectory() as place:
        text = RUN.format(words=line.split(), place=place)
        return Timed(cost(text, "import subprocess, sys", around={"SINGIMPACT_CACHE": place}).seconds, [None])


# ---- arrays of states


def _states(count: int, kind: str = "generic") -> Draws:
    return Draws("linear", kind, count, 0.8)


def _drawn(name: str, setting: str, aim: float | None, draw: Draws, call: ArrayCall) -> Method:
    """A call of an array, of other states each time."""

    def run(states: States) -> None:
        call(states.tau, states.v)

    return Method(f"singimpact, {name}", setting, run, problems=draw.count, draw=draw, aim=Aim(aim))


def _with_errors(osc: si.ImpactOscillator) -> ArrayCall:
    """Hits with their condition numbers and errors."""

    def call(tau: Array, v: Array) -> object:
        hits = osc.first_hit(tau, v)
        return hits.condition, hits.error

    return call


def arrays(effort: Effort) -> list[Method]:
    """The impact map of arrays of states, its iterates, derivatives and inverse."""
    osc, many, some = MODELS["linear"], 100_000, 500 if effort.quick else 5000
    rows = [
        _drawn("impact_map", f"linear, {kind}", 0.15, _states(many, kind), osc.impact_map)
        for kind in ("v from 1e-8 to 1e-2", "tau within 1e6")
    ]
    for name, model, aim in (("iterate", osc, 2.0), ("iterate between walls", osc.replace(upper="1.3"), 3.0)):
        rows.append(_drawn(name, "linear, 20 impacts", aim, _states(10_000), partial(model.iterate, impacts=20)))
    for name, aim in {"linear": 0.15, **FLIGHTS}.items():
        model, draw = MODELS[name], _states(many if name == "linear" else some)
        with_errors = 0.2 if name == "linear" else 1.5 * aim
        rows.append(_drawn("impact_map", name, aim, draw, model.impact_map))
        rows.append(_drawn("first_hit", f"{name}, condition and error", with_errors, draw, _with_errors(model)))
        rows.append(_drawn("derivative", name, 2 * aim, draw, model.derivative))
        rows.append(_drawn("inverse_map", name, 2 * aim, draw, model.inverse_map))
        if name in ("linear", "Duffing"):
            members = 100 if effort.quick else 500
            for call, of in (("one model", one_by_one), ("a family", family_of)):
                rows.append(_plain(call, f"{name}, 300 impacts", None, 300 * members, of(model, members)))
            rows.append(_drawn("first_hit", f"{name}, array", aim, draw, model.first_hit))
            rows.append(_drawn("launch", f"{name}, array", 2 * aim, draw, _off_wall(model)))
            rows.append(_drawn("between walls", f"{name}, array", 1.5 * aim, draw, _between(model)))
    return rows


def _off_wall(osc: si.ImpactOscillator) -> Callable[..., object]:
    """Launches off the wall at drawn times with drawn velocities."""
    return lambda t, xdot: osc.launch(x=0.5, xdot=xdot, t=t)


def _between(osc: si.ImpactOscillator) -> ArrayCall:
    return osc.replace(upper="1.3").first_hit


# ---- calls of one state, and of ten


def _split(size: int, call: ArrayCall) -> ArrayCall:

    def run(tau: Array, v: Array) -> None:
        times, speeds = (tau.tolist(), v.tolist()) if size == 1 else (tau.reshape(-1, size), v.reshape(-1, size))
        for pair in zip(times, speeds, strict=True):
            call(*pair)

    return run


def calls(effort: Effort) -> list[Method]:
    """One state a call, arrays of ten, and what is drawn of a flight and of an orbit."""
    count, rows = 100 if effort.quick else 1000, []
    for name, ten, launch in (("linear", 1.0, 6.0), ("Duffing", 5.0, 9.0)):
        osc = MODELS[name]
        ones: dict[str, tuple[Callable[..., object], float | None]] = {
            "first_hit": (osc.first_hit, None),
            "launch": (_off_wall(osc), launch),
            "between walls": (_between(osc), launch),
            "derivative": (osc.derivative, 10.0),
            "inverse_map": (osc.inverse_map, 10.0),
        }
        rows.append(_drawn("impact_map", f"{name}, ten states", ten, _states(count), _split(10, osc.impact_map)))
        rows += [
            _drawn(what, f"{name}, a hundred states", ten, _states(count), _split(100, ones[what][0]))
            for what in ("first_hit", "launch")
        ]
        for what, (call, aim) in ones.items():
            rows.append(_drawn(what, f"{name}, one state", aim, _states(count), _split(1, call)))
    osc, times, orbit = MODELS["linear"], np.linspace(0.01, 1, 1000), MODELS["linear"].orbit(0.3, 0.7, 300)
    at = np.linspace(orbit.tau[0], orbit.tau[-1], 1000)
    return [
        *rows,
        _plain("acceleration", "linear, one state", 3.0, 1, lambda: osc.acceleration(0.3)),
        _plain("iterate", "linear, one state, 100 impacts", 1.2, 100, lambda: osc.iterate(0.3, 0.7, 100)),
        _plain("flight", "linear, a time", 0.15, 1000, lambda: osc.flight(0.3, 0.7, times)),
        _plain("orbit.sample", "linear, a time", 0.15, 1000, lambda: orbit.sample(at)),
        _plain("orbit.section", "linear, 300 impacts", 100.0, 1, orbit.section),
        _plain("first_hit", "linear, digits=20", 1e3, 1, lambda: osc.first_hit("0.3", "0.7", digits=20)),
        _plain("first_hit", "damped, digits=50", None, 1, lambda: MODELS["damped"].first_hit("0.3", "0.7", digits=50)),
    ]


def _plain(name: str, setting: str, aim: float | None, problems: int, call: Callable[[], object]) -> Method:
    return Method(f"singimpact, {name}", setting, call, problems=problems, aim=Aim(aim))


# ---- searches

SERIES = {"theory.chatter_limit(8)": 0.4e6, "theory.gamma(8)": 0.1e6}
BEFORE_SERIES = "import flint, numpy, sympy\nfrom singimpact import theory\n"


def searches(effort: Effort) -> list[Method]:
    """Chatter limits, thresholds, exponents, branches, curves, basins, manifolds, series."""
    limits, phases, pixels, impacts = (20, 10, 60, 1000) if effort.quick else (100, 100, 600, 10_000)
    duffing, two = MODELS["Duffing"], si.linear("2.8", "0.1", "0.8", amplitude=-1)
    chaotic, released = si.linear("2.8", 0, "0.8"), si.linear("2.8", "0.6", "1/2")
    saddle = next(orbit for orbit in two.periodic(3, 3) if not orbit.stable)
    chattering = partial(Draws, CHATTERING, "chattering", restitution=0.9)
    pressed, exponents = np.linspace(0.9, 2.7, phases), partial(si.lyapunov, duffing, 0.3, 0.7)
    return [
        _plain("threshold", "Duffing, one phase", 4e3, 1, lambda: si.threshold(duffing, "1.2")),
        _plain("threshold", "Duffing, an array, a phase", 1e3, phases, lambda: si.threshold(duffing, pressed)),
        _plain("orbit", "Duffing, an impact", None, impacts, lambda: duffing.orbit(0.3, 0.7, impacts)),
        _plain("lyapunov", "Duffing, an impact", None, impacts, partial(exponents, impacts, transient=0)),
        _plain("branch", "linear, a point", 500.0, 200, partial(linear_branch, 200)),
        _plain("event_curve", "bouncing ball, a point", None, 200, doubling_curve),
        _plain("ensemble", "bouncing ball, an impact", 1.0, 50_000, partial(si.ensemble, BALL, *TABLE, impacts=50)),
        *(
            _plain("regions", f"{name}, a place", PLACES[name], side**2, partial(square, name, side))
            for name, side in (("linear", 40), ("duffing", 24))
        ),
        _plain("basins", "linear, a pixel", 4.2, pixels**2, lambda: si.basins(two, size=pixels)),
        _plain("manifold", "linear", None, 1, lambda: si.manifold(saddle, v=1)),
        _plain("homoclinic_points", "linear", None, 1, lambda: si.homoclinic_points(chaotic.periodic(1, 1)[0])),
        _plain("border_orbits", "linear", None, 1, lambda: si.border_orbits(released, "clearance", (0.6, 0.7))),
        _drawn("chatter_limit", "linear", 3.0, chattering(1000), si.linear(2, "0.7", "0.9").chatter_limit),
        _drawn("chatter_limit", "Duffing", 100.0, Draws("duffing", "chattering", limits, 0.8), duffing.chatter_limit),
        _drawn("impact_map", "smoothed one-sided spring", 20.0, _states(20), MODELS["smoothed spring"].impact_map),
        *(Method("singimpact", call, partial(_series, call), aim=Aim(aim)) for call, aim in SERIES.items()),
    ]


def linear_branch(points: int) -> None:
    """A branch of x'' + x'/10 + x = A cos(4t/5) through a graze."""
    # the graze is at the amplitude -hypot(1 - 0.8^2, 0.08) = -0.3688, between the ends
    osc = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.4")
    si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.6, -0.33), step=1.6 / points)


def doubling_curve() -> None:
    """A curve of period doublings of the bouncing ball."""
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.5"})
    # doubles at G = hypot(pi (1 - r)/(1 + r), 2 (1 + r^2)/(1 + r)^2), which is 1.527 at r = 1/2
    orbits = [si.branch(orbit, "G", (1.4, 1.7)) for orbit in ball.periodic(1, 1)]
    (event,) = (event for family in orbits for event in family.events if event.kind == PERIOD_DOUBLING.name)
    si.event_curve(event, ("G", "restitution"), ((0.5, 3.5), (0.1, 0.95)), step=0.012)


def _series(call: str) -> Timed:
    """In a new process, with flint, numpy and sympy there."""
    return Timed(cost(call, BEFORE_SERIES).seconds, [None])


# ---- stored ratios


def over(rows: Sequence[Row]) -> list[str]:
    """A sentence for each row that takes more than half again as long as its stored ratio to the reference allows, and
    for the calls of `BESIDE` that take longer than it allows.
    """
    stored, own = json.loads(STORED.read_text(encoding="utf-8")), dict(_named(rows))
    slow = [
        f"{key}: {row.spread[0]:.3g} times the reference, {stored.get(key, 0):.3g} stored"
        for key, row in own.items()
        if not row.spread[0] <= MOST * stored.get(key, 0)
    ]
    for name, (plain, most) in BESIDE.items():
        for key in own:
            beside = own.get(key.replace(f": {name},", f": {plain},"))
            if f": {name}," in key and beside is not None and own[key].spread[0] > most * beside.spread[0]:
                slow.append(f"{key}: {own[key].spread[0] / beside.spread[0]:.3g} times {plain}, at most {most:g}")
    return slow


def store(rows: Sequence[Row]) -> None:
    """Store the ratios of a run."""
    STORED.write_text(json.dumps({key: float(f"{row.ratio:.3g}") for key, row in _named(rows)}, indent=1) + "\n")


def _named(rows: Sequence[Row]) -> list[tuple[str, Row]]:
    """Rows other than the reference, by case, call and setting."""
    own = [row for row in rows if row.group == "limit" and row.method != "reference"]
    return [(f"{row.case}: {row.method}, {row.setting}".replace("singimpact, ", "").strip(", "), row) for row in own]
