"""Starts off the wall of linear models against Taylor steps in balls: every kind of free motion, grazes on the way."""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb, arb_mat, ctx

import singimpact as si
from singimpact.status import Status

# f, damping, stiffness, constant force, waves (rate, cosine, sine), clearance; all of them doubles
MODELS = {
    "underdamped": ("x + xdot/8", 0.125, 1.0, 0.0, [(2.75, 1.0, 0.0)], 0.25),
    "undamped": ("x", 0.0, 1.0, 0.0, [(2.75, 1.0, 0.0)], 0.0),
    "overdamped": ("3*xdot + x", 3.0, 1.0, 0.0, [(2.0, 1.0, 0.0)], -0.5),
    "critical": ("2*xdot + x", 2.0, 1.0, -0.5, [(1.0, 1.0, 0.0), (2.0, 0.25, 0.5)], 0.25),
    "no stiffness": ("0", 0.0, 0.0, -0.25, [(1.5, 1.0, 0.0)], 0.0),
    "drag alone": ("xdot/4", 0.25, 0.0, -0.25, [(3.0, 1.0, 0.0), (5.0, 0.0, 1.0)], 0.0),
    "negative stiffness": ("xdot/2 - x/4", 0.5, -0.25, -1.0, [(2.0, 1.0, 0.0)], 0.125),
    "resonance": ("x", 0.0, 1.0, 0.0, [(1.0, 1.0, 0.0)], 0.125),
    "near resonance": ("x + xdot/1024", 2.0**-10, 1.0, 0.0, [(1.0, 1.0, 0.0)], 0.125),
    "antidamped": ("x - xdot/16", -0.0625, 1.0, 0.0, [(2.0, 1.0, 0.0)], 0.0),
    "stiff": ("64*x + xdot", 1.0, 64.0, 0.0, [(1.0, 1.0, 0.0), (3.0, 0.5, 0.5)], 0.125),
    "ball": ("0", 0.0, 0.0, -2.0, [], 0.0),
}
BITS, DEGREE, DEPTH = 200, 30, 56
ROUNDINGS = 6
"""Of a result in the units of `sensitivity`; 2 were the most in 6000 flights."""


def forcing(steady, waves):
    terms = [f"{a!r}*cos({w!r}*t) + {b!r}*sin({w!r}*t)" for w, a, b in waves]
    return " + ".join([repr(steady), *terms])


def oscillator(name):
    f, _d, _k, steady, waves, clearance = MODELS[name]
    return si.ImpactOscillator(f, forcing(steady, waves), repr(clearance), "1/2")


class Flow:
    """y' = M y of y = (x - c, x', 1, cosine and sine of every wave), in steps of a quarter radian."""

    def __init__(self, name):
        _f, damping, stiffness, steady, self.waves, clearance = MODELS[name]
        n = 3 + 2 * len(self.waves)
        rows = [[arb(0)] * n for _ in range(n)]
        rows[0][1], rows[1][:3] = arb(1), [-arb(stiffness), -arb(damping), arb(steady) - arb(stiffness) * clearance]
        for j, (rate, cosine, sine) in enumerate(self.waves):
            at = 3 + 2 * j
            rows[1][at], rows[1][at + 1], rows[at][at + 1], rows[at + 1][at] = cosine, sine, -arb(rate), arb(rate)
        self.matrix = arb_mat(rows)
        fastest = max([0.5, abs(damping), abs(stiffness) ** 0.5, *(wave[0] for wave in self.waves)])
        self.step = 2.0 ** np.floor(np.log2(0.25 / fastest))
        self.over_step = self.after(self.step)

    def after(self, time):
        return (self.matrix * time).exp()

    def start(self, height, v, t):
        angles = [(arb(rate) * arb(t)).sin_cos() for rate, _c, _s in self.waves]
        return arb_mat([[arb(height)], [arb(v)], [arb(1)], *([part] for s, c in angles for part in (c, s))])

    def first_impact(self, height, v, t, until):
        """Time, x', x'' of the first impact before `until`; None without one, nan where 56 halvings do not decide."""
        y, steps = self.start(height, v, t), 0
        while steps * self.step < until:
            root = self.root(y)
            if root is not None:
                time = arb(root)
                for _ in range(8):  # Newton's method, from 56 halvings of the step
                    state = self.after(time) * y
                    time = (time - state[0, 0] / state[1, 0]).mid()
                bend = (self.matrix * state)[1, 0]
                return tuple(float(part) for part in (time + steps * self.step, state[1, 0], bend))
            y, steps = self.over_step * y, steps + 1
            if steps % 16 == 0:
                y = arb_mat([[part.mid()] for part in y.entries()])
        return None

    def root(self, y):
        """The first zero of x - c on a step, by the signs of balls of x and x' on halves of halves."""
        coefficients, term = [], y
        for k in range(DEGREE):
            coefficients.append(term[0, 0])
            term = self.matrix * term / (k + 1)
        parts = [(0.0, self.step)]
        while parts:
            low, high = parts.pop()
            middle, radius = (low + high) / 2, arb(0, (high - low) / 2)
            shifted = moved(coefficients, middle)
            slope = horner([k * part for k, part in enumerate(shifted)][1:], radius)
            if horner(shifted, radius) > 0 or slope > 0:
                continue
            if slope < 0:
                if horner(coefficients, arb(high)) > 0:
                    continue
                for _ in range(DEPTH):
                    middle = (low + high) / 2
                    low, high = (middle, high) if horner(coefficients, arb(middle)) > 0 else (low, middle)
                return low
            if high - low < self.step * 2.0**-DEPTH:
                return np.nan
            parts += [(middle, high), (low, middle)]
        return None


