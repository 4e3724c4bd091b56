"""Flights of an analytic model in balls, impact after impact, at one precision: the flow that orbits use.

First hits soon after a launch take one Taylor polynomial, whose cut-off is bounded for many launches at once.
Let |z''| <= M for all flights z = x - c from a box of launches, 0 < v <= V, while the complex time s since the launch
is below R. By Cauchy's estimate |z_k| <= M R^(2 - k)/(k (k - 1)) for each Taylor coefficient, k >= 2, so

    |y - Y| <= E s^n/n,   |y' - Y'| <= E s^(n-1),   E = M R^(1-n)/((n + 1)(1 - h/R)),   0 <= s <= h < R,

with y = z/s and Y its polynomial of degree n - 1. The first hit is the only zero of y where y > 0 at 0, y < 0 at h and
y' < 0 between.

M comes from a bound G of g - f(c, 0). Where f is linear, Gronwall's lemma gives |z'| <= u and w |z| <= u with
u = (V + G R) e^(L R), w^2 = |f_x|, L = w + |f_v|, and M = G + L u for every R. Else M is a bound of |g - f| on
|z| <= V R + M R^2/2, |z'| <= V + M R, which the flight cannot leave.
"""

from dataclasses import dataclass
from fractions import Fraction
from math import ceil, log, log2
from typing import Any, NamedTuple

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.precision import balls_at, series_of_any_length
from singimpact.flights.enclosures.certified_hit import ENCLOSURE, first_hit
from singimpact.flights.enclosures.equation import Equation, NoHit, Refused, programs_of
from singimpact.flights.enclosures.motion import CarriedMotion, Start
from singimpact.flights.enclosures.taylor_step import around, coefficients, degree_at, drive, linear_coefficients
from singimpact.flights.enclosures.tube import ball, upper
from singimpact.handed_on import flint
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import RESTITUTION


class FlownHit(NamedTuple):
    """A proved first hit: flight time and the velocity there, x-dot < 0; both None when none comes before the limit."""

    time: Any
    velocity: Any


class AnalyticFlow:
    """The numbers of a model as balls, and its flights from launches that are balls.

    Parameters
    ----------
    osc : the model, its restitution a number. bits : of the balls, at which the flow is made and used.
    number : name and ball of a number of the model that takes every value in the ball; what is returned then holds for
        each of them.

    Examples
    --------
    >>> from singimpact.algebra.precision import balls_at
    >>> with balls_at(200):
    ...     flow = AnalyticFlow(Oscillator("x + x**3", "cos(2*t)", "0.3", "0.5"), 200)
    ...     hit = flow.first_hit(flow.number(Fraction(0)), flow.number(Fraction(1)))
    ...     print(hit.time.str(25, radius=False))
    1.769788982840214783740587
    """

    def __init__(self, osc: Oscillator, bits: int, number: tuple[str, Any] | None = None) -> None:
        moving = dict([number] if number else [])
        self.balls, self.equation = Balls(bits), Equation(programs_of(osc, tuple(moving)), moving)
        self.r = moving[RESTITUTION] if RESTITUTION in moving else evaluate(osc.restitution, moving, self.balls)
        self.longest = Fraction(10_000)
        self.short = ShortFlights(self.equation, bits)

    def number(self, value: Fraction) -> Any:
        """A rational as a ball."""
        return self.balls.rational(value)

    def acceleration(self, tau: Any, order: int = 0) -> Any:
        """a_c, or its derivative of order 1, at tau."""
        if order:
            return self.equation.by_time(tau, self.number(Fraction(0)))
        if self.equation.programs.parametric:
            zero = self.number(Fraction(0))
            return self.equation.acceleration(tau, zero, zero)
        with series_of_any_length():  # an orbit asks for a_c where it flies next
            return self.short.drive(tau)[0] - self.equation.at_wall()[0]

    def pressing(self, tau: Any, window: Any, v: Any) -> tuple[Any, Any]:
        """Bounds of -x'' while t is in the window after tau, |x'| <= 2 v and 0 <= x - c <= 2 v window."""
        fast = (2 * v).upper()
        high = (2 * v * window).upper()
        zero = self.number(Fraction(0))
        pull = -self.equation.acceleration(tau.union(tau + window), zero.union(high), (-fast).union(fast))
        return pull.lower(), pull.upper()

    def first_hit(self, tau: Any, v: Any, limit: Any = None, removed: int = 1) -> FlownHit | None:
        """The first t > 0 with x = c.

        Parameters
        ----------
        tau, v : the launch. limit : no hit is looked for beyond. removed : the power p of t in x - c; above 1 from
            rest.

        Returns
        -------
        FlownHit or None : None where these balls do not decide it.
        """
        with series_of_any_length():
            if removed == 1 and (soon := self.short.hit(tau, v)) is not None:
                return FlownHit(None, None) if limit is not None and soon[0] > limit else FlownHit(*soon)
            a = self.acceleration(tau)
            expected = float((2 * v / -a).mid()) if removed == 1 and a < 0 else 0.0
            horizon = self.number(self.longest) if limit is None else limit
            equations, bits = (self.equation, self.equation), self.balls.bits - ENCLOSURE.guard
            motion = CarriedMotion(equations, Start(tau, v, removed, expected), bits)
            try:
                hit = first_hit(motion, horizon, ENCLOSURE.idle_steps)
            except NoHit:
                return FlownHit(None, None)
            except Refused:
                return None
        return FlownHit(hit.flight_time, hit.velocity)


