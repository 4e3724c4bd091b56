"""Branches and events of orbits between two walls, by the word of their walls: against true flights and scipy."""

from dataclasses import replace
from itertools import product

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

DUFFING = si.ImpactOscillator("x + x**3 + 0.1*xdot", "A*cos(1.7*t)", "-0.5", "0.8", {"A": 5}, upper="0.5")
UNEVEN = si.linear("2.8", "-0.5", "0.8", upper=("0.6", "0.7"))
FREE = si.ImpactOscillator("0", "A*cos(t)", "-0.5", "0.7", {"A": 1}, upper="0.5")


@pytest.fixture(scope="module")
def pitchfork():
    orbit = next(each for each in DUFFING.periodic("lluu", 1) if each.symmetric and float(each.v.min()) > 1)
    found = si.branch(orbit, "A", (4, 5.5))
    (event,) = [event for event in found.events if event.kind == "pitchfork"]
    return found, event


def half_map(A, tau, v):
    """The state two impacts later, as the mirror image of one at the lower wall, half a period earlier."""
    wall = -0.5
    for _ in range(2):
        ends = [lambda _, y, place=place: y[0] - place for place in (-0.5, 0.5)]
        for end, direction in zip(ends, (-1, 1), strict=True):
            end.terminal, end.direction = True, direction

        def push(t, y):
            return [y[1], A * np.cos(1.7 * t) - y[0] - y[0] ** 3 - 0.1 * y[1]]

        out = solve_ivp(
            push, (tau, tau + 20), [wall, v if wall < 0 else -v], "DOP853", rtol=1e-13, atol=1e-14, events=ends
        )
        tau, (wall, v) = float(out.t[-1]), out.y[:, -1]
        wall, v = (-0.5, 0.8 * abs(v)) if wall < 0 else (0.5, 0.8 * abs(v))
    return wall, tau - np.pi / 1.7, v


def doubling_of_half(A, tau, v):
    """det(D H + 1) of the map of half an orbit, by differences."""
    step = 1e-5
    columns = []
    for k in (0, 1):
        moved = [np.array(half_map(A, tau + s * step * (k == 0), v + s * step * (k == 1))[1:]) for s in (1, -1)]
        columns.append((moved[0] - moved[1]) / (2 * step))
    return float(np.linalg.det(np.stack(columns, axis=1) + np.eye(2)))


def test_symmetry_breaks_where_half_of_the_orbit_doubles(pitchfork):
    _, event = pitchfork
    orbit = event.orbit
    assert orbit.symmetric
    first = next(i for i in range(4) if orbit.wall[i] == 0 and orbit.wall[i - 1] == 1)
    state = float(orbit.tau[first]), float(orbit.v[first])
    wall, tau, v = half_map(event.parameter, *state)
    assert wall == 0.5
    assert np.allclose([tau, v], state, atol=1e-9)
    assert abs(doubling_of_half(event.parameter, *state)) < 1e-5
    # of another orbit of the branch it is not
    found, _ = pitchfork
    other = found.orbit(2)
    first = next(i for i in range(4) if other.wall[i] == 0 and other.wall[i - 1] == 1)
    assert abs(doubling_of_half(float(found.parameter[2]), float(other.tau[first]), float(other.v[first]))) > 1e-3


@pytest.mark.parametrize("omega", [1.2, 1.6, 2.4, 2.8, 3.5])
@pytest.mark.parametrize("r", [0.5, 0.8])
def test_symmetry_breaks_at_the_amplitude_of_its_closed_form(omega, r):
    """Half a period h of x'' + x = A cos(omega t) between -c and c, with x -> -x, has the multiplier -1."""
    c, h, t = 0.5, np.pi / omega, np.tan(np.pi / omega / 2)
    kappa = (1 + r**2 + 2 * r * np.cos(h)) / ((1 + r) * r * np.sin(h))
    v = -c * omega**2 / (kappa + (1 - omega**2) * (1 + r) * t / (2 * r))
    A = abs(1 - omega**2) * np.hypot(-c + v * (1 + r) * t / (2 * r), v * (1 - r) / (2 * r * omega))
    osc = si.linear(omega, -c, r, amplitude=0.97 * A, upper=c)
    events = [
        event for orbit in osc.periodic("lu", 1) for event in si.branch(orbit, "amplitude", (A / 2, 1.5 * A)).events
    ]
    (breaking,) = [event for event in events if event.kind == "pitchfork"]
    assert breaking.parameter == pytest.approx(A, rel=1e-13)
    assert float(breaking.orbit.v[0]) == pytest.approx(v, rel=1e-10)


def test_orbits_beyond_it_are_two_mirror_images(pitchfork):
    found, event = pitchfork
    (beside,) = event.others()
    assert not beside.symmetric
    images = si.branch(beside, "A", (4, 5.5))
    (meeting,) = [each for each in images.events if each.kind == "pitchfork"]
    assert meeting.parameter == pytest.approx(event.parameter, abs=1e-11)
    assert meeting.others()[0].symmetric
    # the symmetric orbits are stable on one side, and the images where those are not
    stable = found.parameter[found.stable]
    assert stable.max() < event.parameter + 1e-9
    assert images.parameter[images.stable].min() > event.parameter - 1e-9


