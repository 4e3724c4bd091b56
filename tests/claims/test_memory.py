"""Kept verdicts: used while nothing changed, run again when a verifier did, with dependants and no others."""

import dataclasses
import json

import pytest

from singimpact.cache import recall
from singimpact.claims import CLAIMS, engine, memory, run, select
from singimpact.claims.keys import key_of


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    return tmp_path


@pytest.fixture
def decided(monkeypatch):
    """Ids of the claims that were decided, not recalled."""
    names, decide = [], engine.decide
    monkeypatch.setattr(engine, "decide", lambda claim, known: names.append(claim.id) or decide(claim, known))
    return names


def test_second_run_decides_nothing(decided):
    first = run(select(["s3-slope-r"]), kept=True)
    count = len(decided)
    second = run(select(["s3-slope-r"]), kept=True)
    assert count == len(first) == len(decided)
    assert second == first


def test_a_changed_claim_runs_with_its_dependants_only(decided):
    claims = select(["s3-slope-r", "e:lin"])
    run(claims, kept=True)
    decided.clear()
    changed = [
        dataclasses.replace(claim, verify=lambda value, verify=claim.verify: verify(value))
        if claim.id == "s3-DG"
        else claim
        for claim in claims
    ]
    run(changed, kept=True)
    assert decided == ["s3-DG", "s3-eigenvectors", "s3-slope-r"]


def test_key_does_not_depend_on_what_has_run():
    claims = select(["s3-dvdt"])

    def keys():
        found = {}
        for claim in claims:
            found[claim.id] = key_of(claim, found)
        return found

    before = keys()
    run(claims)
    assert keys() == before


def test_keys_differ_between_claims():
    found = {}
    for claim in select():
        found[claim.id] = key_of(claim, found)
    assert len(set(found.values())) == len(CLAIMS)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"key": 1}', "\x00"])
def test_damaged_entry_is_decided_again(text, cache, decided, capsys):
    run(select(["e:yeq"]), kept=True)
    (path,) = (cache / "verdicts").iterdir()
    path.write_text(text)
    decided.clear()
    assert run(select(["e:yeq"]), kept=True)[0].kind == "proved"
    assert decided == ["e:yeq"]
    assert str(path) in capsys.readouterr().err
    assert json.loads(recall(path))["verdict"]["kind"] == "proved"


def test_cache_that_cannot_be_written_is_no_failure(monkeypatch, capsys):
    monkeypatch.setattr("singimpact.cache._SAID", [])
    monkeypatch.setenv("SINGIMPACT_CACHE", "/proc/nowhere")
    kinds = {verdict.id: verdict.kind for verdict in run(select(["e:yeq", "s3-dvdt"]), kept=True)}
    assert kinds["e:yeq"] == "proved"
    assert "error" not in kinds.values()
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "/proc/nowhere" in told


def test_error_is_not_kept(cache):
    verdict = dataclasses.replace(run(select(["e:yeq"]))[0], kind="error")
    memory.keep(verdict, "key")
    assert not (cache / "verdicts").exists()
