"""Transitions of P over any number of the model, the orbits between them, and both sides of one."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

import singimpact as si
from singimpact.branches import OrbitTransitions
from singimpact.inputs import InputError
from singimpact.scenes import PENS, class_colors

COCO = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
GRAZE = -float(np.hypot(1 - 0.64, 0.08))  # of the orbit without impact: Recipes for Continuation 15.2
TWO_WAVES = si.ImpactOscillator("x", "-cos(2.8*t) - h*cos(5.6*t)", "0.3", "0.8", {"h": -1})


@pytest.mark.parametrize(
    ("over", "between", "value"),
    [
        pytest.param("amplitude", ("0.2", 1), 0.5, marks=pytest.mark.slow),
        pytest.param("stiffness", (1, 3), 2.0, marks=pytest.mark.slow),
        ("clearance", ("0.2", 2), 1.0),
    ],
)
def test_swans_over_numbers_that_the_model_does_not_name(over: str, between, value: float) -> None:
    """a_c = A cos 2t - k c has a double zero at A = k c; with c = 1/2 at A = 1/2, and at k = 2."""
    found = si.transitions(si.linear(2, "0.5", "0.5"), over, between, t=(-1, 1))
    assert [(each.kind, pytest.approx(each.value, abs=1e-12)) for each in found] == [("swan, negative", value)]
    assert found.swans_complete
    some = si.transitions(
        si.linear(2, "0.5", "0.5"), over, between, t=(-1, 1), kinds=("swan", "swallowtail", "tangency")
    )
    assert some == found
    assert some.complete == (over != "stiffness")  # lips and beaks are proved to be all where stiffness stays
    assert found.complete == (over == "clearance")  # the others where a theorem says so


@pytest.mark.parametrize(
    "over", ["restitution", *(pytest.param(each, marks=pytest.mark.slow) for each in ("damping", "phase"))]
)
def test_numbers_that_a_c_does_not_depend_on_but_for_a_shift(over: str) -> None:
    found = si.transitions(si.linear(2, "0.5", "0.5"), over, ("0.1", "0.9"), t=(-1, 1))
    assert list(found) == []
    assert found.swans_complete


@pytest.fixture(scope="module")
def coco() -> OrbitTransitions:
    found = si.transitions(COCO, "amplitude", (-0.6, -0.3), orbits=1)
    assert isinstance(found, OrbitTransitions)
    return found


@pytest.mark.slow
def test_orbits_that_graze_do_so_at_their_own_value(coco: OrbitTransitions) -> None:
    (graze,) = coco  # a transition that an orbit makes
    assert (graze.kind, graze.value) == ("periodic graze", pytest.approx(GRAZE, rel=1e-12))
    (interval,) = coco.intervals
    assert (interval.low, interval.high) == (-0.6, -0.3)
    grazes = [change for change in coco.changes if change.kind == "graze"]
    assert sorted((change.n, change.k) for change in grazes) == [(0, 1), (1, 1)]
    for change in grazes:
        assert change.value == pytest.approx(GRAZE, rel=1e-12)
    free, once = sorted(grazes, key=lambda change: change.n)
    assert (free.below, free.above) == (("virtual",), ("stable",))
    assert (once.below, once.above) == (("unstable",), ("virtual",))
    (doubling,) = (change for change in coco.changes if change.kind == "period-doubling")
    assert doubling.value == pytest.approx(-0.518209866598, rel=1e-10)
    assert (doubling.below, doubling.above) == (("stable",), ("unstable",))
    assert [change.value for change in coco.changes] == sorted(change.value for change in coco.changes)
    text = repr(coco)
    assert "graze of the (1, 1) orbit at amplitude = -0.368781778292: unstable below and virtual above" in text
    assert "orbits are looked for at 5 values" in text


@pytest.mark.slow
def test_multipliers_jump_at_a_graze(coco: OrbitTransitions) -> None:
    """With the impact one tends to infinity like 1/v; the orbit without it has finite ones there."""
    once = next(change for change in coco.changes if (change.kind, change.n) == ("graze", 1))
    sizes = []
    for step in (1e-6, 1e-8):
        near = COCO.replace(amplitude=once.value - step).periodic(1, 1)
        sizes.append(np.abs(near[0].multipliers).max() * near[0].v[0])
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-2)
    assert np.abs(COCO.replace(amplitude=once.value - 1e-8).periodic(1, 1)[0].multipliers).max() > 1e6
    (free,) = once.event.others()
    assert free.n == 0
    assert np.abs(free.multipliers).max() < 1


def test_a_chattering_orbit_is_there_on_one_side_of_a_negative_swan() -> None:
    found = si.transitions(si.linear("2.8", 0, "0.5"), between=("0.8", "1.2"), t=(-1, 1), orbits=1)
    assert [each.kind for each in found] == ["swan, negative"]
    before, after = found.intervals
    assert [(orbit.kind, orbit.k) for orbit in before.orbits] == [("chatter", 1)]
    assert after.orbits == ()
    assert before.high == after.low == pytest.approx(1)
    assert "(inf, 1) chatter" in repr(found)


@pytest.fixture(scope="module")
def waves() -> OrbitTransitions:
    found = si.transitions(TWO_WAVES, "h", ("-1.5", "-1"), t=(-2, 2), orbits=[(1, 1), (3, 3)])
    assert isinstance(found, OrbitTransitions)
    return found


@pytest.mark.slow
def test_changes_lie_between_the_transitions_that_are_named(waves: OrbitTransitions) -> None:
    """x'' + x = -cos 2.8t - h cos 5.6t: a_c(0) = -1 - h - 0.3 is a double zero at h = -1.3."""
    assert {each.value for each in waves} == {-1.3}
    below, above = waves.intervals
    assert [(change.kind, change.n, round(change.value, 6)) for change in below.changes] == [
        ("period-doubling", 1, -1.478993), ("period-doubling", 3, -1.409643),
    ]  # fmt: skip
    assert [(change.kind, change.n, round(change.value, 6)) for change in above.changes] == [("fold", 3, -1.021548)]
    assert above.changes[0].interval == 1
    assert sorted(above.changes[0].below) == ["stable", "unstable"]
    assert above.changes[0].above == ()
    assert len(waves.branches) == 2  # the two (3, 3) orbits are one branch, by its fold
    names = sorted((int(orbit.n), orbit.stable) for orbit in above.orbits)
    assert names == [(1, True), (3, False), (3, True)]


def test_no_orbit_changes_at_the_transition_itself() -> None:
    sides = [TWO_WAVES.replace(h=-1.3 + step) for step in (-1e-6, 1e-6)]
    for n in (1, 3):
        before, after = (side.periodic(n, n) for side in sides)
        assert len(before) == len(after) == n // 2 + 1
        for one, other in zip(before, after, strict=True):
            assert np.abs(one.v - other.v).max() < 1e-4
            assert np.abs(one.multipliers - other.multipliers).max() < 1e-3


@pytest.mark.slow
def test_the_forcing_may_vanish_at_an_end() -> None:
    """At amplitude 0 there is no period; the swan at c = A is found all the same."""
    found = si.transitions(si.linear(2, "0.5", "0.5"), "amplitude", (0, 1), t=(-1, 1))
    assert [each.value for each in found] == pytest.approx([0.5])


@pytest.mark.slow
def test_both_sides_of_a_transition(waves: OrbitTransitions) -> None:
    index = [each.kind for each in waves].index("swan, negative")
    both = waves.both_sides(index, apart="0.05", v=(0, "0.8"), size=40)
    assert [float(side.parameters["h"].value) for side in both.models] == pytest.approx([-1.35, -1.25])
    for side in both.basins:
        assert {name for _, name, _ in side.classes} == {"(1, 1) orbit", "(3, 3) orbit"}
        assert (side.tau[0] + side.tau[-1]) / 2 == pytest.approx(0, abs=1e-9)
    colors = class_colors(both.basins)
    named = [dict(zip([name for _, name, _ in side.classes], each, strict=True))
             for side, each in zip(both.basins, colors, strict=True)]  # fmt: skip
    assert named[0] == named[1]
    axes = si.plot(both)
    assert [one.get_title() for one in axes] == ["h = -1.35", "h = -1.25"]
    labels = [text.get_text() for text in axes[0].get_legend().get_texts()]
    assert labels[-3:] == [PENS[name].words for name in ("P", "jump", "gamma")]
    again = si.plot(both, Figure().subplots(1, 2), alpha=0.5)
    assert {line.get_alpha() for one in again for line in one.lines} == {0.5}
    usual = waves.both_sides(index, size=4)
    assert float(usual.models[1].parameters["h"].value) == pytest.approx(-1.275)  # a twentieth of the interval


def test_orbits_with_chatter_are_found_soon_where_others_graze_for_ever() -> None:
    """Undamped flights at omega 2 come back to the wall by a rounding: 4000 of them took two minutes."""
    assert list(si.linear(2, "-0.9", "0.5").periodic(np.inf, 2)) == []


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: si.transitions("x"), "osc = 'x' is not accepted: give an ImpactOscillator"),
        (lambda: si.transitions(COCO, "amplitude", (0, 1), orbits=0), "orbits = 0"),
        (lambda: si.transitions(COCO, "amplitude", (0, 1), orbits="x"), "a whole number from 1 to 8, or pairs"),
        (lambda: si.transitions(COCO, "amplitude", (0, 1), orbits=[(9, 1)]), "n = 9"),
        (lambda: si.transitions(COCO, "mass", (0, 1)), "number of the model 'mass'"),
        (lambda: si.transitions(si.universal(-1, "0.5"), "clearance", (-1, 1), orbits=1), "has no period"),
    ],
)
def test_refusals(ask, told: str) -> None:
    with pytest.raises(InputError) as caught:
        ask()
    assert told in str(caught.value)


@pytest.mark.slow
def test_sides_that_are_none(waves: OrbitTransitions) -> None:
    with pytest.raises(InputError, match="index = 9"):
        waves.both_sides(9)
    with pytest.raises(InputError, match="apart = 0"):
        waves.both_sides(0, apart=0)
    with pytest.raises(InputError, match="two: those before and after"):
        si.plot(waves.both_sides(0, size=2), ax=si.plot(si.linear(2, 0, 1).orbit(0.1, 0.5, impacts=2)))
