"""Write this folder, the golden equations and statements, and generated/: `python derivations/freeze.py`.

The same as `singimpact derive -o derivations`, and from the same sections the LaTeX of each displayed equation, which
the suite compares; the words around the equations may change freely.
"""

from __future__ import annotations

import json
from pathlib import Path

from singimpact.documents.document_steps import Section, equations_of
from singimpact.documents.rendering import Marks, as_files
from singimpact.paper.sections.derivation_sections import sections
from singimpact.paper.sections.stored_sections import marks_of
from singimpact.store import folder, written

HERE = Path(__file__).parent
GENERATED = HERE.parent / "singimpact" / "generated"
GOLDEN = HERE.parent / "tests" / "paper" / "sections" / "golden"


def derivations(told: list[Section], marks: Marks) -> dict[Path, bytes]:
    """Every file of this folder that is generated, with its content."""
    return {HERE / name: content for name, content in as_files(told, marks, "latex").items()}


def golden(told: list[Section]) -> dict[Path, bytes]:
    """One file a section: label -> LaTeX."""
    shown = [section for section in told if equations_of([section])]
    return {
        GOLDEN / f"{section.name}.json": (json.dumps(equations_of([section]), indent=2) + "\n").encode()
        for section in shown
    }


def statements() -> dict[Path, bytes]:
    """id -> what is printed and, where another statement holds, that one: what a person reads of each claim."""
    from singimpact.paper.claims import CLAIMS

    told = {
        name: {"printed": claim.printed.latex} | ({"corrected": claim.corrected().latex} if claim.corrected else {})
        for name, claim in CLAIMS.items()
    }
    return {GOLDEN / "statements.json": (json.dumps(told, indent=2) + "\n").encode()}


def generated() -> dict[Path, bytes]:
    """The source under singimpact/generated: from theory and codegen alone, so it works with that folder emptied."""
    from singimpact.theory.frozen import completion_module

    return {GENERATED / "completion.py": completion_module().encode()}


def main() -> None:
    """Write them all."""
    for path, content in generated().items():  # first: what follows may use them
        with written(path) as draft:
            draft.write_bytes(content)
        print(path.relative_to(HERE.parent))
    told = sections()
    folder(GOLDEN)
    for path, content in {**derivations(told, marks_of(told)), **golden(told), **statements()}.items():
        with written(path) as draft:
            draft.write_bytes(content)
        print(path.relative_to(HERE.parent))


if __name__ == "__main__":
    main()
