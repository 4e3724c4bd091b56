"""Long displayed formulas into lines that fit the page.

A formula may be broken before a + or - that is in no braces and in no \\left ... \\right pair, since a line may end
in neither; plain parentheses may span lines.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_TOKEN = re.compile(r"\\left\s*\\?.|\\right\s*\\?.|\\[a-zA-Z]+\*?|\\.|\s+|.", re.DOTALL)
_OPEN, _CLOSE = ("{", r"\left"), ("}", r"\right")
_PARENTHESES = ("(", "["), (")", "]")
_PAIRS = (*_OPEN, *_PARENTHESES[0], r"\{"), (*_CLOSE, *_PARENTHESES[1], r"\}")
_STACKED = re.compile(r"\\[dt]?frac\s*")


@dataclass(frozen=True)
class Page:
    """The width of a line of the template (16 cm at 11 pt), in widths of a digit (5.5 pt)."""

    line: float = 68.0  # measured: the widest line that the template sets without an overfull box is 76
    indent: float = 4.0
    script: float = 0.72
    sign: float = 2.6  # + - = with the space around them
    phone: float = 30.0  # a line of a list on a phone


PAGE = Page()


def lines_of(formula: str, limit: float = PAGE.line) -> list[str]:
    """The formula as lines, each narrower than the limit where its breaks allow it; parentheses are broken last.

    Examples
    --------
    >>> lines_of("v = a + b - c", limit=10)
    ['v = a + b', '- c']
    """
    lines: list[str] = []
    current = ""
    for piece in _fitting(formula, limit - PAGE.indent):
        room = limit - (PAGE.indent if lines else 0)
        if current.strip() and width(current + piece) > room:
            lines.append(current.strip())
            current = ""
        current += piece
    return [*lines, current.strip()]


def wrapping(formula: str) -> str:
    """The formula for a sentence in Markdown: as several formulas, between which a browser may end a line.

    Examples
    --------
    >>> wrapping(r"v = a + b,\\ t\\ne0"), wrapping("v = 123456789 + 123456789 - 123456789")
    ('$v = a + b,$ $t\\\\ne0$', '$v = 123456789 + 123456789$ ${}- 123456789$')
    """
    lines = [lines_of(clause, PAGE.phone) for clause in _clauses(formula)]
    return " ".join(f"${'{}' if at else ''}{line}$" for clause in lines for at, line in enumerate(clause))


def _clauses(formula: str) -> list[str]:
    """The formula cut at each written space that no pair encloses."""
    clauses, depth = [""], 0
    for token in _TOKEN.findall(formula):
        if depth == 0 and token in (r"\ ", r"\;", r"\quad", r"\qquad"):
            clauses.append("")
            continue
        depth += token.startswith(_PAIRS[0]) - token.startswith(_PAIRS[1])
        clauses[-1] += token
    return [clause.strip() for clause in clauses if clause.strip()]


def _fitting(formula: str, room: float) -> list[str]:
    """The formula cut outside parentheses, and inside them where a piece is too wide by itself."""
    whole = _pieces(formula, _OPEN + _PARENTHESES[0], _CLOSE + _PARENTHESES[1])
    return [part for piece in whole for part in ([piece] if width(piece) <= room else _pieces(piece, _OPEN, _CLOSE))]


def _pieces(formula: str, opening: tuple[str, ...], closing: tuple[str, ...]) -> list[str]:
    """The formula cut at the places where a line may begin: before a sign that no pair encloses."""
    pieces, depth, previous = [""], 0, ""
    for token in _TOKEN.findall(formula):
        if depth == 0 and token in "+-" and token and previous not in ("", "=", "(", "["):
            pieces.append("")
        depth += token.startswith(opening) - token.startswith(closing)
        pieces[-1] += token
        previous = previous if token.isspace() else token
    return pieces


def width(formula: str) -> float:
    """About how wide a formula is set, in widths of a digit.

    Examples
    --------
    >>> width(r"\\frac{123}{4567}"), width("12")
    (4.0, 2.0)
    """
    total, at = 0.0, 0
    while at < len(formula):
        stacked = _STACKED.match(formula, at)
        if stacked:
            above, at = _argument(formula, stacked.end())
            below, at = _argument(formula, at)
            total += max(width(above), width(below))
        elif formula[at] in "^_":
            script, at = _argument(formula, at + 1)
            total += PAGE.script * width(script)
        else:
            token = _TOKEN.match(formula, at)
            assert token is not None  # the last alternative takes any character
            at = token.end()
            total += _width_of(token.group())
    return total


def _argument(formula: str, at: int) -> tuple[str, int]:
    """The argument that begins at a place, and where it ends."""
    if at >= len(formula) or formula[at] != "{":
        token = _TOKEN.match(formula, at)
        return (token.group(), token.end()) if token else ("", at)
    depth = 0
    for end in range(at, len(formula)):
        depth += (formula[end] == "{") - (formula[end] == "}")
        if depth == 0:
            return formula[at + 1 : end], end + 1
    return formula[at + 1 :], len(formula)


def _width_of(token: str) -> float:
    if token in ("{", "}", "&") or token.isspace() or token in (r"\,", r"\!", r"\;", r"\operatorname", r"\mathrm"):
        return 0.0
    return PAGE.sign if token in "+-=<>" or token in (r"\le", r"\ge", r"\ne", r"\to") else 1.0
