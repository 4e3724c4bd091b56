"""The size of the package is a ceiling that only falls; `python tests/architecture/test_sizes.py` prints it."""

import ast
import io
import json
import re
import tokenize
from collections import Counter
from pathlib import Path

import pytest

CEILINGS = Path(__file__).with_name("sizes.json")
"""Measure -> the largest value that is accepted now, and the one to reach (for comments: at least)."""

AT_LEAST = {"lines of comments"}
FORMATTER_OFF = re.compile(r"# fmt: (skip|off)")


def docstrings(tree):
    """Expressions of a tree that are docstrings, or texts below an assignment."""
    return {
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
    }


def lines_of_code(text, tree):
    """Lines of which some part is neither a comment nor a docstring."""
    left_out = {line for node in docstrings(tree) for line in range(node.lineno, node.end_lineno + 1)}
    empty = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
    lines = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in empty:
            lines.update(range(token.start[0], token.end[0] + 1))
    return len(lines - left_out)


def statements(tree):
    return sum(isinstance(node, ast.stmt) for node in ast.walk(tree))


def anys(tree):
    """How often a signature says Any."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]
    count = 0
    for function in functions:
        arguments = function.args
        every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
        notes = [each.annotation for each in every if each is not None and each.annotation is not None]
        for note in [*notes, *([function.returns] if function.returns is not None else [])]:
            count += sum(isinstance(node, ast.Name) and node.id == "Any" for node in ast.walk(note))
    return count


def base_names_twice(paths):
    """File names, or names of a room inside a room, that occur more than once."""
    names = Counter(path.parent.name if path.name == "__init__.py" else path.stem for path in paths)
    return sum(count > 1 for count in names.values())


def sizes(package):
    """Measure -> value, of the files below a folder."""
    paths = sorted(path for path in package.rglob("*.py") if "__pycache__" not in path.parts)
    texts = [path.read_text(encoding="utf-8") for path in paths]
    trees = [ast.parse(text) for text in texts]
    comments = [line.strip() for text in texts for line in text.splitlines() if line.strip().startswith("#")]
    return {
        "files": len(paths),
        "lines of code": sum(map(lines_of_code, texts, trees)),
        "statements": sum(map(statements, trees)),
        "marks that switch the formatter off": sum(len(FORMATTER_OFF.findall(text)) for text in texts),
        "lines of comments": sum(not FORMATTER_OFF.match(comment) for comment in comments),
        "base names used twice": base_names_twice(paths),
        "Any in signatures": sum(map(anys, trees)),
    }


@pytest.fixture(scope="module")
def measured():
    return sizes(Path(__file__).parents[2] / "singimpact")


@pytest.mark.parametrize("name", json.loads(CEILINGS.read_text(encoding="utf-8")))
def test_no_size_grows_beyond_its_ceiling(measured, name):
    ceiling, _ = json.loads(CEILINGS.read_text(encoding="utf-8"))[name]
    assert measured[name] >= ceiling if name in AT_LEAST else measured[name] <= ceiling


@pytest.mark.parametrize("name", json.loads(CEILINGS.read_text(encoding="utf-8")))
def test_a_ceiling_follows_what_has_shrunk(measured, name):
    """One that stands more than a hundredth above the size would let it grow again: write the size into the file."""
    ceiling, _ = json.loads(CEILINGS.read_text(encoding="utf-8"))[name]
    assert abs(measured[name] - ceiling) <= 0.01 * ceiling


def test_what_is_counted(tmp_path):
    (tmp_path / "a.py").write_text(
        '"""A file.\n\nIt has two statements.\n"""\n\n# why\nx = [1,\n     2]  # fmt: skip\n\n\ndef f(y: Any) -> Any:\n'
        '    """A function."""\n    return y\n'
    )
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "a.py").touch()
    found = sizes(tmp_path)
    assert found == {
        "files": 2,
        "lines of code": 4,
        "statements": 5,
        "marks that switch the formatter off": 1,
        "lines of comments": 1,
        "base names used twice": 1,
        "Any in signatures": 2,
    }


if __name__ == "__main__":
    limits = json.loads(CEILINGS.read_text(encoding="utf-8"))
    for name, value in sizes(Path(__file__).parents[2] / "singimpact").items():
        ceiling, goal = limits[name]
        print(f"{name:36} {value:6}  {'at least' if name in AT_LEAST else 'at most'} {ceiling}, to reach {goal}")
