"""What holds in 1.x: public names with their arguments, statuses, keys of files; `python FILE` stores those of now."""

import inspect
import json
from pathlib import Path

import pytest

import singimpact as si
from singimpact.oscillator import FIELDS

STORED = Path(__file__).with_name("signatures.json")


def arguments(function):
    """Names of arguments in order, those by keyword alone behind a star, defaults of what is optional."""
    texts, star = [], False
    for name, item in inspect.signature(function).parameters.items():
        if item.kind is item.KEYWORD_ONLY and not star:
            texts, star = [*texts, "*"], True
        mark = {item.VAR_POSITIONAL: "*", item.VAR_KEYWORD: "**"}.get(item.kind, "")
        if name != "self":
            texts.append(mark + name + ("" if item.default is item.empty else f"={item.default!r}"))
    return ", ".join(texts)


def public():
    """Everything that is promised, as data."""
    things = {name: getattr(si, name) for name in si.__all__}
    things |= {f"theory.{name}": getattr(si.theory, name) for name in dir(si.theory)}
    things |= {f"models.{name}": getattr(si.models, name) for name in dir(si.models)}
    methods = [name for name in dir(si.ImpactOscillator) if not name.startswith("_")]
    things |= {f"ImpactOscillator.{name}": getattr(si.ImpactOscillator, name) for name in methods}
    enums = (si.Status, si.Cause)
    functions = {name: arguments(value) for name, value in things.items() if callable(value) and value not in enums}
    codes = {kind.__name__: {code.name: int(code) for code in kind} for kind in enums}
    return {"names": sorted(things), "arguments": functions, **codes, "keys of model files": list(FIELDS)}


def lost(before, now):
    """What was promised before and does not hold now: names, arguments in their places, defaults, codes, keys."""
    gone = [name for name in before["names"] if name not in now["names"]]
    gone += [name for name, takes in before["arguments"].items() if not goes_on(takes, now["arguments"].get(name, ""))]
    gone += [f"{kind}.{name}" for kind in ("Status", "Cause") for name in before[kind].items() - now[kind].items()]
    return gone + [key for key in before["keys of model files"] if key not in now["keys of model files"]]


def goes_on(before, now):
    """Whether calls that were right still are: arguments stay where they are, and new ones are optional."""
    old, new = (dict.fromkeys(text.split(", ")) if text else {} for text in (before, now))
    by_place = [name for name in old if not name.startswith("*")][: list(old).index("*") if "*" in old else None]
    return (
        set(old) <= set(new)
        and list(new)[: len(by_place)] == by_place
        and all("=" in name or name.startswith("*") for name in set(new) - set(old))
    )


def test_public_signatures_are_those_stored():
    assert public() == json.loads(STORED.read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("now", "good"),
    [
        ("osc, tau, *, digits=None", True),
        ("osc, tau, *, digits=None, more=1", True),
        ("osc, tau, more=1, *, digits=None", True),
        ("osc, *, digits=None", False),
        ("tau, osc, *, digits=None", False),
        ("osc, tau, *, digits=30", False),
        ("osc, tau, more, *, digits=None", False),
    ],
)
def test_an_argument_that_breaks_calls_is_seen(now, good):
    assert goes_on("osc, tau, *, digits=None", now) == good


def test_a_name_that_is_gone_is_seen():
    stored = public()
    assert lost(stored, stored) == []
    assert lost(stored, stored | {"names": stored["names"][1:]}) == stored["names"][:1]
    assert lost(stored, stored | {"Status": {}})
    assert lost(stored, stored | {"keys of model files": ["f", "g"]})


if __name__ == "__main__":
    content, before = public(), json.loads(STORED.read_text(encoding="utf-8")) if STORED.exists() else None
    print(*(lost(before, content) if before else []), sep="\n")
    STORED.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
