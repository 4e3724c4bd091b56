"""Transitions of P over a number: swans where they are known, swallowtails beside them, lips by what is born."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.surface import ImpactSurface, swan_curves, transitions

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(w*t)", "0.3", "0.6", parameters={"w": "1.7"})


def test_swans_of_the_linear_oscillator_over_the_clearance():
    found = transitions(si.linear(2, "0.3", "0.5"), "clearance", ("-1.2", "1.2"), (-3, 3))
    swans = [each for each in found if each.kind.startswith("swan")]
    assert [each.kind for each in swans] == ["swan, positive", "swan, negative"]
    assert np.abs([swans[0].value + 1, swans[1].value - 1, swans[0].tau - np.pi / 2, swans[1].tau]).max() < 1e-10


def two_waves(clearance):
    model = si.ImpactOscillator("x", "cos(w*t) + h*cos(2*w*t)", clearance, "0.5", parameters={"w": 2, "h": "0.5"})
    return transitions(model, "h", ("0", "1"), kinds=("swan", "swallowtail", "tangency"))


@pytest.mark.slow
def test_swans_over_a_parameter_lie_between_the_ends_each_once():
    """With u = cos 2t: u = -1, -1 + h = c; or u = -1/(4h), -1/(8h) - h = c.  For c = 0.3 both lie outside (0, 1)."""
    found = two_waves("0.3")
    assert ([each for each in found if each.kind.startswith("swan")], found.complete) == ([], True)
    found = two_waves("-0.9")
    height = (0.9 + np.sqrt(0.81 - 0.5)) / 2
    side = np.arccos(-1 / (4 * height)) / 2
    swans = [(each.value, each.tau) for each in found if each.kind.startswith("swan")]
    assert np.abs(np.array(swans) - [(0.1, np.pi / 2), (height, side), (height, np.pi - side)]).max() < 1e-12
    assert {each.kind for each in found if each.kind.startswith("swan")} == {"swan, positive"}
    assert [each.value for each in found] == sorted(each.value for each in found)
    assert found.complete


@pytest.mark.slow
def test_a_double_zero_that_stays_is_said():
    """a_c = cos wt - 1 has a double zero at every w, so that none of them is alone; nothing is called complete."""
    found = transitions(si.linear(2, 1, "0.5"), "omega", ("1.2", "1.3"))
    assert not found.complete
    assert any("double ones that stay, for omega from 1.2 to 1.3" in note for note in found.notes)


@pytest.mark.slow
def test_lips_and_beaks_agree_with_the_closed_form_to_ten_digits():
    """x'' + x'/10 + x = cos wt: a = 0, x = c, x' = 0 in (tau, t, w), by mpmath from the written solution."""
    damped = si.ImpactOscillator("x + 0.1*xdot", "cos(w*t)", "0.3", "0.6", parameters={"w": "1.7"})
    found = [each for each in transitions(damped, "w", ("1.9", "2.3"), (0, 12)) if each.kind in ("lips", "beaks")]
    assert {each.kind for each in found} == {"lips", "beaks"}
    assert len({(round(each.value, 8), round(each.tau, 8), round(each.t, 8)) for each in found}) == len(found)

    def missed(tau, t, w):
        gain = 1 / (1 - w**2 + mpmath.j * w / 10)
        rate = mpmath.mpc("-0.05", mpmath.sqrt(1 - mpmath.mpf("0.05") ** 2))

        def forced(s, order=0):
            return (gain * (mpmath.j * w) ** order * mpmath.exp(mpmath.j * w * s)).real

        start, speed = mpmath.mpf("0.3") - forced(tau), -forced(tau, 1)
        free = mpmath.mpc(start, (rate.real * start - speed) / rate.imag)  # x = Re(free exp(rate s))
        x, v = ((free * rate**k * mpmath.exp(rate * t)).real + forced(tau + t, k) for k in (0, 1))
        return mpmath.cos(w * tau) - mpmath.mpf("0.3"), x - mpmath.mpf("0.3"), v

    for each in found:
        with mpmath.workdps(30):
            exact = mpmath.findroot(missed, (each.tau, each.t, each.value))
        assert abs(float(exact[2] - each.value)) < 1e-10
        assert 1.9 <= each.value <= 2.3


@pytest.mark.slow
def test_swallowtails_are_the_crossings_of_the_flight_from_the_swan():
    found = transitions(DUFFING, "clearance", ("0.7", "0.95"))
    swan = next(each for each in found if each.kind.startswith("swan"))
    tails = [each for each in found if each.kind == "swallowtail"]
    assert len(tails) == 3
    assert {each.value for each in tails} == {swan.value}
    model = DUFFING.replace(clearance=swan.value)
    assert all(abs(float(model.flight(swan.tau, 0, each.t).x) - swan.value) < 1e-9 for each in tails)


@pytest.mark.slow
def test_a_piece_of_z_is_born_in_the_lips_that_are_found():
    (lips,) = [each for each in transitions(DUFFING, "w", ("1.9", "2.2")) if each.kind in ("lips", "beaks")]
    assert lips.kind == "lips"
    pieces = []
    for shift in (-2e-5, 2e-5):
        model = DUFFING.replace(w=lips.value + shift)
        window = (lips.tau - 0.4, lips.tau + 0.4), (lips.t - 0.4, lips.t + 0.4)
        pieces.append(sum(curve.closed for curve in ImpactSurface(model, *window).zero_set))
    assert sorted(pieces) == [0, 1]


@pytest.mark.slow
def test_curves_of_swan_points_over_two_numbers():
    """f(c) = max of g: c + 0.3 c^3 = 1 whatever w; over the height h of the forcing c + 0.3 c^3 = h."""
    model = si.ImpactOscillator("x + 0.3*x**3", "h*cos(w*t)", 0, "0.6", parameters={"w": "1.7", "h": 1})
    (level,) = swan_curves(model, ("clearance", "w"), ((0, 2), (1, 2)))
    assert np.abs(level.points[:, 0] + 0.3 * level.points[:, 0] ** 3 - 1).max() < 1e-12
    curves = swan_curves(model, ("h", "clearance"), (("0.2", "2"), ("0.3", "0.9")))
    points = max(curves, key=len).points
    assert np.abs(points[:, 0] - points[:, 1] - 0.3 * points[:, 1] ** 3).max() < 1e-12
    assert len(points) > 40


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: transitions(DUFFING, "q", (0, 1)), "q"),
        (lambda: transitions(DUFFING, "w", (2, 1)), "two numbers"),
        (
            lambda: transitions(si.ImpactOscillator("k*x", "t**2 - 1", 0, "0.5", parameters={"k": 1}), "k", (1, 2)),
            "not seen to be periodic",
        ),
    ],
)
def test_refusals(ask, told):
    with pytest.raises(InputError, match=told):
        ask()
