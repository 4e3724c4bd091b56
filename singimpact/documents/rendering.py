"""Words and sections into LaTeX, Markdown and JSON, as one text or as files: the same sections give the same bytes."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import cache
from typing import TYPE_CHECKING, Any

from singimpact.documents.breaking import lines_of
from singimpact.documents.document_steps import Mark, Section, Step

if TYPE_CHECKING:
    from jinja2 import Environment

PIECE, DOCUMENT, MARKDOWN = "section.tex", "document.tex", "section.md"
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


def as_master(sections: Sequence[Section]) -> str:
    """The document that takes in the files of sections."""
    return _filled(DOCUMENT, bodies=[rf"\input{{{section.name}}}" + "\n" for section in sections])


def as_markdown(section: Section, marks: Marks) -> str:
    """A section as Markdown with formulas between dollar signs."""
    return _filled(MARKDOWN, section=section, marks=marks)


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
    body = lines[0] if len(lines) == 1 else _split(lines)
    if not step.label:
        return f"\\begin{{equation*}}\n{body}\n\\end{{equation*}}"
    badge = _stacked(marks[step.label].text) if step.label in step.claims else ""
    tag = rf"\tag*{{\beside{{{latex_text(step.label)}}}{{{badge}}}}}\label{{{step.label}}}"
    return f"\\begin{{equation}}{tag}\n{body}\n\\end{{equation}}"


def _stacked(words: str, width: int = 30) -> str:
    """Words beside an equation, in lines one below the other where they are long, as the names of theorems are."""
    lines = textwrap.wrap(words, width, break_long_words=False, break_on_hyphens=False)
    return words if len(lines) < 2 else "\\shortstack[r]{" + "\\\\".join(lines) + "}"


def notes(step: Step, marks: Marks) -> list[tuple[str, str, str]]:
    """Notes below an equation, (claim, verdict, printed), without those that already stand beside it."""
    own = [("", "", marks[claim].printed) for claim in step.claims if claim == step.label and marks[claim].printed]
    others = [(claim, marks[claim].text, marks[claim].printed) for claim in step.claims if claim != step.label]
    return own + sorted(others, key=lambda note: bool(note[2]))


def _split(lines: list[str]) -> str:
    first, *rest = lines
    return "\\begin{split}\n&" + "\\\\\n&\\quad{}".join([first, *rest]) + "\n\\end{split}"


def _filled(template: str, **values: Any) -> str:
    return str(_environment().get_template(f"{template}.j2").render(**values))


@cache
def _environment() -> Environment:
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
        from singimpact.documents.compiling import compiled

        names = [step.picture for section in shown for step in section.steps if step.picture and drawn]
        pictures = {f"{name}.pdf": drawn(name) for name in names} if drawn else {}
        return {f"{MASTER}.pdf": compiled(as_latex(shown, marks), pictures).pdf}
    if form == "markdown":
        return {f"{section.name}.md": as_markdown(section, marks).encode() for section in shown}
    if form == "json":
        return {f"{section.name}.json": _json(as_data(section, marks)).encode() for section in shown}
    pieces = {f"{section.name}.tex": as_piece(section, marks).encode() for section in shown}
    return {**pieces, f"{MASTER}.tex": as_master(shown).encode()}


def _json(data: object) -> str:
    return json.dumps(data, indent=2) + "\n"
