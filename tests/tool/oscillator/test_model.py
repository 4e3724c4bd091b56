"""The model: equality by text, periods, files, and one line for each bad input."""

import pickle
import re

import pytest
import sympy

import singimpact as si
from singimpact.algebra import as_float
from singimpact.impact_oscillator import ImpactOscillator, read_model
from singimpact.inputs import InputError
from singimpact.oscillator import Oscillator, fields_of

DUFFING = {"f": "x + 0.1*xdot + 0.3*x**3", "g": "cos(omega*t)", "clearance": "0.3", "restitution": "0.6"}


def duffing(**changes):
    return ImpactOscillator(**({**DUFFING, "parameters": {"omega": "1.7"}} | changes))


def test_models_compare_hash_pickle_and_print_by_their_text():
    osc = duffing()
    assert osc == duffing(clearance=sympy.Rational(3, 10)) != duffing(clearance=0.3)
    assert len({osc, duffing()}) == 1
    assert pickle.loads(pickle.dumps(osc)) == osc
    assert eval(repr(osc), {"ImpactOscillator": ImpactOscillator}) == osc


def test_toml_round_trip(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text(duffing().to_toml())
    assert read_model(path) == duffing()


def test_sympy_model_is_the_text_model():
    x, xdot, t = sympy.symbols("x xdot t")
    osc = ImpactOscillator(
        x + xdot / 10 + sympy.Rational(3, 10) * x**3, sympy.cos(sympy.Rational(17, 10) * t), "0.3", "0.6"
    )
    assert as_float(osc.period) == as_float(duffing().period)


@pytest.mark.parametrize(
    ("g", "period"),
    [
        ("cos(3*t) + sin(2*t)", "2*pi"),
        ("exp(cos(t/2))", "4*pi"),
        ("tan(t/4)", "4*pi"),
        ("cos(pi*t)", "2"),
        ("cos(sqrt(2)*t) + 1", "2*pi/sqrt(2)"),
        ("cos(2*(t - 1))*sin(3*t)", "2*pi"),
        ("1", None),
        ("t**2", None),
        ("cos(t) + cos(pi*t)", None),
        ("cos(t**2)", None),
    ],
)
def test_period_is_found_or_not_claimed(g, period):
    found = ImpactOscillator("x", g, 0, 1).period
    expected = ImpactOscillator("x", "0", 0, 1, period=period).period if period else None
    assert (found is None) == (expected is None)
    assert found is None or as_float(found) == pytest.approx(as_float(expected), rel=1e-15)


REFUSED = [
    ({"clearance": float("nan")}, "clearance = nan"),
    ({"clearance": "abc"}, "clearance = 'abc'"),
    ({"restitution": 1.5}, "restitution = 1.5"),
    ({"restitution": -0.5}, "restitution = -0.5"),
    ({"restitution": "abc"}, "restitution = 'abc'"),
    ({"parameters": {"omga": 1}}, "'omega' has no value"),
    ({"parameters": {"omega": 1, "k": 2}}, "unknown parameter 'k'"),
    ({"parameters": {"omega": float("inf")}}, "omega = inf"),
    ({"parameters": {"t": 1, "omega": 1}}, "parameter name = 't'"),
    ({"parameters": [1]}, "parameters = [1]"),
    ({"f": "y"}, "'y' has no value"),
    ({"f": "cos(s)"}, "'s' has no value"),
    ({"g": "x"}, "'x' has no value"),
    ({"g": "__import__('os')"}, "unknown function"),
    ({"period": 0}, "period = 0"),
    ({"period": 1}, "period = 1 is not a period"),
    ({"period": "abc"}, "period = 'abc'"),
]


@pytest.mark.parametrize(("changes", "told"), REFUSED)
def test_bad_input_is_one_line(changes, told):
    with pytest.raises(ValueError, match=re.escape(told)) as refusal:
        duffing(**changes)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('f = "x"\nclearence = 1', "unknown key in model file: 'clearence': the nearest known are clearance"),
        ('f = "x"', "has no g"),
        ("f = ", "is not TOML"),
        ("\x00", "is not TOML"),
    ],
)
def test_bad_file_is_one_line(text, told):
    with pytest.raises(InputError) as refusal:
        fields_of(text)
    assert told in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_missing_file_is_one_line(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_model(tmp_path / "absent.toml")


def test_a_period_is_asked_for_where_it_is_needed():
    from singimpact.contact import tangency_points

    with pytest.raises(InputError, match="give period="):
        tangency_points(ImpactOscillator("x", "exp(-t)", 0, 1))


def test_abs_parses_and_is_refused_where_smoothness_is_needed():
    osc = ImpactOscillator("x + abs(xdot)*xdot", "cos(2*t)", "0.3", "0.5")
    with pytest.raises(InputError, match="abs"):
        osc.impact_map(1.2, 0.01)


@pytest.mark.parametrize("first", [Oscillator, ImpactOscillator])
def test_results_hold_a_model_of_the_kind_that_was_asked(first):
    """Though another of the same text, which is equal, was studied just before."""
    text = "x", "cos(1.7*t)", "-0.31", "0.6"
    for kind in (first, Oscillator, ImpactOscillator):
        between = kind(*text, upper="0.4")
        assert type(between.mirrored) is type(between.one_wall("upper")) is kind
        (orbit, *_) = si.periodic(kind(*text), 1, 1)
        branch = si.branch(orbit, "restitution", between=("0.55", "0.65"))
        assert type(orbit.oscillator) is type(branch.oscillator) is type(branch.orbit(0).oscillator) is kind
