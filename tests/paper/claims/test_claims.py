"""Every claim has a verdict that is computed, and every verifier rejects what is wrong."""

import json
import re
import subprocess
import sys
from dataclasses import replace

import pytest
from false_certificates import definite

from singimpact import cache
from singimpact.algebra import left_behind
from singimpact.inputs import InputError
from singimpact.paper import (
    CLAIMS,
    IN_MODEL,
    MODULO,
    Check,
    Claim,
    Statement,
    Trial,
    VerdictTable,
    compared,
    decide,
    derived_from,
    near_the_swan,
    recall,
    run,
    select,
    watched,
)
from singimpact.paper.claims.sections import section6_regions
from singimpact.paper.routes import unfolding
from singimpact.progress import ProgressLine

MISPRINTED = {
    "e:phi",
    "s2-horizon",
    "p:phising-set",
    "p:phising-cusp",
    "s2-lift-off-sign",
    "s2-first-hit-rest",
    "s2-corr-sets",
    "s2-G-semiconj",
    "s3-dvdt",
    "e:vtaylor-t2",
    "e:vtaylor-st2",
    "e:vtaylor-t3",
    "e:phinew",
    "e:defq",
    "e:hdef",
    "s4-blowup",
    "t:t2-unique",
    "t:t2-fixed",
    "t:t2-eigenvalue-limit",
    "s4-normal-id2",
    "s4-Er-closed",
    "e:fixm-converse",
    "s4-m32-r1",
    "s4-m2-sign",
    "s4-Nr-3-all",
    "s4-beta-tangent",
    "s4b-T2-place",
    "s4b-l-range",
    "s4b-p-bound",
    "s4b-q-bound",
    "s4b-ratio",
    "s4b-back",
    "s5-coordinates",
    "s5-unique",
    "s5-F-smooth",
    "t:t3-unique",
    "t:t3-eigenvalue-limit",
    "s6-c-side",
    "s6-a0-typo",
    "s6p-AB",
}


@pytest.fixture(scope="module")
def verdicts():
    return {verdict.id: verdict for verdict in run(select(), cached=True)}  # the suite starts with an empty cache


@pytest.mark.parametrize("name", CLAIMS)
def test_claim_has_a_verdict(name):
    verdict = run(select([name]), cached=True)[-1]  # alone with what it rests on: what fails is named at once
    assert verdict.kind in {"proved", MODULO, "certified", "argued", "supported", "cited", "corrected"}, (
        verdict.evidence
    )
    assert verdict.kind != "cited" or name in {"s3-takens", "s2-fold-cusp-forms"}
    assert (verdict.kind == "corrected") == (name in MISPRINTED), verdict.evidence
    assert verdict.printed
    assert verdict.evidence
    if verdict.kind == "corrected":
        assert verdict.corrected != verdict.printed
        assert verdict.witness
        assert verdict.corrected_kind in {"proved", MODULO, "certified", "supported"}


@pytest.mark.parametrize("name", CLAIMS)
def test_verifier_rejects_every_mutant(name):
    claim = CLAIMS[name]
    assert claim.mutants
    for mutant in claim.mutants:
        check = claim.verify(mutant)
        assert not check.holds, f"{name} accepts {mutant}"
        assert check.evidence


def test_every_claim_rests_on_claims_before_it():
    seen = set()
    for claim in select():
        assert set(claim.rests_on) <= seen
        seen.add(claim.id)


# psi o p to second order is the third part of s4-fold-form; that the rest can be removed, e:pdef, rests on it
PART_OF_IT = {"s4-fold-form": {"e:pdef"}}


def _used(claim):
    """The claims whose equations a verifier derived something from, through equations that are no claims."""
    statement = claim.corrected() if claim.corrected else claim.printed
    todo, found = list(watched(lambda: claim.verify(statement.value))[1]), set()
    while todo:
        label = todo.pop()
        found |= {label} & set(CLAIMS)
        todo += [] if label in CLAIMS else derived_from(label)
    return found - {claim.id}


