"""Basins between two walls against orbits of scipy's DOP853, which shares no code with them."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

SLOW = 1e-4
VAN_DER_POL = si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-3", "0.8", upper="1.2")
DUFFING = "x + x**3 + 0.1*xdot"
CHATTERING = "0.3*xdot"
# f and the amplitude and frequency of g as plain functions, walls, restitutions
PLAIN = {
    "linear": (lambda x, u: x + 0.05 * u, 4.0, 2.8, (-0.5, 0.5), (0.8, 0.8)),
    "uneven": (lambda x, u: x + 0.05 * u, 4.0, 2.8, (-0.5, 0.7), (0.8, 0.6)),
    "duffing": (lambda x, u: x + x**3 + 0.1 * u, 5.0, 1.7, (-0.5, 0.5), (0.7, 0.7)),
    "chatter": (lambda x, u: 0 * x + 0.3 * u, 1.0, 1.0, (-0.2, 0.2), (0.3, 0.3)),
}


def model(name):
    _, amplitude, omega, (low, high), (r, upper) = PLAIN[name]
    f = {"linear": "x + 0.05*xdot", "uneven": "x + 0.05*xdot", "duffing": DUFFING, "chatter": CHATTERING}[name]
    walls = {"clearance": low, "restitution": r, "upper": high, "upper_restitution": upper}
    return si.ImpactOscillator(f, "A*cos(w*t)", **walls, parameters={"A": amplitude, "w": omega})


def followed(name, tau, xdot, impacts):
    """Phase, x' and wall of the last impact, and how many times the mass came to rest; x' < 0 at the upper wall."""
    (f, amplitude, omega, walls, rates), period, rests = PLAIN[name], 2 * np.pi / PLAIN[name][2], 0

    def slopes(t, y):
        return [y[1], amplitude * np.cos(omega * t) - f(*y)]

    def lower(_, y):
        return y[0] - walls[0]

    def upper(_, y):
        return y[0] - walls[1]

    lower.terminal = upper.terminal = True
    lower.direction, upper.direction = -1, 1
    at = int(xdot < 0)
    for _ in range(impacts):
        away = 1 - 2 * at
        later = tau + np.linspace(0, period, 4001)
        push = away * slopes(later, (walls[at], 0.0))[1]
        if abs(xdot) < SLOW and push[0] < 0:
            tau, xdot, rests = later[np.argmax(push > 0)], 0.0, rests + 1
        # the first step is shorter than a flight, whose event functions are 0 at its start
        options = {"rtol": 1e-12, "atol": 1e-13, "max_step": 0.05 * period, "first_step": min(1e-3, abs(xdot) / 9 or 1)}
        flight = solve_ivp(slopes, (tau, tau + 200), (walls[at], xdot), "DOP853", events=(lower, upper), **options)
        at = int(flight.t_events[1].size > 0)
        tau, xdot = flight.t[-1], -rates[at] * flight.y[1, -1]
    return tau % period, xdot, at, rests


def wrong_pixels(name, found, wall, count, impacts=200):
    """How many of some states end elsewhere than the basins say."""
    period, rng, wrong = 2 * np.pi / PLAIN[name][2], np.random.default_rng(3), 0
    for i, j in rng.integers(0, found.tau.size, (count, 2)):
        tau, xdot, at, rests = followed(name, found.tau[j], found.v[i] * (1 - 2 * wall), impacts)
        attractor = found.attractors[found.codes[i, j]]
        if attractor.kind == "chatter":
            wrong += rests < 3
            continue
        turns = (attractor.tau - tau) / period
        away = np.maximum(np.abs(turns - np.rint(turns)), np.abs(attractor.v - xdot))
        wrong += attractor.kind != "orbit" or away.min() > 1e-3 or attractor.word.count("lu"[at]) == 0
    return wrong


@pytest.mark.parametrize("wall", [0, 1])
@pytest.mark.parametrize("name", PLAIN)
def test_states_end_where_scipy_ends(name, wall):
    found = si.basins(model(name), size=12, wall=wall)
    assert wrong_pixels(name, found, wall, 8) == 0


@pytest.mark.parametrize("name", ["linear", "duffing"])
def test_mirror_images_that_are_taken_for_one_another_are_seen(name):
    found = si.basins(model(name), size=12)
    assert len(found.attractors) >= 2
    found.codes[:] = (found.codes + 1) % len(found.attractors)
    assert wrong_pixels(name, found, 0, 8) >= 6


def test_mirror_images_have_names_and_mirrored_basins():
    lower, upper = (si.basins(model("duffing"), size=16, wall=wall) for wall in ("lower", "upper"))
    assert [run.name for run in lower.attractors] == ["(lluu, 1) orbit"] * 2
    names = [name for _, name, _ in lower.classes]
    assert len(set(names)) == 2
    # half a period later the upper wall has the picture of the lower one, with the other of both orbits
    of = {code: name for code, name, _ in lower.classes}, {code: name for code, name, _ in upper.classes}
    here = np.vectorize(of[0].get)(lower.codes)
    there = np.roll(np.vectorize(of[1].get)(upper.codes), 8, axis=1)
    assert (here != there).all()
    assert (lower.wall, upper.wall) == (0, 1)


def test_mass_that_a_wall_holds_rests_there_for_ever():
    for push, wall in (("1", "upper"), ("-1", "lower")):
        osc = si.ImpactOscillator("0", f"{push} + cos(t)/2", -1, "0.5", upper=1)
        assert [run.name for run in si.basins(osc, size=8).attractors] == [f"rest for ever at the {wall} wall"]


def test_a_forcing_that_never_repeats():
    osc = si.ImpactOscillator("x", "cos(2*t) + cos(2*sqrt(2)*t)/2", "-0.3", "0.7", upper="0.2")
    assert [run.name for run in si.basins(osc, size=4).attractors] == ["quasi-periodic"]


@pytest.mark.parametrize(("osc", "names", "v"), [
    (VAN_DER_POL, ["limit cycle of 1 impact, period 4.51183"], [2.02611]),
    (VAN_DER_POL.replace(upper=3), ["limit cycle without impact, period 6.66329"], []),
    (VAN_DER_POL.replace(clearance=-1, upper=1), ["limit cycle of 2 impacts, period 0.657411"], [5.39152, 5.39152]),
    (si.ImpactOscillator("x**3 - x + xdot/10", "0", "-1.5", "0.8", upper="0.5"),
     ["rest for ever at the upper wall", "rest off the wall at x = -1"], []),
    (si.ImpactOscillator("xdot/10 - x", "0", -1, "0.8", upper=1),
     ["rest for ever at the lower wall", "rest for ever at the upper wall"], []),
])  # fmt: skip
def test_models_without_t_start_between_the_walls(osc, names, v):
    """Velocities of the cycles are those of DOP853 with events at both walls."""
    found = si.basins(osc, size=10)
    assert sorted(run.name for run in found.attractors) == names
    assert found.x[-1] < float(str(osc.upper))
    assert found.wall is None
    assert np.abs(found.attractors[0].v).tolist() == pytest.approx(v, abs=1e-5)


@pytest.mark.parametrize(("osc", "more", "words"), [
    (VAN_DER_POL, {"wall": "upper"}, "none for a model without t"),
    (VAN_DER_POL, {"window": ((-1, 1.3), (-1, 1))}, "to an upper one"),
    (model("linear"), {"wall": ["lower", "upper"]}, "one wall, that of all states"),
    (model("linear"), {"wall": "left"}, "'lower' or 'upper'"),
    (si.linear(2, 0, "0.5"), {"wall": "upper"}, "the model has one wall"),
])  # fmt: skip
def test_refused(osc, more, words):
    with pytest.raises(InputError, match=words):
        si.basins(osc, size=4, **more)