# ---- flights that are over soon


@dataclass(frozen=True)
class ShortSettings:
    """Which flights are short, and where their bound is made."""

    # of a window, over the flight time that doubles expect: y is shown negative at its end
    reach: float = 1.125
    # of R that a flight time is at most; beyond it a step of its own needs the lower degree
    share: float = 0.5
    # coefficients and steps of the flight time in doubles
    expected: int = 8
    rounds: int = 10
    # degree of a polynomial at least: a_c and its derivative are read off its forcing
    least: int = 4
    # R at first and the factor of the next one, at most so many: under cos 2t the lowest degree has R = 8 to 11 where f
    # is linear, and R = 0.45 for x + x^3
    widest: float = 16.0
    shrink: float = 0.7
    discs: int = 60
    # of launch times, over R: chatter lies within it, and a wider box has a larger M
    box: float = 0.25
    # V over the velocity of the first launch: the launches after it in an orbit may be a little faster
    faster: float = 4.0
    # factor of the bound that is tried over |g - f| at launches
    room: float = 4.0
    # of the bound, which is rounded outwards
    bits: int = 64
    # bits of a cut-off beyond those of v, whose radius grows from impact to impact; 2^-8 of it adds little
    finer: int = 8
    # bits of a root in doubles, where balls find it there
    guessed: int = 43
    # of Newton's method in balls at most; 300 bits take three
    steps: int = 8


SHORT = ShortSettings()


class Discs(NamedTuple):
    """A box of launches, and what bounds x'' of all of them.

    Parameters
    ----------
    tau, v : the launch times, a ball, and V. radius, bound : R and M. size : log2(M R).
    """

    tau: Any
    v: Any
    radius: float
    bound: Any
    size: float

    def degree(self, time: float, v: float, bits: int) -> int:
        """The degree whose cut-off after a time is 2^-bits of v."""
        return ceil((bits + self.size - log2(v)) / log2(self.radius / (time * SHORT.reach)))


