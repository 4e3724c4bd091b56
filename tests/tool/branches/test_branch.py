"""Branches against published curves, against orbits found otherwise, and through grazes."""

from __future__ import annotations

import numpy as np
import pytest

import singimpact as si
from singimpact.branches import Closing, Event
from singimpact.flights.family import family
from singimpact.inputs import InputError


def grazing_amplitude(w: float, damping: float = 0.1) -> float:
    """x'' + b x' + x = A cos wt reaches 1 at A = sqrt((1 - w^2)^2 + (b w)^2): COCO's example of Recipes 15.2."""
    return float(np.hypot(1 - w * w, damping * w))


def coco(w: float, share: float) -> si.ImpactOscillator:
    return si.linear(w, -1, "0.8", damping="0.1", amplitude=-share * grazing_amplitude(w))


def flown(orbit, impacts: int) -> tuple[float, float]:
    """The state after some impacts of the true map."""
    tau, v = float(orbit.tau[0]), float(orbit.v[0])
    for _ in range(impacts):
        step = orbit.oscillator.impact_map(tau, v)
        tau, v = float(step.tau), float(step.v)
    return tau, v


def kinds(branch) -> list[str]:
    return [event.kind for event in branch.events]


@pytest.mark.parametrize("w", [0.6, 0.8, 1.0, 1.2, 1.4])
def test_the_graze_of_an_orbit_without_impact_and_the_branch_through_it(w: float) -> None:
    (free,) = coco(w, 0.9).periodic(0, 1)
    reach = -np.array([1.2, 0.8]) * grazing_amplitude(w)
    before = si.branch(free, "amplitude", reach)
    (graze,) = before.events
    assert graze.kind == "graze"
    assert -graze.parameter == pytest.approx(grazing_amplitude(w), rel=1e-12)
    (touching,) = graze.others()
    assert (touching.n, touching.k) == (1, 1)
    through = si.branch(touching, "amplitude", reach)
    found = [event for event in through.events if event.kind == "graze"]
    assert -found[0].parameter == pytest.approx(grazing_amplitude(w), rel=1e-12)
    # smooth through the graze: the amplitude is a polynomial of v there, not a square root
    near = np.abs(through.v[:, 0]) < 0.02
    assert near.sum() > 6
    fit = np.polynomial.Polynomial.fit(through.v[near, 0], through.parameter[near], 4)
    assert fit(through.v[near, 0]) == pytest.approx(through.parameter[near], abs=1e-7)


@pytest.mark.parametrize("over", ["clearance", "omega", "damping", "amplitude"])
def test_the_graze_over_any_number(over: str) -> None:
    (orbit,) = coco(0.8, 1.00000105).periodic(1, 1)
    assert orbit.v[0] == pytest.approx(1e-6, rel=0.01)
    start = {"clearance": -1.0, "omega": 0.8, "damping": 0.1, "amplitude": -1.00000105 * grazing_amplitude(0.8)}
    found = si.branch(orbit, over, (start[over] - 0.02, start[over] + 0.02))
    (graze,) = (event for event in found.events if event.kind == "graze")
    at = start | {over: graze.parameter}
    A = -at["clearance"] * grazing_amplitude(at["omega"], at["damping"])
    assert -at["amplitude"] == pytest.approx(A, rel=1e-12)


@pytest.mark.parametrize("r", [0.3, 0.5, 0.8])
def test_doubling_of_the_bouncing_ball(r: float) -> None:
    # Luck and Mehta 1993
    gamma = np.sqrt((np.pi * (1 - r) / (1 + r)) ** 2 + (2 * (1 + r * r) / (1 + r) ** 2) ** 2)
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, r, {"G": 0.98 * gamma})
    orbits = ball.periodic(1, 1)
    assert orbits.complete
    doublings = []
    for orbit in orbits:
        found = si.branch(orbit, "G", (0.55 * gamma, 1.3 * gamma))
        doublings += [event for event in found.events if event.kind == "period-doubling"]
    assert doublings
    for event in doublings:
        assert event.parameter == pytest.approx(gamma, rel=1e-12)
        assert min(event.orbit.multipliers) == pytest.approx(-1, abs=1e-9)
        (twice,) = event.others()
        assert (twice.n, twice.k, twice.visible) == (2, 2, True)
        tau, v = flown(twice, 2)
        assert tau == pytest.approx(twice.tau[0] + 4 * np.pi, rel=1e-12)
        assert v == pytest.approx(twice.v[0], rel=1e-9)


