"""The verdicts of a run: as a table for any width, as the list of misprints, and as data."""

import json
import re
import sys
import textwrap
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple, overload

from singimpact.certificates.claims_checker import SCHEMA, digest_of, file_of
from singimpact.inputs import checked_keywords
from singimpact.notebook import table
from singimpact.paper.claims.claim import MODULO, Claim, Verdict
from singimpact.paper.claims.index import Entry
from singimpact.store import folder, write_text

ERROR = "error"
# of a verdict, in the file of its certificates: no seconds, which differ from run to run
_WRITTEN = (
    "id verdict effective modulo effective_modulo section title printed corrected corrected_kind rests_on "
    "in_model certificates"
)
WRITTEN = tuple(_WRITTEN.split())
CORRECTED = "corrected"


# A table of verdicts laid out for a wide terminal, a narrow one, or a pipe.

Painter = Callable[[str, str], str]


class Row(NamedTuple):
    """One claim as cells."""

    id: str
    statement: str
    kind: str
    verdict: str
    evidence: str
    seconds: str


@dataclass(frozen=True)
class Widths:
    """Largest widths of the columns."""

    narrow: int = 96  # columns; below, statement and evidence would get less than 25 each and a stack reads better
    evidence: int = 72  # in a pipe, longer evidence runs on instead of padding every other line
    least: int = 24  # a cell narrower than this breaks formulas at every sign


WIDTHS = Widths()
HEADER = Row("id", "statement", "", "verdict", "evidence", "seconds")


def unpainted(text: str, kind: str) -> str:  # noqa: ARG001
    """No colour."""
    return text


def laid_out(rows: list[Row], width: int | None, paint: Painter = unpainted) -> str:
    """The table as text; `width` None means lines of any length."""
    if width is None:
        return _one_line_each(rows)
    return _stacked(rows, width, paint) if width < WIDTHS.narrow else _side_by_side(rows, width, paint)


def wrapped(label: str, text: str, width: int | None) -> list[str]:
    """A labelled text, broken to the width under its label."""
    if width is None:
        return [label + text]
    return textwrap.wrap(
        text,
        max(width, len(label) + WIDTHS.least),
        initial_indent=label,
        subsequent_indent=" " * len(label),
        break_on_hyphens=False,
    )


def _columns(rows: list[Row]) -> tuple[int, int]:
    return max(len(row.id) for row in rows), max(len(row.verdict) for row in rows)


def _one_line_each(rows: list[Row]) -> str:
    table = [HEADER, *rows]
    ids, verdicts = _columns(table)
    statement = max(len(row.statement) for row in table)
    evidence = min(WIDTHS.evidence, max(len(row.evidence) for row in table))
    return "\n".join(
        f"{row.id:<{ids}}  {row.statement:<{statement}}  {row.verdict:<{verdicts}}  "
        f"{row.evidence:<{evidence}}  {row.seconds:>7}"
        for row in table
    )