class ShortFlights:
    """Short flights of an equation at one precision; the discs of a launch serve those next to it.

    Examples
    --------
    >>> from fractions import Fraction
    >>> from singimpact.algebra.precision import balls_at, series_of_any_length
    >>> from singimpact.flights.enclosures.equation import equation_of
    >>> from singimpact.oscillator.model import Oscillator
    >>> import flint
    >>> with series_of_any_length(), balls_at(200):
    ...     flights = ShortFlights(equation_of(Oscillator("x + x**3", "-2 + cos(2*t)", 0, "0.5")), 170)
    ...     time, velocity = flights.hit(flint.arb(0), flint.arb(1) / 64)
    ...     print(time.str(25, radius=False))
    0.03123729959163697494137940
    """

    def __init__(self, equation: Equation, bits: int) -> None:
        self.equation, self.bits, self.most = equation, bits, degree_at(bits)
        self.discs: Discs | None = None
        self.degree = SHORT.least
        self.launch: tuple[Any, list[Any]] = None, []

    def drive(self, tau: Any) -> list[Any]:
        """Taylor coefficients of g at a launch, as many as the flight before took."""
        if self.launch[0] is not tau:
            self.launch = tau, drive(self.equation, tau, self.degree)
        return self.launch[1]

    def hit(self, tau: Any, v: Any) -> tuple[Any, Any] | None:
        """Flight time and velocity of the first hit from a launch, both proved; None where the flight is not short."""
        if self.equation.programs.parametric:  # the discs below are those of a force at rest
            return None
        speed, g, force = float(v), self.drive(tau), self.equation.at_wall()
        a = g[0] - force[0]
        if not (a < 0 and v > 0 and speed > 0):
            return None
        time = _root_of([speed, float(a) / 2, float(g[1] - force[2] * a) / 6])
        discs = self._around(tau, v, time) if time > 0 else None
        if discs is None or not time < discs.radius * SHORT.share:
            return None
        # digits beyond the radius of v would be lost
        bits = min(self.bits, v.rel_accuracy_bits() + SHORT.finer)
        degree = discs.degree(time, speed, bits)
        if degree > self.most:
            return None
        self.degree = max(degree, SHORT.least)
        if not self.equation.linear:
            X = coefficients(self.equation, (tau, v * 0, v), self.degree)
        else:
            g = g[: self.degree - 1] if self.degree <= len(g) else drive(self.equation, tau, self.degree - 1)
            X = linear_coefficients(g, force, (v * 0, v))
        time = _root_of([float(value) for value in X[1 : SHORT.expected]])
        return self._proved(X, time, bits, discs) if 0 < time < discs.radius * SHORT.share else None

    def _around(self, tau: Any, v: Any, time: float) -> Discs | None:
        """Discs that hold a launch: those of the last one, where they do."""
        discs = self.discs
        if discs is None or not (discs.tau.contains(tau) and v < discs.v):
            with balls_at(SHORT.bits):
                self.discs = self._best(tau, v, time, SHORT.widest if discs is None else 2 * discs.radius)
        return self.discs

    def _best(self, tau: Any, v: Any, time: float, radius: float) -> Discs | None:
        """The discs, from a radius downwards, that take the lowest degree for a flight of so long."""
        best: tuple[int, Discs] | None = None
        for _ in range(SHORT.discs):
            if not radius * SHORT.share > time:
                break
            discs = self._discs(tau, upper(v * SHORT.faster), radius)
            if discs is not None:
                degree = discs.degree(time, float(v), self.bits)
                if best is not None and not degree < best[0]:
                    break
                best = degree, discs
            radius *= SHORT.shrink
        return None if best is None else best[1]

    def _discs(self, tau: Any, fastest: Any, radius: float) -> Discs | None:
        """Discs of a radius; None where no bound of x'' is shown."""
        g = self.equation.run("drive", t=around(tau, flint.arb(radius * (1 + SHORT.box))))[0]
        bound = (self._linear if self.equation.linear else self._picard)(g, fastest, radius)
        if bound is None or not bound.is_finite():
            return None
        size = log2(radius) + float(bound.log()) / log(2)
        return Discs(tau + ball(flint.arb(radius * SHORT.box)), fastest, radius, bound, size)

    def _linear(self, g: Any, fastest: Any, radius: float) -> Any:
        """The bound of |z''| by Gronwall's lemma, where f is linear."""
        at_wall, k, d = self.equation.at_wall()
        G, L = upper(g - at_wall), upper(k).sqrt() + upper(d)
        return upper(G + L * (fastest + G * radius) * (L * radius).exp())

    def _picard(self, g: Any, fastest: Any, radius: float) -> Any | None:
        """A bound of |z''| that the flight is shown to keep, as the discs that it leads to give a smaller one."""
        zero = flint.arb(0)
        pull = self.equation.run("force", x=around(zero, zero), xdot=around(zero, fastest))[0]
        bound = upper(flint.acb(g - pull)) * SHORT.room
        if not bound.is_finite():
            return None
        high, fast = radius * (fastest + bound * radius / 2), fastest + bound * radius
        pull = self.equation.run("force", x=around(zero, high), xdot=around(zero, fast))[0]
        shown = upper(flint.acb(g - pull))
        return shown if shown <= bound else None

    @staticmethod
    def _proved(X: list[Any], time: float, bits: int, discs: Discs) -> tuple[Any, Any] | None:
        n, radius, window = len(X) - 1, flint.arb(discs.radius), flint.arb(time * SHORT.reach)
        left = discs.bound * radius ** (1 - n) / ((n + 1) * (1 - window / radius))
        y = flint.arb_poly([*X[1:], ball(left / n)])
        slope = flint.arb_poly([*(k * value for k, value in enumerate(X[2:], 1)), ball(left)])
        # y = z/s is positive at 0, where it is v
        piece = flint.arb(0).union(window)
        rate = slope(piece)
        if not (rate < 0 and y(window) < 0):
            return None
        # the mean value theorem: the root is t - y(t)/y'(s), with s between t and the root
        middle = flint.arb(time)
        root = middle - y(middle) / rate
        sharp = SHORT.guessed if abs(float(root) - time) < 2.0**-SHORT.guessed * time else 0
        for _ in range(SHORT.steps):
            if not (root > 0 and root < window):
                return None
            # the slope is known to so many bits, and multiplies a distance that is known to have so many
            if sharp + rate.rel_accuracy_bits() > bits:
                break
            middle, sharp, rate = root.mid(), root.rel_accuracy_bits(), slope(root)
            root = middle - y(middle) / rate
        return root, slope(root) * root


def _root_of(y: list[float]) -> float:
    """The zero of a polynomial next to that of its first two terms, in doubles; 0 where Newton's method has none."""
    if not y[1] < 0:
        return 0.0
    t = -y[0] / y[1]
    for _ in range(SHORT.rounds):
        value, slope = 0.0, 0.0
        for coefficient in reversed(y):
            slope = slope * t + value
            value = value * t + coefficient
        if not slope < 0:
            return 0.0
        change = value / slope
        t -= change
        if abs(change) < 1e-13 * t:
            return t
    return 0.0
