"""Numbers of the article on chatter as a leak."""

from __future__ import annotations

from functools import cache
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

import singimpact as si

Array = NDArray[Any]
TURN = 2 * np.pi
PERIODS = 80  # until which launches are flown
AMPLITUDES, RESTITUTIONS = ("1.8", "1.9", "2.0", "2.4"), ("0.4", "0.5", "0.6")
LATER = 24, 12  # rates are taken from the first of these periods on that leaves enough rests
ENOUGH = 100
WIDE = ("1.75", "2.6")  # of the amplitude, over which the released orbit is followed
PLATEAU = ("1.893700796003", "1.939751233690")  # between border orbits, to 1e-12
SIZES = (0.8, 0.4, 0.2, 0.1)  # half lengths of the arc in which the mass can rest, in phase
CAPTURED = "2.3695"  # whose released orbit ends on a stable orbit
MOST = 6  # periods of windows that are proved
OMEGA = 2.8  # of the oscillator whose hole closes
HEIGHTS = {"0.4": 1.4, "0.5": 0.8, "0.6": 0.5, "0.7": 0.3, "0.8": 0.16}  # above all landings that rest, in its units


class Size(NamedTuple):
    """How much is computed."""

    launches: int
    survivors: int
    pairs: int
    members: int  # values of the amplitude
    pieces: int  # of the run of a window
    grid: int
    thrown: int  # launches of the count that compares with the law of the hole


SIZE = {True: Size(4000, 100, 1600, 500, 32, 40, 100_000), False: Size(100_000, 500, 8_000, 4000, 128, 100, 2_000_000)}


class Model(NamedTuple):
    """An oscillator whose uncertainty exponent is measured, and the greatest velocity of its launches."""

    words: str
    osc: si.ImpactOscillator
    period: float
    fastest: float


MODELS = (
    Model("ball, $G = 1.9$", si.ImpactOscillator("1", "1.9*sin(t)", 0, "1/2"), TURN, 3.0),
    Model("ball in air, $f = 1 + x'/40$, $G = 3$", si.ImpactOscillator("1 + xdot/40", "3*sin(t)", 0, "1/2"), TURN, 3.0),
    Model("$x'' + x$, $\\omega = 3.6$, $c = -0.3$", si.linear("3.6", "-0.3", "0.4"), TURN / 3.6, 2.0),
    Model("$x'' + x$, $\\omega = 7.2$, $c = 0.1$", si.linear("7.2", "0.1", "0.4"), TURN / 7.2, 2.0),
)
APART = 10.0 ** -np.arange(4, 10)  # parts by which velocities differ
SETTLED, LONG = 25, 160  # periods after which launches are near the saddle, and until which they are flown
GROUPS = 8  # of pairs, whose spread gives errors


def ball(amplitude: str, r: str) -> si.ImpactOscillator:
    return si.ImpactOscillator("1", f"{amplitude}*sin(t)", 0, r)


def family() -> si.ImpactOscillator:
    return si.ImpactOscillator("1", "G*sin(t)", 0, "1/2", {"G": "19/10"})


