"""Flights of a family: ends and their derivatives against scipy's integrator and differences of exact ends."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from singimpact.flights import exponential
from singimpact.flights.family import family
from singimpact.impact_oscillator import ImpactOscillator, linear

DUFFING = ImpactOscillator(
    "x + d*xdot + b*x**3", "A*cos(w*t)", "0.3", "0.6", {"d": "0.1", "b": "0.3", "A": 1, "w": "1.7"}
)
WAVES = ImpactOscillator("k*x + d*xdot", "A*cos(w*t + 1) + sin(2*w*t)", "0.3", "0.6",
                         {"d": "0.1", "k": "1.2", "A": 1, "w": "1.7"})  # fmt: skip
OVER = [(DUFFING, name) for name in ("d", "b", "A", "w", "clearance", "restitution")]
OVER += [(WAVES, name) for name in ("d", "k", "A", "w", "clearance", "restitution")]
OVER += [(linear("0.9", -1, "0.8", phase="0.3"), "phase")]


@pytest.mark.parametrize(("osc", "name"), OVER)
def test_derivatives(osc: ImpactOscillator, name: str) -> None:
    moving = family(osc, (name,))
    tau, v, time, values = 0.7, 0.4, 2.3, dict(moving.start)
    end = moving.end(values, tau, v, time)

    def slope(place) -> np.ndarray:
        return (place(1e-5) - place(-1e-5)) / 2e-5

    close = {"rel": 1e-8, "abs": 3e-9}
    assert end.by_time == pytest.approx(slope(lambda h: moving.end(values, tau, v, time + h).place), **close)
    assert end.by_tau == pytest.approx(slope(lambda h: moving.end(values, tau + h, v, time).place), **close)
    assert end.by_v == pytest.approx(slope(lambda h: moving.end(values, tau, v + h, time).place), **close)
    moved = slope(lambda h: moving.end({name: values[name] + h}, tau, v, time).place)
    assert end.by_numbers[0] == pytest.approx(moved, **close)


@pytest.mark.parametrize("osc", [DUFFING, WAVES])
def test_ends_and_paths_are_those_of_an_integrator(osc: ImpactOscillator) -> None:
    moving = family(osc, ("w", "clearance"))
    values = {"w": 1.3, "clearance": -0.2}
    p = {name: float(str(tree)) for name, tree in osc.parameters.items()} | {"w": 1.3}

    def motion(t: float, state: list[float]) -> list[float]:
        x, u = state
        if osc is DUFFING:
            return [u, p["A"] * np.cos(1.3 * t) - x - p["d"] * u - p["b"] * x**3]
        return [u, p["A"] * np.cos(1.3 * t + 1) + np.sin(2.6 * t) - p["k"] * x - p["d"] * u]

    path = moving.path(values, 0.7, -0.4, 3.0)
    times = 0.7 + np.linspace(0, 3.0, len(path) + 1)[1:]
    truth = solve_ivp(motion, (0.7, 3.7), [-0.2, -0.4], "DOP853", t_eval=times, rtol=1e-13, atol=1e-13).y
    assert path[:, 0] - 0.2 == pytest.approx(truth[0], abs=1e-11)
    assert path[:, 1] == pytest.approx(truth[1], abs=1e-11)
    assert moving.end(values, 0.7, -0.4, 3.0).place == pytest.approx(path[-1], abs=1e-13)
    period = moving.period(values)
    assert period.value == pytest.approx(2 * np.pi / 1.3, rel=1e-15)
    assert period.slopes == pytest.approx((-2 * np.pi / 1.69, 0.0), rel=1e-14)


def test_exponential() -> None:
    from scipy.linalg import expm

    rng = np.random.default_rng(3)
    for size in (0.01, 1.0, 30.0):
        matrix = rng.normal(size=(7, 7))
        matrix = size * (matrix - matrix.T) / 7
        assert exponential(matrix) == pytest.approx(expm(matrix), abs=1e-13)
    assert exponential(np.zeros((3, 3))).tolist() == np.eye(3).tolist()


def test_threads_do_not_meet_in_the_numbers_of_a_model() -> None:
    moving = family(DUFFING, ("b",))
    values = [{"b": 0.1 * i} for i in range(1, 9)]

    def flown(each: dict[str, float]) -> list[float]:
        return moving.end(each, 0.7, 0.4, 1.3).place.tolist()

    alone = [flown(each) for each in values]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(flown, values * 5))
    assert together == alone * 5


def test_a_faster_forcing_is_sampled_more_finely() -> None:
    moving = family(linear("0.9", -1, "0.8"), ("omega",))
    slow, fast = (moving.samples({"omega": omega}, 10.0) for omega in (0.9, 9.0))
    assert fast >= 24 * 10 * 9 / (2 * np.pi) > slow