def test_the_fold_of_the_bouncing_ball() -> None:
    # two (1, 1) orbits meet where Gamma = pi (1 - r)/(1 + r)
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.2"})
    found = si.branch(ball.periodic(1, 1)[0], "G", (0.9, 1.4))
    (fold,) = (event for event in found.events if event.kind == "fold")
    assert fold.parameter == pytest.approx(np.pi / 3, rel=1e-13)


def test_a_branch_that_closes() -> None:
    osc = si.linear(omega="2.8", clearance="0.1", restitution="0.8", amplitude=-1)
    orbits = osc.periodic(3, 3)
    assert [orbit.stable for orbit in orbits] == [True, False]
    found = si.branch(orbits[0], "clearance", (-0.2, 0.3))
    assert found.notes == ("closed: the branch comes back to where it began",)
    assert sorted(kinds(found)) == ["fold"] * 2 + ["graze"] * 2 + ["period-doubling"] * 2
    # the other orbit is on the same branch
    places = np.abs(found.parameter - 0.1) < 0.01
    away = np.abs(found.v[places] - orbits[1].v).max(axis=1).min()
    assert away < 0.1
    # each point returns to itself under the true map where it says that it is visible
    for index in range(0, len(found), 9):
        orbit = found.orbit(index)
        if found.visible[index]:
            tau, v = flown(orbit, 3)
            assert tau == pytest.approx(orbit.tau[0] + 3 * 2 * np.pi / 2.8, rel=1e-11)
            assert v == pytest.approx(orbit.v[0], rel=1e-8)
        else:
            assert not orbit.visible


@pytest.mark.slow
def test_a_torus_needs_negative_damping() -> None:
    osc = si.ImpactOscillator("x - mu*(1 - x**2)*xdot", "A*cos(w*t)", 0, "0.9", {"mu": "0.2", "A": "1.5", "w": "2.2"})
    (orbit,) = osc.periodic(1, 1, start=(2.64089, 2.19428))
    found = si.branch(orbit, "A", (0.5, 1.6), step=0.1)
    (torus,) = (event for event in found.events if event.kind == "torus")
    assert np.abs(torus.orbit.multipliers) == pytest.approx([1, 1], abs=1e-9)
    slope = torus.orbit.oscillator.derivative(torus.orbit.tau[0], torus.orbit.v[0]).matrix
    assert np.linalg.det(slope) == pytest.approx(1, abs=1e-9)


@pytest.mark.slow
def test_a_doubled_branch_meets_the_one_that_it_left() -> None:
    (orbit,) = coco(0.8, 0.45 / grazing_amplitude(0.8)).periodic(1, 1)
    (doubling,) = (event for event in si.branch(orbit, "amplitude", (-0.6, -0.3)).events if "doubling" in event.kind)
    found = si.branch(doubling.others()[0], "amplitude", (-0.6, -0.3))
    (note,) = (note for note in found.notes if "meets" in note)
    assert "the (1, 1) orbits at their doubling" in note
    assert float(note.rpartition(" ")[2]) == pytest.approx(doubling.parameter, abs=1e-3)
    assert kinds(found).count("fold") == 2  # none where it meets them
    (pitchfork,) = (event for event in found.events if event.kind == "pitchfork")
    assert pitchfork.parameter == pytest.approx(doubling.parameter, rel=1e-12)


@pytest.mark.slow
def test_an_orbit_that_touches_the_wall_is_visible() -> None:
    duffing = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(1.7*t)", "-0.3", "0.6", {"A": 1})
    (orbit,) = duffing.periodic(1, 1, start=(2.12287, 1.16715))
    (graze,) = (event for event in si.branch(orbit, "A", (0.2, 1.2), step=0.1).events if event.kind == "graze")
    (free,) = graze.others()
    assert float(free.x[0]) == pytest.approx(-0.3, abs=1e-12)
    assert free.visible


def test_areas_that_are_kept_make_no_tori() -> None:
    # r = 1 without damping: the product of the multipliers is 1 all along, up to rounding
    found = si.branch(si.linear("2.6", "0.01", 1).periodic(1, 1)[0], "clearance", (-0.3, 0.3))
    assert kinds(found) == ["graze", "period-doubling"]
    assert not found.stable.any()
    assert np.isclose(np.abs(found.multipliers), 1, rtol=1e-9).all(axis=1).any()


def test_multipliers_are_those_of_the_map() -> None:
    osc = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "-0.3", "0.6")
    for orbit in osc.periodic(1, 1, start=(2.12, 1.17)):
        slope = osc.derivative(orbit.tau[0], orbit.v[0]).matrix
        found, truth = (sorted(each, key=lambda mu: (mu.imag, mu.real)) for each in
                        (orbit.multipliers, np.linalg.eigvals(slope)))  # fmt: skip
        assert found == pytest.approx(truth, abs=1e-9)


