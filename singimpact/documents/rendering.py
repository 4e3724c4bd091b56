"""Words and sections into LaTeX, Markdown and JSON, as one text or as files: the same sections give the same bytes."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from itertools import chain
from typing import TYPE_CHECKING, Any
from unicodedata import normalize

from singimpact.documents.document_steps import Mark, Section, Step

# Long displayed formulas into lines that fit the page.
#
# A formula may be broken before a + or - that is in no braces and in no \left ... \right pair, since a line may end
# in neither; plain parentheses may span lines.

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
    # outside parentheses, and inside them where a piece is too wide by itself
    whole = _pieces(formula, _OPEN + _PARENTHESES[0], _CLOSE + _PARENTHESES[1])
    narrow = [[piece] if width(piece) <= limit - PAGE.indent else _pieces(piece, _OPEN, _CLOSE) for piece in whole]
    for piece in chain.from_iterable(narrow):
        if current.strip() and width(current + piece) > limit - (PAGE.indent if lines else 0):
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


# Formulas as one line of Unicode, for a terminal.

_SIGNS = r"""
    \alpha α \beta β \gamma γ \delta δ \eta η \kappa κ \lambda λ \sigma σ \tau τ \phi φ \chi χ \psi ψ
    \omega ω \pi π \ell ℓ \Lambda Λ \Pi Π \Sigma Σ \Phi Φ \partial ∂ \infty ∞ \pm ± - − \le ≤ \ge ≥ \ne ≠
    \in ∈ \ni ∋ \subset ⊂ \setminus ∖ \cup ∪ \cap ∩ \circ ∘ \to → \mapsto ↦ \Rightarrow ⇒ \sim ~ \dots …
    \cos cos \lim lim \times × \{ { \} } \# #"""
_LEFT_OUT = (r"\,", r"\!", r"\;", r"\bigl", r"\bigr", r"\left", r"\right", "{", "}")
_UNICODE = {
    **dict(zip(_SIGNS.split()[::2], _SIGNS.split()[1::2], strict=True)),
    **dict.fromkeys(_LEFT_OUT, ""),
    **dict.fromkeys((r"\ ", r"\quad", r"\qquad"), " "),
}
_ACCENTS = {r"\dot": "\u0307", r"\ddot": "\u0308", r"\tilde": "\u0303", r"\bar": "\u0304"}
_RAISED = str.maketrans("0123456789+−s", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ˢ"), str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_VULGAR = {"1/2": "½", "1/3": "⅓", "2/3": "⅔", "1/4": "¼", "3/4": "¾", "1/6": "⅙", "1/8": "⅛"}
_RELATION = re.compile(r"\s*(:=|[=<>≤≥≠∈∋⊂∖∪∩∘→↦⇒~])\s*")


def unicode_line(formula: str) -> str:
    """A formula in LaTeX as one line of Unicode; a command that is not known stays as it is.

    Examples
    --------
    >>> unicode_line(r"\\frac{\\partial v_c}{\\partial t}(z_*)=-\\tfrac12a_*^2,\\quad\\sqrt{m^{-1}}\\ne\\dot x")
    '∂v_c/∂t(z_*) = −½a_*², √(m⁻¹) ≠ ẋ'
    """
    return " ".join(_RELATION.sub(r" \1 ", normalize("NFC", _in_unicode(formula))).split())


def _in_unicode(formula: str) -> str:
    """The signs of a formula, spaces not yet in order."""
    line, at = "", 0
    while at < len(formula):
        token = str(next(_TOKEN.finditer(formula, at)).group())
        at += len(token)
        if _STACKED.fullmatch(token):
            above, at = _argument(formula, at)
            below, at = _argument(formula, at)
            line += _fraction(_in_unicode(above), _in_unicode(below))
        elif token in ("^", "_"):
            script, at = _argument(formula, at)
            line += _script(token, _in_unicode(script))
        elif token in _ACCENTS or token in (r"\text", r"\mathcal", r"\mathbb", r"\sqrt"):
            inner, at = _argument(formula, len(formula) - len(formula[at:].lstrip()))
            line += f"√({_in_unicode(inner)})" if token == r"\sqrt" else _in_unicode(inner) + _ACCENTS.get(token, "")
        else:
            line += _UNICODE.get(token, token)
    return line


def _fraction(above: str, below: str) -> str:
    """A quotient on one line; a number is in brackets where it could be read together with what follows."""
    atoms = [part if re.fullmatch(r"∂?\s*\w+", part) else f"({part})" for part in (above, below)]
    quotient = "/".join(atom.replace("∂ ", "∂") for atom in atoms)
    return _VULGAR.get(quotient, f"({quotient})" if (above + below).isdigit() else quotient)


def _script(sign: str, script: str) -> str:
    """An index or an exponent, raised or lowered where Unicode has all of its signs."""
    table = _RAISED[sign == "_"]
    moved = script.translate(table)
    if all(ord(letter) in table for letter in script) or not script.strip("′'"):
        return moved
    return f"{sign}{script}" if len(script) == 1 else f"{sign}({script})"


if TYPE_CHECKING:
    from jinja2 import Environment

PIECE, DOCUMENT, MARKDOWN, VERDICTS = "section.tex", "document.tex", "section.md", "verdicts.html"
MASTER = "derivations"
Marks = Mapping[str, Mark]


# Words into LaTeX and Markdown: signs that mean something there are written so that they mean themselves.

_LATEX = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
}
_FORMULA = re.compile(r"(\$[^$]*\$)")