def moved(coefficients, at):
    """The polynomial in the distance from a place."""
    parts = list(coefficients)
    for i in range(len(parts)):
        for j in range(len(parts) - 2, i - 1, -1):
            parts[j] = parts[j] + at * parts[j + 1]
    return parts


def horner(coefficients, s):
    value = arb(0)
    for part in reversed(coefficients):
        value = value * s + part
    return value


@pytest.fixture(autouse=True)
def bits():
    before, ctx.prec = ctx.prec, BITS
    yield
    ctx.prec = before


def states(name, seed, count):
    """Heights from 1e-12 to 10, velocities of both signs of as many sizes, times of up to a million."""
    rng, clearance = np.random.default_rng([seed, len(name)]), MODELS[name][-1]
    x = clearance + 10 ** rng.uniform(-12, 1, count)
    v = 10 ** rng.uniform(-12, 1, count) * rng.choice([-1, 1], count)
    return x, v, rng.uniform(-10, 10, count) * 10 ** rng.choice([0, 0, 2, 5], count)


def compare(name, launched, starts, horizon):
    """All that was launched: the first impact, to its sensitivity; none is missed or invented."""
    flow, clearance = Flow(name), MODELS[name][-1]
    for k, (x, v, t) in enumerate(zip(*(column.tolist() for column in starts), strict=True)):
        status, time, velocity = launched.status[k], launched.flight_time[k], launched.velocity[k]
        if status == Status.hit and time > horizon:
            continue
        truth = flow.first_impact(x - clearance, v, t, min(time, horizon) * 1.001 + flow.step)
        if status in (Status.no_return, Status.escaped):
            assert truth is None, (x, v, t)
            continue
        if status != Status.hit:
            assert status in (Status.graze, Status.unresolved)
            continue
        assert truth is not None, (x, v, t)
        exact_time, exact_velocity, bend = truth
        # roundings of the start, over the speed at the impact
        size = abs(x - clearance) + abs(v) * exact_time + exact_time**2
        steep = 1 + size / abs(exact_velocity * exact_time)
        rounding = ROUNDINGS * 2.0**-52 * steep * (1 + exact_time / 16)
        assert abs(time - exact_time) <= rounding * exact_time, (x, v, t)
        bound = rounding * (abs(exact_velocity) + abs(bend) * exact_time)
        assert abs(velocity - exact_velocity) <= bound, (x, v, t)


@pytest.mark.parametrize("name", MODELS)
def test_arrays(name):
    starts = states(name, 1, 80)
    compare(name, oscillator(name).launch(*starts), starts, 12.0)


@pytest.mark.parametrize("name", MODELS)
def test_single_starts_are_those_of_arrays(name):
    osc, (x, v, t) = oscillator(name), states(name, 2, 70)
    many = osc.launch(x, v, t)
    for k, start in enumerate(zip(x.tolist(), v.tolist(), t.tolist(), strict=True)):
        one = osc.launch(*start)
        assert one.status == many.status[k]
        assert one.flight_time == pytest.approx(many.flight_time[k], rel=1e-13, nan_ok=True)
        assert one.v == pytest.approx(many.v[k], rel=1e-12, nan_ok=True)


def beside_a_graze(flow, clearance, depth, rng):
    """A start whose flight comes to `depth` above the wall and no lower for a while."""
    while True:
        touch, before = rng.uniform(0, 6), rng.uniform(0.5, 16) * flow.step
        state = flow.start(depth, 0.0, touch)
        height, v = (flow.after(arb(-before)) * state).entries()[:2]
        if (flow.matrix * state)[1, 0] > 0.05 and height > 1e-3:
            return clearance + float(height), float(v), touch - before


@pytest.mark.parametrize("name", ["underdamped", "critical", "drag alone", "resonance", "no stiffness"])
def test_grazes_on_the_way(name):
    """Above the wall and below it, by less and less: followed backwards from there."""
    flow, clearance, rng = Flow(name), MODELS[name][-1], np.random.default_rng(3)
    depths = [sign * 10.0**-power for power in (3, 6, 9, 11, 13) for sign in (1, -1)]
    starts = np.array([beside_a_graze(flow, clearance, depth, rng) for depth in depths for _ in range(8)]).T
    compare(name, oscillator(name).launch(*starts), starts, 12.0)
