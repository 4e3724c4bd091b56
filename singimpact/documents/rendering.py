"""Sections into LaTeX and Markdown through templates: the same sections give the same bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from singimpact.documents import escape
from singimpact.documents.breaking import lines_of
from singimpact.documents.steps import Section

if TYPE_CHECKING:
    from jinja2 import Environment

LATEX, MARKDOWN = "section.tex", "section.md"


def as_latex(section: Section, verdicts: Mapping[str, str]) -> str:
    """A section as a LaTeX document that compiles by itself.

    Parameters
    ----------
    section : what is told.
    verdicts : claim id -> verdict, for every claim that the section shows.
    """
    return _filled(LATEX, section, verdicts)


def as_markdown(section: Section, verdicts: Mapping[str, str]) -> str:
    """A section as Markdown with formulas between dollar signs."""
    return _filled(MARKDOWN, section, verdicts)


def as_data(section: Section, verdicts: Mapping[str, str]) -> dict[str, Any]:
    """A section as data for JSON."""
    steps = [
        {
            "text": step.text,
            "equation": step.equation,
            "label": step.label,
            "claims": {claim: verdicts[claim] for claim in step.claims},
        }
        for step in section.steps
    ]
    return {"name": section.name, "title": section.title, "steps": steps}


def display(equation: str, label: str = "") -> str:
    """A displayed equation with its label, broken into lines where it is too wide for the page.

    Examples
    --------
    >>> print(display("v = a", "e:demo"))
    \\begin{equation}\\label{e:demo}
    v = a
    \\end{equation}
    """
    lines = lines_of(equation)
    body = lines[0] if len(lines) == 1 else _split(lines)
    head = rf"\begin{{equation}}\label{{{label}}}" if label else r"\begin{equation*}"
    return f"{head}\n{body}\n" + (r"\end{equation}" if label else r"\end{equation*}")


def _split(lines: list[str]) -> str:
    first, *rest = lines
    return "\\begin{split}\n&" + "\\\\\n&\\quad{}".join([first, *rest]) + "\n\\end{split}"


def _filled(template: str, section: Section, verdicts: Mapping[str, str]) -> str:
    return str(_environment().get_template(f"{template}.j2").render(section=section, verdicts=verdicts))


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


_FILTERS: dict[str, Callable[..., str]] = {
    "latex": escape.latex,
    "latex_words": escape.latex_words,
    "markdown": escape.markdown,
    "markdown_words": escape.markdown_words,
    "display": display,
}