def test_a_hidden_impact_and_the_orbit_with_one_impact_more() -> None:
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, "0.3", {"G": "2.1"})
    orbit = next(orbit for orbit in ball.periodic(1, 1) if orbit.v[0] < 2)
    found = si.branch(orbit, "G", (1.7, 3))
    (hidden,) = (event for event in found.events if event.kind == "hidden impact")
    beside = ball.replace(G=hidden.parameter)
    path = beside.flight(float(hidden.orbit.tau[0]), float(hidden.orbit.v[0]), hidden.time)
    assert path.x == pytest.approx(0, abs=1e-13)
    assert path.xdot == pytest.approx(0, abs=1e-12)
    (more,) = hidden.others()
    assert (more.n, more.k) == (2, 1)
    assert min(more.v) == pytest.approx(0, abs=1e-12)


def test_points_and_files(tmp_path) -> None:
    (orbit,) = coco(0.8, 1.2).periodic(1, 1)
    found = si.branch(orbit, "amplitude", (-0.6, -0.2))
    found.to_csv(tmp_path / "branch.csv")
    rows = np.genfromtxt(tmp_path / "branch.csv", delimiter=",", names=True)
    np.testing.assert_array_equal(rows["amplitude"], found.parameter)
    np.testing.assert_array_equal(rows["visible"].astype(bool), found.visible)
    again = found.orbit(3)
    assert again.tau[0] % (2 * np.pi / 0.8) == pytest.approx(found.tau[3, 0] % (2 * np.pi / 0.8), rel=1e-12)


@pytest.mark.parametrize(
    ("over", "between", "words"),
    [
        ("speed", None, "unknown number of the model 'speed'"),
        ("amplitude", (1, 0), "two numbers low < high"),
        ("amplitude", (1, 2), "an interval that holds amplitude"),
        ("restitution", (0, 2), "two numbers low < high in"),
    ],
)
def test_bad_input(over: str, between: object, words: str) -> None:
    (orbit,) = coco(0.8, 1.2).periodic(1, 1)
    with pytest.raises(InputError, match=words):
        si.branch(orbit, over, between)
    with pytest.raises(InputError, match="an orbit of osc"):
        si.branch(0.3, "amplitude")


def test_conditions_that_are_wrong_are_seen() -> None:
    # the derivative by the period would be missing if launches were not kept in the first period
    osc = si.ImpactOscillator("x + 0.1*xdot", "-A*cos(w*t)", -1, "0.8", {"A": "0.45", "w": "0.8"})
    closing = Closing(family(osc, ("w",)), 2, 3)
    point = np.array([9.0, 17.0, 0.3, 0.2, 0.8])
    loop, step = closing.at(point), 1e-6
    for column in range(5):
        moved = np.zeros(5)
        moved[column] = step
        change = (closing.at(point + moved).miss - closing.at(point - moved).miss) / (2 * step)
        assert loop.slope[:, column] == pytest.approx(change, abs=1e-7)


def test_event_prints_words() -> None:
    (free,) = coco(0.8, 0.9).periodic(0, 1)
    text = repr(si.branch(free, "amplitude", (-0.5, -0.2)))
    assert "<graze at amplitude = -0.368781778292>" in text
    assert isinstance(si.branch(free, "amplitude", (-0.5, -0.2)).events[0], Event)


def test_an_elastic_model_without_damping_has_no_torus_by_rounding() -> None:
    osc = si.linear("2.3", "0.05", 1)
    (orbit,) = osc.periodic(1, 1)
    assert set(kinds(si.branch(orbit, "clearance", (-0.3, 0.3)))) == {"graze", "period-doubling"}


def test_an_orbit_with_chatter_is_not_followed() -> None:
    chatter = si.linear(2, "0.7", "0.5").periodic(np.inf, 1)[0]
    with pytest.raises(InputError, match="an orbit with chatter is not followed"):
        si.branch(chatter)


def test_a_fold_a_graze_and_a_doubling_at_one_place() -> None:
    # at resonance of the forcing with the free motion they meet: c = 1/3 is where the free orbit touches
    (orbit,) = si.linear(2, "0.3", "0.5").periodic(1, 1)
    found = si.branch(orbit, "clearance", (-1.5, 1.5))
    assert found.notes[-1] == "closed: the branch comes back to where it began"
    for kind in ("fold", "graze", "period-doubling"):
        places = sorted(event.parameter for event in found.events if event.kind == kind)
        assert places == pytest.approx([-1 / 3, 1 / 3], rel=1e-12)
