"""The errata: each statement that fails as printed, with what holds instead, why, the witness, and what survives."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, overload

from singimpact.documents.rendering import latex_text, latex_words, markdown_text, markdown_words, wrapping
from singimpact.inputs import checked_keywords
from singimpact.paper.claims.index import places_in_paper
from singimpact.paper.sections.remarks import GRADES, PLURALS, Remark, remark_on
from singimpact.paper.sections.stored_sections import kept_legend

if TYPE_CHECKING:
    from singimpact.paper.claims.claim import Claim, Verdict
    from singimpact.paper.claims.index import Entry

# Where a claim stands in the paper: page, equation, theorem and line, for a reader with the paper beside him.

PAPER = "D. R. J. Chillingworth, Dynamics of an impact oscillator near a degenerate graze"
VERSION = (
    "Preprint submitted to Nonlinearity. Numbers of equations and theorems are those of its LaTeX source; pages are "
    "those of the source set in the class article at 12 pt (24 pages), and may differ by one or two in print."
)


@dataclass(frozen=True)
class Place:
    """Where a claim stands in the paper.

    Attributes
    ----------
    page : of the preprint, see `VERSION`. line : of its LaTeX source. equations : the numbers of the displayed
        equations that hold the claim, empty where it stands in the text. statement : such as "Theorem 4.1", or "".
    """

    page: int
    line: int
    equations: tuple[int, ...]
    statement: str

    def __str__(self) -> str:
        return ", ".join(part for part in (f"p. {self.page}", self.statement, self.numbers) if part)

    @property
    def numbers(self) -> str:
        """The numbers of the equations, as they are printed.

        Examples
        --------
        >>> place_of("s4-blowup").numbers, str(place_of("t:t2-fixed"))
        ('(24), (25)', 'p. 11, Theorem 4.1')
        """
        return ", ".join(f"({number})" for number in self.equations)


@cache
def _stored_places() -> dict[str, Place]:
    return {
        line["id"]: Place(line["page"], line["line"], tuple(line["equations"]), line["statement"])
        for line in places_in_paper()
    }


def place_of(claim: str) -> Place:
    """The place of a claim of the paper, by its id.

    Raises
    ------
    KeyError : a claim that the paper does not have.
    """
    return _stored_places()[claim]


# Plain words of claims, with the letters of formulas between dollar signs; loads no sympy.

_GREEK = "sigma|tau|eta|omega|kappa|lambda|beta|gamma|phi|chi|psi|ell|Pi"
_SIGNS = {"!=": r"\ne", "<=": r"\le", ">=": r"\ge", "->": r"\to"}
_LETTERS = re.compile(
    rf"(?P<dot>x-dot|x_dot)(?P<wall>_c)?|(?P<sign>!=|<=|>=|->)|\b(?P<jet>a)_d(?P<order>\d)\b|\b(?P<name>{_GREEK}|dv|[A-Za-z])"
    r"(?P<below>_[A-Za-z0-9*+-]+|_\([a-z ]+\)|(?<=m)[123])?(?P<primes>'+)?(?![A-Za-z0-9_('])"
)


def in_letters(text: str) -> str:
    r"""Plain words in which the letters of formulas get dollar signs: sigma, a_d1, x-dot, tau_*, m2, f_10.

    Examples
    --------
    >>> print(in_letters("x-dot/h^2 at sigma' = -h, a_d1 = 7/4, m2 a root, f_10 = 2"))
    $\dot x$/h^2 at $\sigma'$ = -h, $a'$ = 7/4, $m_{2}$ a root, $f_{10}$ = 2
    """
    return _LETTERS.sub(_letter, text)


def _letter(letter: re.Match[str]) -> str:
    if letter["dot"]:
        return rf"$\dot x{letter['wall'] or ''}$"
    if letter["sign"]:
        return f"${_SIGNS[letter['sign']]}$"
    if letter["jet"]:
        return f"$a{chr(39) * int(letter['order'])}$"
    name, below, primes = letter["name"], (letter["below"] or "").strip("_()"), letter["primes"] or ""
    if len(name) == 1 and not below and not primes:
        return letter[0]  # an article, or a letter that reads as well without
    below = re.sub(rf"\b({_GREEK})\b", r"\\\1", below)
    return f"${name if name == 'dv' or len(name) == 1 else chr(92) + name}{f'_{{{below}}}' if below else ''}{primes}$"


@dataclass(frozen=True)
class Erratum:
    """One misprint.

    Attributes
    ----------
    verdict : of the claim.
    dependants : id -> effective verdict, in words, of the claims that rest directly on it, that is on the corrected
        statement.
    """

    verdict: Verdict
    dependants: dict[str, str]

    @property
    def place(self) -> Place:
        """Page, equation and theorem of the paper."""
        return place_of(self.verdict.id)

    @property
    def remark(self) -> Remark:
        """The kind of misprint, its reason, and what it does not touch; several misprints may share one remark."""
        found = remark_on(self.verdict.id)
        if found is None:
            raise LookupError(f"{self.verdict.id} is corrected and has no remark in remarks.py")
        return found

    @property
    def witness(self) -> str:
        """The numbers at which the printed statement fails, on one line."""
        return ", ".join(f"{name} = {value}" for name, value in (self.verdict.witness or {}).items())

    @property
    def trials(self) -> list[str]:
        """Model by model, what was found and what the two statements say."""
        return [trial.line() for trial in self.verdict.trials]

    @property
    def survives(self) -> str:
        """The claims that rest on it, with their verdicts for the corrected statement."""
        return ", ".join(f"{name} ({kind})" for name, kind in self.dependants.items())

    def as_dict(self) -> dict[str, Any]:
        """The erratum as plain data."""
        verdict, where, remark = self.verdict, self.place, self.remark
        names = ("id", "section", "title", "printed", "corrected", "corrected_kind", "effective", "worth", "evidence")
        return {name: getattr(verdict, name) for name in names} | {
            "page": where.page,
            "equations": list(where.equations),
            "statement": where.statement,
            "line": where.line,
            "grade": remark.grade,
            "reason": remark.reason,
            "survives": remark.survives,
            "same_remark": [name for name in remark.claims if name != verdict.id],
            "witness": dict(verdict.witness or {}),
            "trials": [asdict(trial) for trial in verdict.trials],
            "dependants": self.dependants,
        }


@dataclass(frozen=True, repr=False)
class Errata(Sequence[Erratum]):
    """The misprints in the order of the paper; prints as text."""

    entries: tuple[Erratum, ...]

    @overload
    def __getitem__(self, at: int) -> Erratum: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[Erratum]: ...
    def __getitem__(self, at: int | slice) -> Erratum | Sequence[Erratum]:
        return self.entries[at]

    def __len__(self) -> int:
        return len(self.entries)

    def __iter__(self) -> Iterator[Erratum]:
        return iter(self.entries)

    def __repr__(self) -> str:
        return self.text()

    def _repr_markdown_(self) -> str:
        return self.markdown()

    @property
    def remarks(self) -> list[tuple[Erratum, ...]]:
        """The misprints in groups, each explained by one remark, in the order of their first places in the paper."""
        groups: dict[Remark, list[Erratum]] = {}
        for entry in self:
            groups.setdefault(entry.remark, []).append(entry)
        return sorted((tuple(group) for group in groups.values()), key=lambda group: group[0].place.line)

    @property
    def summary(self) -> str:
        """Numbers of statements that fail, by grade."""
        grades = Counter(entry.remark.grade for entry in self)
        errors = ", ".join(f"{grades[name]} {PLURALS[name]}" for name in GRADES if name != "reading")
        return (
            f"{len(self)} statements fail as printed, in {len(self.remarks)} remarks: {len(self) - grades['reading']} "
            f"errors ({errors}) and {grades['reading']} {PLURALS['reading']}."
        )

    def text(self) -> str:
        """Plain text, for a terminal."""
        parts = [f"{PAPER}\n{VERSION}\n\n{self.summary}"]
        for number, group in enumerate(self.remarks, 1):
            remark = group[0].remark
            head = f"{number}. {_places(group)}: {GRADES[remark.grade]}\n  why        {_plain(remark.reason)}\n"
            parts.append(
                head + "\n".join(_text_entry(entry) for entry in group) + f"\n  survives   {_plain(remark.survives)}"
            )
        return "\n\n".join(parts)

    def markdown(self) -> str:
        """Markdown with formulas between dollar signs: a table for a first look, then each remark."""
        parts = ["# Errata", f"*{PAPER}.* {VERSION}", self.summary, "## At a glance"]
        parts.append("\n".join(_brief_markdown(number, group) for number, group in enumerate(self.remarks, 1)))
        parts += ["## Letters and models", "\n".join(f"- {line}" for line in kept_legend())]
        parts.append("## One by one")
        for number, group in enumerate(self.remarks, 1):
            remark = group[0].remark
            head = f"### {number}. {_places(group)}: {GRADES[remark.grade]}\n\n{remark.reason}\n\n"
            parts.append(
                head + "\n".join(_markdown_entry(entry) for entry in group) + f"\n- what survives: {remark.survives}"
            )
        return "\n\n".join(parts) + "\n"

    def latex(self) -> str:
        """A LaTeX document: two pages for a first look, then each remark with its numbers."""
        fields = {
            "PAPER": latex_text(PAPER),
            "VERSION": latex_text(VERSION),
            "SUMMARY": latex_text(self.summary),
            "BRIEF": "\n".join(_brief_latex(group) for group in self.remarks),
            "LEGEND": "\n".join(rf"\item {latex_words(line)}" for line in kept_legend()),
            "ITEMS": "\n".join(_latex_remark(number, group) for number, group in enumerate(self.remarks, 1)),
        }
        document = _DOCUMENT
        for name, text in fields.items():
            document = document.replace(f"<{name}>", text)
        return document

    def as_dict(self) -> dict[str, Any]:
        """The errata as plain data; ``singimpact errata --json`` prints it."""
        return {"paper": PAPER, "version": VERSION, "grades": GRADES, "errata": [entry.as_dict() for entry in self]}


_DOCUMENT = r"""\documentclass[11pt,a4paper]{article}
\usepackage[margin=18mm]{geometry}
\usepackage{amsmath,amssymb}
\setlength{\parindent}{0pt}
\emergencystretch=3em
\newcommand{\say}[1]{\item[\normalfont\textit{#1}]}
\newenvironment{numbers}%
  {\begin{description}\setlength{\itemsep}{0pt}\setlength{\parskip}{0pt}\setlength{\parsep}{0pt}}%
  {\end{description}}
\renewcommand{\labelitemi}{$\bullet$}  % the bullet of text comes from a bitmap font
\begin{document}
\section*{Errata}
\textit{<PAPER>}

\smallskip
{\small <VERSION>}

\medskip
<SUMMARY> Each line says where, what to read, and why; the numbers behind it follow after the list.

{\small\raggedright
\begin{enumerate}\setlength{\itemsep}{1pt}\setlength{\parskip}{0pt}
<BRIEF>
\end{enumerate}}

\typeout{the list ends on page \thepage}
\newpage
\section*{Letters and models}
{\small
\begin{itemize}\setlength{\itemsep}{1pt}
<LEGEND>
\end{itemize}}

\section*{One by one}
<ITEMS>
\end{document}
"""


def _places(group: Sequence[Erratum]) -> str:
    """The places of a remark, each once."""
    return "; ".join(dict.fromkeys(str(entry.place) for entry in group))


def _plain(words: str) -> str:
    """Words without the dollar signs of their formulas."""
    return words.replace("$", "")


def _numbers(entry: Erratum) -> list[tuple[str, str]]:
    """The numbers that a person can check."""
    return [("witness", entry.witness), *(("tried", line) for line in entry.trials)]


def _text_entry(entry: Erratum) -> str:
    v = entry.verdict
    lines = [f"{v.id}: {v.title}", f"  printed    {v.printed}", f"  corrected  {v.corrected}   [{v.worth}]"]
    lines += [f"  {name:11}{told}" for name, told in _numbers(entry)]
    return "\n".join(lines + [f"  used by    {entry.survives}"] * bool(entry.dependants))


def _brief_markdown(number: int, group: Sequence[Erratum]) -> str:
    remark = group[0].remark
    read = "; ".join(wrapping(entry.verdict.corrected or "") for entry in group)
    return f"{number}. {_places(group)} ({remark.grade}). Read {read}. {remark.reason}"


def _markdown_entry(entry: Erratum) -> str:
    v = entry.verdict
    lines = [
        f"`{v.id}`: {_words_markdown(v.title)}.\n",
        f"- printed: {wrapping(v.printed)}",
        f"- corrected ({v.worth}): {wrapping(v.corrected or '')}",
        *(f"- {name}: {_words_markdown(told)}" for name, told in _numbers(entry)),
    ]
    return "\n".join(lines + [f"- used by: {markdown_text(entry.survives)}"] * bool(entry.dependants)) + "\n"


def _words_markdown(words: str) -> str:
    return markdown_words(in_letters(words))


def _brief_latex(group: Sequence[Erratum]) -> str:
    remark = group[0].remark
    read = ";\\ ".join(f"${entry.verdict.corrected}$" for entry in group)
    place = latex_text(_places(group))
    return rf"\item \textbf{{{place}}} ({remark.grade}). Read {read}. {latex_words(remark.reason)}"


def _latex_remark(number: int, group: Sequence[Erratum]) -> str:
    remark = group[0].remark
    head = rf"\subsection*{{{number}. {latex_text(_places(group))}: \normalfont {latex_text(GRADES[remark.grade])}}}"
    return "\n".join(
        [
            head,
            rf"\raggedright {latex_words(remark.reason)}\par",
            *(_latex_entry(entry) for entry in group),
            rf"\textit{{What survives:}} {latex_words(remark.survives)}",
            "",
        ]
    )


def _latex_entry(entry: Erratum) -> str:
    v = entry.verdict
    rows = [
        ("printed", f"${v.printed}$"),
        ("corrected", f"${v.corrected}$ ({latex_text(v.worth)})"),
        *((name, latex_words(in_letters(number))) for name, number in _numbers(entry)),
    ]
    rows += [("used by", latex_text(entry.survives))] * bool(entry.dependants)
    body = "\n".join(rf"\say{{{name}}} {text}" for name, text in rows)
    head = rf"\texttt{{{latex_text(v.id)}}}: {latex_words(in_letters(v.title))}."
    return f"\\par {head}\n\\begin{{numbers}}\n{body}\n\\end{{numbers}}"


@checked_keywords
def errata(on_start: Callable[[Entry | Claim, int, int], None] | None = None) -> Errata:
    """The misprints of the paper, as the verifiers found them; the twin of the command `singimpact errata`.

    Parameters
    ----------
    on_start : called with the claim, its place and the number of claims before each is worked on; without it a line of
        progress is shown on a terminal, or under the cell of a notebook.
    """
    from singimpact.paper.claims import run, select

    claims = select()
    verdicts = {verdict.id: verdict for verdict in run(claims, on_start=on_start, cached=True)}
    entries = []
    for verdict in verdicts.values():
        if verdict.kind == "corrected":
            above = {c.id: verdicts[c.id].worth for c in claims if verdict.id in c.rests_on}
            entries.append(Erratum(verdict, above))
    return Errata(tuple(entries))