@pytest.mark.parametrize("name", CLAIMS)
def test_what_a_verifier_uses_is_named(name):
    """From what ran: each equation it derived from is among what the claim rests on, directly or through others."""
    below = {claim.id for claim in select([name])}
    assert _used(CLAIMS[name]) <= below | PART_OF_IT.get(name, set())


def test_a_run_shows_its_progress_unless_the_caller_does(monkeypatch):
    shown = []

    class Line(ProgressLine):
        def show(self, done, total, text):
            shown.append((done, total, text.split()[0]))

    monkeypatch.setattr("singimpact.paper.claims.engine.ProgressLine", Line)
    run(select(["e:acc"]), cached=True)
    assert shown == [(0, 2, "e:yeq"), (1, 2, "e:acc")]
    run(select(["e:acc"]), on_start=lambda *_: None, cached=True)
    assert len(shown) == 2


def test_selection_brings_what_it_rests_on():
    names = [claim.id for claim in select(["e:meq", "e:qdef"])]
    assert {"e:yeq", "e:degen", "e:phinew", "e:defq", "e:qdef", "e:fixm", "e:meq"} <= set(names)
    assert "t:t1" not in names


def test_effective_verdict_is_the_weakest_below(verdicts):
    assert verdicts["s3-slope"].kind == "proved"
    assert verdicts["s3-slope"].effective == MODULO


NEAR_THE_SWAN = {
    "s6-scaling", "s6-lips", "s6p-none", "s6p-AB", "s6p-BE", "s6p-AE", "s6p-eps", "s6n-corr", "s6n-maps",
    "s6n-shadow-neg", "s6n-cusp", "s6n-AB", "s6n-X", "s6p-regions", "s6n-corr-A", "s6n-C", "s6-swallowtail",
}  # fmt: skip


def test_exact_arguments_about_the_universal_model_are_proved_in_the_model_or_near_the_swan(verdicts):
    found = {name for name, verdict in verdicts.items() if verdict.effective == IN_MODEL}
    assert found == {"s6-sections", "s6n-visible"}
    assert verdicts["s6n-visible"].kind == "proved"
    assert verdicts["s6n-visible"].in_words == "proved in the model"
    assert {verdicts[name].worth for name in NEAR_THE_SWAN} == {"proved"}
    assert all("persists near the swan" in verdicts[name].evidence for name in NEAR_THE_SWAN)
    assert verdicts["s6p-AB"].in_words == "corrected (proved)"
    assert not verdicts["s5-phi"].in_model


@pytest.mark.parametrize("name", sorted(NEAR_THE_SWAN - {"s6-scaling"}))
def test_without_the_scaling_lemma_it_is_proved_in_the_model(name, verdicts):
    claim = CLAIMS[name]
    assert "s6-scaling" in claim.rests_on
    alone = replace(claim, rests_on=tuple(below for below in claim.rests_on if below != "s6-scaling"))
    assert decide(alone, verdicts).worth == IN_MODEL


@pytest.mark.parametrize("value", [0, unfolding.kappa - unfolding.kappa, unfolding.kappa + 1, False])
def test_what_does_not_persist_fails(value):
    check = near_the_swan(Check(True, "proved", "in the model"), [("a number", value)])
    assert not check.holds
    assert "does not persist near the swan" in check.evidence
    assert not near_the_swan(Check(True, "proved", "in the model"), []).holds


def test_a_claim_about_the_model_that_fails_near_the_swan_is_an_error():
    claim = CLAIMS["s6-lips"]
    numbers = lambda value: near_the_swan(claim.verify(value), [("a number", 0)])  # noqa: E731
    assert decide(replace(claim, verify=numbers), {}).kind == "error"


