"""Swan points of a family: exact definitions, any digits, and a model at c_0 that knows its double zero."""

import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import EXACT, SYMBOLIC, Certified, Root, ball_of, parse
from singimpact.inputs import InputError

DUFFING = ("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)")
TWO_WAVES = ("x + x**3/5", "cos(t) + sin(3*t)/2")


def test_linear_oscillator():
    swans = si.swan_points("x", "cos(2*t)")
    assert [(swan.kind, swan.clearance, swan.tau) for swan in swans] == [
        ("negative", 1.0, 0.0),
        ("positive", -1.0, np.pi / 2),
    ]
    assert swans[0].oscillator("0.5") == si.ImpactOscillator("x", "cos(2*t)", 1, "0.5")
    assert isinstance(swans[0].oscillator("0.5"), si.ImpactOscillator)


@pytest.mark.parametrize("digits", [30, 200])
def test_certified_numbers_contain_mpmath(digits):
    """c_0 of the Duffing oscillator solves a cubic, tau_* of two waves a transcendental equation."""
    (tau, place) = si.swan_points(*DUFFING)[0].certified(digits)
    with mpmath.workdps(digits + 200):
        assert tau.contains(0)
        root = mpmath.findroot(lambda c: c + 3 * c**3 / 10 - 1, 0.83, tol=mpmath.mpf(10) ** -(2 * digits + 100))
        assert place.contains(root)
        assert not place.contains(root * (1 + mpmath.mpf(10) ** -(digits - 3)))
        assert place.radius <= mpmath.mpf(10) ** -digits


def test_two_waves():
    swans = si.swan_points(*TWO_WAVES)
    assert len(swans) == 6
    with mpmath.workdps(120):
        for swan in swans:
            tau, place = swan.certified(30)
            time = mpmath.findroot(lambda t: -mpmath.sin(t) + 3 * mpmath.cos(3 * t) / 2, swan.tau, tol=1e-110)
            level = mpmath.cos(time) + mpmath.sin(3 * time) / 2
            c = mpmath.findroot(lambda x, level=level: x + x**3 / 5 - level, swan.clearance, tol=1e-110)
            for found, truth in ((tau, time), (place, c)):
                known = Certified(found.value, found.radius + mpmath.mpf(10) ** -100, 30)
                assert known.contains(truth)
                assert not known.contains(truth + mpmath.mpf(10) ** -25)


@pytest.mark.parametrize(
    ("f", "g"), [DUFFING, pytest.param(*TWO_WAVES, marks=pytest.mark.slow), ("2*x + 1", "cos(2.8*t + 1)")]
)
def test_model_at_the_swan_knows_its_double_zero(f, g):
    for swan in si.swan_points(f, g):
        osc = swan.oscillator("0.6")
        near = [p for p in si.tangency_points(osc) if abs(p.tau - swan.tau) < 1e-6]
        assert [p.kind for p in near] == ["degenerate"]
        if swan.kind == "negative":
            graph = si.theory.gamma(order=4, at="swan", model=osc, tau=swan.time)
            rate = si.fixed_points.swan("0.6", 30).lambda_.value
            second = osc.acceleration(swan.tau, order=2)
            assert float(graph[3]) == pytest.approx(
                second / 24 * float((1 - rate) * (rate**2 + 2 * rate + 3)), rel=1e-12
            )


def test_text_pickle_and_toml_keep_the_root():
    osc = si.swan_points(*DUFFING)[0].oscillator("0.6")
    assert "root(u + 0.3*u**3 - 1, 0.829051, 0.829052)" in repr(osc)
    assert pickle.loads(pickle.dumps(osc)) == osc
    assert si.ImpactOscillator(**osc.to_dict()) == osc


def test_flights_at_the_swan_take_the_root_for_the_number_it_is():
    osc = si.swan_points(*DUFFING)[0].oscillator("0.6")
    rounded = osc.replace(clearance=si.swan_points(*DUFFING)[0].clearance)
    assert float(osc.impact_map(0.4, 0.3).tau) == pytest.approx(float(rounded.impact_map(0.4, 0.3).tau), rel=1e-13)
    many = osc.impact_map("0.4", "0.3", digits=30)
    assert abs(float(many.v) - float(osc.impact_map("0.4", "0.3").v)) < 1e-13
    assert osc.first_hit(0, 0).status == si.Status.sticks


def test_between_limits_the_search():
    assert [swan.kind for swan in si.swan_points(*DUFFING, between=(0, 2))] == ["negative"]
    assert len(si.swan_points("x + sin(x)/2", "cos(2*t)", between=("-3", "pi"))) == 2
    assert len(si.swan_points("w*x", "cos(2*t)", {"w": 3})) == 2
    assert [swan.kind for swan in si.swan_points("x", "t**2 - 1")] == ["positive"]


@pytest.mark.parametrize(
    ("arguments", "options", "what"),
    [
        (("x", "cos(2*t)"), {"over": "omega"}, "over = 'omega'"),
        (("x + sin(x)/2", "cos(2*t)"), {}, "between is needed"),
        (("x", "cos(2*t)"), {"between": (2, 1)}, "between"),
        (("x", "cos(2*t)"), {"between": 3}, "between"),
        (("x", "t**3"), {}, "not simple"),
        (("x**2", "cos(2*t) + 1"), {}, "double zero"),
        (("xdot", "cos(2*t)"), {}, "does not contain x"),
        (("x", "tanh(t**2)"), {}, "period"),
    ],
)
def test_bad_input_is_one_line(arguments, options, what):
    with pytest.raises(InputError, match=what) as caught:
        si.swan_points(*arguments, **options)
    assert "\n" not in str(caught.value)


def test_a_root_is_a_number():
    tree = parse("1 + root(u**2 - 2, 1, 2)/2")
    assert parse(str(tree)) == tree
    assert isinstance(parse("root(u**2 - 2, 1, 2)"), Root)
    with mpmath.workdps(60):
        assert (
            str(ball_of(parse("root(u**2 - 2, 1, 2)"), 200).mid().str(50, radius=False))[:45]
            == str(mpmath.sqrt(2))[:45]
        )
    for ring in (EXACT, SYMBOLIC):
        with pytest.raises(ArithmeticError, match="not written"):
            ring.root(parse("root(u**2 - 2, 1, 2)"))
    assert Fraction(1) != tree


@pytest.mark.parametrize(
    "text",
    ["root(u**2 - 2, 2, 3)", "root(u**2 - 2, -2, 2)", "root(u**2, -1, 1)", "root(u)", "root(u - 1, 0, pi)",
     "root(x, 0, 1)", "root(u - 1, 2, 0)", "u", "root(u - 1, 0, 2"],
)  # fmt: skip
def test_what_is_no_root_is_refused(text):
    with pytest.raises(InputError):
        parse(text)


@pytest.mark.parametrize("model", [("x", "cos(2*t)"), DUFFING, TWO_WAVES, ("x", "t**2 - t**3/3")])
def test_a_second_search_finds_the_same(model):
    swans = si.swan_points(*model)
    assert swans.complete
    fewer = type(swans)(swans[1:])
    fewer.model, fewer.between = swans.model, swans.between
    assert not fewer.complete
    assert pickle.loads(pickle.dumps(swans)).between == swans.between


def test_an_interval_without_swan_points_is_complete():
    none = si.swan_points("x", "cos(2*t)", between=(2, 3))
    assert (len(none), none.complete) == (0, True)
    assert si.swan_points("x", "1").complete
