"""First lines of docstrings stand alone, and long functions name their variables by nouns: counts that only fall."""

import ast
import json
import re
from pathlib import Path

import pytest

LISTED = Path(__file__).with_name("sentences.json")
"""What is left of each habit, as a count for each room; it only falls."""

NO_SENTENCE = re.compile(r"(The same|Those|With|As|What|How|One that|That)\b")
NO_NOUNS = {"found", "made", "told", "kept", "given", "asked", "known", "part", "place", "each"}
SHORT = 10
"""Lines of a function in which a name may be anything."""


def first_lines(tree):
    """The first lines of all docstrings of a file, with the line they stand in."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in ast.walk(tree):
        if isinstance(node, kinds) and (text := ast.get_docstring(node)):
            yield getattr(node, "lineno", 1), text.partition("\n")[0]


def open_first_lines(tree):
    """Lines whose docstring begins as no sentence does that stands alone."""
    return [line for line, text in first_lines(tree) if NO_SENTENCE.match(text)]


def bound_names(function):
    """Names that a function binds itself, not those of functions inside it: (name, line)."""
    arguments = function.args
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
    yield from ((argument.arg, argument.lineno) for argument in every if argument is not None)
    stack = list(function.body)
    while stack:
        node = stack.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            continue
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            yield node.id, node.lineno
        stack += ast.iter_child_nodes(node)


def participles(tree):
    """Names in long functions that say nothing of what they hold: each function and name once."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and node.end_lineno - node.lineno >= SHORT:
            found |= {(node.lineno, name) for name, _ in bound_names(node) if name in NO_NOUNS}
    return sorted(found)


RULES = {"first lines that do not stand alone": open_first_lines, "names that are no nouns": participles}


def counts(package, rule):
    """Room -> how often; rooms without any are left out."""
    totals = {}
    for path in sorted(package.rglob("*.py")):
        room = path.relative_to(package).parts[0].removesuffix(".py")
        totals[room] = totals.get(room, 0) + len(rule(ast.parse(path.read_text(encoding="utf-8"))))
    return {room: count for room, count in totals.items() if count}


@pytest.mark.parametrize("name", RULES)
def test_a_habit_only_fades(clone, name):
    """A room in which it has faded writes its new count into the list."""
    assert counts(clone / "singimpact", RULES[name]) == json.loads(LISTED.read_text(encoding="utf-8"))[name]


@pytest.mark.parametrize("text", ["The same in balls.", "Those of a point.", "How far it is.", "What a model needs."])
def test_a_planted_first_line_is_seen(text):
    assert open_first_lines(ast.parse(f'def f():\n    """{text}"""\n')) == [1]


def test_a_planted_name_is_seen():
    body = "".join(f"    x{at} = {at}\n" for at in range(10))
    assert participles(ast.parse(f"def f(x):\n    found = 1\n{body}")) == [(1, "found")]
    assert participles(ast.parse(f"def f(x):\n    hit = [each for each in x]\n{body}")) == [(1, "each")]
    assert participles(ast.parse("def f(x):\n    found = 1\n    return found\n")) == []
    assert open_first_lines(ast.parse('def f():\n    """The hit of a flight."""\n')) == []
