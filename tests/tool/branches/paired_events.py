"""Branches of (1, k) orbits of linear oscillators with two events of one kind at a chosen distance, in closed form.

    x'' + b x' + x = cos(omega t),  x >= c,  v -> -r v

u, the motion less its forced part p, starts and ends a flight of time T = 2 pi k/omega at the same place, since p does:
(E - 1) u = -(0, (1 + 1/r) v), E the flow of u over T.  So p and p' at the impact are linear in v, and the amplitude of
p gives c and the phase for each v.  A number c or b at which an event takes place is replaced by a cubic of a new
number q that passes it twice: the events of the branch over q are known to rounding.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from scipy.linalg import expm
from scipy.optimize import brentq

import singimpact as si

KINDS = ("period-doubling", "graze", "hidden impact", "torus", "fold")


@dataclass(frozen=True)
class Pair:
    """A branch, and the two numbers at which it has events of a kind."""

    kind: str
    orbit: Any
    between: tuple[float, float]
    events: tuple[float, float]
    distance: float


@dataclass(frozen=True)
class Family:
    """(1, k) orbits of one linear model, by the velocity v after the impact; `side` is the sign of p."""

    omega: float
    b: float
    r: float
    k: int
    side: int

    def orbit(self, v: float) -> tuple[float, float, np.ndarray] | None:
        """Launch time, clearance and the derivative of the return map; None where |p'| would be too large."""
        T = 2 * np.pi * self.k / self.omega
        E = expm(np.array([[0.0, 1.0], [-1.0, -self.b]]) * T)
        u = np.linalg.solve(E - np.eye(2), [0.0, -(1 + 1 / self.r) * v])
        Z = 1 / (1 - self.omega**2 + 1j * self.b * self.omega)
        across = (v - u[1]) / self.omega / abs(Z)  # p' = -|Z| omega sin(omega tau + arg Z)
        if not abs(across) < 1:
            return None
        turn = np.arctan2(-across, self.side * np.sqrt(1 - across**2))
        tau = (turn - np.angle(Z)) / self.omega
        c = u[0] + abs(Z) * np.cos(turn)
        a0 = np.cos(self.omega * tau) - c - self.b * v
        a1 = np.cos(self.omega * tau) - c + self.b * v / self.r
        slopes = np.zeros((2, 2))
        if v:
            for column, start in enumerate(((-v, -a0), (0.0, 1.0))):
                X, X1 = E @ start
                later = X * self.r / v
                slopes[:, column] = later, -self.r * (X1 + a1 * later)
        return tau, c, slopes

    def lowest(self, v: float) -> float:
        """The least height above the wall at a local minimum within the flight; inf where there is none."""
        orbit = self.orbit(v)
        if orbit is None:
            return np.nan
        tau, c, _ = orbit
        T = 2 * np.pi * self.k / self.omega
        s = np.linspace(0, T, 4001)[1:-1]
        Z = 1 / (1 - self.omega**2 + 1j * self.b * self.omega)
        p0 = Z * np.exp(1j * self.omega * tau)
        u0, u1 = c - p0.real, v - (1j * self.omega * p0).real
        w = np.sqrt(1 - self.b**2 / 4)

        def height(s: Any) -> Any:
            u = np.exp(-self.b * s / 2) * (u0 * np.cos(w * s) + (u1 + self.b * u0 / 2) / w * np.sin(w * s))
            return (Z * np.exp(1j * self.omega * (tau + s))).real + u - c

        x = height(s)
        turns = np.flatnonzero((x[1:-1] < x[:-2]) & (x[1:-1] <= x[2:])) + 1
        h = 1e-5
        lows = [brentq(lambda at: height(at + h) - height(at - h), s[i - 1], s[i + 1]) for i in turns]
        return min((float(height(at)) for at in lows), default=np.inf)


def drawn(kind: str, rng: np.random.Generator, distances: tuple[float, float]) -> Pair:
    """A branch with a pair of events, of a distance that is drawn evenly in its logarithm, of the interval's width."""
    while True:
        distance = float(np.exp(rng.uniform(*np.log(distances))))
        pair = _fold(rng, distance) if kind == "fold" else _quadratic(kind, rng, distance)
        if pair is not None:
            return pair