def test_what_is_worth_less_than_its_own_argument(verdicts):
    less = {name for name, verdict in verdicts.items() if verdict.effective == "supported" != verdict.strength}
    assert less == set()
    modulo = {name for name, verdict in verdicts.items() if verdict.effective == MODULO != verdict.strength}
    assert modulo >= {"t:t2-attracting", "t:t2-repelling", "t:t2-fixed", "t:t2-eigenvalue-limit", "t:t3-repelling"}


@pytest.mark.parametrize("name", ["s6p-BE", "s6p-AE"])
def test_the_mirror_image_of_E_is_rejected(name, monkeypatch):
    monkeypatch.setattr(unfolding, "E", (-unfolding.E[0], -unfolding.E[1]))
    assert not CLAIMS[name].verify(CLAIMS[name].printed.value).holds


def test_a_flight_from_E_that_lands_before_B_is_rejected(monkeypatch):
    """The conic of flights from rest, moved: the one that lands at B starts to the left of E."""
    moved = unfolding.zero_set().subs(unfolding.sigma, unfolding.sigma + 1)
    monkeypatch.setattr(unfolding, "zero_set", lambda: moved)
    assert not CLAIMS["s6p-gamma"].verify(CLAIMS["s6p-gamma"].printed.value).holds


def test_a_map_of_DA_that_turns_is_rejected(monkeypatch):
    monkeypatch.setattr(section6_regions, "_turning_points", lambda: [unfolding.D])
    assert not CLAIMS["s6n-maps"].verify(CLAIMS["s6n-maps"].printed.value).holds


def test_unknown_id_names_the_nearest():
    with pytest.raises(InputError, match="unknown claim 'e:mex': the nearest known are e:meq"):
        select(["e:mex"])


def _claim(verify, corrected=None, trials=None):
    return Claim("test", "0", "a test", Statement("x", 1), verify, (0,), corrected, trials=trials)


def test_a_verifier_that_raises_is_an_error():
    def fails(value):
        raise RuntimeError(f"no {value}")

    (verdict,) = run([_claim(fails)])
    assert (verdict.kind, verdict.evidence) == ("error", "RuntimeError: no 1")


def test_a_failure_without_a_statement_that_holds_is_an_error():
    fails = lambda value: Check(False, "proved", f"{value} is wrong", {"x": "1"})  # noqa: E731
    assert run([_claim(fails)])[0].kind == "error"
    assert run([_claim(fails, lambda: Statement("y", 2))])[0].kind == "error"


def test_a_correction_needs_a_witness():
    verify = lambda value: Check(value == 2, "proved", "compared")  # noqa: E731
    assert run([_claim(verify, lambda: Statement("y", 2))])[0].kind == "error"


def _trial(model, printed=False, corrected=True):
    return Trial(model, "x", "2", "1", "2", printed, corrected)


@pytest.mark.parametrize(
    ("trials", "kind", "reason"),
    [
        ([_trial("one"), _trial("two")], "corrected", ""),
        ([], "error", "there are 0"),
        ([_trial("one")], "error", "there are 1"),
        ([_trial("one"), _trial("one")], "error", "there are 1"),
        ([_trial("one"), _trial("two", printed=True)], "error", "there are 1"),
        ([_trial("one"), _trial("two"), _trial("three", corrected=False)], "error", "fails on a model: three"),
    ],
)
def test_a_correction_needs_two_models(trials, kind, reason):
    verify = lambda value: Check(value == 2, "proved", "compared", {"x": "2"})  # noqa: E731
    (verdict,) = run([_claim(verify, lambda: Statement("y", 2), lambda _printed, _corrected: trials)])
    assert verdict.kind == kind
    assert reason in verdict.evidence


@pytest.mark.parametrize("name", sorted(MISPRINTED))
def test_correction_is_told_by_two_models(name, verdicts):
    trials = verdicts[name].trials
    assert len({trial.model for trial in trials if trial.tells}) >= 2
    assert all(trial.corrected_holds for trial in trials)


