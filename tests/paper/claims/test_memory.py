"""Kept verdicts: used while nothing changed, run again when a verifier did, with dependants and no others."""

import ast
import dataclasses

import pytest

from singimpact.cache import recall, unpacked
from singimpact.paper import CLAIMS, Trial, Verdict, keep, key_of, run, select
from singimpact.paper.claims import deciding, engine


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    return tmp_path


@pytest.fixture
def decided(monkeypatch):
    """Ids of the claims that were decided, not recalled."""
    names, decide = [], deciding.decide
    monkeypatch.setattr(deciding, "decide", lambda claim, known: names.append(claim.id) or decide(claim, known))
    return names


def test_second_run_decides_nothing(decided):
    first = run(select(["s3-slope-r"]), cached=True)
    count = len(decided)
    second = run(select(["s3-slope-r"]), cached=True)
    assert count == len(first) == len(decided)
    assert second == first


@pytest.fixture
def edited(monkeypatch):
    """A file of `sections` is edited: its text changes, the claims that it makes do not."""
    source = engine.source_of

    def edit(file):
        engine.file_digest.cache_clear()
        monkeypatch.setattr(engine, "source_of", lambda name: source(name) + "# edited\n" * (name == file))

    yield edit
    engine.file_digest.cache_clear()


def test_an_edited_verifier_runs_with_its_file_and_their_dependants_only(decided, edited):
    claims = select(["s3-slope-r", "e:lin", "t:foliate-smooth"])
    run(claims, cached=True)
    decided.clear()
    edited("section3")
    run(claims, cached=True)
    assert decided == [
        "s3-Dp",
        "s3-Dphi",
        "s3-DG",
        "s3-eigenvectors",
        "s3-slope-r",
        "t:t1",
        "s3-takens",
        "t:foliate-smooth",
    ]


@pytest.mark.slow
def test_edited_file_runs_the_claims_of_the_files_that_take_it(decided, edited):
    claims = select(["e:meq", "s5-phi", "s6p-AB"])
    run(claims, cached=True)
    decided.clear()
    edited("section6_exact")
    run(claims, cached=True)
    assert decided == [claim.id for claim in claims if claim.file.startswith("section6")]


def test_a_claim_that_is_given_itself_is_always_decided(decided):
    run([CLAIMS["e:yeq"]], cached=True)
    run([CLAIMS["e:yeq"]], cached=True)
    assert decided == ["e:yeq", "e:yeq"]


@pytest.mark.parametrize("file", sorted(path.stem for path in engine.SECTIONS.glob("section*.py")))
def test_imports_within_the_sections_are_all_in_the_key(file):
    room = "singimpact.paper.claims.sections"
    direct = set()
    for node in ast.walk(ast.parse(engine.source_of(file))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(room):
            direct |= {node.module.rpartition(".")[2]} if node.module != room else {each.name for each in node.names}
    assert {file, *direct} <= set(engine.imported_by(file))
    assert direct or file in (
        "section2_trials",
        "section4_orbits",
        "section6_exact",
    )


def test_key_does_not_depend_on_what_has_run():
    claims = select(["s3-dvdt"])

    def found():
        known = {}
        for claim in claims:
            known[claim.id] = key_of(claim, known)
        return known

    before = found()
    run(claims)
    assert found() == before


def test_keys_differ_between_claims():
    found = {}
    for claim in select():
        found[claim.id] = key_of(claim, found)
    assert len(set(found.values())) == len(CLAIMS)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"key": 1}', "\x00"])
def test_damaged_entry_is_decided_again(text, cache, decided, capsys):
    run(select(["e:yeq"]), cached=True)
    (path,) = (cache / "verdicts").iterdir()
    path.write_text(text)
    decided.clear()
    assert run(select(["e:yeq"]), cached=True)[0].kind == "proved"
    assert decided == ["e:yeq"]
    assert str(path) in capsys.readouterr().err
    assert unpacked(recall(path), (Verdict, Trial))[1].kind == "proved"


def test_cache_that_cannot_be_written_is_no_failure(monkeypatch, capsys):
    monkeypatch.setattr("singimpact.cache._SAID", [])
    monkeypatch.setenv("SINGIMPACT_CACHE", "/proc/nowhere")
    kinds = {verdict.id: verdict.kind for verdict in run(select(["e:yeq", "s3-dvdt"]), cached=True)}
    assert kinds["e:yeq"] == "proved"
    assert "error" not in kinds.values()
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "/proc/nowhere" in told


def test_error_is_not_kept(cache):
    verdict = dataclasses.replace(run(select(["e:yeq"]))[0], kind="error")
    keep(verdict, "key")
    assert not (cache / "verdicts").exists()
