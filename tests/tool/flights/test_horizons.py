"""Default horizons: flights that are long beside the forcing or the free motion, compared with scanned closed forms."""

import numpy as np
import pytest

import singimpact as si
from singimpact.status import Status

KINDS = ("slow forcing", "fast forcing", "weak mean force", "weak mean force with damping")


def draw(rng, kind):
    """Stiffness, damping, frequency, mean force and clearance of x'' + d x' + k x = cos(omega t) + mean, x >= c."""
    if kind == "slow forcing":
        return 1.0, float(rng.choice([0.0, 0.01])), 10 ** rng.uniform(-4, -2), 0.0, rng.uniform(-0.5, 0.9)
    if kind == "fast forcing":
        return 1.0, 0.0, 10 ** rng.uniform(2, 3), 0.0, rng.uniform(-0.5, 0.5)
    damping = 10 ** rng.uniform(-3, -1) if "damping" in kind else 0.0
    return 0.0, damping, rng.uniform(1, 4), -(10 ** rng.uniform(-4, -1)), 0.0


def closed_form(numbers, tau, v):
    """x - c at times after the launch, in numpy."""
    k, d, omega, mean, c = numbers
    answer = 1 / complex(k - omega**2, d * omega)

    def forced(t):
        return (answer * np.exp(1j * omega * t)).real

    place, speed = c - forced(tau), v - (1j * omega * answer * np.exp(1j * omega * tau)).real
    if k:
        rate, place = np.sqrt(k - d * d / 4), place - mean / k
        return lambda t: np.exp(-d * t / 2) * (
            place * np.cos(rate * t) + (speed + d * place / 2) / rate * np.sin(rate * t)
        ) + mean / k + forced(tau + t) - c  # fmt: skip
    if d:
        return lambda t: place + (speed - mean / d) * -np.expm1(-d * t) / d + mean / d * t + forced(tau + t) - c
    return lambda t: place + speed * t + mean * t * t / 2 + forced(tau + t) - c


def scanned(x, step, longest):
    """The first zero of x on a fine grid, by bisection; inf where there is none."""
    count, start = 2**17, 0.0
    while start < longest:
        t = start + step * np.arange(count + 1)
        z = x(t)
        if start == 0.0:
            z[0] = 1.0
        # a dip between two points of the grid is looked for at the lowest point of the parabola there
        middle = np.flatnonzero((z[1:-1] <= z[:-2]) & (z[1:-1] <= z[2:]) & (z[1:-1] < 1e-2)) + 1
        bend = z[middle - 1] - 2 * z[middle] + z[middle + 1]
        lowest = t[middle] + step * (z[middle - 1] - z[middle + 1]) / (2 * bend)
        dips = x(lowest) < 0
        ends = [(t[i - 1], t[i]) for i in np.flatnonzero(z < 0)[:1]]
        ends += [(t[i - 1], low) for i, low in zip(middle[dips][:1], lowest[dips][:1], strict=True)]
        if ends:
            low, high = min(ends, key=lambda pair: pair[1])
            for _ in range(70):
                middle = (low + high) / 2
                low, high = (middle, high) if x(middle) > 0 else (low, middle)
            return high
        start = t[-1]
    return np.inf


def compare(seed, count):
    rng, long_ones = np.random.default_rng(seed), 0
    for index in range(count):
        kind = KINDS[index % len(KINDS)]
        numbers = k, d, omega, mean, c = draw(rng, kind)
        osc = si.ImpactOscillator(f"{k!r}*x + {d!r}*xdot", f"cos({omega!r}*t) + ({mean!r})", c, "0.8")
        tau, v = rng.uniform(0, 2 * np.pi / omega), 10 ** rng.uniform(-3, 1)
        longest = 4 * np.pi / omega if kind == "slow forcing" else 2e4
        true = scanned(closed_form(numbers, tau, v), 0.05 / max(omega, k**0.5), longest)
        hit = osc.first_hit(tau, v)
        case = f"{numbers} from ({tau!r}, {v!r}): {hit}, scanned {true}"
        if np.isfinite(true):
            assert hit.status == Status.hit, case
            assert hit.flight_time == pytest.approx(true, rel=1e-9), case
            long_ones += true > 500
        else:
            assert hit.status != Status.hit or hit.flight_time > 0.99 * longest, case
    return long_ones


def test_long_flights_are_found_by_default():
    assert compare(1, 40) >= 2


@pytest.mark.slow
def test_long_flights_of_many_models_are_found_by_default():
    assert compare(2, 400) >= 20


def test_flights_of_a_weak_mean_force_and_of_a_fast_forcing():
    weak = si.ImpactOscillator("0", "cos(2*t) - 1/2000", 0, "0.8")
    assert weak.first_hit(0, 1.7).status == Status.hit
    assert si.linear(4000, "0.1", "0.8").first_hit("0.1", 1).flight_time == pytest.approx(2.9422974823412468, rel=1e-15)
    stiff = si.ImpactOscillator("x + 0.3*x**3", "cos(4000*t)", "0.1", "0.8")
    assert stiff.first_hit("0.1", 1).status == Status.hit
    ball = si.ImpactOscillator("0", "-1", 0, "0.8")
    assert ball.first_hit(0, 1e9).flight_time == pytest.approx(2e9)


def test_a_given_horizon_is_not_stretched():
    weak = si.ImpactOscillator("0", "cos(2*t) - 1/2000", 0, "0.8")
    assert weak.first_hit(0, 1.7, horizon=1000).status == Status.no_return


def test_a_slow_forcing_lifts_the_mass_for_a_third_of_its_period():
    """The quasi-static rest leaves the wall at cos(tau) = c and comes back at the mirrored phase, give or take O(1)."""
    osc = si.linear("1e-6", "0.1", "0.8")
    start = -np.arccos(0.1) * 1e6
    step = osc.impact_map(osc.release(start - 1.0), 0)
    assert step.status == Status.hit
    assert step.flight_time == pytest.approx(2 * np.arccos(0.1) * 1e6, rel=1e-3)


@pytest.mark.parametrize("force", ["(1 + cos(2*t)/5)*x + 0.1*xdot", "x + 0.1*xdot + 0.001*x**3"])
def test_a_force_that_vanishes_at_a_sample_is_no_weak_spring(force):
    """f = 0 at x = 0, 0.3 above the wall, up to rounding: the horizon was 2.5e6, which no Taylor steps reach."""
    osc = si.ImpactOscillator(force, "cos(2*t)/3", "-0.3", "0.7")
    hit = osc.replace(clearance="-0.6").first_hit(9.0, 0.008)  # it swings by 0.4
    assert hit.status in (Status.no_return, Status.escaped, Status.hit)
    ends = osc.launch(np.zeros(9), np.linspace(-1, 1, 9), 0.0)
    assert np.isin(ends.status, (Status.no_return, Status.escaped, Status.hit)).all()
    assert "unresolved" not in {found.kind for found in osc.basins(size=4).attractors}
