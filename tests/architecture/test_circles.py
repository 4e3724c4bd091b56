"""No circle of files within a room: every import counts, those inside functions and for type checkers too."""

import ast
from pathlib import Path

import pytest


def module_of(path, root):
    parts = path.relative_to(root.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(text, name, modules):
    """Modules of the package that a file imports, at any depth."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            inner = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= {each if each in modules else node.module for each in inner}
    return (found & modules) - {name}


def circles(graph):
    """Sets of modules that reach one another."""
    reached = {name: set() for name in graph}
    for start in graph:
        stack = list(graph[start])
        while stack:
            name = stack.pop()
            if name not in reached[start]:
                reached[start].add(name)
                stack += graph.get(name, ())
    return {frozenset(other for other in reached[name] if name in reached[other])
            for name in graph if name in reached[name]}  # fmt: skip


def graph_of(root):
    files = {module_of(path, root): path for path in sorted(root.rglob("*.py"))}
    return {name: imported(path.read_text(encoding="utf-8"), name, set(files)) for name, path in files.items()}


def within(graph, room):
    """The part of a graph in one room; doors that name what is behind them (`__init__`) are left out."""
    return {name: {other for other in others if other.startswith(room + ".")}
            for name, others in graph.items() if name.startswith(room + ".")}  # fmt: skip


def test_no_circles(clone):
    root = Path(clone) / "singimpact"
    graph = graph_of(root)
    rooms = {f"singimpact.{each.name}" for each in root.iterdir() if each.is_dir()}
    found = {each for room in rooms for each in circles(within(graph, room))}
    assert sorted(map(sorted, found)) == []


@pytest.mark.parametrize("text", ["from singimpact.room.a import f", "def g():\n    from singimpact.room import a"])
def test_a_planted_circle_is_seen(text, tmp_path):
    room = tmp_path / "singimpact" / "room"
    room.mkdir(parents=True)
    (room / "__init__.py").touch()
    (room / "a.py").write_text("from singimpact.room.b import g")
    (room / "b.py").write_text(text)
    assert circles(within(graph_of(tmp_path / "singimpact"), "singimpact.room")) == {
        frozenset({"singimpact.room.a", "singimpact.room.b"})
    }