def test_the_curve_of_symmetry_breaking_has_a_multiplier_1(pitchfork):
    _, event = pitchfork
    curve = si.event_curve(event, ("A", "restitution"), ((4, 5.5), (0.6, 0.95)))
    assert curve.kind == "pitchfork"
    assert len(curve) > 20
    for i in range(0, len(curve), 7):
        A, r = map(float, curve.parameters[i])
        osc, D = DUFFING.replace(A=A, restitution=r), np.eye(2)
        step = osc.impact_map(curve.tau[i], curve.v[i], wall=curve.wall)
        assert np.allclose(step.v, np.roll(curve.v[i], -1), atol=1e-9)
        assert (step.wall == np.roll(curve.wall, -1)).all()
        for tau, v, wall in zip(curve.tau[i], curve.v[i], curve.wall, strict=True):
            D = osc.derivative(float(tau), float(v), wall=int(wall)).matrix @ D
        assert abs(np.linalg.eigvals(D) - 1).min() < 1e-6


@pytest.mark.parametrize(
    ("osc", "word", "k", "over"),
    [(UNEVEN, "lu", 1, "upper"), (UNEVEN, "lul", 1, "clearance"), (FREE, "lu", 1, "upper_restitution"),
     (FREE, "lu", 2, "A"), (DUFFING, "lul", 1, "restitution"), (UNEVEN, "l", 1, "upper")],
)  # fmt: skip
def test_points_are_true_orbits_where_they_are_visible(osc, word, k, over):
    for orbit in osc.periodic(word, k)[:2]:
        found = si.branch(orbit, over, points=40)
        touching = {event.index + shift for event in found.events for shift in (0, 1)}
        for i in range(len(found)):
            model = (
                osc.replace(**{over: float(found.parameter[i])}) if over != "A" else osc.replace(A=found.parameter[i])
            )
            tau, v = found.tau[i], found.v[i]
            if v.min() < 0:
                assert not found.visible[i]
                continue
            step = model.impact_map(tau, v, wall=found.wall)
            late = step.flight_time - np.diff(np.append(tau, tau[0] + found.period[i]))
            same = (step.wall == np.roll(found.wall, -1)).all() and np.abs(late).max() < 1e-6
            assert same == found.visible[i] or i in touching


@pytest.mark.parametrize(
    ("osc", "word"),
    [(si.linear("2.058", "-0.114", "0.475", damping="0.156", amplitude="1.862", upper=("0.397", "0.589")), "llllu"),
     (si.linear("2.936", "-0.582", "0.467", damping="0.121", amplitude="5.499", upper=("0.056", "0.351")), "luuuu"),
     (si.linear("3.943", "-0.401", "0.915", damping="0.079", amplitude="5.081", upper=("0.301", "0.319")), "luuuu")],
)  # fmt: skip
def test_an_orbit_that_attracts_is_among_those_of_its_word(osc, word):
    """Few states of a grid have a word with four impacts at one wall; orbits that attract are met from most."""
    after = osc.iterate(np.linspace(0, 6, 50), 0.5, 3000)
    found = [orbit for orbit in osc.periodic(word, 1) if orbit.stable]
    period = 2 * np.pi / float(osc.parameters["omega"].value)
    states = [(tau, v, wall) for orbit in found for tau, v, wall in zip(orbit.tau, orbit.v, orbit.wall, strict=True)]
    near = [
        min(abs((tau - t + period / 2) % period - period / 2) + abs(v - u) + (wall != w) for t, u, w in states)
        for tau, v, wall in zip(after.tau, after.v, after.wall, strict=True)
    ]
    assert min(near) < 1e-8


@pytest.mark.parametrize(("d", "A", "upper"), [(4, 2, "0.475"), (6, 4, "0.633")])
def test_small_multipliers_keep_their_digits(d, A, upper):
    """An orbit of one impact at each wall leaves (r R)^2 exp(-d T) of an area; a determinant has lost half of it."""
    osc = si.ImpactOscillator(f"{d}*xdot", f"{A}*cos(t)", "-" + upper, "0.5", upper=upper)
    (orbit,) = osc.periodic("lu", 1)
    first, second = orbit.multipliers
    assert first * second / (0.5**4 * np.exp(-d * 2 * np.pi)) == pytest.approx(1, abs=1e-12)
    assert abs(second) < 1e-9 * abs(first)