@pytest.mark.parametrize(
    "name", ["e:vtaylor-t2", "e:phinew", "s4b-ratio", "s3-dvdt", "s6-c-side", "e:hdef", "e:defq", "s4-blowup"]
)
def test_trials_are_decided_by_the_statements(name):
    """With the statements exchanged no model tells for the correction: that the printed one fails is found."""
    claim = CLAIMS[name]
    assert not any(trial.tells for trial in claim.trials(claim.corrected().value, claim.printed.value))


def test_compared_to_a_tolerance():
    assert compared("m", "q", 1.0, 1.01, 1.0001).tells
    assert not compared("m", "q", 1.0, 1.0001, 1.0).tells


def test_corrections_are_lines_of_unicode_and_formulas_of_a_page(verdicts):
    claims = [CLAIMS[name] for name in verdicts]
    found = VerdictTable(claims, list(verdicts.values()))
    lines = found.screen().splitlines()
    corrected = [name for name, verdict in verdicts.items() if verdict.kind == "corrected"]
    assert [line.split()[0] for line in lines if ", read " in line] == corrected
    assert not any("\\" in line for line in lines)
    assert "  s3-dvdt                for ∂v_c/∂t(z_*) = ½a_*, read ∂v_c/∂t(z_*) = −½ a" in lines
    assert len(lines) <= len(corrected) + 6
    assert max(map(len, found.screen(90).splitlines())) == 90
    page = found.html()
    assert page.count("<math ") == len(verdicts) + len(corrected)
    assert not re.search(r"https?://(?!www\.w3\.org/)", page)  # nothing is loaded


def test_verify_from_the_command_line():
    command = [sys.executable, "-m", "singimpact", "verify", "e:meq", "s3-dvdt", "--json"]
    found = subprocess.run(command, capture_output=True, text=True, check=True)
    claims = {claim["id"]: claim for claim in json.loads(found.stdout)["claims"]}
    assert claims["e:meq"]["verdict"] == "proved"
    assert claims["s3-dvdt"]["verdict"] == "corrected"
    assert claims["s3-dvdt"]["witness"] == {"at": "a = 1", "stated": "1/2", "derived": "-1/2"}
    assert {"id", "verdict", "printed", "corrected", "witness", "seconds"} <= set(claims["e:meq"])


def test_for_all_r_rests_on_certificates(verdicts):
    kinds = {name: [c["kind"] for c in verdicts[name].certificates] for name in CLAIMS}
    assert "chain" in kinds["s4-root-places"]
    assert kinds["s4-saddle-m3"].count("value") >= 4
    assert kinds["s4-saddle-m3"].count("positive") >= 3
    assert {"value", "positive"} <= set(kinds["s5-mstar-place"])
    assert "positive" in kinds["s5-slopes"]
    assert "positive" in kinds["s4b-M"]
    assert "definite" in kinds["s5-positive"]
    assert "value" in kinds["s3-slope-r"]


def test_a_kept_verdict_with_a_damaged_certificate_is_decided_again(tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    run(select(["s4b-M"]), cached=True)
    (path,) = (tmp_path / "verdicts").iterdir()
    kept = cache.recall(path)
    key, _ = json.loads(kept)[1]
    assert recall("s4b-M", key) is not None
    cache.keep(path, kept.replace(b'"sign": 1', b'"sign": -1'))
    assert recall("s4b-M", key) is None
    assert run(select(["s4b-M"]), cached=True)[0].kind == "proved"


def test_a_proof_whose_certificate_is_refused_is_none():
    def forged(_value):
        left_behind(definite(["1", "0", "-1"]))
        return Check(True, "proved", "a saddle is said to have one sign")

    verdict = run([replace(CLAIMS["s4b-M"], verify=forged)])[0]
    assert verdict.kind == "error"
    assert "the form has not one sign" in verdict.evidence
