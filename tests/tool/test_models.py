"""Named systems of the literature: each is a model with a source and a page that computes what is known of it."""

import re

import pytest

import singimpact as si
from singimpact.inputs import InputError

NAMES = list(si.models)


def test_all_names():
    assert len(si.models) == len(NAMES) == 15
    assert dir(si.models) == NAMES
    assert [line.split()[0] for line in repr(si.models).splitlines()] == NAMES
    assert si.models._repr_html_().count("<tr>") == 16


@pytest.mark.parametrize("name", NAMES)
def test_a_system_is_a_model_with_a_source(name):
    system = getattr(si.models, name)
    assert system is si.models[name]
    osc = system()
    assert isinstance(osc, si.ImpactOscillator)
    assert re.search(r"\((1[789]|20)\d\d\)|section 6", system.source)
    assert system.known in repr(system)
    assert osc.impact_map(0.3, 0.4).status in tuple(si.Status)
    for number in ("clearance", *osc.parameters, *(() if osc.upper is None else ("upper", "upper_restitution"))):
        value = "0.25" if osc.upper is not None else "1.25"
        changed = system(**{number: value})
        assert changed == osc.replace(**{number: value})
        assert changed != osc


@pytest.mark.parametrize("name", NAMES)
def test_a_page_shows_what_is_published_beside_ours(name, clone):
    """The numbers on the page are doctests; here that there are some, and a picture."""
    page = (clone / "docs" / "models" / f"{name}.md").read_text()
    assert si.models[name].source in page
    assert si.models[name].known in page
    assert f"gallery_{name}.png" in page
    assert f"# picture: {name}\n" in page
    assert re.search(r"^published .*, here |^True$", page, re.MULTILINE)
    assert f"models/{name}.md" in (clone / "docs" / "models.md").read_text()


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: si.models.chin(omga=2), "unknown number of chin 'omga': the nearest known are omega"),
        (
            lambda: si.models.chin(f="x"),
            "unknown number of chin 'f': none is near; there are beyond, clearance",
        ),
        (lambda: si.models["nordmarc"], "unknown named model 'nordmarc': the nearest known are nordmark"),
    ],
)
def test_refusals(call, told):
    with pytest.raises(InputError) as caught:
        call()
    assert told in str(caught.value)


def test_an_attribute_that_is_none():
    with pytest.raises(AttributeError, match="unknown named model 'hertzz': the nearest known are hertz"):
        _ = si.models.hertzz
