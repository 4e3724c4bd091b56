"""Functions of models with one wall refuse one with two: it would be taken for one with its lower wall alone."""

import inspect

import pytest

import singimpact as si
from singimpact.inputs import TWO_WALLS, FlightOptions, InputError

PAIR = si.linear("2.8", "-0.5", "0.8", upper=("0.5", "0.7"))
SENTENCE = "a second at upper = '0.5': give osc.one_wall"
MODEL_ONLY = {
    "force", "forcing", "mirrored", "one_wall", "replace", "rho", "rho_at_rest", "seen_from", "slope_at_rest",
    "to_dict",
}  # fmt: skip
"""Methods of the model as it is written."""
TAKEN = {
    "acceleration", "basins", "bifurcation", "branch", "chatter_limit", "derivative", "event_curve", "first_hit",
    "impact_map", "inverse_map", "iterate", "launch", "lyapunov", "orbit", "periodic", "release", "selftest", "to_toml",
    "ImpactSurface", "Scene", "grown_gamma", "tangency_points", "threshold", "classify", "transitions", "explore",
    "ensemble", "over", "regions",
}  # fmt: skip
"""What takes two walls."""


def is_taken(function):
    function = function.__init__ if inspect.isclass(function) else function
    return getattr(getattr(function, "__wrapped__", function), TWO_WALLS, False)


def public_functions():
    """Functions whose first argument is a model, and methods of one."""
    found = {}
    for name in si.__all__:
        thing = getattr(si, name)
        takes = list(inspect.signature(thing).parameters) if callable(thing) else []
        if takes and takes[0] in ("osc", "orbit", "event"):
            found[name] = thing
    methods = [name for name in dir(si.ImpactOscillator) if not name.startswith("_") and name not in MODEL_ONLY]
    return found | {f"osc.{name}": getattr(PAIR, name) for name in methods if callable(getattr(PAIR, name))}


@pytest.mark.parametrize("name", public_functions())
def test_two_walls_are_taken_or_refused(name):
    function, method = public_functions()[name], name.startswith("osc.")
    orbit = PAIR.periodic("lu", 1)[0]
    if name.removeprefix("osc.") in TAKEN or name == "animate":
        assert is_taken(function)
        return
    assert not is_taken(function)
    first = [] if method else [orbit if next(iter(inspect.signature(function).parameters)) == "orbit" else PAIR]
    with pytest.raises(InputError, match=SENTENCE):
        function(*first)


def test_enough_of_both_are_tried():
    names = public_functions()
    assert len([name for name in names if name.removeprefix("osc.") in TAKEN]) >= len(TAKEN)
    assert len(names) > 35


@pytest.mark.parametrize("call", [lambda: si.theory.gamma(1, model=PAIR)])
def test_what_names_a_model_otherwise_refuses_it_too(call):
    with pytest.raises(InputError, match="one wall"):
        call()


@pytest.mark.parametrize("method", [si.ImpactOscillator.first_hit, si.ImpactOscillator.impact_map])
def test_type_checkers_see_every_option_of_a_flight(method):
    options = [item for item in inspect.signature(method).parameters.values() if item.kind is item.KEYWORD_ONLY]
    assert {item.name for item in options} == set(FlightOptions.__annotations__)
