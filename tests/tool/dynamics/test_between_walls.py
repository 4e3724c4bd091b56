"""Diagrams and periodic orbits between two walls: against one another, and a pitchfork that breaks a symmetry."""

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Wall

PAIR = si.linear("2.8", "-0.5", "0.8", damping="0.05", amplitude=4, upper="0.5")
ROUNDING = 1e-6


@pytest.mark.parametrize("direction", [None, "up"])
def test_a_diagram_has_the_periodic_orbits_of_both_walls(direction):
    found = si.bifurcation(PAIR, "amplitude", ("3.6", "4.4"), 5, direction=direction)
    assert found.settled.all()
    names = [run.name for run in found.attractors]
    assert names.count("(lu, 1) orbit") >= 2
    for value, events, name in zip(found.values, found.events, names, strict=True):
        if name != "(lu, 1) orbit":
            continue
        orbits = [orbit for orbit in PAIR.replace(amplitude=value).periodic("lu", 1) if orbit.stable]
        own = {round(float(v), 6) for orbit in orbits for v in np.where(orbit.wall == 1, -orbit.v, orbit.v)}
        shown = {round(float(v), 6) for v in events[:, 1]}
        assert shown <= own
        assert min(shown) < 0 < max(shown)


def test_a_diagram_shows_the_impacts_at_both_walls():
    found = si.bifurcation(PAIR, "amplitude", ("3.6", "4.4"), 5)
    axes = si.plot(found)
    upper = next(axis for axis in np.ravel(axes) if "after an impact" in axis.get_ylabel())
    low, high = upper.get_ylim()
    assert low < np.nanmin(found.events[:, :, 1]) < 0 < np.nanmax(found.events[:, :, 1]) < high


def test_a_diagram_runs_over_the_place_and_the_restitution_of_the_upper_wall():
    found = si.bifurcation(PAIR, "upper", ("0.4", "0.6"), 3)
    assert found.settled.any()
    for value, events in zip(found.values[found.settled], found.events[found.settled], strict=True):
        orbit = PAIR.replace(upper=value).orbit(0.0, 0.1, 2000)
        assert np.allclose(np.sort(events[-2:, 1]), np.sort(orbit.speeds[-2:]), atol=ROUNDING)
    assert np.isfinite(si.bifurcation(PAIR, "upper_restitution", ("0.5", "0.9"), 3).values).all()
    with pytest.raises(InputError, match="upper"):
        si.bifurcation(si.linear(2, 0, "0.5"), "upper", (1, 2), 3)


def test_a_number_that_the_model_does_not_name_keeps_the_second_wall():
    free = si.linear("2.8", "-0.5", "0.8", upper="0.5")
    found = si.bifurcation(free, "amplitude", (4, 5), 2)
    assert (found.events[:, :, 1] < 0).any()


def test_symmetric_orbits_lose_their_stability_to_a_pair_of_mirror_images():
    duffing = si.ImpactOscillator("x + x**3 + 0.1*xdot", "5*cos(1.7*t)", "-0.5", "0.7", upper="0.5")
    orbits = duffing.periodic("lluu", 1)
    lone = [orbit for orbit in orbits if not orbit.symmetric]
    assert any(orbit.symmetric and orbit.multipliers[0] > 1 for orbit in orbits)
    assert [orbit.stable for orbit in lone] == [True, True]
    first, second = lone
    # half a period later, on the other walls
    half = first.period / 2
    shift = next(k for k in range(4) if np.allclose(np.roll(second.v, k), first.v, rtol=1e-9))
    assert (np.roll(second.wall, shift) != first.wall).all()
    late = (np.roll(second.tau, shift) - first.tau - half) / first.period
    assert np.abs(late - np.rint(late)).max() < 1e-9


