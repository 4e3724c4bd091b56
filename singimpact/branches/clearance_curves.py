"""All orbits of one or two impacts of a linear model with one harmonic, at every clearance: curves, by formulas.

With e = h0 - k c, the acceleration at rest on the wall, and the forcing h0 + C cos(omega t) + S sin(omega t) from a
launch on, z = (x - c, x', e, C, S) obeys z' = A z. An impact gives two conditions, x = c and x' = -v/r where its
flight ends, which are linear in velocities, e, C and S; C^2 + S^2 is the square of the amplitude.

    one impact     C and S on a circle, v and e linear in them; p is the angle
    two impacts    four equations for five numbers at each length p of the first flight: two solutions, z and -z

So p is a coordinate of a curve that has all orbits on it, virtual ones too.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import atan2, comb, isfinite, pi
from operator import mul
from typing import Any

from singimpact.algebra import Balls, evaluate
from singimpact.handed_on import flint
from singimpact.inputs import InputError, need
from singimpact.oscillator import Oscillator, linear_form

TERMS = 5  # of Taylor series about the middle of an interval of p; the rest is taken over the interval
LENGTH = TERMS + 2  # of series of the motion: where a zero is divided out one term is lost
KEPT = 3  # terms of the series of an orbit by p: its numbers, their first and second derivatives
NEAR = 64  # radii of an interval: so near to a length where all minors vanish the interval is made to reach it
SINGULAR = "the two conditions on one impact depend on each other and do not give v and c: give other pairs"

Ball = Any  # of flint, or a matrix of them
Series = Any
State = tuple[Series, ...]  # z, as series in p


class Motion:
    """exp(t A) in balls.

    Examples
    --------
    >>> flow = Motion(flint.arb(0), flint.arb(1), flint.arb(2))(flint.arb(1, 0.125))
    >>> flow[0, 1].contains(flint.arb(1).sin()), float(flow[0, 1].rad()) < 0.1
    (True, True)
    """

    def __init__(self, damping: Ball, stiffness: Ball, rate: Ball) -> None:
        rows = [[0, 1, 0, 0, 0], [-stiffness, -damping, 1, 1, 0], [0] * 5, [0, 0, 0, 0, rate], [0, 0, 0, -rate, 0]]
        self.A = flint.arb_mat(rows)
        self.kept: dict[Any, Any] = {}

    def __call__(self, t: Ball) -> Ball:
        # the matrix over a ball: a Taylor polynomial about the middle, and the rest over the ball
        key = t.mid().man_exp(), t.rad().man_exp()
        if key not in self.kept:
            off = t - t.mid()
            term = (self.A * t.mid()).exp()
            rest, total = term * (self.A * off).exp(), term
            for j in range(1, TERMS):
                term, rest = term * self.A * (off / j), rest * self.A * (off / j)
                total += term if j < TERMS - 1 else rest
            self.kept[key] = total
        return self.kept[key]

    def series(self, t: Ball, sign: int = 1) -> list[list[Series]]:
        """The entries of exp((t + sign s) A) as series in s."""
        terms = [self(t)]
        for j in range(1, LENGTH):
            terms.append(terms[-1] * self.A * (flint.arb(sign) / j))
        return [[flint.arb_series([term[i, j] for term in terms], LENGTH) for j in range(5)] for i in range(5)]


def combined(row: list[Any], state: State) -> Series:
    # the sum of products
    return sum(map(mul, row, state))


@dataclass(frozen=True)
class OrbitOnCurve:
    """Series by p, over a ball of p.

    Attributes
    ----------
    curve : of the orbit. c : its clearance. launches : z just after each impact. spans : lengths of the flights, balls.
    flows : exp(t A) of each whole flight.
    """

    curve: "ClearanceCurve"
    c: Series
    launches: tuple[State, ...]
    spans: tuple[Ball, ...]
    flows: tuple[list[list[Series]], ...]

    @property
    def v(self) -> list[Series]:
        """The velocities after the impacts."""
        return [launch[1] for launch in self.launches]

    def launched(self, flight: int, order: int) -> Ball:
        """z just after an impact, or its derivative by p, as a column."""
        return flint.arb_mat([[part[order]] for part in self.launches[flight]])

    def test(self, multiplier: int) -> Series:
        """1 + d - mu t, t the trace and d the determinant of the return map, times the number of `traced`."""
        trace, scale = self.traced
        return scale * (1 + self.curve.determinant) - multiplier * trace

    @cached_property
    def traced(self) -> tuple[Series, Series]:
        """The trace of the derivative of the return map in (tau, v) times a number, and the number: no 0 divides."""
        slopes, scale = [], 1
        for launch, flow in zip(self.launches, self.flows, strict=True):
            speed = combined(flow[1], launch)
            slopes.append(self._slope(launch, flow, speed))
            scale *= speed
        (a, b), (c, d) = slopes[0]
        if len(slopes) == 1:
            return a + d, scale
        (p, q), (r, s) = slopes[1]
        return a * p + b * r + c * q + d * s, scale

    def _slope(self, launch: State, flow: list[list[Series]], speed: Series) -> list[list[Series]]:
        # the derivative of the impact map, times x' before the impact: the flight gets longer by -h / x'
        r, rate = self.curve.r, self.curve.rate
        force = combined(flow[1], tuple(combined(row, launch) for row in self.curve.motion.A.table()))
        later = 0, 0, 0, rate * launch[4], -rate * launch[3]
        by_tau, by_v = ([combined(flow[i], later) for i in (0, 1)], [flow[0][1], flow[1][1]])
        return [[speed - by_tau[0], -by_v[0]], [-r * (by[1] * speed - force * by[0]) for by in (by_tau, by_v)]]


class ClearanceCurve:
    """The orbits of n impacts, 1 or 2, in k periods.

    Parameters
    ----------
    osc : linear with one harmonic, stiffness that is not 0, a number for restitution and one wall.
    counts : n and k. sign : of two impacts, which of the solutions z and -z.

    Attributes
    ----------
    ends : of p. Of one impact v < 0 at both. Of two impacts the first flight has no length at the first end, and both
        have the same at the second: beyond it the impacts change their names.
    determinant : of the derivative of the return map.
    """

    def __init__(self, osc: Oscillator, counts: tuple[int, int], bits: int, sign: int = 1) -> None:
        form, balls = linear_form(osc), Balls(bits)
        assert form is not None
        assert osc.period is not None
        (self.n, self.k), self.sign, self.balls = counts, sign, balls
        numbers = form.damping, form.stiffness, form.constant, form.harmonics[0].rate, osc.restitution, osc.period
        damping, self.stiffness, self.steady, self.rate, self.r, self.period = (
            evaluate(tree, {}, balls) for tree in numbers
        )
        self.motion, self.span = Motion(damping, self.stiffness, self.rate), self.k * self.period
        waves = [
            [evaluate(tree, {}, balls) for tree in (wave.phase, wave.cosine, wave.sine)] for wave in form.harmonics
        ]
        self.at_zero = (
            sum(a * phase.cos() + b * phase.sin() for phase, a, b in waves),
            sum(b * phase.cos() - a * phase.sin() for phase, a, b in waves),
        )
        self.amplitude = (self.at_zero[0] ** 2 + self.at_zero[1] ** 2).sqrt()
        self.determinant = self.r ** (2 * self.n) * (-damping * self.span).exp()
        turns = round(float(self.span * self.rate / (2 * flint.arb.pi())))
        self.alike = [self.span / 2] if self.n == 2 and turns % 2 == 0 else []
        self.kept: dict[Any, OrbitOnCurve | None] = {}

    @cached_property
    def ends(self) -> tuple[float, float]:
        """The ends of p."""
        if self.n == 2:
            return 0.0, float(self.span) / 2
        along, across = (float(self._one(flint.arb(p))[1][0]) for p in (0, flint.arb.pi() / 2))
        need(isfinite(along), InputError(f"orbits = (1, {self.k}) is not accepted: {SINGULAR}"))
        slowest = atan2(across, along) - pi
        return slowest, slowest + 2 * pi

    def at(self, p: Ball) -> OrbitOnCurve | None:
        """The orbit over a ball of p; None where the ball is too wide to tell."""
        key = p.mid().man_exp(), p.rad().man_exp()
        if key not in self.kept:
            try:
                self.kept[key] = self._orbit(p)
            except (ValueError, ZeroDivisionError):
                self.kept[key] = None
        return self.kept[key]

    def phase(self, launch: State) -> Ball:
        """The phase of a launch, in (-period/2, period/2]."""
        (a, b), (c, s) = self.at_zero, (launch[3][0], launch[4][0])
        return flint.arb.atan2(c * b - s * a, c * a + s * b) / self.rate

    def _orbit(self, p: Ball) -> OrbitOnCurve:
        if self.n == 1:
            e, v, *wave = self._one(p)
            launches, spans = [(0 * v, v, e, *wave)], [self.span]
            flows = [self.motion(self.span).table()]
        else:
            spans = [p, self.span - p]
            flows = [self.motion.series(p), self.motion.series(self.span - p, -1)]
            e, *wave, v, after = self._two(p)
            turned = [combined(row[3:], tuple(wave)) for row in flows[0][3:]]
            launches = [(0 * v, v, e, *wave), (0 * v, after, e, *turned)]
        return OrbitOnCurve(self, (self.steady - e) * (1 / self.stiffness), tuple(launches), tuple(spans), tuple(flows))

    # ---- one impact

    def _one(self, p: Ball) -> list[Series]:
        # e, v, C, S by the angle p
        angle, flow = flint.arb_series([p, 1], LENGTH), self.motion(self.span)
        wave = angle.cos() * self.amplitude, angle.sin() * self.amplitude
        pushed = [-combined([flow[i, 3], flow[i, 4]], wave) for i in (0, 1)]
        (a, b), (c, d) = (flow[0, 2], flow[0, 1]), (self.r * flow[1, 2], self.r * flow[1, 1] + 1)
        share = 1 / (a * d - b * c)
        return [
            (pushed[0] * d - pushed[1] * (self.r * b)) * share,
            (pushed[1] * (self.r * a) - pushed[0] * c) * share,
            *wave,
        ]

    # ---- two impacts

    def _two(self, p: Ball) -> list[Series]:
        # e, C, S and both velocities by the length p of the first flight: Taylor's formula about the middle of p
        off = p - p.mid()
        middle = self._scaled(p.mid())
        if off.is_zero():
            return middle
        powers = [flint.arb(1)]
        while len(powers) <= TERMS:
            powers.append(powers[-1] * off)
        series = []
        for here, over in zip(middle, self._scaled(p), strict=True):
            terms = [here[j] for j in range(TERMS)] + [over[TERMS]]
            moved = [sum(comb(j, m) * terms[j] * powers[j - m] for j in range(m, TERMS + 1)) for m in range(KEPT)]
            series.append(flint.arb_series(moved, KEPT))
        return series

    def _scaled(self, p: Ball) -> list[Series]:
        # the solution with the amplitude of the forcing
        solution = self._solution(p)
        wave = solution[1] * solution[1] + solution[2] * solution[2]
        size = (self.sign * self.amplitude) / wave.sqrt()
        return [part * size for part in solution]

    def _solution(self, p: Ball) -> list[Series]:
        # a solution of the four equations: their minors
        # All minors vanish with p, and where both flights are alike: near there they are divided by the distance. What
        # is left has the Taylor coefficients of the next order, over a ball that reaches to the zero.
        for zero, side in [(flint.arb(0), 1), *((alike, -1) for alike in self.alike)]:
            gap = side * (p - zero)
            if abs(gap).lower() <= NEAR * p.rad():
                minors = self._minors(p.union(zero))
                return [side * flint.arb_series(list(minor)[1:], TERMS + 1) for minor in minors]
            if gap < self.period / 8:
                return [minor / flint.arb_series([gap, side], LENGTH) for minor in self._minors(p)]
        return self._minors(p)

    def _minors(self, p: Ball) -> list[Series]:
        first, second = self.motion.series(p), self.motion.series(self.span - p, -1)
        turn, rows = [row[3:] for row in first[3:]], []
        for i, scale, after in ((0, 1, 0), (1, self.r, 1)):
            rows.append([*(first[i][j] * scale for j in (2, 3, 4, 1)), after])
        for i, scale, after in ((0, 1, 0), (1, self.r, 1)):
            turned = [combined(second[i][3:], (turn[0][j], turn[1][j])) for j in (0, 1)]
            rows.append([*(entry * scale for entry in (second[i][2], *turned)), after, second[i][1] * scale])
        minors: dict[tuple[int, ...], Series] = {(j,): rows[-1][j] for j in range(5)}  # by columns, of the last rows
        for size, row in enumerate(reversed(rows[:-1]), 2):
            minors = {
                columns: combined(
                    [row[j] if slot % 2 == 0 else -row[j] for slot, j in enumerate(columns)],
                    tuple(minors[columns[:slot] + columns[slot + 1 :]] for slot in range(size)),
                )
                for columns in combinations(range(5), size)
            }
        return [(-1) ** (4 - slot) * minors[columns] for slot, columns in enumerate(minors)][::-1]
