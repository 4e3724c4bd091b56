"""Every entry of the reference is found, and shows an example that the suite runs."""

import inspect
import re
from importlib import import_module

import pytest

import singimpact as si

DIRECTIVE = re.compile(r"^\.\. auto(module|class|function|exception):: ([\w.]+)((?:\n   :.*)*)", re.MULTILINE)


def pages(clone):
    return sorted((clone / "docs" / "reference").glob("*.md"))


def resolved(path):
    """A module, or a thing in one."""
    try:
        return import_module(path)
    except ModuleNotFoundError:
        home, _, name = path.rpartition(".")
        return getattr(resolved(home), name)


def entries(text):
    """Path -> documented thing: functions, classes, and those of their methods that the page shows."""
    found = {}
    for kind, path, options in DIRECTIVE.findall(text):
        thing = resolved(path)
        chosen = re.search(r":members:(.*)", options)
        names = [name.strip() for name in chosen[1].split(",") if name.strip()] if chosen else []
        if kind != "module":
            found[path] = thing
        if chosen:
            inherited = ":inherited-members:" in options
            members = {name: getattr(thing, name) for name in names} or dict(own(thing, kind, inherited))
            for name, member in members.items():
                if not callable(member):  # a property says what it holds in one sentence
                    continue
                found[f"{path}.{name}"] = member
                if inspect.isclass(member) and kind == "module":
                    found |= {f"{path}.{name}.{inner}": value for inner, value in own(member, "class", False)}
    return found


def own(thing, kind, inherited):
    """The public functions, classes and methods that autodoc would list."""
    for name, member in inspect.getmembers(thing) if inherited else vars(thing).items():
        if name.startswith("_") or not inspect.getdoc(member):
            continue
        if kind == "module":
            here = getattr(member, "__module__", "") == thing.__name__ and callable(member)
        else:
            here = inspect.isfunction(member) or inspect.ismethod(member)
        if here:
            yield name, member


def without_example(text, tasks=""):
    """Entries without an example in the docstring, or in lines of the page or of the tasks.

    A result counts as shown where the thing that returns or holds it is.
    """
    found = entries(text)
    docs = {path: inspect.getdoc(thing) or "" for path, thing in found.items()}
    lines = "\n".join(re.findall(r"^```(?:pycon|python)\n(.*?)^```", text + tasks, re.MULTILINE | re.DOTALL))
    shown = {path for path in found if ">>>" in docs[path] or word(path, lines)}
    while held := {path for path, thing in found.items() if inspect.isclass(thing) and path not in shown
                   and any(word(path, types_in(found[other])) for other in shown)}:  # fmt: skip
        shown |= held
    return [path for path in found if path not in shown]


def word(path, text):
    return re.search(rf"\b{path.rpartition('.')[2]}\b", text)


def types_in(thing):
    """The annotations of what a function returns, or of the fields and properties of a class, as one text."""
    if not inspect.isclass(thing):
        return str(getattr(thing, "__annotations__", {}).get("return", ""))
    properties = [getattr(value, "fget", None) or getattr(value, "func", None) for value in vars(thing).values()]
    inner = [types_in(each) for each in properties if each is not None]
    fields, bases = vars(thing).get("__annotations__", {}).values(), getattr(thing, "__orig_bases__", ())
    return " ".join([*map(str, fields), *map(str, bases), *inner])


def test_every_entry_has_an_example(clone):
    texts = {page.name: page.read_text() for page in pages(clone)}
    assert sum(len(entries(text)) for text in texts.values()) > 150
    tasks = (clone / "docs" / "how_to.md").read_text()
    assert {name: found for name, text in texts.items() if (found := without_example(text, tasks))} == {}


def test_an_entry_without_example_is_seen():
    bare = "```{eval-rst}\n.. autofunction:: singimpact.dynamics.growth.held\n```"
    assert without_example(bare) == ["singimpact.dynamics.growth.held"]
    assert without_example(bare.replace("growth.held", "orbit.orbit")) == []
    assert without_example(f"```pycon\n>>> held(window, points)\n\n```\n\n{bare}") == []


@pytest.mark.parametrize("name", dir(si))
def test_public_name_is_in_the_list_of_pages(name, clone):
    text = (clone / "docs" / "reference.md").read_text()
    row = next(line for line in text.splitlines() if f"`{name}`" in line)
    page = clone / "docs" / re.search(r"\((reference/\w+\.md)\)", row)[1]
    assert page in pages(clone)
    assert re.search(rf"\b{name}\b", page.read_text())
