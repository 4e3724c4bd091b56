"""The public names: each resolves, appears in dir(), and a misspelt one is told the nearest."""

import ast
import inspect

import pytest

import singimpact as si

HOMES = si._ROOMS | si._HOMES


@pytest.mark.parametrize("name", HOMES)
def test_name_resolves(name):
    assert getattr(si, name) is getattr(si, name)
    assert name in dir(si)


def test_version_is_that_of_the_project(clone):
    assert 'dynamic = ["version"]' in (clone / "pyproject.toml").read_text()
    assert si.__version__.count(".") == 2


def test_the_last_version_of_the_change_log_is_this_one_and_is_read_in_two_minutes(clone):
    first, second = (clone / "CHANGELOG.md").read_text(encoding="utf-8").split("\n## ")[1:3]
    last = second if first.startswith("Unreleased") else first
    assert last.splitlines()[0] == si.__version__
    assert len(last.split()) < 500


@pytest.mark.parametrize(
    ("wrong", "right"), [("ImpactOscilator", "ImpactOscillator"), ("liner", "linear"), ("verfy", "verify")]
)
def test_misspelt_name_is_told_the_nearest(wrong, right):
    with pytest.raises(AttributeError, match=f"no attribute '{wrong}': the nearest known are {right}"):
        getattr(si, wrong)


def test_special_name_is_just_missing():
    assert not hasattr(si, "__wrapped__")


def test_a_study_is_a_function_and_a_method_documented_once():
    """Of models, and of periodic orbits."""
    orbits = si.linear(2, "0.3", "0.5").periodic(1, 1)
    firsts = {"osc": si.ImpactOscillator, "saddle": type(orbits[0])}
    studies = {
        name: inspect.signature(getattr(si, name)).parameters
        for name in si.__all__
        if inspect.isfunction(getattr(si, name))
    }
    found = {name: firsts[next(iter(takes))] for name, takes in studies.items() if next(iter(takes), "") in firsts}
    assert len(found) >= 15
    for name, kind in found.items():
        assert getattr(kind, name).__doc__ == getattr(si, name).__doc__ != None, name  # noqa: E711
    assert type(orbits[0]).branch is si.branch
    method, function = (
        orbits[0].oscillator.lyapunov(0.3, 0.5, impacts=50),
        si.lyapunov(orbits[0].oscillator, 0.3, 0.5, impacts=50),
    )
    assert (method.exponents == function.exponents).all()
    with pytest.raises(si.InputError, match="osc = 3 is not accepted: give an ImpactOscillator"):
        si.periodic(3, 1, 1)
    with pytest.raises(si.InputError, match="missing a required argument: 'osc'"):
        si.orbit()
    assert si.orbit(osc=orbits[0].oscillator, tau=0.3, v=0.5, impacts=2).tau.size == 3


def test_type_checker_sees_the_same_names(clone):
    """The list is that of type checkers; of collections it has the type."""
    tree = ast.parse((clone / "singimpact" / "__init__.pyi").read_text())
    imported = {each.asname for node in tree.body if isinstance(node, ast.ImportFrom) for each in node.names}
    declared = {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
    assert {name for name in imported | declared if not name.startswith("_")} == set(si.__all__)