def launches(period: float, fastest: float, count: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(0)
    return rng.uniform(0, period, count), rng.uniform(0.02 * fastest, fastest, count)


# Rates


@cache
def flown(amplitude: str, r: str, quick: bool) -> Any:
    """Launches of a ball, flown to the last period."""
    tau, v = launches(TURN, 3.0, SIZE[quick].launches)
    return si.ensemble(ball(amplitude, r), tau, v, until=(PERIODS + 1) * TURN)


def rate_of(first: Array, begin: float, end: float) -> tuple[float, float, int]:
    """The rate of greatest likelihood of first rests between two times, its standard error, and their number."""
    seen = first[(first > begin) & (first < end)] - begin
    n, length = seen.size, end - begin
    if n < 2:
        return np.nan, np.nan, n

    def mean(rate: float) -> float:
        # of an exponential law cut off at the length
        part = rate * length
        return length / 2 - length * part / 12 if abs(part) < 1e-4 else 1 / rate - length / np.expm1(min(part, 700.0))

    rate = float(brentq(lambda x: mean(x) - seen.mean(), -2, 20))
    part = rate * length
    information = length**2 / 12 if abs(part) < 1e-3 else 1 / rate**2 - length**2 / (4 * np.sinh(part / 2) ** 2)
    return rate, float(1 / np.sqrt(n * information)), n


@cache
def rates(quick: bool) -> dict[tuple[str, str], dict[str, Any]]:
    """Of each ball: the rate from first rests alone, the rate of all at risk, and the share that is left."""
    rows = {}
    for r in RESTITUTIONS:
        for amplitude in AMPLITUDES:
            orbits = flown(amplitude, r, quick)
            first = (orbits.first_rest - orbits.start) / TURN
            enough = [begin for begin in LATER if ((first > begin) & (first < PERIODS)).sum() >= ENOUGH]
            begin = enough[0] if enough else LATER[-1]
            rate, error, count = rate_of(first, begin, PERIODS)
            mean = TURN * orbits.escape_rate(after=begin * TURN)[0]
            left = float(np.mean(first > PERIODS))
            rows[amplitude, r] = {"rate": rate, "error": error, "count": count, "mean": mean, "left": left} | {
                "begin": begin
            }
    return rows


def bracketed(value: float, error: float) -> str:
    """A value with its error in units of the last digit: 0.0769(2)."""
    if not np.isfinite(error) or error <= 0:
        return "--"
    digits = max(int(np.ceil(-np.log10(error) - 0.02)), 0)
    unit = round(error * 10**digits)
    if unit >= 10:
        digits, unit = digits - 1, round(error * 10 ** (digits - 1))
    return f"{value:.{digits}f}({unit})"


# What holds the rest


@cache
def held(quick: bool) -> list[dict[str, Any]]:
    """Of each ball with a share left: how many of its survivors rest in 400 more periods, and in 2000."""
    rows = []
    for (amplitude, r), row in rates(quick).items():
        orbits = flown(amplitude, r, quick)
        alive = np.flatnonzero(np.isinf(orbits.first_rest))[: SIZE[quick].survivors]
        if row["left"] < 0.02 or not alive.size:
            continue
        tau, v = np.mod(orbits.tau[alive], TURN), orbits.v[alive]
        later = si.ensemble(ball(amplitude, r), tau, v, until=(2000 if not quick else 400) * TURN)
        lasts = (later.first_rest - later.start) / TURN
        stay = np.isinf(lasts)
        rows.append(
            {
                "r": r,
                "amplitude": amplitude,
                "left": f"{row['left']:.4f}",
                "followed": alive.size,
                "after": [int((lasts > n).sum()) for n in ((100, 200, 390) if quick else (100, 400, 1990))],
                "states": (later.tau[stay], later.v[stay]),
                "last": float(np.max(lasts[~stay], initial=0.0)),
            }
        )
    return rows


STABLE = {
    ("1.8", "0.4"): (2, (0.607659, 1.82283)),
    ("1.9", "0.4"): (2, (0.28386, 1.90476)),
    ("2.4", "0.5"): (3, (0.243529, 0.853536)),
}


@cache
def certified(quick: bool) -> list[dict[str, Any]]:
    """The stable periodic orbits, certified, and how near to them those that stay are."""
    rows = []
    for (amplitude, r), (n, start) in STABLE.items():
        (orbit,) = ball(amplitude, r).periodic(n, n, start=start)
        proved = orbit.certified(12)
        assert proved.stable
        (row,) = (one for one in held(quick) if (one["amplitude"], one["r"]) == (amplitude, r))
        tau, v = row["states"]
        phase = (tau[:, None] - orbit.tau + np.pi) % TURN - np.pi
        distance = np.hypot(phase, v[:, None] - orbit.v).min(axis=1)
        first, second = (complex(each) for each in orbit.multipliers)
        pair = (
            f"{first.real:.4f} \\pm {abs(first.imag):.4f}\\,i"
            if first.imag
            else f"{first.real:.4f},\\ {second.real:.4f}"
        )
        rows.append(
            {
                "amplitude": amplitude,
                "r": r,
                "n": n,
                "tau": str(proved.tau[0]),
                "v": str(proved.v[0]),
                "multipliers": pair,
                "on": int((distance < 1e-6).sum()),
                "stay": distance.size,
            }
        )
    return rows


@cache
def chaotic(quick: bool) -> list[dict[str, Any]]:
    """Lyapunov exponents a period of those that stay where no periodic orbit holds them."""
    rows = []
    for amplitude, r in (("2.0", "0.4"), ("2.0", "0.6")):
        (row,) = (one for one in held(quick) if (one["amplitude"], one["r"]) == (amplitude, r))
        tau, v = (states[:16] for states in row["states"])
        run = ball(amplitude, r).lyapunov(np.mod(tau, TURN), v, 400 if quick else 3000)
        larger = TURN * run.exponents.max(axis=-1)
        larger = larger[np.isfinite(larger)]
        rows.append(
            {
                "amplitude": amplitude,
                "r": r,
                "exponent": bracketed(float(larger.mean()), float(larger.std() / np.sqrt(larger.size))),
                "stay": row["states"][0].size,
                "followed": row["followed"],
                "last": f"{row['last']:.0f}",
            }
        )
    return rows


# Uncertainty


@cache
def uncertainty(index: int, quick: bool) -> dict[str, Any]:
    """Rate, Lyapunov exponent and uncertainty exponent of a model, with errors, and the shares of pairs."""
    model, count = MODELS[index], SIZE[quick].pairs
    osc, period, end = model.osc, model.period, (LONG + 1) * model.period
    tau, v = launches(period, model.fastest, count)
    first = si.ensemble(osc, tau, v, until=end).first_rest
    rate, error, _ = rate_of((first - tau) / period, SETTLED, LONG)
    # pairs next to the saddle: those that come to rest in the end, and not soon
    begun = si.ensemble(osc, tau, v, until=SETTLED * period)
    flying = np.isinf(begun.first_rest)
    times, state = np.arange(4, 22) * period, (np.mod(begun.tau[flying], period), begun.v[flying])
    one, other = (si.ensemble(osc, state[0], state[1] * size, until=end, sample=times) for size in (1, 1 + 1e-10))
    sooner, later = (choice(one.first_rest, other.first_rest) for choice in (np.minimum, np.maximum))
    late = (sooner > 25 * period) & np.isfinite(later)
    with np.errstate(divide="ignore"):
        apart = (np.asarray(one.x) - other.x, np.asarray(one.xdot) - other.xdot)
        distance = np.log(np.hypot(*apart)[:, late])
    distance = distance[:, np.isfinite(distance).all(axis=0)]
    used = distance.mean(axis=1) < np.log(1e-4)

    def growth(part: Array) -> float:
        return float(np.polyfit(times[used] / period, part.mean(axis=1)[used], 1)[0])

    slopes = [growth(distance[:, group::GROUPS]) for group in range(GROUPS)]
    first = np.nan_to_num(first, posinf=1e9)
    parts = []
    for part in APART:
        rest = np.nan_to_num(si.ensemble(osc, tau, v * (1 + part), until=end).first_rest, posinf=1e9)
        parts.append(np.abs(first - rest) > period / 2)
    differ = np.array(parts)

    def exponent(part: Array) -> float:
        # a group without a pair that differs has half of one
        shares = np.maximum(part.mean(axis=1), 0.5 / part.shape[1])
        return float(np.polyfit(np.log(APART), np.log(shares), 1)[0])

    alphas = [exponent(differ[:, group::GROUPS]) for group in range(GROUPS)]
    alpha, growing = exponent(differ), growth(distance)
    spread = [float(np.std(values, ddof=1) / np.sqrt(GROUPS)) for values in (slopes, alphas)]
    quotient = rate / growing
    relative = np.hypot(error / rate, spread[0] / growing)
    return {
        "words": model.words,
        "rate": bracketed(rate, error),
        "growth": bracketed(growing, spread[0]),
        "quotient": bracketed(quotient, quotient * relative),
        "alpha": bracketed(alpha, spread[1]),
        "over": f"{alpha / quotient:.2f}",
        "shares": differ.mean(axis=1),
        "law": quotient,
    }


@cache
def unsettled(quick: bool) -> dict[str, str]:
    """Of the last model: kappa from period 12 on, and lambda over the first periods of all that fly on."""
    model = MODELS[-1]
    osc, period, times = model.osc, model.period, np.arange(4, 18) * model.period
    tau, v = launches(period, model.fastest, SIZE[quick].pairs)
    one, other = (
        si.ensemble(osc, tau, v * size, until=(PERIODS + 1) * period, sample=times) for size in (1, 1 + 1e-10)
    )
    rate, error, _ = rate_of((one.first_rest - tau) / period, 12, PERIODS)
    late = np.minimum(one.first_rest, other.first_rest) > 30 * period
    with np.errstate(divide="ignore"):
        apart = (np.asarray(one.x) - other.x, np.asarray(one.xdot) - other.xdot)
        distance = np.log(np.hypot(*apart)[:, late])
    mean = distance[:, np.isfinite(distance).all(axis=0)].mean(axis=1)
    growing = float(np.polyfit(times / period, mean, 1)[0])
    return {"rate": bracketed(rate, error), "growth": f"{growing:.2f}", "quotient": f"{rate / growing:.2f}"}


# The closing hole


def free_of_the_universal(t: Array, u: Array) -> Array:
    """True where the flight of X'' = T**2 - 1 that lands at t with velocity -u was above the wall long before."""
    at = t - 12 * np.geomspace(1e-4, 1, 200)[:, None, None]

    def height(s: Array) -> Array:
        return s**4 / 12 - s**2 / 2

    above = height(at) - height(t) - (t**3 / 3 - t) * (at - t) - u * (at - t)
    return np.asarray((above > 0).all(axis=0))


@cache
def universal_area(r: str, grid: int) -> float:
    """A(r): the area of the flights that land and rest in the arc, |T| < 1."""
    centres = (np.arange(grid) + 0.5) / grid
    t, u = np.meshgrid(-1.6 + 2.6 * centres, HEIGHTS[r] * centres)
    landed = si.ensemble(si.ImpactOscillator("0", "t**2 - 1", 0, r), t, float(r) * u, until=1.5)
    inside = (landed.first_rest < 1.01) & free_of_the_universal(t, u)
    beyond = inside[-1] | inside[:, 0]
    assert not beyond.any(), "the grid does not hold the region"
    return float(u[inside].sum() * 2.6 * HEIGHTS[r] / grid**2)


def closing(size: float, r: str, omega: float = OMEGA) -> si.ImpactOscillator:
    """x'' + x = cos(omega t) above a wall that presses the mass for the phases pi - size to pi + size alone."""
    return si.linear(str(omega), repr(float(-np.cos(size))), r)


def free_of_the_linear(t: Array, u: Array, clearance: float, back: float) -> Array:
    """As above, for the flights of x'' + x = cos(omega t)."""
    k = 1 / (1 - OMEGA**2)
    cosine, sine = clearance - k * np.cos(OMEGA * t), -u + k * OMEGA * np.sin(OMEGA * t)
    y = -np.geomspace(1e-4, 1, 200)[:, None, None] * back
    x = cosine * np.cos(y) + sine * np.sin(y) + k * np.cos(OMEGA * (t + y))
    return np.asarray((x > clearance).all(axis=0))


@cache
def scaled_area(size: float, r: str, grid: int) -> float:
    """The area of the hole of the linear oscillator over b**2 s**7."""
    step, b = size / OMEGA, OMEGA**2 / 2
    wide, high = 2.6 * step, HEIGHTS[r] * b * step**3
    centres = (np.arange(grid) + 0.5) / grid
    t, u = np.meshgrid(np.pi / OMEGA - 1.6 * step + wide * centres, high * centres)
    landed = si.ensemble(closing(size, r), t, float(r) * u, until=(np.pi + 1.5 * size) / OMEGA)
    rests = landed.first_rest < (np.pi + 1.01 * size) / OMEGA
    inside = rests & free_of_the_linear(t, u, -np.cos(size), 12 * step)
    return float(u[inside].sum() * wide * high / grid**2 / (b**2 * step**7))


@cache
def thrown(size: float, quick: bool) -> tuple[int, float]:
    """Launches of x'' + x = cos(0.7 t), even in v dv dtau, whose first flight lands in the hole; and the law."""
    omega, r, fastest, count = 0.7, 0.4, 3.0, SIZE[quick].thrown
    osc, rng = closing(size, "0.4", omega), np.random.default_rng(0)
    period, step = TURN / omega, size / omega
    tau = rng.uniform(0, period, count)
    hit = osc.impact_map(tau, fastest * np.sqrt(rng.uniform(0, 1, count)))
    shift = hit.tau % period - np.pi / omega
    slow = hit.v < HEIGHTS["0.4"] * r * omega**2 / 2 * step**3
    near = (hit.status == 0) & (np.abs(shift) < 2 * step) & slow & (hit.tau - tau > 3 * step)
    end = (np.pi + 1.5 * size) / omega + 2 * step
    landed = si.ensemble(osc, shift[near] + np.pi / omega, hit.v[near], until=end)
    law = universal_area("0.4", SIZE[quick].grid) * (omega**2 / 2) ** 2 * step**7 / (period * fastest**2 / 2) * count
    return int(np.count_nonzero(landed.first_rest < (np.pi + 1.01 * size) / omega)), float(law)


# Windows


class Released(NamedTuple):
    """Released orbits of drawn amplitudes: how long until they rest, in periods, and what those are on that do not."""

    amplitude: Array
    lasts: Array
    periodic: Array
    exponent: Array


@cache
def released(quick: bool) -> Released:
    """The released orbit of each amplitude, flown for 2000 periods; the distance to which it returns at its end."""
    low, high = map(float, WIDE)
    amplitude = np.sort(np.random.default_rng(5).uniform(low, high, SIZE[quick].members))
    start = np.arcsin(1 / amplitude)
    orbits = si.ensemble(family().over(G=amplitude), start, np.zeros_like(start), until=2001 * TURN)
    lasts = (orbits.first_rest - start) / TURN
    stay = np.isinf(lasts)
    many, tau, v = family().over(G=amplitude[stay]), orbits.tau[stay], orbits.v[stay]
    nearest, at = np.full(tau.size, np.inf), (tau, v)
    for _ in range(64):
        hit = many.impact_map(*at)
        at = hit.tau, hit.v
        nearest = np.minimum(nearest, np.hypot((at[0] - tau + np.pi) % TURN - np.pi, at[1] - v))
    exponent = TURN * si.lyapunov(many, np.mod(tau, TURN), v, 1000).exponents.max(axis=-1)
    return Released(amplitude, lasts, nearest < 1e-7, exponent)


@cache
def proved_plateau(quick: bool) -> Any:
    return si.resting_windows(family(), "G", PLATEAU, periods=5, pieces=64 if quick else 512)


@cache
def windows(quick: bool) -> list[Any]:
    """Windows that are proved: in the runs of amplitudes whose released orbits rest after equally many periods."""
    scan, found = released(quick), list(proved_plateau(quick))
    least = 0.02 if quick else 0.002
    low_end, high_end = map(float, PLATEAU)
    after = np.ceil(np.where(np.isfinite(scan.lasts), scan.lasts, 0)).astype(int)
    for periods, group in groupby(range(after.size), key=lambda index: int(after[index])):
        run = list(group)
        low, high = scan.amplitude[run[0]], scan.amplitude[run[-1]]
        if 0 < periods <= MOST and high - low > least and not low_end < (low + high) / 2 < high_end:
            ends = f"{low:.6f}", f"{high:.6f}"
            found += si.resting_windows(family(), "G", ends, periods=periods, pieces=SIZE[quick].pieces)
    return sorted(found)


@cache
def plateau(quick: bool) -> dict[str, Any]:
    """The window of five periods: its border orbits, their cascades, and the part between them that is proved."""
    borders: list[Any] = []
    for place in PLATEAU:
        near = f"{float(place) - 1e-4:.6f}", f"{float(place) + 1e-4:.6f}"
        borders += si.border_orbits(family(), "G", near, digits=16, periods=5, points=3)
    proved = proved_plateau(quick)
    limits = [border.cascade.limit for border in borders]
    return {
        "borders": [str(border.certified) for border in borders],
        "sides": [border.side for border in borders],
        "limits": [bracketed(float(limit[0]), max(float(limit[1]), 1e-9)) for limit in limits],
        "edges": [len(border.cascade.distance) for border in borders],
        "share": f"{100 * float(proved.share):.1f}",
        "ends": [f"{float(proved[0].low):.5f}", f"{float(proved[-1].high):.5f}"],
    }


def shares(quick: bool) -> list[tuple[int, str, str]]:
    """After n periods, the share of amplitudes not at rest: of all, and of those that rest before 2000 periods."""
    lasts, rows = released(quick).lasts, []
    for n in (5, 10, 20, 40, 80, 160, 320, 640, 1280):
        everyone, leaves = float(np.mean(lasts > n)), float(np.mean((lasts > n) & np.isfinite(lasts)))
        errors = [np.sqrt(max(share * (1 - share), 1 / lasts.size) / lasts.size) for share in (everyone, leaves)]
        rows.append((n, bracketed(everyone, errors[0]), bracketed(leaves, errors[1])))
    return rows


def intervals(quick: bool) -> list[dict[str, Any]]:
    """Where in the amplitude orbits that stay lie: runs of them with gaps below 0.03."""
    scan = released(quick)
    stay = np.isinf(scan.lasts)
    values, periodic, exponent = scan.amplitude[stay], scan.periodic, scan.exponent
    rows = []
    for run in np.split(np.arange(values.size), np.flatnonzero(np.diff(values) > 0.03) + 1):
        if run.size:
            chaos = exponent[run] > 0.01
            rows.append(
                {
                    "low": f"{values[run[0]]:.4f}",
                    "high": f"{values[run[-1]]:.4f}",
                    "size": run.size,
                    "periodic": int(periodic[run].sum()),
                    "chaotic": int((chaos & ~periodic[run]).sum()),
                }
            )
    return rows


@cache
def capture() -> dict[str, Any]:
    """At one amplitude: the released orbit, which ends on a periodic orbit that is certified to be stable."""
    model = ball(CAPTURED, "0.5")
    run = si.ensemble(model, np.arcsin(1 / float(CAPTURED)), 0.0, until=201 * TURN)
    assert run.rests == 0
    (orbit,) = model.periodic(3, 3, start=(float(np.mod(run.tau, TURN)), float(run.v)))
    proved = orbit.certified(12)
    assert proved.stable
    phase = (float(run.tau) - orbit.tau + np.pi) % TURN - np.pi
    distance = float(np.hypot(phase, float(run.v) - orbit.v).min())
    size = max(abs(complex(each)) for each in orbit.multipliers)
    power = int(np.ceil(np.log10(max(distance, 1e-15))))
    return {"amplitude": CAPTURED, "below": f"10^{{{power}}}", "multiplier": f"{size:.4f}", "v": str(proved.v[0])}


# What is printed


def numbers(quick: bool) -> dict[str, Any]:
    """What the text prints."""
    size, rows = SIZE[quick], rates(quick)
    grid = size.grid
    mu = next(one for one in si.constants("1/2", 16) if (one.name, one.order) == ("mu", 1))
    lam = next(one for one in si.constants("1/2", 16) if (one.name, one.order) == ("lambda", 1))
    uncertain = [uncertainty(index, quick) for index in range(len(MODELS))]
    scan, found = released(quick), windows(quick)
    low, high = map(float, WIDE)
    stays = int(np.isinf(scan.lasts).sum())
    worst = [("1.8", "0.4"), ("2.4", "0.5")]
    widths: dict[int, float] = {}
    for one in found:
        widths[int(one.periods)] = widths.get(int(one.periods), 0.0) + float(one.high - one.low)
    covered = sum(widths.values()) / (high - low)
    thick = np.isfinite(scan.lasts) & (np.ceil(scan.lasts) <= MOST)
    return {
        "quick": quick,
        "size": size,
        "launches": f"{size.launches:,}".replace(",", "\\,"),
        "thrown": f"{size.thrown:,}".replace(",", "\\,"),
        "pairs": f"{size.pairs:,}".replace(",", "\\,"),
        "members": f"{size.members:,}".replace(",", "\\,"),
        "amplitudes": AMPLITUDES,
        "restitutions": RESTITUTIONS,
        "rates": {
            (amplitude, r): {
                "rate": bracketed(row["rate"], row["error"]),
                "left": f"{row['left']:.4f}",
                "late": row["begin"] == LATER[0],
            }
            for (amplitude, r), row in rows.items()
        },
        "factor": f"{max(rows[one]['rate'] / rows[one]['mean'] for one in worst):.0f}",
        "periods": PERIODS,
        "later": LATER,
        "enough": ENOUGH,
        "wide": WIDE,
        "worst_even": f"{100 * max(abs(float(row['over']) - 1) for row in uncertain):.0f}",
        "wrong": [
            {
                "amplitude": a,
                "r": r,
                "mean": f"{rows[a, r]['mean']:.4f}",
                "rate": bracketed(rows[a, r]["rate"], rows[a, r]["error"]),
            }
            for a, r in worst
        ],
        "lasting": held(quick),
        "times": (100, 200, 390) if quick else (100, 400, 1990),
        "certified": certified(quick),
        "chaotic": chaotic(quick),
        "uncertain": uncertain,
        "unsettled": unsettled(quick),
        "settled": SETTLED,
        "long": LONG,
        "areas": {r: f"{universal_area(r, grid):.4f}" for r in HEIGHTS},
        "scaled": {r: [f"{scaled_area(s, r, grid):.4f}" for s in SIZES] for r in ("0.5", "0.7")},
        "sizes": SIZES,
        "counts": [(s, *thrown(s, quick)) for s in (0.5, 0.7, 1.0)],
        "plateau": plateau(quick),
        "mu": f"{float(mu.value.value):.10f}",
        "lam": f"{float(lam.value.value):.6f}",
        "contraction": f"{float(lam.value.value) ** 2 * float(mu.value.value):.4f}",
        "windows": len(found),
        "covered": f"{100 * covered:.1f}",
        "seen": f"{100 * float(thick.mean()):.1f}",
        "widths": [(k, f"{width:.4f}") for k, width in sorted(widths.items())],
        "shares": shares(quick),
        "intervals": intervals(quick),
        "most": MOST,
        "stays": stays,
        "stay_share": bracketed(stays / scan.lasts.size, float(np.sqrt(stays) / scan.lasts.size)),
        "last": f"{float(np.max(scan.lasts[np.isfinite(scan.lasts)])):.0f}",
        "capture": capture(),
    }
