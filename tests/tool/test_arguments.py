"""Arguments that a public callable does not take are refused in a sentence, of every one of them."""

import inspect

import pytest

import singimpact as si
from singimpact.inputs import InputError

FUNCTIONS = {name: getattr(si, name) for name in si.__all__ if inspect.isfunction(getattr(si, name))}
METHODS = {
    f"osc.{name}": getattr(si.linear(2, 0, "1/2"), name)
    for name in dir(si.ImpactOscillator)
    if not name.startswith("_") and inspect.isroutine(getattr(si.ImpactOscillator, name))
}
THEORY = {
    f"theory.{name}": getattr(si.theory, name)
    for name in dir(si.theory)
    if inspect.isfunction(getattr(si.theory, name))
}
CALLED = {"ImpactOscillator": si.ImpactOscillator, **FUNCTIONS, **METHODS, **THEORY}
KEYS = {name for name, each in CALLED.items() if inspect.Parameter.VAR_KEYWORD in
        {parameter.kind for parameter in inspect.signature(each).parameters.values()}}  # fmt: skip


def test_there_are_many():
    assert len(FUNCTIONS) > 25
    assert len(METHODS) > 15
    assert len(THEORY) > 5
    assert len(KEYS) < 5


@pytest.mark.quick
@pytest.mark.parametrize("name", sorted(set(CALLED) - KEYS))
def test_an_unknown_keyword_is_named(name):
    with pytest.raises(InputError, match=r"no argument 'no_such_thing': give \w") as refusal:
        CALLED[name](no_such_thing=1)
    assert refusal.value.__suppress_context__


@pytest.mark.parametrize(
    ("call", "why"),
    [
        (lambda: si.linear(2, 0, "1/2").orbit(0.1, 0.2, n=3), "orbit has no argument 'n': give impacts"),
        (lambda: si.basins(si.linear(2, 0, "1/2"), grid=9), "basins has no argument 'grid': give size"),
        (lambda: si.ImpactOscillator("x", "0", 0, 1, params={}), "ImpactOscillator has .* 'params': give parameters"),
        (lambda: si.ImpactOscillator("x"), "takes f, g, clearance, .* missing a required argument: 'g'"),
        (lambda: si.linear(2, 0, "1/2").impact_map(), "takes tau, v, .* missing a required argument: 'tau'"),
        (lambda: si.threshold(1, 2, 3, 4), "too many positional"),
    ],
)
def test_the_name_that_was_meant_is_told(call, why):
    with pytest.raises(InputError, match=why):
        call()


def test_an_error_inside_stays_what_it_is():
    def inner(value):
        return value + None

    from singimpact.inputs import checked_keywords

    with pytest.raises(TypeError, match="unsupported operand"):
        checked_keywords(inner)(1)