def latex_text(text: str) -> str:
    """Plain text as LaTeX.

    Examples
    --------
    >>> print(latex_text("50% of f_10 & more"))
    50\\% of f\\_10 \\& more
    """
    return "".join(_LATEX.get(sign, sign) for sign in text)


def latex_words(text: str) -> str:
    """Words as LaTeX; what stands between dollar signs is a formula and stays.

    Examples
    --------
    >>> print(latex_words("at $v_c$ by 5%"))
    at $v_c$ by 5\\%
    """
    return "".join(part if _FORMULA.fullmatch(part) else latex_text(part) for part in _FORMULA.split(text))


def markdown_text(text: str) -> str:
    """Plain text as Markdown.

    Examples
    --------
    >>> print(markdown_text("f_10 * 2"))
    f\\_10 \\* 2
    """
    return re.sub(r"([\\`*_\[\]<>#|])", r"\\\1", text)


def markdown_words(text: str) -> str:
    """Words as Markdown; formulas between dollar signs stay."""
    return "".join(part if _FORMULA.fullmatch(part) else markdown_text(part) for part in _FORMULA.split(text))


def as_latex(sections: Sequence[Section], marks: Marks) -> str:
    """Sections as one LaTeX document that compiles by itself.

    Parameters
    ----------
    sections : what is told, in order.
    marks : claim id -> what was found, for every claim that the sections show.
    """
    return _filled(DOCUMENT, bodies=[as_piece(section, marks) for section in sections])


def as_piece(section: Section, marks: Marks) -> str:
    """A section as LaTeX for a document that takes it in by ``\\input``."""
    return _filled(PIECE, section=section, marks=marks)


def as_markdown(section: Section, marks: Marks) -> str:
    """A section as Markdown with formulas between dollar signs."""
    return _filled(MARKDOWN, section=section, marks=marks)


def as_page(summary: Sequence[str], verdicts: Sequence[Any]) -> str:
    """Verdicts as an HTML page that needs no network: formulas are MathML."""
    return _filled(VERDICTS, summary=summary, verdicts=verdicts)


def mathml(formula: str) -> str:
    """A formula in LaTeX as MathML, which browsers set."""
    from latex2mathml.converter import convert

    return str(convert(formula))


def as_data(section: Section, marks: Marks) -> dict[str, Any]:
    """A section as data for JSON."""
    steps = [
        {
            "text": step.text,
            "equation": step.formula,
            "label": step.label,
            "claims": {claim: asdict(marks[claim]) for claim in step.claims},
        }
        for step in section.steps
    ]
    return {"name": section.name, "title": section.title, "steps": steps}


