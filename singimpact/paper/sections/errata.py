"""The errata: each statement that fails as printed, with what holds instead, why, the witness, and what survives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, overload

from singimpact.documents import escape
from singimpact.documents.breaking import wrapping

if TYPE_CHECKING:
    from singimpact.paper.claims.claim import Claim, Verdict
    from singimpact.paper.claims.index import Entry


@dataclass(frozen=True)
class Erratum:
    """One misprint.

    Attributes
    ----------
    verdict : of the claim.
    dependants : id -> effective verdict of the claims that rest directly on it, that is on the corrected statement.
    """

    verdict: Verdict
    dependants: dict[str, str]

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
        return ", ".join(f"{name} ({kind})" for name, kind in self.dependants.items()) or "nothing rests on it"

    def as_dict(self) -> dict[str, Any]:
        """The erratum as plain data."""
        verdict = self.verdict
        names = ("id", "section", "title", "printed", "corrected", "corrected_kind", "effective", "evidence")
        return {name: getattr(verdict, name) for name in names} | {
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

    def text(self) -> str:
        """Plain text, for a terminal."""
        parts = [f"{len(self)} statements fail as printed"]
        for entry in self:
            v = entry.verdict
            parts.append(
                f"{v.id}  (section {v.section})  {v.title}\n  printed    {v.printed}\n"
                f"  corrected  {v.corrected}   [{v.effective}]\n  why        {v.evidence}\n"
                f"  witness    {entry.witness}\n"
                + "".join(f"  tried      {line}\n" for line in entry.trials)
                + f"  survives   {entry.survives}"
            )
        return "\n\n".join(parts)

    def markdown(self) -> str:
        """Markdown with formulas between dollar signs."""
        parts = ["# Errata", f"{len(self)} statements fail as printed."]
        for entry in self:
            v = entry.verdict
            parts.append(
                f"## `{v.id}` (section {v.section})\n\n{escape.markdown(v.title)}.\n\n"
                f"- printed: {wrapping(v.printed)}\n- corrected ({v.effective}): {wrapping(v.corrected or '')}\n"
                f"- why: {escape.markdown(v.evidence)}\n- witness: {escape.markdown(entry.witness)}\n"
                + "".join(f"- tried: {escape.markdown(line)}\n" for line in entry.trials)
                + f"- what rests on it: {escape.markdown(entry.survives)}"
            )
        return "\n\n".join(parts) + "\n"

    def latex(self) -> str:
        """A LaTeX document."""
        items = "\n".join(_latex_entry(entry) for entry in self)
        return _DOCUMENT.replace("COUNT", str(len(self))).replace("ITEMS", items)

    def as_dict(self) -> dict[str, Any]:
        """The errata as plain data; ``singimpact errata --json`` prints it."""
        return {"errata": [entry.as_dict() for entry in self]}


_DOCUMENT = r"""\documentclass[11pt,a4paper]{article}
\usepackage[margin=18mm]{geometry}
\usepackage[T1]{fontenc}
\usepackage{amsmath,amssymb}
\setlength{\parindent}{0pt}
\emergencystretch=3em
\begin{document}
\section*{Errata}
COUNT statements fail as printed.

ITEMS
\end{document}
"""


def _latex_entry(entry: Erratum) -> str:
    v = entry.verdict
    rows = [
        ("printed", f"${v.printed}$"),
        ("corrected", f"${v.corrected}$ ({v.effective})"),
        ("why", escape.latex(v.evidence)),
        ("witness", escape.latex(entry.witness)),
        *(("tried", escape.latex(line)) for line in entry.trials),
        ("survives", escape.latex(entry.survives)),
    ]
    body = "\n".join(rf"\item[\textit{{{name}}}] {text}" for name, text in rows)
    head = rf"\subsection*{{\texttt{{{escape.latex(v.id)}}} \normalfont(section {escape.latex(v.section)})}}"
    listed = f"\\begin{{description}}\\setlength{{\\itemsep}}{{0pt}}\n{body}\n\\end{{description}}\n"
    return f"{head}\n\\raggedright {escape.latex(v.title)}.\n{listed}"


def errata(on_start: Callable[[Entry | Claim, int, int], None] | None = None) -> Errata:
    """The misprints of the paper, as the verifiers found them; the twin of the command `singimpact errata`.

    Parameters
    ----------
    on_start : called with the claim, its place and the number of claims before each is worked on.
    """
    from singimpact.paper.claims import run, select

    claims = select()
    verdicts = {verdict.id: verdict for verdict in run(claims, on_start=on_start, kept=True)}
    found = []
    for verdict in verdicts.values():
        if verdict.kind == "corrected":
            above = {c.id: verdicts[c.id].effective for c in claims if verdict.id in c.rests_on}
            found.append(Erratum(verdict, above))
    return Errata(tuple(found))