def test_a_graze_leads_to_the_orbit_without_the_impact_and_a_hidden_one_to_that_with_it():
    words = {}
    damped = si.linear("1.7", "-0.3", "0.6", damping="0.1", upper="0.3")
    low = si.linear(4, 0, "0.5", upper=1)  # an orbit whose flights touch the upper wall where it comes down
    for osc, word, k in ((damped, "lu", 1), (damped, "lul", 1), (low, "l", 2)):
        for orbit, over in product(osc.periodic(word, k), ("upper", "restitution")):
            for event in si.branch(orbit, over, points=80).events:
                for other in event.others() if event.kind in ("graze", "hidden impact") else []:
                    words.setdefault(event.kind, []).append((orbit.word, other.word))
                    same = [
                        each for each in si.branch(other, over, points=80).events
                        if each.kind in ("graze", "hidden impact")
                        and abs(each.parameter - event.parameter) < 1e-8 * abs(event.parameter)
                    ]  # fmt: skip
                    assert same
                    assert {same[0].kind, event.kind} == {"graze", "hidden impact"}
    assert {len(after) - len(before) for before, after in words["hidden impact"]} == {1}
    assert {len(after) - len(before) for before, after in words["graze"]} == {-1}
    assert ((0,), (0, 1)) in [(before, tuple(sorted(after))) for before, after in words["hidden impact"]]


def symmetric_speeds(omega, c, r):
    """v of the symmetric orbits of x'' + x = cos(omega t) between -c and c, from half a period of the forcing."""
    omega, c, r = map(mpmath.mpf, (omega, c, r))
    half, A = mpmath.pi / omega, 1 / (1 - omega**2)
    K = (r - 1) / (r + 1) / mpmath.tan(half / 2)
    size, lag = A * mpmath.sqrt(K * K + omega**2), mpmath.atan2(omega, K)
    phases = [lag + sign * mpmath.acos(-c * K / size) for sign in (1, -1)]
    return [(c + A * mpmath.cos(at)) / mpmath.tan(half / 2) - A * omega * mpmath.sin(at) for at in phases]


def test_a_symmetric_orbit_is_proved_to_have_the_velocity_of_its_closed_form():
    osc = si.linear("1.7", "-0.3", "0.6", upper="0.3")
    orbits, finer = osc.periodic("lu", 1), osc.periodic("lu", 1, digits=40)
    assert [orbit.symmetric for orbit in orbits] == [True]
    proof = orbits[0].certified(30)
    with mpmath.workdps(50):
        wanted = symmetric_speeds("1.7", "0.3", "0.6")
        assert min(abs(mpmath.mpf(str(proof.v[0].value)) - v) for v in wanted) < 1e-29
        assert min(abs(finer[0].v[0] - v) for v in wanted) < mpmath.mpf(10) ** -39
        assert min(abs(finer[0].v[0] - v) for v in symmetric_speeds("1.7", "0.3", "0.61")) > 1e-6
    assert proof.v[0].radius < 1e-29
    assert proof.stable == orbits[0].stable


def test_an_orbit_of_another_word_has_no_proof():
    (orbit, *_) = DUFFING.periodic("lluu", 1)
    assert orbit.certified().v
    with pytest.raises(InputError, match="is not certified"):
        replace(orbit, wall=np.array([1, 0, 0, 0], np.int8)).certified()


def test_an_orbit_that_passes_the_other_wall_has_no_proof():
    (orbit,) = si.linear(4, 0, "0.5", upper=1).periodic("l", 2)
    found = si.branch(orbit, "upper", (0.7, 1.1))
    for i in (0, len(found) - 1):
        beside = found.orbit(i)
        if found.visible[i]:
            assert beside.certified().v
            continue
        with pytest.raises(InputError, match="meets the wall before its impact"):
            beside.certified()
    assert len(set(found.visible[[0, -1]])) == 2


def test_events_between_walls_are_proved():
    """The fold against its closed form; a graze, a doubling, and what no proof covers."""
    pair = si.models.impact_pair()
    events = {event.kind: event for event in si.branch(pair.periodic("lu", 1)[0], "A", (0.05, 0.45)).events}
    fold = events["fold"].certified(20)
    with mpmath.workdps(40):
        wanted = mpmath.mpf("0.5") * mpmath.mpf("0.3") / mpmath.hypot("0.3", mpmath.pi * mpmath.mpf("1.7") / 2)
        assert abs(mpmath.mpf(str(fold.parameter.value)) - wanted) < 1e-19
    with pytest.raises(InputError, match=r"pitchfork .* no proof covers an event of this kind"):
        events["pitchfork"].certified()
    damped = si.ImpactOscillator("x + xdot/10", "A*cos(1.7*t)", "-0.3", "0.6", {"A": 1}, upper="0.3")
    (orbit,) = damped.periodic("lul", 1)
    found = {event.kind: event for event in si.branch(orbit, "A", (0.6, 1.5)).events}
    for kind in ("graze", "period-doubling", "fold"):
        proof = found[kind].certified(15)
        assert float(proof.parameter.value) == pytest.approx(found[kind].parameter, rel=1e-12)
        assert proof.parameter.radius < 1e-14
    # an event of another word has none
    wrong = replace(found["graze"], orbit=replace(found["graze"].orbit, wall=np.zeros(3, np.int8)))
    with pytest.raises(InputError, match="not certified"):
        wrong.certified()
    event = si.branch(orbit, "restitution", (0.4, 0.8)).events[0]
    with pytest.raises(InputError, match="only those over a parameter"):
        event.certified()
