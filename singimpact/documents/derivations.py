"""The derivations by name, with the verdicts of what they show, in any format."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence

from singimpact.documents.rendering import as_data, as_latex, as_markdown
from singimpact.documents.sections import SECTIONS
from singimpact.documents.steps import Section, claims_of
from singimpact.inputs import unknown

ENDINGS = {"latex": ".tex", "pdf": ".pdf", "markdown": ".md", "json": ".json"}


def sections(names: Sequence[str] = ()) -> list[Section]:
    """The sections named, or all, in the paper's order."""
    for name in names:
        if name not in SECTIONS:
            raise unknown("section", name, SECTIONS)
    return [build() for name, build in SECTIONS.items() if not names or name in names]


def verdicts_of(shown: Iterable[Section], on_start: Callable[..., None] | None = None) -> dict[str, str]:
    """Claim id -> verdict, for every claim that sections show; runs them."""
    ids = claims_of(shown)
    if not ids:
        return {}
    from singimpact.claims import run, select

    return {verdict.id: verdict.kind for verdict in run(select(ids), on_start=on_start)}


def rendered(section: Section, verdicts: Mapping[str, str], form: str) -> bytes:
    """A section in one of the formats of `ENDINGS`, as the bytes of its file."""
    if form == "pdf":
        from singimpact.documents.compiling import compiled

        return compiled(as_latex(section, verdicts)).pdf
    if form == "json":
        return (json.dumps(as_data(section, verdicts), indent=2) + "\n").encode()
    return {"latex": as_latex, "markdown": as_markdown}[form](section, verdicts).encode()
