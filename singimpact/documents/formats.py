"""Sections of a document as one text or as files, in any format."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence

from singimpact.documents.document_steps import Section
from singimpact.documents.rendering import MASTER, Marks, as_data, as_latex, as_markdown, as_master, as_piece


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