@pytest.mark.parametrize("word", ["lu", "lul", "lluu"])
def test_states_of_an_orbit_are_mapped_to_one_another(word):
    walls = {"upper": "0.6", "upper_restitution": "0.8"}
    osc = si.ImpactOscillator("x + x**3 + 0.1*xdot", "5*cos(1.7*t)", "-0.5", "0.7", **walls)
    for orbit in osc.periodic(word, 1):
        step = osc.impact_map(orbit.tau, orbit.v, wall=orbit.wall)
        assert (step.wall == np.roll(orbit.wall, -1)).all()
        assert np.allclose(step.v, np.roll(orbit.v, -1), rtol=1e-9)
        D = np.eye(2)
        for tau, v, wall in zip(orbit.tau, orbit.v, orbit.wall, strict=True):
            D = osc.derivative(float(tau), float(v), wall=int(wall)).matrix @ D
        sizes = (np.sort(np.abs(each)) for each in (np.linalg.eigvals(D), orbit.multipliers))
        assert np.allclose(*sizes, rtol=1e-5, atol=1e-7)
        assert {Wall(int(wall)).name[0] for wall in orbit.wall} == set(word)


@pytest.mark.parametrize("word", ["", "lx", 2, None])
def test_a_word_has_the_letters_of_the_walls(word):
    with pytest.raises(InputError, match="letters l and u"):
        PAIR.periodic(word, 1)


def test_an_orbit_is_found_from_a_start():
    osc = PAIR
    stable = next(orbit for orbit in osc.periodic("lu", 1) if orbit.stable)
    lower = int(np.flatnonzero(stable.wall == 0)[0])
    (again,) = osc.periodic("lu", 1, start=(stable.tau[lower] + 1e-3, stable.v[lower] * 1.001))
    assert np.allclose(again.v, stable.v, rtol=1e-9)
    with pytest.raises(InputError, match="start"):
        osc.periodic("lu", 1, start="here")


@pytest.mark.parametrize("force", ["-9.81", "-9.81 + cos(t)/10**15"])
@pytest.mark.parametrize("v", [27.9, 9.0, 2.5, 2.4])
def test_a_ball_that_reaches_the_ceiling_does_not_come_to_rest_before(force, v):
    """Of a constant force the sum of a chatter is exact at any speed, so nothing but the ceiling speaks against it."""
    ball, g, height, r = si.ImpactOscillator("0", force, 0, "0.9", upper="0.3"), 9.81, 0.3, 0.9
    time, speed, walls = 0.0, v, [0]
    while (squared := speed**2 - 2 * g * height) > 0:
        down = r * squared**0.5
        landing = (down**2 + 2 * g * height) ** 0.5
        time += (speed - squared**0.5 + landing - down) / g
        speed, walls = r * landing, [*walls, 1, 0]
    orbit, limit = ball.orbit(0, v, 400), ball.chatter_limit(0, v)
    assert orbit.wall[: len(walls)].tolist() == walls
    end = orbit.tau[orbit.kind == "complete"][0]
    assert end == pytest.approx(time + 2 * speed / g / (1 - r), rel=1e-12)
    assert limit.status == (si.Status.complete if walls == [0] else si.Status.lifts_off)
    assert limit.tau == pytest.approx(end if walls == [0] else orbit.tau[1], rel=1e-12)


def test_a_diagram_knows_chatter_that_comes_back_after_many_impacts():
    """Over 100 events from one lift-off to the next: what follows a lift-off is fixed by its phase and wall."""
    walls = {"upper": "0.108", "upper_restitution": "0.521"}
    osc = si.ImpactOscillator("x + x**3 + 0.119*xdot", "A*cos(3.007*t)", "-0.425", "0.678", {"A": "6.449"}, **walls)
    orbit = osc.replace(A=6.449).orbit(0, 0.1, 1000)
    lifted = np.flatnonzero(orbit.kind == "release")
    assert (np.diff(lifted) > 64).all()
    turns = np.diff(orbit.tau[lifted]) * 3.007 / (2 * np.pi)
    found = si.bifurcation(osc, "A", ("6.449", "6.45"), 2, settle=3000)
    assert found.settled[0]
    assert found.attractors[0].name == f"(inf, {turns[0]:.0f}) chatter for ever"
