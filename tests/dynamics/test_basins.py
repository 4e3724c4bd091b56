"""Classes of states against single orbits, and settled orbits over a parameter."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics.basins import basins, name_of
from singimpact.dynamics.bifurcation import bifurcation
from singimpact.inputs import InputError
from singimpact.scenes.basins import draw_basins, draw_bifurcation
from singimpact.status import Status

MODEL = si.linear(2, "0.3", "0.5")


@pytest.fixture(scope="module")
def found():
    with ThreadPoolExecutor(1) as pool:
        return basins(MODEL, size=20, executor=pool)


def test_classes_agree_with_single_orbits(found):
    for i, j in [(0, 3), (0, 15), (10, 5), (19, 19), (4, 10)]:
        tau, v = float(found.tau[j]), float(found.v[i])
        if name_of(int(found.codes[i, j])) == "complete chatter":
            assert MODEL.chatter_limit(tau, v).status == Status.complete
        else:
            orbit = MODEL.orbit(tau, v, impacts=80)
            n, k = divmod(int(found.codes[i, j]), 1000)
            assert abs(orbit.tau[-1] - orbit.tau[-1 - n] - k * np.pi) < 1e-6


def test_shares_and_picture(found):
    assert abs(sum(share for _, _, share in found.classes) - 1) < 1e-12
    axes = draw_basins(found)
    assert "complete chatter" in " ".join(text.get_text() for text in axes.get_legend().get_texts())
    axes.figure.canvas.draw()


def test_across_a_swan():
    """Below c_0 = 1 settled orbits leave the obstacle at a tangency; above it they rest for ever."""
    model = si.linear(2, "0.3", "0.5")
    with ThreadPoolExecutor(1) as pool:
        over = bifurcation(model, "clearance", ("0.9", "1.1"), 3, impacts=60, kept=20, executor=pool)
    counts = np.isfinite(over.events[:, :, 0]).sum(axis=1)
    assert counts[0] > 5
    assert counts[2] == 1
    assert over.events[2, 0, 2] == 1
    draw_bifurcation(over).figure.canvas.draw()


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: basins(3), "model = 3"),
        (lambda: basins(si.universal(-1, "0.5")), "period"),
        (lambda: basins(MODEL, size=1), "size = 1"),
        (lambda: basins(MODEL, v=(-1, 1)), "window of v"),
        (lambda: basins(MODEL, tau=(1, 0)), "window of tau"),
        (lambda: bifurcation(MODEL, "q", (0, 1)), "unknown number of the model 'q'"),
        (lambda: bifurcation(MODEL, "omega", (1, 0)), "two numbers"),
        (lambda: bifurcation(MODEL, "omega", (1, 2), kept=0), "kept = 0"),
    ],
)
def test_refusals(ask, told):
    with pytest.raises(InputError, match=told):
        ask()


def to_the_end(model, size, v):
    """Codes of a grid by flying every state as long as the slowest chatter takes, without a look in between."""
    from singimpact.dynamics.attractors import periodic_codes
    from singimpact.flights.grids import after
    from singimpact.oscillator.acceleration import acceleration

    found = basins(model, v=(0, v), size=size)
    tau, speed = (part.ravel() for part in np.meshgrid(found.tau, found.v))
    ends = after(model, tau, speed, 90)
    codes = np.zeros(tau.size, dtype=int)
    codes[(ends.v < 1e-7 * v) & (acceleration(model, ends.tau) < 0)] = 1
    flying = np.flatnonzero((codes == 0) & (ends.status == 0) & (ends.v > 0))
    codes[flying] = periodic_codes(model, ends.tau[flying], ends.v[flying], v)
    return found.codes, codes.reshape(size, size)


@pytest.mark.parametrize(("force", "forcing", "r"), [("x", "cos(2*t)", "1/2"), ("x", "cos(14*t/5)", "0.6")])
def test_orbits_decided_early_are_those_decided_late(force, forcing, r):
    early, late = to_the_end(si.ImpactOscillator(force, forcing, "0.3", r), 40, 2.0)
    assert len(np.unique(late)) > 1
    assert np.mean(early != late) == 0


def test_an_attractor_catches_only_what_comes_in():
    from singimpact.dynamics.attractors import SETTINGS, caught, new_attractors
    from singimpact.flights.grids import after

    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", "1/2")
    ends = after(model, np.array([0.3]), np.array([1.5]), 60)
    (attractor,) = new_attractors(model, ends.tau, ends.v, 2.0)
    assert attractor.code == 1001
    assert SETTINGS.close <= attractor.catch <= SETTINGS.catch
    place = attractor.tau[0] + 0.99 * attractor.catch * np.pi * np.array([1, -1, 0])
    speed = attractor.v[0] + 0.99 * attractor.catch * 2.0 * np.array([1, -1, 0])
    assert (caught([attractor], model, place, speed, 2.0) == 1001).all()
    home = after(model, place, speed, 200)
    assert np.abs(home.v - attractor.v[0]).max() < 1e-9
    assert (caught([attractor], model, place + 0.5, speed, 2.0) == 0).all()
