"""What differs between kinds of events stands in one file a kind, and all else asks the kind."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import singimpact
from singimpact.branches import KINDS, EventKind, kind_of
from singimpact.certificates import KINDS as CHECKED

PACKAGE = Path(singimpact.__file__).parent
ORDINARY = {"fold", "graze"}
"""Names that other things have too: singularities of maps of the plane, impacts without velocity."""
HOMES = ("branches/events/", "certificates/checker/")


def words_in(text: str) -> list[str]:
    """Strings of a program that are not docstrings."""
    tree = ast.parse(text)
    documents = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    texts = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return [str(node.value) for node in texts if id(node) not in documents]


def test_the_name_of_a_kind_stands_in_its_file_alone() -> None:
    names = {kind.name for kind in KINDS} - ORDINARY
    sources = {path.relative_to(PACKAGE).as_posix(): path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")}
    uses = {(name, path) for path, text in sources.items() for name in names & set(words_in(text))}
    assert {path for _, path in uses if not path.startswith(HOMES)} == set()
    homes = [name for name, path in uses if path.startswith(HOMES[0])]
    assert sorted(homes) == sorted(names)
    assert words_in('"""torus"""\nif kind == "torus":\n    pass') == ["torus"]


def test_kinds_differ() -> None:
    for several in ([kind.name for kind in KINDS], [kind.word for kind in KINDS], [kind.marker for kind in KINDS]):
        assert len(set(several)) == len(KINDS)
        assert all(several)
    assert all(kind_of(kind.name) is kind for kind in KINDS)


def test_the_second_program_reads_the_kinds_that_have_proofs() -> None:
    assert tuple(kind.name for kind in KINDS if kind.proof) == CHECKED


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_a_proof_is_of_the_return_map_or_of_the_touching_point(kind: EventKind) -> None:
    import flint

    saddle = flint.arb_mat([[3, 0], [0, 0.5]])
    if kind.proof and not kind.touches:
        assert kind.of_return_map(saddle) != 0
    else:
        with pytest.raises(ArithmeticError, match=kind.name):
            kind.of_return_map(saddle)
