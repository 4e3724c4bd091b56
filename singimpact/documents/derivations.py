"""The derivations by name, with the verdicts of what they show, in any format."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence

from singimpact.documents.rendering import MASTER, Marks, as_data, as_latex, as_markdown, as_master, as_piece
from singimpact.documents.sections import NOTATION, OTHER_NAMES, SECTIONS
from singimpact.documents.steps import Mark, Section, claims_of
from singimpact.inputs import unknown


def sections(names: Sequence[str] = ()) -> list[Section]:
    """The notation, then the sections named, or all, in the paper's order.

    Parameters
    ----------
    names : names, numbers or subjects: ``section4``, ``4`` and ``tangency`` are one.

    Raises
    ------
    InputError : an unknown name; the nearest known ones are named.
    """
    wanted = [OTHER_NAMES.get(name, name) for name in names]
    for name, given in zip(wanted, names, strict=True):
        if name not in SECTIONS:
            raise unknown("section", given, [*SECTIONS, *OTHER_NAMES])
    return [NOTATION, *(build() for name, build in SECTIONS.items() if not wanted or name in wanted)]


def marks_of(shown: Iterable[Section], on_start: Callable[..., None] | None = None) -> dict[str, Mark]:
    """Claim id -> its mark, for every claim that sections show; runs them."""
    ids = claims_of(shown)
    if not ids:
        return {}
    from singimpact.claims import run, select

    return {
        found.id: Mark(found.kind, found.effective, found.printed if found.corrected else "")
        for found in run(select(ids), on_start=on_start)
    }


def as_text(shown: Sequence[Section], marks: Marks, form: str) -> str:
    """Sections as one text: ``latex``, ``markdown`` or ``json``."""
    if form == "latex":
        return as_latex(shown, marks)
    if form == "markdown":
        return "\n".join(as_markdown(section, marks) for section in shown)
    return _json({"sections": [as_data(section, marks) for section in shown]})


def as_files(shown: Sequence[Section], marks: Marks, form: str) -> dict[str, bytes]:
    """File name -> content: one a section, and for LaTeX the master that takes them in; a PDF is one file."""
    if form == "pdf":
        from singimpact.documents.compiling import compiled

        return {f"{MASTER}.pdf": compiled(as_latex(shown, marks)).pdf}
    if form == "markdown":
        return {f"{section.name}.md": as_markdown(section, marks).encode() for section in shown}
    if form == "json":
        return {f"{section.name}.json": _json(as_data(section, marks)).encode() for section in shown}
    pieces = {f"{section.name}.tex": as_piece(section, marks).encode() for section in shown}
    return {**pieces, f"{MASTER}.tex": as_master(shown).encode()}


def _json(data: object) -> str:
    return json.dumps(data, indent=2) + "\n"
