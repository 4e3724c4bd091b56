"""Points of contact order j over j - 1 numbers, beside determinants of the columns of a_c in one variable."""

from itertools import pairwise

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError

SECOND_WAVE = si.ImpactOscillator("x", "cos(t) + b*sin(2*t)", 0, "1/2", {"b": 0})


def wave(rate, shift, order):
    """The derivative of cos(rate t + shift), as a function."""
    return lambda t: rate**order * np.cos(rate * t + shift + order * np.pi / 2)


def expected(shifts):
    """Times and numbers of order 3 for a_c = cos(t + s0) + b cos(2t + s1)/2 - c, where a' and a'' are linear in b.

    Both vanish where the determinant of their columns does: a function of t alone, halved on a grid here.
    """

    def determinant(t):
        columns = [[wave(1, shifts[0], k)(t), wave(2, shifts[1], k)(t) / 2] for k in (1, 2)]
        return columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0]

    grid = np.linspace(-1e-3, 2 * np.pi - 1e-3, 4000)
    places = []
    for low, high in pairwise(grid):
        if determinant(low) * determinant(high) < 0:
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if determinant(low) * determinant(middle) > 0 else (low, middle)
            k = 1 if abs(wave(2, shifts[1], 1)(low)) > 1 else 2
            b = -wave(1, shifts[0], k)(low) / wave(2, shifts[1], k)(low) * 2
            places.append((b, low, wave(1, shifts[0], 0)(low) + b * wave(2, shifts[1], 0)(low) / 2))
    return places


@pytest.mark.parametrize("seed", range(6))
def test_all_points_of_order_three_of_drawn_models(seed):
    rng = np.random.default_rng(seed)
    shifts = rng.uniform(0, 2 * np.pi, 2).tolist()
    g = f"cos(t + {shifts[0]!r}) + b*cos(2*t + {shifts[1]!r})/2"
    osc = si.ImpactOscillator("x + x*xdot/5", g, 0, "1/2", {"b": 0})
    found = si.contact_points(osc, 3, ("b", "clearance"), ((-10, 10), (-12, 12)), digits=20)
    true = sorted(place for place in expected(shifts) if abs(place[0]) < 10)
    assert found.complete
    assert len(found) == len(true) > 0
    for point, (b, tau, c) in zip(sorted(found, key=lambda point: point.numbers["b"]), true, strict=True):
        assert (point.numbers["b"], point.tau, point.numbers["clearance"]) == pytest.approx((b, tau, c), abs=1e-9)
        third = wave(1, shifts[0], 3)(tau) + b * wave(2, shifts[1], 3)(tau) / 2
        assert point.leading == pytest.approx(third, rel=1e-8)
        assert point.sign == np.sign(third)
        assert all(number.radius < 1e-20 for number in point.certified.values())


def test_order_two_over_the_clearance_is_a_swan():
    swans = si.swan_points("x + 3*x**3/10", "cos(2*t) + sin(t)/3")
    osc = si.ImpactOscillator("x + 3*x**3/10", "cos(2*t) + sin(t)/3", 0, "1/2")
    points = si.contact_points(osc, 2, "clearance", (-3, 3))
    assert points.complete
    assert len(points) == len(swans) == 4
    for point, swan in zip(points, sorted(swans, key=lambda swan: (swan.tau, swan.clearance)), strict=True):
        assert (point.numbers["clearance"], point.tau) == pytest.approx((swan.clearance, swan.tau))
        assert (point.sign > 0) == (swan.kind == "positive")


def test_order_four_over_three_numbers():
    """a_c = cos t + b cos 2t + d sin 3t - c: an even a_c whose second derivative vanishes is of order four."""
    family = si.ImpactOscillator("x", "cos(t) + b*cos(2*t) + d*sin(3*t)", 0, "1/2", {"b": 0, "d": 0})
    points = si.contact_points(family, 4, ("clearance", "b", "d"), ((-2, 2), (-1, 1), (-1, 1)))
    assert points.complete
    assert [(p.numbers["clearance"], p.numbers["b"], p.tau) for p in points] == [
        pytest.approx((0.75, -0.25, 0), abs=1e-12),
        pytest.approx((-0.75, 0.25, np.pi), abs=1e-12),
    ]
    assert points[0].leading == pytest.approx(-3)
    near = points[0].unfolded(1e-4, 0.0, -0.04)  # -(s^4 - s^2/25 + 10^-4)/8
    roots = sorted(zero.tau for zero in si.tangency_points(near))
    squares = (0.04 + np.array([-1, 1]) * np.sqrt(0.0016 - 0.0004)) / 2
    assert roots[:2] == pytest.approx(np.sqrt(squares), rel=0.05)


def test_what_the_numbers_do_not_unfold_is_undecided():
    """Over the clearance and the height of an even second wave the zero is of order four at once."""
    even = si.ImpactOscillator("x", "cos(t) + b*cos(2*t)", 0, "1/2", {"b": 0})
    found = si.contact_points(even, 3, ("clearance", "b"), ((-2, 2), (-1, 1)))
    assert not found.complete
    assert any(low <= -0.25 <= high for _, _, (low, high) in found.undecided)


@pytest.mark.parametrize(
    ("order", "over", "between", "error"),
    [
        (3, "clearance", None, "2 numbers, one less than the order"),
        (3, ("clearance", "clearance"), None, "2 numbers, one less than the order"),
        (3, ("clearance", "restitution"), None, "contains"),
        (3, ("clearance", "damping"), None, "contains"),
        (3, ("clearance", "q"), None, "number of the model"),
        (2, "clearance", (1, 1), "two ends low < high of clearance"),
        (3, ("clearance", "b"), ((0, 1),), "two ends for each number"),
        (9, "clearance", None, "order"),
    ],
)
def test_bad_input(order, over, between, error):
    with pytest.raises(InputError, match=error):
        si.contact_points(SECOND_WAVE, order, over, between)


def test_numbers_that_change_the_period_are_refused():
    osc = si.ImpactOscillator("x", "cos(w*t)", 0, "1/2", {"w": 2})
    with pytest.raises(InputError, match="do not change the period"):
        si.contact_points(osc, 2, "w")


def test_numbers_that_are_zero_have_balls_of_an_ordinary_size():
    """Newton's method squares the radius at 0 again and again."""
    points = si.contact_points(si.ImpactOscillator("0", "t**3 + p*t + q", 0, "1/2", {"p": 0, "q": 0}), 3, ("p", "q"))
    assert points[0].numbers == {"p": 0, "q": 0}
    assert all(1e-400 < number.radius < 1e-25 or number.radius == 0 for number in points[0].certified.values())
