"""Single changes of a program that a suite should notice: where they can be made, and the changed text.

A mutant differs from the source at one place: a sign, an operator, a comparison, a whole number, a power, a truth value
or the order of two arguments.  Words (docstrings, messages, annotations, defaults of settings) are left alone.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

SWAPPED = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">",
    ast.Eq: "!=", ast.NotEq: "==", ast.And: "or", ast.Or: "and", ast.FloorDiv: "/", ast.Mod: "//",
}  # fmt: skip
SIGNS = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
    ast.Eq: "==", ast.NotEq: "!=", ast.And: "and", ast.Or: "or", ast.FloorDiv: "//", ast.Mod: "%",
}  # fmt: skip


# pairs that `zip` makes are added, or compared
SYMMETRIC = ("plus", "times", "add", "multiply", "zip", "max", "min", "maximum", "minimum", "same", "substitution")


@dataclass(frozen=True)
class Mutant:
    """One change: characters start to end of a file become `text`.

    Attributes
    ----------
    file : of the repository. line : counted from 1. was, text : what stands there, and what stands there instead.
    """

    file: str
    line: int
    start: int
    end: int
    was: str
    text: str

    def applied(self, source: str) -> str:
        """The changed source."""
        return source[: self.start] + self.text + source[self.end :]

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.was} -> {self.text}"


def mutants_of(file: str, source: str) -> list[Mutant]:
    """Every mutant of a file, in the order of the text.

    Examples
    --------
    >>> [str(each) for each in mutants_of("f.py", "def f(x: int) -> int:\\n    return 2*x - 1\\n")]
    ['f.py:2: 2 -> 3', 'f.py:2: * -> /', 'f.py:2: - -> +', 'f.py:2: 1 -> 2']
    """
    tree = ast.parse(source)
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line.encode()))
    encoded = source.encode()

    def place(line: int, column: int) -> int:
        return len(encoded[: starts[line - 1] + column].decode())

    found = [
        Mutant(file, node_line, start, end, source[start:end], text)
        for node_line, start, end, text in _changes(tree, source, place)
    ]
    return sorted(set(found), key=lambda each: (each.start, each.end, each.text))


def _changes(tree: ast.AST, source: str, place) -> Iterator[tuple[int, int, int, str]]:
    for node in _code(tree):
        if isinstance(node, ast.BinOp | ast.Compare | ast.BoolOp):
            yield from _operators(node, source, place)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            at = place(node.lineno, node.col_offset)
            yield node.lineno, at, at + 1, "+"
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            yield node.lineno, place(node.lineno, node.col_offset), place(node.lineno, node.col_offset) + 4, ""
        elif isinstance(node, ast.Constant) and type(node.value) in (int, bool):
            text = str(not node.value) if isinstance(node.value, bool) else str(node.value + 1)
            yield (node.lineno, place(node.lineno, node.col_offset), place(node.end_lineno, node.end_col_offset), text)
        elif isinstance(node, ast.Call) and len(node.args) == 2 and not _symmetric(node):
            first, second = (
                (place(each.lineno, each.col_offset), place(each.end_lineno, each.end_col_offset)) for each in node.args
            )
            one, between, other = source[slice(*first)], source[first[1] : second[0]], source[slice(*second)]
            if one != other:
                yield node.lineno, first[0], second[1], other + between + one


def _symmetric(call: ast.Call) -> bool:
    """Whether exchanging two arguments is no change: of a symmetric function, or of arguments that are unpacked."""
    name = getattr(call.func, "id", None) or getattr(call.func, "attr", "")
    return name in SYMMETRIC or any(isinstance(each, ast.Starred) for each in call.args)


def _operators(node, source: str, place) -> Iterator[tuple[int, int, int, str]]:
    if isinstance(node, ast.BinOp):
        pairs = [(node.left, node.op, node.right)]
    elif isinstance(node, ast.Compare):
        pairs = list(zip([node.left, *node.comparators], node.ops, node.comparators, strict=False))
    else:
        pairs = [(one, node.op, other) for one, other in zip(node.values, node.values[1:], strict=False)]
    for left, op, right in pairs:
        low, high = place(left.end_lineno, left.end_col_offset), place(right.lineno, right.col_offset)
        sign = SIGNS.get(type(op))
        if sign and source[low:high].count(sign) == 1:
            at = low + source[low:high].index(sign)
            yield source[:at].count("\n") + 1, at, at + len(sign), SWAPPED[type(op)]


def _code(tree: ast.AST) -> Iterator[ast.AST]:
    """The nodes that compute: without annotations, docstrings, texts in f-strings, raised messages and settings."""
    for field, value in ast.iter_fields(tree):
        if field in ("annotation", "returns", "decorator_list", "type_params") or isinstance(tree, ast.Raise):
            continue
        for node in value if isinstance(value, list) else [value]:
            if not isinstance(node, ast.AST) or isinstance(
                node, ast.JoinedStr | ast.Import | ast.ImportFrom | ast.AnnAssign
            ):
                if isinstance(node, ast.AnnAssign) and node.value is not None and not isinstance(tree, ast.ClassDef):
                    yield node.value
                    yield from _code(node.value)
                continue
            yield node
            yield from _code(node)