def display(step: Step, marks: Marks) -> str:
    """A displayed equation with its label and verdicts at the right, broken where it is too wide for the page.

    Examples
    --------
    >>> print(display(Step("", "v = a", "e:demo", ("e:demo",)), {"e:demo": Mark("proved", "proved")}))
    \\begin{equation}\\tag*{\\beside{e:demo}{proved}}\\label{e:demo}
    v = a
    \\end{equation}
    """
    lines = lines_of(step.formula) if isinstance(step.equation, str) else [step.formula]
    body = lines[0] if len(lines) == 1 else "\\begin{split}\n&" + "\\\\\n&\\quad{}".join(lines) + "\n\\end{split}"
    if not step.label:
        return f"\\begin{{equation*}}\n{body}\n\\end{{equation*}}"
    # words beside an equation stand below one another where they are long, as the names of theorems are
    words = marks[step.label].text if step.label in step.claims else ""
    lines = textwrap.wrap(words, 30, break_long_words=False, break_on_hyphens=False)
    badge = words if len(lines) < 2 else "\\shortstack[r]{" + "\\\\".join(lines) + "}"
    tag = rf"\tag*{{\beside{{{latex_text(step.label)}}}{{{badge}}}}}\label{{{step.label}}}"
    return f"\\begin{{equation}}{tag}\n{body}\n\\end{{equation}}"


def notes(step: Step, marks: Marks) -> list[tuple[str, str, str]]:
    """Notes below an equation, (claim, verdict, printed), without those that already stand beside it."""
    own = [("", "", marks[claim].printed) for claim in step.claims if claim == step.label and marks[claim].printed]
    others = [(claim, marks[claim].text, marks[claim].printed) for claim in step.claims if claim != step.label]
    return own + sorted(others, key=lambda note: bool(note[2]))


def _filled(template: str, **values: Any) -> str:
    return str(environment().get_template(f"{template}.j2").render(**values))


@cache
def environment() -> Environment:
    """Jinja with delimiters that LaTeX does not use; a name that is missing is an error, never an empty place."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("singimpact.documents", "templates"),
        undefined=StrictUndefined,
        autoescape=False,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        block_start_string="<%",
        block_end_string="%>",
        variable_start_string="<<",
        variable_end_string=">>",
        comment_start_string="<#",
        comment_end_string="#>",
    )
    environment.filters.update(_FILTERS)
    return environment


_FILTERS: dict[str, Callable[..., Any]] = {
    "latex": latex_text,
    "latex_words": latex_words,
    "markdown": markdown_text,
    "markdown_words": markdown_words,
    "display": display,
    "mathml": mathml,
    "notes": notes,
}


def as_text(shown: Sequence[Section], marks: Marks, form: str) -> str:
    """Sections as one text: ``latex``, ``markdown`` or ``json``."""
    if form == "latex":
        return as_latex(shown, marks)
    if form == "markdown":
        return "\n".join(as_markdown(section, marks) for section in shown)
    return _json({"sections": [as_data(section, marks) for section in shown]})


def as_files(
    shown: Sequence[Section], marks: Marks, form: str, drawn: Callable[[str], bytes] | None = None
) -> dict[str, bytes]:
    """File name -> content: one a section, and for LaTeX the master that takes them in; a PDF is one file.

    Parameters
    ----------
    shown, marks : as of `as_latex`. form : ``latex``, ``pdf``, ``markdown`` or ``json``.
    drawn : gives the picture of a name as PDF, for a PDF; None leaves pictures out.
    """
    if form == "pdf":
        from singimpact.documents.document_steps import compiled

        names = [step.picture for section in shown for step in section.steps if step.picture and drawn]
        pictures = {f"{name}.pdf": drawn(name) for name in names} if drawn else {}
        return {f"{MASTER}.pdf": compiled(as_latex(shown, marks), pictures).pdf}
    if form == "markdown":
        return {f"{section.name}.md": as_markdown(section, marks).encode() for section in shown}
    if form == "json":
        return {f"{section.name}.json": _json(as_data(section, marks)).encode() for section in shown}
    pieces = {f"{section.name}.tex": as_piece(section, marks).encode() for section in shown}
    master = _filled(DOCUMENT, bodies=[rf"\input{{{section.name}}}" + "\n" for section in shown])
    return {**pieces, f"{MASTER}.tex": master.encode()}


def _json(data: object) -> str:
    return json.dumps(data, indent=2) + "\n"
