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
    assert len(KEYS) < 12


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
        (lambda: si.basins(si.linear(2, 0, "1/2"), grid=9), "argument of basins 'grid': the nearest known are size"),
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


@pytest.mark.parametrize(
    ("call", "why"),
    [
        (lambda orbit: orbit.to_csv("orbit.xlsx"), "a name that ends in .csv"),
        (lambda orbit: si.plot(orbit, colour="red"), "plot has no argument 'colour'"),
        (lambda orbit: si.plot(orbit, color="no such colour"), "color = 'no such colour' is not accepted"),
        (
            lambda _: si.bifurcation(si.ImpactOscillator("x", "cos(2*t)", 0, 1), "omega", (1, 2)),
            "has a name if it is a parameter, cos.omega.t. with",
        ),
    ],
)
def test_a_mistake_with_a_result_is_told(call, why):
    with pytest.raises(InputError, match=why):
        call(si.linear(2, 0, "1/2").orbit(0.1, 0.2, 3))


def test_a_list_of_orbits_says_why_there_is_none():
    none = si.linear(2, 0, "1/2").periodic(7, 1)
    assert len(none) == 0
    with pytest.raises(IndexError, match="there is no orbit 0 of these 0: ") as refusal:
        none[0]
    assert all(note in str(refusal.value) for note in none.notes)


def test_styles_go_to_lines():
    orbit = si.linear(2, 0, "1/2").orbit(0.1, 0.2, 3)
    axes = si.plot(orbit, color="red", linewidth=3, label="mine")
    assert {line.get_color() for line in axes.lines} == {"red"}
    assert [line.get_label() for line in axes.lines].count("mine") == 1
    before = len(axes.lines)
    again = si.plot(orbit, ax=axes, color="blue")
    assert again is axes
    assert [line.get_color() for line in axes.lines[:before]] == ["red"] * before
    assert {line.get_color() for line in axes.lines[before:]} == {"blue"}
    with pytest.raises(InputError, match="axes"):
        si.plot(orbit, axes=axes)


def test_a_figure_has_the_name_of_its_number():
    assert si.figure("12").axes


def test_names_before_1_0_are_refused_with_those_there_are():
    osc = si.linear(2, "0.9", "0.5")
    with pytest.raises(InputError, match="explore has no argument 'steps': give osc, between, points"):
        si.explore(osc, steps=2)
    with pytest.raises(InputError, match="Scene has no argument 'model': give "):
        si.Scene(model=osc, layers=("gamma",), v=(0, 1))
    with pytest.raises(InputError, match="explore has no argument 'stepps': give osc, between, points"):
        si.explore(osc, stepps=2)


@pytest.mark.parametrize(
    "study",
    [
        lambda osc: osc.inverse_map(0.1, 0.2),
        lambda osc: osc.threshold(1.5),
        lambda osc: osc.grown_gamma(),
        lambda osc: osc.certified_gamma(),
        lambda osc: osc.explore(points=2),
        lambda osc: si.theory.gamma(4, model=osc),
        lambda osc: si.theory.chatter_limit(4, osc, "1.5"),
        lambda osc: si.border_orbits(osc, "clearance", ("0.3", "0.4"), points=3),
    ],
)
def test_a_study_that_needs_rebounds_refuses_the_restitution_0(study):
    osc = si.linear(2, "0.3", 0)
    with pytest.raises(InputError, match="restitution = 0 is not accepted"):
        study(osc)
    study(osc.replace(restitution="0.5"))


def test_what_is_drawn_has_a_name():
    """A label where a legend shows it, else a gid, by which a user finds an artist again."""
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    saddle = next(orbit for orbit in osc.periodic(3, 3) if not orbit.stable)
    branch = si.branch(osc.periodic(1, 1)[0], "clearance", (0, 0.2))
    things = [osc.orbit(0.3, 0.5, 20), osc.bifurcation("clearance", (0, 0.1), points=5), si.basins(osc, size=20)]
    for thing in [*things, branch, si.manifold(saddle, v=1)]:
        axes = si.plot(thing)
        artists = [*axes.lines, *axes.collections, *axes.images]
        assert artists
        assert [a for a in artists if a.get_gid() is None and a.get_label().startswith("_")] == [], type(thing).__name__
    assert {line.get_gid() for line in si.plot(branch).lines} > {"branch, stable"}


@pytest.mark.parametrize("name", [name for name in si.__all__ if name not in ("Status", "Cause", "InputError")])
def test_every_public_callable_refuses_an_argument_that_it_does_not_take(name):
    thing = getattr(si, name)
    if callable(thing):
        with pytest.raises(InputError):
            thing(no_such_argument=1)