def _side_by_side(rows: list[Row], width: int, paint: Painter) -> str:
    ids, verdicts = _columns([HEADER, *rows])
    free = width - ids - verdicts - 7 - 8
    statement = max(WIDTHS.least, free * 9 // 20)
    evidence = max(WIDTHS.least, free - statement)
    rule = "-" * min(width, ids + verdicts + statement + evidence + 15)
    lines: list[str] = []
    for row in [HEADER, *rows]:
        cells = zip_longest(_cell(row.statement, statement), _cell(row.evidence, evidence), fillvalue="")
        for at, (left, right) in enumerate(cells):
            head = row if at == 0 else Row("", "", "", "", "", "")
            verdict = f"{head.verdict:<{verdicts}}"
            verdict = paint(verdict, row.kind) if head.kind else verdict
            line = f"{head.id:<{ids}}  {left:<{statement}}  {verdict}  {right:<{evidence}}  {head.seconds:>7}"
            lines.append(line.rstrip())
        if row is HEADER:
            lines.append(rule)
    return "\n".join(lines)


def _stacked(rows: list[Row], width: int, paint: Painter) -> str:
    blocks = (
        [
            f"{row.id}  {paint(row.verdict, row.kind)}  {row.seconds} s",
            *wrapped("    ", row.statement, width),
            *wrapped("    = ", row.evidence, width),
        ]
        for row in rows
    )
    return "\n".join(line for block in blocks for line in block)


def _cell(text: str, width: int) -> list[str]:
    return textwrap.wrap(text, width, break_on_hyphens=False) or [""]


@checked_keywords
def verify(
    ids: str | Sequence[str] | None = None,
    on_start: Callable[[Entry | Claim, int, int], None] | None = None,
    *,
    beyond: bool = False,
) -> "VerdictTable":
    """Derive, prove and cross-check claims of the paper; the twin of the command `singimpact verify`.

    Parameters
    ----------
    ids : one id, several, or None for every claim; what they rest on is run with them.
    on_start : called with the claim, its place and the number of claims before each is worked on.
    beyond : whether the claims that the paper does not have are run beside the ids; without ids they alone, and what
        they rest on.

    Returns
    -------
    VerdictTable : a sequence of verdicts that prints as the table.

    Raises
    ------
    InputError : an unknown id; the nearest known ones are named.

    Examples
    --------
    >>> import singimpact as si
    >>> si.verify("e:meq").exit_code                                    # doctest: +SKIP
    0
    """
    from singimpact.paper.claims import run, select

    wanted = [ids] if isinstance(ids, str) else None if ids is None else list(ids)
    if beyond:
        from singimpact.paper.claims import BEYOND

        wanted = [*(wanted or ()), *BEYOND]
    claims = select(wanted)
    return VerdictTable(claims, run(claims, on_start=on_start, cached=True))


@dataclass(frozen=True, repr=False)
class VerdictTable(Sequence["Verdict"]):
    """Claims and their verdicts, in the order of the paper."""

    claims: Sequence[Entry]
    verdicts: Sequence[Verdict]

    @overload
    def __getitem__(self, at: int) -> Verdict: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[Verdict]: ...
    def __getitem__(self, at: int | slice) -> Verdict | Sequence[Verdict]:
        return self.verdicts[at]

    def __len__(self) -> int:
        return len(self.verdicts)

    @property
    def exit_code(self) -> int:
        """1 when a claim ends in `error`, else 0."""
        return int(any(verdict.kind == ERROR for verdict in self.verdicts))

    def as_dict(self) -> dict[str, Any]:
        """The verdicts as plain data; ``singimpact verify --json`` prints it."""
        return {"claims": [verdict.as_dict() for verdict in self.verdicts]}

    def save_certificates(self, place: str | Path) -> list[Path]:
        """Write one JSON file a claim into a folder: its verdict, its own certificates, and the files that it rests on.

        Parameters
        ----------
        place : the folder, made if it is missing; of a file that is there already the content is replaced.

        Returns
        -------
        list[Path] : the files, in the order of the claims; ``python singimpact/certificates/claims_checker.py FILE``
            checks one.

        Raises
        ------
        InputError : the folder cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> import singimpact as si
        >>> with tempfile.TemporaryDirectory() as place:
        ...     [file.name for file in si.verify("e:acc").save_certificates(place)]
        ['e_yeq.json', 'e_acc.json']
        """
        directory = folder(place)
        contents = self._contents()
        paths = [directory / file_of(verdict.id) for verdict in self.verdicts]
        for path, verdict in zip(paths, self.verdicts, strict=True):
            write_text(path, json.dumps(contents[verdict.id], indent=1, ensure_ascii=False) + "\n")
        return paths

    def save_coq(self, directory: str | Path) -> list[Path]:
        """Write one file for Coq a claim into a folder, with a theorem a certificate, and a project file.

        Parameters
        ----------
        directory : the folder, made if it is missing; of a file that is there already the content is replaced.

        Returns
        -------
        list[Path] : the files in the order in which ``coqc -Q . Claims FILE`` compiles them there, with Coq 8.16 or
            newer. A claim that has no certificate of its own has none.

        Raises
        ------
        InputError : the folder cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> import singimpact as si
        >>> with tempfile.TemporaryDirectory() as place:
        ...     [file.name for file in si.verify("e:acc").save_coq(place)]
        ['certificates.v', 'claim_e_yeq.v', 'claim_e_acc.v']
        """
        from singimpact.documents.coq_files import LEMMAS, coq_file

        path, contents = folder(directory), self._contents()
        texts = {LEMMAS.name: LEMMAS.read_text(encoding="utf-8")} | {
            f"claim_{re.sub(r'[^0-9A-Za-z]', '_', name)}.v": coq_file(contents[name])
            for name in (verdict.id for verdict in self.verdicts)
            if contents[name]["certificates"]
        }
        for name, text in (texts | {"_CoqProject": "\n".join(["-Q . Claims", *texts, ""])}).items():
            write_text(path / name, text)
        return [path / name for name in texts]

    def _contents(self) -> dict[str, dict[str, Any]]:
        """The files by id: of the certificates its own, and of the claims that it rests on their files' digests."""
        verdicts = {verdict.id: verdict for verdict in self.verdicts}
        contents: dict[str, dict[str, Any]] = {}
        certified: dict[str, set[str]] = {}  # of a claim and of all below it

        def write(verdict: Verdict) -> None:
            below = [name for name in verdict.rests_on if name in verdicts]
            for name in below:
                if name not in contents:
                    write(verdicts[name])
            others = set[str]().union(*(certified[name] for name in below))
            texts = [json.dumps(certificate, sort_keys=True) for certificate in verdict.certificates]
            certified[verdict.id] = others.union(texts)
            content = {"schema": SCHEMA} | {name: value for name, value in verdict.as_dict().items() if name in WRITTEN}
            content["rests_on"] = {name: contents[name]["digest"] for name in below}
            content["certificates"] = [json.loads(text) for text in dict.fromkeys(texts) if text not in others]
            contents[verdict.id] = {**content, "digest": digest_of(content)}

        for verdict in self.verdicts:
            if verdict.id not in contents:
                write(verdict)
        return contents

    def text(self, width: int | None = None, paint: Painter = unpainted) -> str:
        """The table, the count of each verdict, and the list of what is misprinted.

        Parameters
        ----------
        width : int or None. Columns to lay it out in; None leaves each claim on one line.
        paint : colours a verdict's name.
        """
        counts = "\n".join(wrapped("", self._summary(), width))
        return "\n\n".join(filter(None, [laid_out(self._rows(), width, paint), counts, self._misprints(width)]))

    def __str__(self) -> str:
        import shutil

        return self.text(shutil.get_terminal_size().columns if sys.stdout.isatty() else None)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        rows = [(row.id, row.statement, row.verdict, row.evidence) for row in self._rows()]
        return table(["claim", "what it says", "verdict", "evidence"], rows, self._summary(), most=len(rows))

    def _rows(self) -> list[Row]:
        titles = {claim.id: claim.title for claim in self.claims}
        return [
            Row(v.id, titles.get(v.id, ""), v.kind, v.in_words, v.evidence, f"{v.seconds:.2f}") for v in self.verdicts
        ]

    def screen(self, width: int | None = None) -> str:
        """All claims on one screen: counts, what they rest on, errors, and a line a correction.

        Parameters
        ----------
        width : columns; longer lines end in an ellipsis. None leaves them as long as they are.
        """
        from singimpact.documents.rendering import unicode_line

        wrong = [f"  {verdict.id}  {verdict.evidence}" for verdict in self if verdict.kind == ERROR]
        lines = [self._summary(), self._rests_on(), *(["", "In error:", *wrong] if wrong else [])]
        misprints = [verdict for verdict in self if verdict.kind == CORRECTED]
        if misprints:
            ids = max(len(verdict.id) for verdict in misprints)
            lines += [
                "",
                f"Misprinted, {len(misprints)} (`singimpact errata` gives the reasons):",
                *(
                    f"  {v.id:{ids}}  for {unicode_line(v.printed)}, read {unicode_line(v.corrected or '')}"
                    for v in misprints
                ),
            ]
        return "\n".join(line if width is None or len(line) <= width else f"{line[: width - 1]}…" for line in lines)

    def html(self) -> str:
        """All claims as an HTML page with formulas, for a browser without a network."""
        from singimpact.documents.rendering import as_page

        return as_page([self._summary(), self._rests_on()], self.verdicts)

    def _rests_on(self) -> str:
        certificates = sum(len(verdict.certificates) for verdict in self)
        theorems = {name for verdict in self for name in verdict.effective_modulo}
        trials = sum(len(verdict.trials) for verdict in self)
        return (
            f"They rest on {certificates} certificates for a second program, {len(theorems)} theorems that are named, "
            f"and {trials} trials of misprints on models."
        )

    def _summary(self) -> str:
        counts = Counter(verdict.kind for verdict in self.verdicts)
        seconds = sum(verdict.seconds for verdict in self.verdicts)
        named = {MODULO: f"{MODULO} a theorem"}
        told = ", ".join(f"{count} {named.get(kind, kind)}" for kind, count in counts.most_common())
        return f"{len(self.verdicts)} claims: {told or 'none'}; {seconds:.1f} s in their verifiers."

    def _misprints(self, width: int | None) -> str:
        found = [verdict for verdict in self.verdicts if verdict.kind == CORRECTED]
        if not found:
            return ""
        return "\n\n".join([f"Misprinted: {len(found)}", *(_misprint(verdict, width) for verdict in found)])


def _misprint(verdict: Verdict, width: int | None) -> str:
    witness = ", ".join(f"{name} = {value}" for name, value in (verdict.witness or {}).items()) or "none"
    lines = [
        verdict.id,
        *wrapped("  printed    ", verdict.printed, width),
        *wrapped("  corrected  ", f"{verdict.corrected}   [{verdict.worth}]", width),
        *wrapped("  witness    ", witness, width),
    ]
    return "\n".join(lines)