def event_velocity(kind: str, family: Family, rng: np.random.Generator) -> float | None:
    """v at an event; None where none is met."""
    if kind == "graze":
        return 0.0
    if kind == "torus":
        return float(rng.uniform(0.05, 2))

    def test(v: float) -> float:
        orbit = family.orbit(v)
        if orbit is None:
            return np.nan
        slopes = orbit[2]
        return family.lowest(v) if kind == "hidden impact" else 1 + np.trace(slopes) + np.linalg.det(slopes)

    grid = np.linspace(0.02, 3, 30)
    values = np.array([test(v) for v in grid])
    with np.errstate(invalid="ignore"):
        jumps = np.abs(np.diff(values)) < 1
        places = np.flatnonzero((values[:-1] * values[1:] < 0) & np.isfinite(values[:-1] + values[1:]) & jumps)
    if not places.size:
        return None
    i = int(rng.choice(places))
    return float(brentq(test, grid[i], grid[i + 1], xtol=1e-15))


def _quadratic(kind: str, rng: np.random.Generator, distance: float) -> Pair | None:
    omega, r, k = rng.uniform(1.3, 6), rng.uniform(0.3, 0.95), int(rng.integers(1, 4))
    T = 2 * np.pi * k / omega
    b = float(2 * np.log(r) / T if kind == "torus" else rng.choice([0.0, rng.uniform(0, 0.3)]))
    family = Family(omega, b, r, k, int(rng.choice([-1, 1])))
    v = event_velocity(kind, family, rng)
    orbit = None if v is None else family.orbit(v)
    if orbit is None or v is None:
        return None
    tau, c, slopes = float(orbit[0]), float(orbit[1]), orbit[2]
    if kind == "torus" and not abs(np.trace(slopes)) < 1.9:
        return None
    if kind == "graze" and np.cos(omega * tau) - c < 0.05:
        return None
    middle, rate = rng.uniform(-0.3, 0.3), float(rng.choice([-1, 1]) * rng.uniform(0.2, 1.5))
    # the number that has the event at 0 = s(q), skew so that nothing is symmetric about the middle
    skew = rng.uniform(-0.5, 0.5)
    form = "rate*((q - m)**2 - d**2/4)*(1 + skew*(q - m))"
    force = f"x + (b + {form})*xdot" if kind == "torus" else f"x + c + {form} + b*xdot"
    wall = c if kind == "torus" else 0.0
    # far enough from the events that none of them is met on the way from the other direction alone
    begin = float(middle + rng.choice([-1, 1]) * (distance / 2 + rng.uniform(0.01, 0.15)))
    start = _nearby(family, kind, v, rate, distance, skew, begin - middle)
    if start is None or not abs(begin) < 0.5:
        return None
    numbers = {"omega": float(omega), "b": b, "rate": rate, "m": float(middle), "d": distance, "skew": float(skew)}
    numbers |= {} if kind == "torus" else {"c": c}
    osc = si.ImpactOscillator(force, "cos(omega*t)", wall, float(r), {"q": begin, **numbers})
    orbits = [o for o in osc.periodic(1, k, start=start) if o.n == 1 and abs(o.v[0] - start[1]) < 1e-6 * (1 + start[1])]
    if not orbits:
        return None
    ends = middle - distance / 2, middle + distance / 2
    return Pair(kind, orbits[0], (-0.5, 0.5), ends, distance)


def _nearby(
    family: Family, kind: str, v: float, rate: float, distance: float, skew: float, at: float
) -> tuple[float, float] | None:
    """The orbit of the same branch where q is away from the middle, followed in small steps of q."""
    orbit = family.orbit(v)
    assert orbit is not None
    goal = rate * (at * at - distance**2 / 4) * (1 + skew * at)
    c, shift = orbit[1], 0.0
    for share in np.linspace(0, 1, 41)[1:]:
        shift = share * goal
        moved = family if kind != "torus" else Family(family.omega, family.b + shift, family.r, family.k, family.side)
        wanted = c if kind == "torus" else c + shift

        def miss(v: float, moved: Family = moved, wanted: float = wanted) -> float:
            orbit = moved.orbit(v)
            return np.nan if orbit is None else orbit[1] - wanted

        for width in (0.003, 0.01, 0.03):
            low, high = v - width, v + width
            if miss(low) * miss(high) < 0:
                v = float(brentq(miss, low, high, xtol=1e-15))
                break
        else:
            return None
    orbit = moved.orbit(v)
    return None if orbit is None or v < 0.01 else (float(orbit[0]), v)


