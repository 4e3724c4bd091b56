"""Tests know rooms, not their files, and the tests of the tool know neither the paper nor the bench."""

import ast
import json
from importlib import import_module
from pathlib import Path

import pytest

from singimpact.handed_on import homes_in

EXCEPTIONS = json.loads(Path(__file__).with_name("imports_of_files.json").read_text(encoding="utf-8"))
"""Test file -> files of rooms that it imports: those whose inside it replaces or measures.  It only shrinks."""

OF_OTHER_THIRDS = json.loads(Path(__file__).with_name("imports_of_other_thirds.json").read_text(encoding="utf-8"))
"""Test file of the tool -> rooms of the paper and the bench that it asks as witnesses.  It only shrinks."""

OTHER_THIRDS = ("singimpact.paper", "singimpact.bench")


def is_module(clone, name):
    path = clone.joinpath(*name.split("."))
    return path.is_dir() or path.with_suffix(".py").exists()


def imported_modules(clone, text):
    """Full names of the modules of the package that a source imports from, or as a whole."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.startswith("singimpact"))
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("singimpact"):
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                yield full if is_module(clone, full) else node.module


def files_of_rooms(clone, text):
    """Imported modules that lie inside a room."""
    return sorted({name for name in imported_modules(clone, text) if name.count(".") >= 2})


def rooms_of_other_thirds(clone, text):
    return sorted({name for name in imported_modules(clone, text) if name.startswith(OTHER_THIRDS)})


def by_test(clone, folder, rule):
    paths = sorted((clone / folder).rglob("*.py"))
    assert len(paths) > 50
    names = {path.relative_to(clone).as_posix(): rule(clone, path.read_text(encoding="utf-8")) for path in paths}
    return {path: modules for path, modules in names.items() if modules}


def test_no_test_imports_deeper_than_a_room(clone):
    """An exception that is no longer needed leaves the list."""
    assert by_test(clone, "tests", files_of_rooms) == EXCEPTIONS


def test_the_tool_is_tested_without_paper_and_bench(clone):
    assert by_test(clone, "tests/tool", rooms_of_other_thirds) == OF_OTHER_THIRDS


def test_the_lists_only_shrink():
    assert sum(map(len, EXCEPTIONS.values())) <= 144
    assert sum(map(len, OF_OTHER_THIRDS.values())) <= 19


@pytest.mark.parametrize(
    "text",
    [
        "from singimpact.flights.states import States",
        "from singimpact.flights import states",
        "def late():\n    import singimpact.flights.states",
    ],
)
def test_a_planted_import_is_seen(clone, text):
    assert files_of_rooms(clone, text) == ["singimpact.flights.states"]


def test_an_import_of_a_room_is_none(clone):
    assert files_of_rooms(clone, "import singimpact as si\nfrom singimpact.flights import States") == []
    assert rooms_of_other_thirds(clone, "from singimpact.bench import values") == ["singimpact.bench"]


def test_every_room_hands_on_what_it_names(clone):
    """Each name is there, and is no name of a file, which an import of the file would put in its place."""
    rooms = sorted(path.parent.name for path in (clone / "singimpact").glob("*/__init__.py"))
    tables = [clone / "singimpact" / room / "__init__.pyi" for room in rooms]
    tables = {stub.parent.name: homes_in(stub) for stub in tables if stub.exists()}
    assert len(tables) > 12
    for room, names in tables.items():
        for name in names:
            assert getattr(import_module(f"singimpact.{room}"), name) is not None
            assert not is_module(clone, f"singimpact.{room}.{name}")
