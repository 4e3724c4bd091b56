"""Classes of states against single orbits, and settled orbits over a parameter."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import (
    CHATTER,
    OTHER,
    Future,
    basins,
    bifurcation,
    caught,
    chaotic,
    closing_orbits,
    new_attractors,
    settled,
)
from singimpact.dynamics.attractors import SETTINGS
from singimpact.flights import iterate
from singimpact.inputs import InputError
from singimpact.scenes import bifurcation_sheet, draw_basins, draw_first_chatter
from singimpact.status import Status

MODEL = si.linear(2, "0.3", "0.5")


@pytest.fixture(scope="module")
def found():
    with ThreadPoolExecutor(1) as pool:
        return basins(MODEL, size=20, executor=pool)


def test_classes_agree_with_single_orbits(found):
    for i, j in [(0, 3), (0, 15), (10, 5), (19, 19), (4, 10)]:
        tau, v = float(found.tau[j]), float(found.v[i])
        completes = MODEL.chatter_limit(tau, v, impacts=500).status == Status.complete
        assert found.first_chatter_completes[i, j] == completes
        attractor = found.attractors[found.codes[i, j]]
        orbit = MODEL.orbit(tau, v, impacts=80)
        assert abs(orbit.tau[-1] - orbit.tau[-1 - attractor.n] - attractor.k * np.pi) < 1e-6


def test_a_first_chatter_that_completes_is_no_class():
    """102 of 3600 states chatter once and settle on the (3, 3) orbit: by their own orbits and by the grid."""
    model = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    with ThreadPoolExecutor(1) as pool:
        found = basins(model, v=(0, 0.8), size=60, executor=pool)
    assert found.first_chatter_completes.sum() == 102
    assert {name for _, name, _ in found.classes} == {"(3, 3) orbit", "(1, 1) orbit"}
    names = [each.name for each in found.attractors]
    assert {names[code] for code in found.codes[found.first_chatter_completes]} == {"(3, 3) orbit"}
    i, j = np.argwhere(found.first_chatter_completes)[::25].T
    for row, column in zip(i, j, strict=True):
        orbit = model.orbit(float(found.tau[column]), float(found.v[row]), impacts=120)
        assert "complete" in orbit.kind
        assert abs(orbit.tau[-1] - orbit.tau[-4] - 3 * 2 * np.pi / 2.8) < 1e-6


def test_chatter_for_ever_is_a_class_with_its_periods():
    model = si.linear(2, "0.7", "0.5")
    with ThreadPoolExecutor(1) as pool:
        found = basins(model, v=(0, 1), size=8, executor=pool)
    (attractor,) = found.attractors
    assert (attractor.kind, attractor.n, attractor.k) == ("chatter", np.inf, 1)
    orbit = model.orbit(0.3, 0.4, impacts=400)
    lifted = orbit.tau[orbit.kind == "release"]
    assert np.allclose(np.diff(lifted)[2:], np.pi, atol=1e-9)
    assert abs((lifted[-1] - attractor.tau[0]) / np.pi - round((lifted[-1] - attractor.tau[0]) / np.pi)) < 1e-9


def test_where_a_c_never_rises_the_mass_rests_for_ever():
    with ThreadPoolExecutor(1) as pool:
        found = basins(si.linear("2.8", "1.2", "0.8"), v=(0, 1), size=6, executor=pool)
    assert [each.kind for each in found.attractors] == ["rest"]


def test_two_orbits_of_equal_n_and_k_are_two_classes():
    """Counted in double periods, an orbit and its shift by one period are two (1, 1) orbits."""
    model = si.ImpactOscillator("x", "cos(2.8*t)", "-0.3", "0.95", period="4*pi/2.8")
    with ThreadPoolExecutor(1) as pool:
        found = basins(model, v=(0, 2), size=20, executor=pool)
    kinds = [(each.n, each.k) for each in found.attractors]
    assert kinds.count((1, 1)) == 2
    one, other = (each for each in found.attractors if (each.n, each.k) == (1, 1))
    assert abs(abs(one.tau[0] - other.tau[0]) - 2 * np.pi / 2.8) < 1e-3
    codes = {code for code, _, _ in found.classes}
    assert len(codes) == len(found.attractors)


def test_chaos_is_told_by_an_exponent_and_the_rest_is_not_decided():
    model = si.linear("2.8", 0, "0.8")
    assert chaotic(model, np.array([0.3, 1.0]), np.array([0.7, 0.4]), 2.0).all()
    with ThreadPoolExecutor(1) as pool:
        (attractor,) = basins(model, v=(0, 2), size=6, executor=pool).attractors
    assert attractor.kind == "chaotic"
    # r = 1 and a weak forcing: curves that close slowly, with no exponent and no orbit that others settle on
    still = si.ImpactOscillator("x", "0.01*cos(sqrt(2)*t)", 0, 1)
    with ThreadPoolExecutor(1) as pool:
        (attractor,) = basins(still, v=(1, 2), size=4, executor=pool).attractors
    assert attractor.kind == "not decided"


def test_cycles_of_lift_offs():
    chattering = [Future((CHATTER, 1.0, 0.0), 4.0), Future((CHATTER, 2.0, 0.0), 2.0), Future((CHATTER, 1.0, 0.0), 7.0)]
    assert settled(chattering, 0, 3.0) == (CHATTER, 1, 3)
    leaves = [Future((CHATTER, 1.0, 0.0), 4.0), Future((2001.0, 0.5, 0.3), np.nan)]
    assert settled(leaves, 0, 3.0) == (2001.0, 0.5, 0.3)
    assert settled([Future((CHATTER, 0.0, 0.0), np.nan)], 0, 3.0)[0] == OTHER


def test_shares_and_pictures(found):
    assert abs(sum(share for _, _, share in found.classes) - 1) < 1e-12
    axes = draw_basins(found)
    assert "(1, 1) orbit" in " ".join(text.get_text() for text in axes.get_legend().get_texts())
    axes.figure.canvas.draw()
    first = draw_first_chatter(found)
    assert "first chatter completes" in first.get_legend().get_texts()[0].get_text()
    first.figure.canvas.draw()


def test_across_a_swan():
    """Below c_0 = 1 settled orbits leave the obstacle at a tangency; above it they rest for ever."""
    model = si.linear(2, "0.3", "0.5")
    with ThreadPoolExecutor(1) as pool:
        over = bifurcation(model, "clearance", ("0.9", "1.1"), 3, impacts=60, kept=20, executor=pool)
    counts = np.isfinite(over.events[:, :, 0]).sum(axis=1)
    assert counts[0] > 5
    assert counts[2] == 1
    assert over.events[2, 0, 2] == 1
    bifurcation_sheet(over).canvas.draw()


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
    """Classes of a grid by flying every state as long as the slowest chatter takes, without a look in between."""
    from singimpact.oscillator import acceleration

    found = basins(model, v=(0, v), size=size)
    tau, speed = (part.ravel() for part in np.meshgrid(found.tau, found.v))
    ends = iterate(model, tau, speed, 90)
    first = (ends.v < 1e-7 * v) & (acceleration(model, ends.tau) < 0)
    codes = np.zeros(tau.size, dtype=int)
    flying = np.flatnonzero(~first & (ends.status == 0) & (ends.v > 0))
    codes[flying] = closing_orbits(model, ends.tau[flying], ends.v[flying], v)[0]
    early = np.array([int(each.n) * 1000 + each.k if each.kind == "orbit" else 0 for each in found.attractors])
    return found.first_chatter_completes, first.reshape(size, size), np.where(first.reshape(size, size), 0, early[
        found.codes]), codes.reshape(size, size)  # fmt: skip


@pytest.mark.parametrize(("force", "forcing", "r"), [("x", "cos(2*t)", "1/2"), ("x", "cos(14*t/5)", "0.6")])
def test_orbits_decided_early_are_those_decided_late(force, forcing, r):
    chattered, completed, early, late = to_the_end(si.ImpactOscillator(force, forcing, "0.3", r), 40, 2.0)
    assert 0 < completed.sum() < completed.size
    assert (chattered == completed).all()
    assert (early == late).all()


def test_an_attractor_catches_only_what_comes_in():

    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", "1/2")
    ends = iterate(model, np.array([0.3]), np.array([1.5]), 60)
    (attractor,) = new_attractors(model, ends.tau, ends.v, 2.0)
    assert attractor.code == 1001
    assert SETTINGS.close <= attractor.catch <= SETTINGS.catch
    place = attractor.tau[0] + 0.99 * attractor.catch * np.pi * np.array([1, -1, 0])
    speed = attractor.v[0] + 0.99 * attractor.catch * 2.0 * np.array([1, -1, 0])
    assert (caught([attractor], model, place, speed, 2.0) == 0).all()
    home = iterate(model, place, speed, 200)
    assert np.abs(home.v - attractor.v[0]).max() < 1e-9
    assert (caught([attractor], model, place + 0.5, speed, 2.0) == -1).all()


def test_a_state_that_spirals_in_is_not_taken_for_an_orbit_of_twice_the_period():
    """The multipliers of the (3, 3) orbit are near +-0.5i: a state may come back nearer after six impacts than three.

    A block of ten rows of a grid of 300 x 300 was called "(6, 6) orbit".
    """
    model = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    orbit = next(each for each in model.periodic(3, 3) if each.stable)
    angle, size = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.geomspace(1e-8, 5e-6, 60))
    tau = orbit.tau[0] + 2 * np.pi / 2.8 * (size * np.cos(angle)).ravel()
    codes = closing_orbits(model, tau, orbit.v[0] + (size * np.sin(angle)).ravel(), 1.0)[0]
    assert (codes == 3003).sum() > 1500
    assert set(codes.tolist()) <= {3003, OTHER}


def fold_of_one_impact(omega, r):
    """c, tau and v at the fold of the (1, 1) orbits of x'' + x = cos(omega t), which exist for |c| up to it.

    (c - K v)^2 + (L v)^2 = gamma^2 with K = (1 + r) cot(T/2)/(2 r), L = (1 - r)/(2 r omega), gamma = 1/(1 - omega^2).
    """
    gamma, sharp, flat = 1 / (1 - omega**2), (1 + r) / (2 * r) / np.tan(np.pi / omega), (1 - r) / (2 * r * omega)
    c = np.sign(sharp) * abs(gamma) * np.hypot(1, sharp / flat)
    v = c * sharp / (sharp**2 + flat**2)
    phase = np.arctan2(flat * v / gamma, (c - sharp * v) / gamma)  # of gamma cos(omega t): its place and velocity
    return c, phase / omega, v


def test_a_state_that_passes_slowly_beside_a_fold_is_not_on_an_orbit():
    """1e-7 beyond the fold a state comes back to 1e-6 for thousands of turns; it was called a (1, 1) orbit."""
    generator, before = np.random.default_rng(7), 0
    for _ in range(12):
        omega, r = round(generator.uniform(2.1, 3.8), 3), round(generator.uniform(0.3, 0.8), 2)
        c, tau, v = fold_of_one_impact(omega, r)
        window = ((tau - 0.01, tau + 0.01), (max(v - 0.02, 1e-3), v + 0.02))
        kinds = []
        for size in (c * (1 - 1e-5), c * (1 + 1e-7)):
            found = si.basins(si.linear(str(omega), repr(float(size)), str(r)), window, 4)
            kinds.append({(each.n, each.k) for each in found.attractors if each.kind == "orbit"})
        before += (1, 1) in kinds[0]
        assert (1, 1) not in kinds[1]
    assert before >= 6


@pytest.mark.parametrize(
    ("omega", "r", "doubling"),
    [
        ("2.805", "0.84", 0.071221561), ("2.314", "0.34", -0.170632980), ("3.538", "0.44", 0.271225344),
        ("2.207", "0.78", -0.231052874), ("2.698", "0.63", 0.019954120), ("2.22", "0.7", -0.224021839),
    ],
)  # fmt: skip
def test_beside_a_doubling_the_orbit_is_that_which_is_stable(omega, r, doubling):
    """The multiplier is -0.9998: a state comes nearer by every second impact, and was called a (2, 2) orbit."""
    for offset, n in ((-1e-5, 2), (1e-5, 1)):
        model = si.linear(omega, repr(doubling + offset), r)
        orbit = next(each for each in si.linear(omega, repr(doubling + 1e-3), r).periodic(1, 1) if each.stable)
        tau, v = float(orbit.tau[0]), float(orbit.v[0])
        found = si.basins(model, ((tau - 0.005, tau + 0.005), (v - 0.005, v + 0.005)), 4)
        assert {(each.n, each.k) for each in found.attractors} == {(n, n)}


def test_the_period_of_chatter_that_comes_again_does_not_rest_on_roundings():
    """Chatter that comes again after thousands of impacts had a number of periods that no double decides."""
    generator, doubtful, named = np.random.default_rng(11), 0, 0
    for _ in range(10):
        omega, mean = round(generator.uniform(1.4, 2.6), 3), round(generator.uniform(0.3, 0.9), 3)
        pair = [
            si.basins(si.ImpactOscillator("0.05*xdot", f"cos({omega}*t)-{mean}{more}", 0, "0.8"), size=8)
            for more in ("", "-1e-14")
        ]
        rows = [[(each.kind, each.k) for each in found.attractors] for found in pair]
        for codes in zip(*(found.codes.ravel().tolist() for found in pair), strict=True):
            one, other = (rows[side][code] for side, code in enumerate(codes))
            doubtful += one[0] == "sensitive"
            if one[0] == "chatter" == other[0]:
                assert one == other
                named += 1
    assert doubtful
    assert named