def _fold(rng: np.random.Generator, distance: float) -> Pair | None:
    """A ball under the gravity q on a shaken floor, with a law of restitution that falls steeply at one velocity.

    (1, k) orbits: q T = w + R(w), w and R(w) the velocities before and after the impact.  Near w = W the right side is
    about Q - e y + K y^3, y = w - W, with folds at y = +-sqrt(e/(3 K)), where it differs by 4 e y/3.
    """
    k, W, K = int(rng.integers(1, 3)), rng.uniform(2, 4), rng.uniform(0.2, 2)
    T = 2 * np.pi * k
    y = (distance * T / (4 * K)) ** (1 / 3)
    e = 3 * K * y * y
    Q = W + rng.uniform(1.5, 3)
    from_W = Polynomial([-W, 1.0])
    law = Q - e * from_W + K * from_W**3 - Polynomial([0.0, 1.0])
    # a law vanishes at 0, with a slope in (0, 1]: far from W it is bent to that
    bend = 7 / W - (0.5 - law.deriv()(0)) / law(0)
    law = law - law(0) * (1 - Polynomial([0.0, 1 / W])) ** 7 * Polynomial([1.0, bend])
    total = law + Polynomial([0.0, 1.0])
    flat = total.deriv().roots()
    flat = np.sort(flat[np.abs(flat.imag) < 1e-12].real)
    folds = [float(flat[np.argmin(np.abs(flat - (W + sign * y)))]) for sign in (1, -1)]
    numbers = [float(total(w)) / T for w in folds]
    if not 0 < numbers[1] - numbers[0] < 3 * distance:
        return None
    w = W + float(rng.choice([-1, 1]) * (2 * y + rng.uniform(0.02, 0.3)))
    v, q, middle, G = float(law(w)), float(total(w)) / T, sum(numbers) / 2, float(rng.uniform(2, 5))
    across = (v - q * T / 2) / G
    if not (abs(across) < 0.95 and v > 0.05 and abs(q - middle) < 0.5):
        return None
    tau = float(rng.choice([np.arcsin(across), np.pi - np.arcsin(across)])) % (2 * np.pi)
    text = " + ".join(f"({float(each)!r})*(-v)**{i}" for i, each in enumerate(law.coef) if i)
    osc = si.ImpactOscillator("q", "G*cos(t)", 0, text, {"q": q, "G": G})
    orbits = [o for o in osc.periodic(1, k, start=(tau, v)) if abs(o.v[0] - v) < 1e-6]
    if not orbits:
        return None
    return Pair("fold", orbits[0], (middle - 0.5, middle + 0.5), (numbers[0], numbers[1]), numbers[1] - numbers[0])


def missed(pair: Pair) -> tuple[list[float], Any]:
    """Events of a pair that the branch lacks, and the branch."""
    branch = si.branch(pair.orbit, "q", pair.between)
    within = max(1e-9, 1e-3 * pair.distance)
    parameters = [event.parameter for event in branch.events if event.kind == pair.kind]
    return [event for event in pair.events if not any(abs(event - at) < within for at in parameters)], branch


def between(pair: Pair, branch: Any) -> np.ndarray:
    """Points of a branch between the events of a pair, on the way from one to the other."""
    one, other = (min((event for event in branch.events if event.kind == pair.kind),
                      key=lambda event: abs(event.parameter - at)).index for at in pair.events)  # fmt: skip
    points = np.arange(min(one, other) + 1, max(one, other) + 1)
    return points[~branch.at_event[points]]


def pairs(count: int, seed: int, distances: tuple[float, float]) -> Iterator[Pair]:
    """As many of each kind."""
    for turn in range(count):
        yield drawn(KINDS[turn % len(KINDS)], np.random.default_rng([seed, turn]), distances)


def main() -> None:
    """Count what is missed: `python tests/tool/branches/paired_events.py 2000 1`."""
    count, seed = (int(text) for text in sys.argv[1:3])
    tally: Counter[tuple[str, int]] = Counter()
    lost: Counter[tuple[str, int]] = Counter()
    for turn, pair in enumerate(pairs(count, seed, (1e-4, 1e-1))):
        decade = (pair.kind, int(np.floor(np.log10(pair.distance))))
        tally[decade] += 1
        lacking, branch = missed(pair)
        if lacking or not between(pair, branch).size:
            lost[decade] += 1
            print(f"{turn}: {pair.kind} at {pair.events}, {len(lacking)} missed: {branch!r}")
    for (kind, power), number in sorted(tally.items()):
        print(f"{kind}, distance 1e{power} to 1e{power + 1}: {number} branches, {lost[kind, power]} with a miss")


if __name__ == "__main__":
    main()
