"""The verdicts of what sections show, as marks beside their equations."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from singimpact.documents.document_steps import Mark, Section, claims_of


def marks_of(shown: Iterable[Section], on_start: Callable[..., None] | None = None) -> dict[str, Mark]:
    """Claim id -> its mark, for every claim that sections show; a kept verdict is not computed again."""
    ids = claims_of(shown)
    if not ids:
        return {}
    from singimpact.paper.claims import run, select

    return {
        verdict.id: Mark(verdict.kind, verdict.worth, verdict.printed if verdict.corrected else "")
        for verdict in run(select(ids), on_start=on_start, kept=True)
    }
